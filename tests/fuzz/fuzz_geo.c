/* Any bytes as a script of Gmsh: looked through, and told of with a place that is in it. */
#include "fuzz.h"
#include "grid/gmsh/geo_check.h"
#include "grid/gmsh/geo_script.h"

static FILE *nowhere;

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc, (void)argv;
  fuzz_start();
  nowhere = fopen("/dev/null", "w");
  return 0;
}

static void fuzz_one(const uint8_t *data, size_t n)
{
  char path[64];
  const char *why;
  PetscBool safe;
  Diag *diag;
  GeoScript script;
  GeoFinding finding;
  GeoInclusion inclusion;
  const int fd = fuzz_file(data, n, path);
  FUZZ_CALL(GeoScriptRead(path, &script, &finding, &why));
  if (why || script.n != n) abort();
  const PetscBool is_text = !finding.reason;
  if (is_text) geo_find_action(&script, &finding);
  if (finding.reason && finding.at + finding.width > n) abort();
  for (size_t at = 0, before = 0; is_text && geo_next_inclusion(&script, &at, &inclusion); before = at)
    if (at <= before || inclusion.at + inclusion.width > n || (!inclusion.problem && !inclusion.name[0])) abort();
  FUZZ_CALL(GeoScriptFree(&script));
  FUZZ_CALL(DiagCreate(&diag));
  FUZZ_CALL(GeoCheck(path, diag, &safe));
  if ((finding.reason && safe) || (!safe && diag_errors(diag) != 1)) abort();
  FUZZ_CALL(DiagFlush(diag, nowhere));
  FUZZ_CALL(DiagDestroy(&diag));
  close(fd);
}
