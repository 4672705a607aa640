/* Any bytes as a case file. What is accepted must be accepted again when it is written down and
 * read back. */
#include "fuzz.h"
#include "input/case_file.h"

static FILE *nowhere;

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc, (void)argv;
  fuzz_start();
  nowhere = fopen("/dev/null", "w");
  return 0;
}

static Case *Read(const uint8_t *data, size_t n)
{
  char path[64];
  Diag *diag;
  Case *c;
  const int fd = fuzz_file(data, n, path);
  FUZZ_CALL(DiagCreate(&diag));
  FUZZ_CALL(CaseRead(PETSC_COMM_SELF, path, 0, NULL, diag, &c));
  if (!c && !diag_errors(diag)) abort(); /* refused without a word */
  FUZZ_CALL(DiagFlush(diag, nowhere));
  FUZZ_CALL(DiagDestroy(&diag));
  close(fd);
  return c;
}

static void fuzz_one(const uint8_t *data, size_t n)
{
  char *yaml, *again;
  Case *c = Read(data, n);
  if (!c) return;
  FUZZ_CALL(CaseToYaml(c, &yaml));
  FUZZ_CALL(CaseDestroy(&c));
  c = Read((const uint8_t *)yaml, strlen(yaml));
  if (!c) {
    fputs(yaml, stderr);
    abort();
  }
  FUZZ_CALL(CaseToYaml(c, &again));
  if (strcmp(yaml, again)) {
    fprintf(stderr, "%s\nis read back as\n%s", yaml, again);
    abort();
  }
  FUZZ_CALL(CaseDestroy(&c));
  FUZZ_CALL(PetscFree(yaml));
  FUZZ_CALL(PetscFree(again));
}
