/* No case of the collection, and no row of its studies, has a key that has no effect: what a series leaves idle that
 * the case, or the study, wrote for another choice is no mistake of anybody. */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka wants those before it */
#include <cmocka.h>
#include "input/case_file.h"
#include "verify/verify_private.h"

#define OK(call) assert_int_equal((call), 0)

/* What is said of the case alone, and of the case of each row; to be freed. */
static char *said_of(const char *folder, PetscInt *rows)
{
  const VerifyOptions options = {.folder = folder, .full = PETSC_TRUE};
  Verification v = {.comm = PETSC_COMM_SELF, .size = 1, .options = &options};
  char reference[PETSC_MAX_PATH_LEN], *text = NULL;
  size_t size;
  Case *c;
  Diag *diag;
  FILE *out = open_memstream(&text, &size);
  OK(DiagCreate(&diag));
  OK(PetscSNPrintf(v.file, sizeof v.file, "%s/case.yaml", folder));
  OK(PetscSNPrintf(reference, sizeof reference, "%s/reference.yaml", folder));
  if (access(v.file, R_OK)) *rows = -1; /* of one material point, without a grid */
  else {
    OK(CaseRead(v.comm, v.file, 0, NULL, diag, &c));
    OK(CaseDestroy(&c));
    OK(DiagFlush(diag, out));
    OK(ReferenceRead(v.comm, reference, diag, &v.reference));
    OK(VerifyPlanAll(&v, diag));
    *rows = v.n;
    for (PetscInt k = 0; k < v.n; ++k) {
      OK(VerifyPlanRow(&v, &v.rows[k], diag, &c));
      OK(CaseDestroy(&c));
      OK(DiagFlush(diag, out));
    }
    OK(VerifyPlanClear(&v));
    OK(ReferenceDestroy(&v.reference));
  }
  OK(DiagDestroy(&diag));
  fclose(out);
  return text;
}

static void test_cases(void **state)
{
  DIR *cases = opendir(TALUS_SOURCE_DIR "/cases");
  PetscInt n = 0, wrong = 0, rows;
  (void)state;
  assert_non_null(cases);
  for (struct dirent *entry; (entry = readdir(cases));) {
    char folder[PETSC_MAX_PATH_LEN];
    if (entry->d_name[0] == '.') continue;
    snprintf(folder, sizeof folder, "%s/%s", TALUS_SOURCE_DIR "/cases", entry->d_name);
    char *said = said_of(folder, &rows);
    n += PetscMax(0, rows);
    if (strstr(said, "has no effect here") && ++wrong) print_error("%s", said);
    free(said);
  }
  closedir(cases);
  assert_true(n > 500);
  assert_int_equal(wrong, 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_cases)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
