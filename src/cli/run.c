/* talus run: from a case file to a directory of results. */
#include "cli/cli.h"
#include <unistd.h>
#include "io/case_file.h"
#include "run/run.h"
#include "run/verify.h"

static const CliOption options_known[] = {
  {"set", "PATH=VALUE", "change a value of the case, e.g. --set materials.rubber.young=1e6; may be given often"},
  {"out", "DIR", "where the results go; default: runs/<name of the case>"},
  {"force", NULL, "replace a run that is in DIR already"},
  {"quiet", NULL, "nothing on the terminal but errors"},
  {"log", "FILE", "write the log there instead of to DIR/log.txt"},
  {NULL, NULL, NULL},
};

static const CliUsage usage = {
  .usage = "talus run CASE [options]",
  .help =
    "Runs a case file and writes states (.hdf, for ParaView), history.csv and a log into a run directory.\n"
    "If the case has a reference.yaml beside it that knows this very case, the results are compared with it.",
  .options = options_known,
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

/* Beside the references of the case, if it has any. Whatever they say, the run is done. */
static PetscErrorCode Compare(const char *file, const char *out)
{
  char folder[PETSC_MAX_PATH_LEN], reference[PETSC_MAX_PATH_LEN + 16];
  const char *slash = strrchr(file, '/');
  const VerifyOptions options = {.folder = folder, .run = out};
  VerifyOutcome outcome;
  PetscMPIInt there;
  PetscInt n;
  Diag *diag;

  PetscFunctionBeginUser;
  if (strcmp(slash ? slash + 1 : file, "case.yaml")) PetscFunctionReturn(0);
  snprintf(folder, sizeof folder, "%.*s", slash ? PetscMax((int)(slash - file), 1) : 1, slash ? file : ".");
  snprintf(reference, sizeof reference, "%s/reference.yaml", folder);
  there = access(reference, F_OK) == 0;
  PetscCallMPI(MPI_Bcast(&there, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  if (!there) PetscFunctionReturn(0);
  PetscCall(DiagCreate(&diag));
  PetscCall(VerifyRun(PETSC_COMM_WORLD, &options, stdout, diag, &n, &outcome));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
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
  if (result == RUN_DONE && !CliFlag(&arguments, "quiet"))
    PetscCall(Compare(arguments.words[0], CliValue(&arguments, "out") ? CliValue(&arguments, "out") : out));
  *exit_code = (int)result;
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}
