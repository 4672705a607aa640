#include "base/process/start.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/process/memory.h"

PetscErrorCode StartPetsc(int *argc, char ***argv)
{
  /* PETSc looks for files even so if it gets no words at all */
  static char name[] = "talus", *own[] = {name, NULL};
  char **list = own;
  int n = 1;
  const PetscBool given = argc && argv && *argc > 0;
  PetscErrorCode code = MemoryInstall(given ? *argc : 0, given ? *argv : NULL);
  if (!code) code = PetscOptionsSetValue(NULL, "-skip_petscrc", NULL);
  if (!code) code = given ? PetscInitialize(argc, argv, NULL, NULL) : PetscInitialize(&n, &list, NULL, NULL);
  return code;
}

/* Who asks for a file of options, or against those that PETSc looks for, knows. */
static PetscBool is_told_of(int argc, char **argv)
{
  const char *options = getenv("PETSC_OPTIONS");
  if (options && strstr(options, "-skip_petscrc")) return PETSC_TRUE;
  for (int i = 1; i < argc; ++i)
    if (!strcmp(argv[i], "-options_file") || !strcmp(argv[i], "-skip_petscrc")) return PETSC_TRUE;
  return PETSC_FALSE;
}

const char *start_unread_file(int argc, char **argv, char path[PETSC_MAX_PATH_LEN])
{
  static const char *const names[] = {"petscrc", ".petscrc"};
  const char *home = getenv("HOME");
  path[0] = '\0';
  if (is_told_of(argc, argv)) return path;
  for (size_t i = 0; i < 2; ++i)
    if (!access(names[i], R_OK)) return strcpy(path, names[i]);
  snprintf(path, PETSC_MAX_PATH_LEN, "%s/.petscrc", home ? home : "");
  if (!home || access(path, R_OK)) path[0] = '\0';
  return path;
}
