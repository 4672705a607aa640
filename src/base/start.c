#include "base/start.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/memory.h"

PetscErrorCode StartPetsc(int *argc, char ***argv)
{
  const PetscBool words = argc && argv ? PETSC_TRUE : PETSC_FALSE;
  PetscErrorCode code = MemoryInstall(words ? *argc : 0, words ? *argv : NULL);
  if (!code) code = PetscOptionsSetValue(NULL, "-skip_petscrc", NULL);
  if (!code) code = words ? PetscInitialize(argc, argv, NULL, NULL) : PetscInitializeNoArguments();
  return code;
}

/* Who asks for the files, or against them, knows. */
static PetscBool is_told_of(void)
{
  const char *options = getenv("PETSC_OPTIONS");
  PetscBool named = PETSC_FALSE;
  if (options && strstr(options, "-skip_petscrc")) return PETSC_TRUE;
  return PetscOptionsHasName(NULL, NULL, "-options_file", &named) || named ? PETSC_TRUE : PETSC_FALSE;
}

const char *start_unread_file(char path[PETSC_MAX_PATH_LEN])
{
  static const char *const names[] = {"petscrc", ".petscrc"};
  const char *home = getenv("HOME");
  path[0] = '\0';
  if (is_told_of()) return path;
  for (size_t i = 0; i < 2; ++i)
    if (!access(names[i], R_OK)) return strcpy(path, names[i]);
  snprintf(path, PETSC_MAX_PATH_LEN, "%s/.petscrc", home ? home : "");
  if (!home || access(path, R_OK)) path[0] = '\0';
  return path;
}
