#include <stdio.h>
#include "cli/cli.h"
#include "input/case_file.h"
#include "run/check/check.h"

static const CliOption options[] = {
  {"set", "PATH=VALUE", "change a value of the case file: --set materials.sand.young=1e6"},
  CLI_LAW_OPTIONS,
  {"trust", NULL,
   "let the .geo of the case run programs and write files (Gmsh's SystemCall, Save, ...): only if you know it"},
  {NULL, NULL, NULL},
};

const CliUsage cli_check_usage = {
  .usage = "talus check CASE [--set PATH=VALUE]... [--trust]",
  .help =
    "Validates a case file without running it, and prints the resolved case (every key with its value, defaults too),\n"
    "sizes, estimated memory, the regions found, and warnings.",
  .examples = "talus check case.yaml\ntalus check case.yaml --set grid.size=0.05   # how large would it be?",
  .options = options,
  .min_words = 1,
  .max_words = 1,
};

static PetscErrorCode PrintResolved(const Case *c)
{
  char *text;

  PetscFunctionBeginUser;
  PetscCall(CaseToYaml(c, &text));
  if (cli_prints()) {
    printf("# %s, resolved: every key, defaults too; SI units, angles in degrees\n%s", c->file, text);
    fflush(stdout);
  }
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

PetscErrorCode CliCheck(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  const char *set[CLI_MAX_ARGUMENTS];
  PetscBool go_on;
  PetscInt errors;
  Diag *diag;
  Case *c;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_check_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  PetscCall(DiagCreate(&diag));
  const PetscInt n_set = cli_values(&arguments, "set", set);
  PetscCall(CaseRead(PETSC_COMM_WORLD, arguments.words[0], n_set, set, diag, &c));
  if (c) PetscCall(PrintResolved(c));
  if (c) c->grid.trusted = cli_flag(&arguments, "trust");
  if (c) PetscCall(CheckModel(PETSC_COMM_WORLD, c, diag, stdout));
  PetscCall(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
  if (errors) *exit_code = CLI_BAD_INPUT;
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}
