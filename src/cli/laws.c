/* --law and --umat: laws from the user's own libraries, loaded as soon as the command line is
 * read. */
#include <stdio.h>
#include <string.h>
#include "cli/cli.h"
#include "material/plugin/plugin.h"

PetscErrorCode CliLoadLaws(const CliArguments *a, PetscBool *ok, int *exit_code)
{
  PetscInt errors = 0, loaded = 0;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  for (int i = 0; i < a->n_options; ++i) {
    const PetscBool umat = !strcmp(a->names[i], "umat");
    if (!umat && strcmp(a->names[i], "law")) continue;
    PetscCall(PluginLoad(a->values[i], umat, diag));
    ++loaded;
  }
  if (loaded) PetscCall(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  if (errors) *ok = PETSC_FALSE;
  if (errors) *exit_code = CLI_BAD_INPUT;
  PetscFunctionReturn(0);
}
