/* talus run: from a case file to a directory of results. */
#include "cli/cli.h"
#include "io/case_file.h"
#include "run/run.h"

static const CliOption options[] = {
  {"set", "PATH=VALUE", "change a value of the case, e.g. --set materials.rubber.young=1e6; may be given often"},
  {"out", "DIR", "where the results go; default: runs/<name of the case>"},
  {"force", NULL, "replace a run that is in DIR already"},
  {"quiet", NULL, "nothing on the terminal but errors"},
  {"log", "FILE", "write the log there instead of to DIR/log.txt"},
  {NULL, NULL, NULL},
};

static const CliUsage usage = {
  .usage = "talus run CASE [options]",
  .help = "Runs a case file and writes states (.hdf, for ParaView), history.csv and a log into a run directory.",
  .options = options,
  .min_words = 1,
  .max_words = 1,
};

/* runs/cantilever for cases/cantilever/case.yaml and for cantilever.yaml. */
static void default_out(const char *file, char *out, size_t size)
{
  char name[PETSC_MAX_PATH_LEN], *base, *dot;
  PetscStrncpy(name, file, sizeof name);
  base = strrchr(name, '/') ? strrchr(name, '/') + 1 : name;
  if (!strcmp(base, "case.yaml") && base > name) {
    base[-1] = '\0';
    base = strrchr(name, '/') ? strrchr(name, '/') + 1 : name;
  } else if ((dot = strrchr(base, '.')) && dot > base) *dot = '\0';
  PetscSNPrintf(out, size, "runs/%s", base);
}

PetscErrorCode CliRun(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  PetscBool go_on;
  const char *set[CLI_MAX_ARGUMENTS];
  char out[PETSC_MAX_PATH_LEN];
  RunResult result = RUN_BAD_INPUT;
  RunSummary summary = {0};
  Diag *diag;
  Case *c;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  const PetscInt n_set = CliValues(&arguments, "set", set);
  PetscCall(DiagCreate(&diag));
  PetscCall(CaseRead(PETSC_COMM_WORLD, arguments.words[0], n_set, set, diag, &c));
  if (c) {
    default_out(arguments.words[0], out, sizeof out);
    const RunOptions run = {.out = CliValue(&arguments, "out") ? CliValue(&arguments, "out") : out,
                            .force = CliFlag(&arguments, "force"),
                            .quiet = CliFlag(&arguments, "quiet"),
                            .log = CliValue(&arguments, "log"),
                            .summary = &summary};
    PetscCall(RunCase(PETSC_COMM_WORLD, c, &run, diag, NULL, &result));
    if (summary.reason[0]) DiagError(diag, NULL, "%s", summary.reason);
  }
  PetscCall(DiagFlush(diag, stderr));
  *exit_code = (int)result;
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}
