/* Diagnostics: layout, order, nearest words, and messages that travel to rank 0. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include "base/diag/diag.h"

static PetscMPIInt rank, ranks;

/* What DiagFlush prints; to be freed. */
__attribute__((noinline)) static char *Flush(Diag *diag)
{
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(DiagFlush(diag, out), 0);
  fclose(out);
  return text;
}

static void Expect(Diag *diag, const char *expected)
{
  char *text = Flush(diag);
  assert_string_equal(text, rank == 0 ? expected : "");
  free(text);
}

static void Layout(void **state)
{
  const DiagPlace place = {"case.yaml", "\trubber: {yung: 90e6}", 12, 11, 4};
  Diag *diag;
  (void)state;
  assert_int_equal(DiagCreate(&diag), 0);
  diag_at(diag, DIAG_ERROR, &place, "key '%s' of materials.rubber is not known", "yung");
  diag_hint(diag, "did you mean '%s'?", "young");
  assert_int_equal(diag_errors(diag), 1);
  Expect(diag,
         "case.yaml:12:11: error: key 'yung' of materials.rubber is not known\n"
         "  \trubber: {yung: 90e6}\n"
         "  \t         ^~~~\n"
         "  hint: did you mean 'young'?\n");
  assert_int_equal(diag_errors(diag), 0);
  assert_int_equal(DiagDestroy(&diag), 0);
  assert_null(diag);
}

/* Characters count, not bytes; and nothing of the file reaches the terminal that could steer it. */
static void OddCharacters(void **state)
{
  const DiagPlace accents = {"a", "\xc3\xa9\xe2\x82\xac: x", 1, 5, 1}, escape = {"b", "\x1b[2J\xff x", 1, 6, 1};
  Diag *diag;
  (void)state;
  assert_int_equal(DiagCreate(&diag), 0);
  diag_at(diag, DIAG_WARNING, &accents, "one");
  diag_at(diag, DIAG_NOTE, &escape, "two");
  assert_int_equal(diag_errors(diag), 0);
  assert_int_equal(diag_warnings(diag), 1);
  Expect(diag,
         "a:1:5: warning: one\n  \xc3\xa9\xe2\x82\xac: x\n      ^\n"
         "b:1:6: note: two\n  ?[2J? x\n       ^\n");
  assert_int_equal(DiagDestroy(&diag), 0);
}

static void LongLineIsCut(void **state)
{
  char line[1001], *text;
  Diag *diag;
  (void)state;
  memset(line, 'a', 1000);
  line[1000] = '\0';
  line[499] = 'X';
  const DiagPlace place = {"f", line, 1, 500, 1};
  assert_int_equal(DiagCreate(&diag), 0);
  diag_at(diag, DIAG_ERROR, &place, "here");
  text = Flush(diag);
  if (rank == 0) {
    const char *source = strchr(text, '\n') + 1, *caret = strchr(source, '\n') + 1;
    assert_true(strlen(text) < 300);
    assert_int_equal(strchr(source, 'X') - source, strchr(caret, '^') - caret);
  }
  free(text);
  assert_int_equal(DiagDestroy(&diag), 0);
}

static void Resolver(void *context, const char *path, DiagPlace *place)
{
  place->file = context;
  place->line = path ? (int)strlen(path) : 0;
}

static void SortedByLine(void **state)
{
  Diag *diag;
  char file[] = "c";
  (void)state;
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(DiagSetResolver(diag, Resolver, file), 0);
  diag_error(diag, "333", "third");
  diag_warning(diag, "1", "first");
  diag_error(diag, NULL, "whole");
  diag_error(diag, "22", "second");
  diag_error(diag, "22", "second again");
  Expect(diag,
         "c: error: whole\nc:1: warning: first\nc:2: error: second\nc:2: error: second again\nc:3: error: third\n");
  assert_int_equal(DiagDestroy(&diag), 0);
}

/* A thousand mistakes are counted; the first of them are shown, and no warning takes an error's
 * place. */
static void ManyAreCounted(void **state)
{
  Diag *diag;
  int lines = 0;
  (void)state;
  assert_int_equal(DiagCreate(&diag), 0);
  for (int i = 0; i < 1000; ++i) diag_warning(diag, NULL, "warning %d", i);
  assert_true(diag_full(diag, DIAG_WARNING));
  assert_false(diag_full(diag, DIAG_ERROR));
  for (int i = 0; i < 1000; ++i) diag_error(diag, NULL, "error %d", i);
  diag_hint(diag, "of none that is shown");
  assert_int_equal(diag_errors(diag), 1000);
  assert_int_equal(diag_warnings(diag), 1000);
  char *text = Flush(diag);
  for (const char *c = text; *c; ++c) lines += *c == '\n';
  assert_int_equal(lines, rank == 0 ? 2 * DIAG_MOST + 2 : 0);
  if (rank == 0) assert_non_null(strstr(text, "error: error 49\nand 950 more warnings\nand 950 more errors\n"));
  assert_null(strstr(text, "hint"));
  free(text);
  assert_int_equal(diag_errors(diag), 0);
  diag_error(diag, NULL, "afterwards");
  Expect(diag, "error: afterwards\n");
  assert_int_equal(DiagDestroy(&diag), 0);
}

