#include "base/process/memory.h"
#include <stdlib.h>
#include <string.h>

static PetscErrorCode Refuse(size_t bytes, int line, const char *function, const char *file)
{
  return PetscError(PETSC_COMM_SELF, line, function, file, PETSC_ERR_MEM, PETSC_ERROR_INITIAL,
                    "no memory left: %.0f bytes were asked for", (double)bytes);
}

static PetscErrorCode Allocate(size_t bytes, PetscBool clear, int line, const char *function, const char *file,
                               void **result)
{
  *result = NULL;
  if (!bytes) return 0;
  *result = clear ? calloc(1, bytes) : malloc(bytes);
  return *result ? 0 : Refuse(bytes, line, function, file);
}

static PetscErrorCode Free(void *data, int line, const char *function, const char *file)
{
  (void)line, (void)function, (void)file;
  free(data);
  return 0;
}

static PetscErrorCode Reallocate(size_t bytes, int line, const char *function, const char *file, void **data)
{
  if (!bytes) {
    free(*data);
    *data = NULL;
    return 0;
  }
  void *larger = realloc(*data, bytes);
  if (!larger) return Refuse(bytes, line, function, file);
  *data = larger;
  return 0;
}

PetscErrorCode MemoryInstall(int argc, char **argv)
{
  const char *options = getenv("PETSC_OPTIONS");
  PetscBool debug = PetscDefined(USE_DEBUG) || (options && strstr(options, "-malloc"));
  for (int i = 1; i < argc; ++i)
    if (!strncmp(argv[i], "-malloc", 7)) debug = PETSC_TRUE;
  return debug ? 0 : PetscMallocSet(Allocate, Free, Reallocate);
}
