/* talus import: projects of other programs. */
#include <string.h>
#include "cli/cli.h"
#include "import/import.h"

static const CliOption options[] = {
  {"out", "DIR", "the folder that is made; default: the name of the problem"},
  {NULL, NULL, NULL},
};

const CliUsage cli_import_usage = {
  .usage = "talus import kratos DIR [options]",
  .help =
    "Makes a case of a project of Kratos's material point method: DIR has ProjectParameters.json (or is such a file, "
    "by\n"
    "whatever name), which names the meshes of grid and body (.mdpa) and the materials. What talus lacks is told, all "
    "of\n"
    "it, with file and line, and nothing is written then; what it takes otherwise is told, too. Results that the "
    "project\n"
    "compares itself with become a reference.yaml: `talus run` compares itself with them. docs/import.md tells what is "
    "read.",
  .examples = "talus import kratos cantilever.gid --out cantilever\ntalus run cantilever/case.yaml",
  .options = options,
  .min_words = 2,
  .max_words = 2,
};

PetscErrorCode CliImport(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  char folder[PETSC_MAX_PATH_LEN] = "";
  PetscBool go_on;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_import_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  if (strcmp(arguments.words[0], "kratos")) {
    PetscCall(CliUsageError(exit_code, "kratos", "projects of '%s' are not read", arguments.words[0]));
    PetscFunctionReturn(0);
  }
  if (cli_prints()) {
    PetscCall(DiagCreate(&diag));
    PetscCall(ImportKratos(arguments.words[1], cli_value(&arguments, "out"), diag, folder));
    PetscCall(DiagFlush(diag, stderr));
    PetscCall(DiagDestroy(&diag));
    if (folder[0])
      printf("%s/case.yaml\n  talus check %s/case.yaml\n  talus run %s/case.yaml\n", folder, folder, folder);
    fflush(stdout);
    *exit_code = folder[0] ? CLI_DONE : CLI_BAD_INPUT;
  }
  PetscCallMPI(MPI_Bcast(exit_code, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
