#include "base/process/environment.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static PetscBool is_of_mpi(const char *variable)
{
  static const char *const launchers[] = {"OMPI_", "PMIX_", "PMI_", "PRTE_", "HYDRA_"};
  for (size_t p = 0; p < sizeof launchers / sizeof *launchers; ++p)
    if (!strncmp(variable, launchers[p], strlen(launchers[p]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Was the variable there, with this value, when the process began? */
static PetscBool was_there(const char *variable)
{
  FILE *in = fopen("/proc/self/environ", "r");
  char *text = NULL;
  size_t size = 0;
  PetscBool found = PETSC_FALSE;
  while (in && !found && getdelim(&text, &size, 0, in) > 0) found = !strcmp(text, variable);
  free(text);
  if (in) fclose(in);
  return found;
}

PetscErrorCode EnvironmentForChild(PetscInt more, char ***out)
{
  const PetscBool launched = getenv("OMPI_COMM_WORLD_SIZE") || getenv("PMI_SIZE");
  PetscInt n = 0, kept = 0;

  PetscFunctionBeginUser;
  while (environ[n]) ++n;
  PetscCall(PetscMalloc1(n + more + 1, out));
  for (PetscInt k = 0; k < n; ++k)
    if (!is_of_mpi(environ[k]) || (!launched && was_there(environ[k]))) (*out)[kept++] = environ[k];
  (*out)[kept] = NULL;
  PetscFunctionReturn(0);
}