/* As many on every rank: rank 0 tells its own and counts all. */
static void ManyTravel(void **state)
{
  PetscInt errors;
  Diag *diag;
  (void)state;
  assert_int_equal(DiagCreate(&diag), 0);
  for (int i = 0; i < 100; ++i) diag_error(diag, NULL, "error %d", i);
  assert_int_equal(DiagReduce(PETSC_COMM_WORLD, diag, &errors), 0);
  assert_true(errors >= 100);
  char *text = Flush(diag);
  if (rank == 0) assert_non_null(strstr(text, "more errors\n"));
  free(text);
  assert_int_equal(DiagDestroy(&diag), 0);
}

static void LongMessageIsCut(void **state)
{
  char huge[5000];
  Diag *diag;
  (void)state;
  memset(huge, 'k', sizeof huge - 1);
  huge[sizeof huge - 1] = '\0';
  assert_int_equal(DiagCreate(&diag), 0);
  diag_error(diag, NULL, "key '%s' is not known", huge);
  char *text = Flush(diag);
  assert_true(strlen(text) < 2100);
  if (rank == 0) assert_non_null(strstr(text, "kkk...\n"));
  free(text);
  assert_int_equal(DiagDestroy(&diag), 0);
}

static void Nearest(void **state)
{
  const char *const words[] = {"young", "poisson", "points_per_cell", "keep-on-boundary", NULL};
  char huge[2000];
  (void)state;
  assert_string_equal(diag_nearest("yung", words), "young");
  assert_string_equal(diag_nearest("yuong", words), "young");
  assert_string_equal(diag_nearest("Poisson", words), "poisson");
  assert_string_equal(diag_nearest("points-per-cell", words), "points_per_cell");
  assert_string_equal(diag_nearest("point_per_cells", words), "points_per_cell");
  assert_string_equal(diag_nearest("points", words), "points_per_cell");
  assert_string_equal(diag_nearest("keep_it", words), "keep-on-boundary");
  assert_null(diag_nearest("pointless_and_otherwise", words)); /* less than half */
  assert_null(diag_nearest("density", words));
  assert_null(diag_nearest("", words));
  memset(huge, 'x', sizeof(huge));
  huge[sizeof(huge) - 1] = '\0';
  assert_null(diag_nearest(huge, words));
}

/* Every rank says the same, and one thing of its own. */
static void Reduce(void **state)
{
  const DiagPlace place = {"c", "text", 7, 2, 1};
  char expected[400] = "c:7:2: error: common\n  text\n   ^\n  hint: h\n", own[80];
  PetscInt errors;
  Diag *diag;
  (void)state;
  assert_int_equal(DiagCreate(&diag), 0);
  diag_at(diag, DIAG_ERROR, &place, "common");
  diag_hint(diag, "h");
  const DiagPlace mine = {"c", NULL, 10 + rank, 0, 1};
  diag_at(diag, DIAG_ERROR, &mine, "rank %d", rank);
  assert_int_equal(DiagReduce(PETSC_COMM_WORLD, diag, &errors), 0);
  assert_int_equal(errors, 1 + ranks);
  assert_int_equal(DiagReduce(PETSC_COMM_WORLD, diag, &errors), 0);
  assert_int_equal(errors, 1 + ranks);
  for (int r = 0; r < ranks; ++r) {
    snprintf(own, sizeof(own), "c:%d: error: rank %d\n", 10 + r, r);
    strcat(expected, own);
  }
  Expect(diag, expected);
  assert_int_equal(DiagDestroy(&diag), 0);
}

/* Two things about the same place are two messages, whoever says them; the same thing said twice is
 * one. */
static void ReduceKeepsWords(void **state)
{
  const DiagPlace place = {"c", "text", 7, 2, 1};
  PetscInt errors;
  Diag *diag;
  (void)state;
  assert_int_equal(DiagCreate(&diag), 0);
  diag_at(diag, DIAG_ERROR, &place, "it is too long");
  diag_at(diag, DIAG_ERROR, &place, "it is not known");
  diag_at(diag, DIAG_ERROR, &place, "it is too long");
  assert_int_equal(DiagReduce(PETSC_COMM_WORLD, diag, &errors), 0);
  assert_int_equal(errors, 2);
  Expect(diag, "c:7:2: error: it is too long\n  text\n   ^\nc:7:2: error: it is not known\n  text\n   ^\n");
  assert_int_equal(DiagDestroy(&diag), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Layout),        cmocka_unit_test(OddCharacters),
                                     cmocka_unit_test(LongLineIsCut), cmocka_unit_test(ManyAreCounted),
                                     cmocka_unit_test(ManyTravel),    cmocka_unit_test(LongMessageIsCut),
                                     cmocka_unit_test(SortedByLine),  cmocka_unit_test(Nearest),
                                     cmocka_unit_test(Reduce),        cmocka_unit_test(ReduceKeepsWords)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  if (rank > 0 && !freopen("/dev/null", "w", stdout)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
