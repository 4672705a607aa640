/* talus verify: is what talus computes right? */
#include "cli/cli.h"
#include "run/verify.h"

static const CliOption options_known[] = {
  {"full", NULL, "also the rows that take long"},
  {"only", "STUDY", "one study of reference.yaml"},
  {"out", "DIR", "where runs, tables and figures go; default: runs/verify/<case>"},
  {"keep", NULL, "keep the states (.hdf) of all runs, not only logs and histories"},
  {"record", NULL, "write the tables into docs/verification.md of the source tree, too"},
  {NULL, NULL, NULL},
};

static const CliUsage usage = {
  .usage = "talus verify CASE_DIR [options]",
  .help =
    "Runs every row of CASE_DIR/reference.yaml, compares it with its reference, and draws the figures.\n"
    "The exit code is 3 if a row is off, 1 if a run gave up. docs/verification.md tells the language of the file.",
  .options = options_known,
  .min_words = 1,
  .max_words = 1,
};

PetscErrorCode CliVerify(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  VerifyOutcome outcome;
  PetscBool go_on;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  const VerifyOptions options = {
    .folder = arguments.words[0],
    .out = CliValue(&arguments, "out"),
    .only = CliValue(&arguments, "only"),
    .full = CliFlag(&arguments, "full"),
    .keep = CliFlag(&arguments, "keep"),
    .record = CliFlag(&arguments, "record"),
  };
  PetscCall(DiagCreate(&diag));
  PetscCall(VerifyCase(PETSC_COMM_WORLD, &options, stdout, diag, &outcome));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  *exit_code = (int)outcome;
  PetscFunctionReturn(0);
}
