/* talus verify: is what talus computes right? */
#include "cli/cli.h"
#include "verify/verify.h"

static const CliOption options_known[] = {
  {"run", "RUN_DIR", "run nothing: compare this run with the rows whose case it is"},
  {"full", NULL, "also the rows that take long"},
  {"only", "STUDY", "one study of reference.yaml"},
  {"out", "DIR", "where runs, tables and figures go; default: runs/verify/<case>"},
  {"keep", NULL, "keep the states (.hdf) of all runs, not only logs and histories"},
  {"resume", NULL, "take over the runs that an earlier call has finished; the tables name the program they are from"},
  {"record", NULL, "write the tables into docs/verification.md of the source tree, too"},
  CLI_LAW_OPTIONS,
  {"trust", NULL,
   "let the .geo of the case run programs and write files (Gmsh's SystemCall, Save, ...): only if you know it"},
  {NULL, NULL, NULL},
};

const CliUsage cli_verify_usage = {
  .usage = "talus verify CASE_DIR [options]",
  .help =
    "Runs every row of CASE_DIR/reference.yaml, compares it with its reference, and draws the figures.\n"
    "With --run it only looks at a run that is there already.\n"
    "The exit code is 3 if a row is off, 1 if a run gave up. docs/verification.md tells the language of the file.",
  .examples =
    "talus verify cases/cantilever\ntalus verify cases/cantilever --full --keep\ntalus verify cases/cantilever --run "
    "runs/cantilever",
  .options = options_known,
  .min_words = 1,
  .max_words = 1,
};

/* A row that is not in the file cannot be compared. */
static PetscErrorCode CompareRun(const VerifyOptions *options, Diag *diag, VerifyOutcome *outcome)
{
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(VerifyRun(PETSC_COMM_WORLD, options, stdout, diag, &n, outcome));
  if (n || *outcome == VERIFY_BAD_INPUT) PetscFunctionReturn(0);
  if (cli_prints()) {
    diag_error(diag, NULL, "no row of %s/reference.yaml has the case of '%s'", options->folder, options->run);
    diag_hint(diag,
              "a run is compared if all its values are those of a row, but for title, output, checkpoint, linear and "
              "petsc");
  }
  *outcome = VERIFY_BAD_INPUT;
  PetscFunctionReturn(0);
}

PetscErrorCode CliVerify(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  VerifyOutcome outcome;
  PetscBool go_on;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_verify_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  const VerifyOptions options = {
    .folder = arguments.words[0],
    .out = cli_value(&arguments, "out"),
    .only = cli_value(&arguments, "only"),
    .run = cli_value(&arguments, "run"),
    .full = cli_flag(&arguments, "full"),
    .keep = cli_flag(&arguments, "keep"),
    .resume = cli_flag(&arguments, "resume"),
    .record = cli_flag(&arguments, "record"),
    .trust = cli_flag(&arguments, "trust"),
  };
  if (options.run && (options.out || options.full || options.keep || options.resume || options.record)) {
    PetscCall(CliUsageError(exit_code, "only --only goes with it", "--run writes nothing and runs nothing"));
    PetscFunctionReturn(0);
  }
  PetscCall(DiagCreate(&diag));
  if (options.run) PetscCall(CompareRun(&options, diag, &outcome));
  else PetscCall(VerifyCase(PETSC_COMM_WORLD, &options, stdout, diag, &outcome));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  *exit_code = (int)outcome;
  PetscFunctionReturn(0);
}
