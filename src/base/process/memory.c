#include "base/process/memory.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

/* A control group's bytes; 0: it allows all that there is. */
static PetscReal control_group(void)
{
  char line[64] = "";
  FILE *file = fopen("/sys/fs/cgroup/memory.max", "r");
  if (!file) return 0;
  if (!fgets(line, sizeof line, file)) line[0] = 0;
  fclose(file);
  return (PetscReal)strtod(line, NULL); /* of "max": 0 */
}

static PetscReal of_this_machine(void)
{
  const PetscReal group = control_group(), all = (PetscReal)sysconf(_SC_PHYS_PAGES) * (PetscReal)sysconf(_SC_PAGESIZE);
  if (!(all > 0)) return group;
  return group > 0 ? PetscMin(group, all) : all;
}

/* Bytes; 0: nothing, or nothing that makes sense. */
static PetscReal told_memory(Diag *diag)
{
  const char *told = getenv("TALUS_MEMORY");
  char *end = NULL;
  const double size = told ? strtod(told, &end) : 0;
  if (!told) return 0;
  if (end > told && !*end && size > 0 && size < INFINITY) return (PetscReal)size * 1e9;
  diag_warning(diag, NULL, "TALUS_MEMORY is '%s', and counts for nothing: it must be a number > 0, in GB", told);
  return 0;
}

PetscErrorCode MemoryHeld(MPI_Comm comm, Diag *diag, PetscReal *bytes)
{
  const PetscReal limit = told_memory(diag);
  PetscReal here = 0;
  PetscMPIInt rank;
  MPI_Comm machine;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine));
  PetscCallMPI(MPI_Comm_rank(machine, &rank));
  PetscCallMPI(MPI_Comm_free(&machine));
  if (rank == 0) here = of_this_machine();
  PetscCall(MPIU_Allreduce(&here, bytes, 1, MPIU_REAL, MPI_SUM, comm));
  if (limit > 0) *bytes = limit;
  PetscFunctionReturn(0);
}
