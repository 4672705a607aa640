/* talus element: one material point on a path. */
#include <string.h>
#include "cli/cli.h"
#include "element/element.h"

static const CliOption options_known[] = {
  {"test", "NAME", "of the material of a case: triaxial, oedometer, simple-shear, biaxial or isotropic"},
  {"to", "A[,B...]", "where the test goes, and turns: a strain (compression positive), or a pressure in Pa"},
  {"confining", "P", "effective pressure at the start, Pa, compression positive (default: 0)"},
  {"undrained", NULL, "the volume stays, and a pore pressure takes what that asks for"},
  {"material", "NAME", "which of the materials of the case"},
  {"steps", "N", "increments on each way (default: 100)"},
  CLI_LAW_OPTIONS,
  {"set", "PATH=VALUE", "change a value of the file; may be given often"},
  {"out", "DIR", "where the table and the picture go; default: runs/element/<name of the file>"},
  {"force", NULL, "write there even if an element.csv is in DIR that talus has not written"},
  {NULL, NULL, NULL},
};

const CliUsage cli_element_usage = {
  .usage = "talus element FILE [options]",
  .help =
    "Leads one material point through a path of strains and stresses, as a laboratory does: element.csv, a picture of\n"
    "q over p' and of what is over the strain, and a line for each stage. FILE tells material and path, or is a case\n"
    "(or its folder), one of whose materials is tested.\n"
    "The exit code is 1 if the path cannot be followed to its end. docs/element.md tells the language of the file.",
  .examples =
    "talus element clay.yaml\n"
    "talus element cases/dry-column --test triaxial --confining 2e3 --to 0.05\n"
    "talus element case.yaml --material sand --test oedometer --to 0.02,0.01,0.03",
  .options = options_known,
  .min_words = 1,
  .max_words = 1,
};

/* Options of a test mean nothing to a file that tells its path. */
static PetscErrorCode Check(const CliArguments *a, PetscBool *ok, int *exit_code)
{
  static const char *const of_test[] = {"to", "confining", "undrained", "material", "steps"};

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  for (size_t k = 0; k < sizeof of_test / sizeof of_test[0] && *ok; ++k) {
    if (cli_value(a, "test") || !cli_value(a, of_test[k])) continue;
    *ok = PETSC_FALSE;
    PetscCall(CliUsageError(exit_code, "--test triaxial", "--%s belongs to a test: it needs --test", of_test[k]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode CliElement(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  const char *set[CLI_MAX_ARGUMENTS];
  ElementOutcome outcome = ELEMENT_DONE;
  PetscBool go_on;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_element_usage, argc, argv, &arguments, &go_on, exit_code));
  if (go_on) PetscCall(Check(&arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  const ElementOptions options = {
    .file = arguments.words[0],
    .test = cli_value(&arguments, "test"),
    .material = cli_value(&arguments, "material"),
    .to = cli_value(&arguments, "to"),
    .confining = cli_value(&arguments, "confining"),
    .steps = cli_value(&arguments, "steps"),
    .undrained = cli_flag(&arguments, "undrained"),
    .n_set = cli_values(&arguments, "set", set),
    .set = set,
    .out = cli_value(&arguments, "out"),
    .force = cli_flag(&arguments, "force"),
  };
  /* a point is one rank's work */
  if (cli_prints()) {
    PetscCall(DiagCreate(&diag));
    PetscCall(ElementRun(&options, stdout, diag, NULL, &outcome));
    PetscCall(DiagFlush(diag, stderr));
    PetscCall(DiagDestroy(&diag));
  }
  *exit_code = (int)outcome;
  PetscCallMPI(MPI_Bcast(exit_code, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
