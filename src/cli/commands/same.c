/* Ranks that mpiexec has started with different words (`mpiexec -n 1 talus run a.yaml : -n 1 talus
 * run b.yaml`) would wait for each other for ever: it is found out before anything else. */
#include <stdlib.h>
#include <string.h>
#include "cli/cli.h"

/* The words behind the program's name, one text; of malloc. */
static char *join(int argc, char **argv)
{
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out) return NULL;
  for (int i = 1; i < argc; ++i) fprintf(out, " %s", argv[i]);
  fclose(out);
  return text;
}

/* The text of one rank on all; of PetscMalloc. */
static PetscErrorCode ShareText(const char *mine, PetscMPIInt from, char **text)
{
  PetscMPIInt rank, n = (PetscMPIInt)strlen(mine) + 1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Bcast(&n, 1, MPI_INT, from, PETSC_COMM_WORLD));
  PetscCall(PetscMalloc1(n, text));
  if (rank == from) PetscCall(PetscArraycpy(*text, mine, n));
  PetscCallMPI(MPI_Bcast(*text, n, MPI_CHAR, from, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

PetscErrorCode CliSameCommand(int argc, char **argv, PetscBool *same, int *exit_code)
{
  PetscMPIInt rank, size, other;
  char *mine = join(argc, argv), *first, *odd;

  PetscFunctionBeginUser;
  PetscCheck(mine, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the command line");
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(ShareText(mine, 0, &first));
  other = strcmp(mine, first) ? rank : size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &other, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  *same = other == size;
  if (!*same) {
    PetscCall(ShareText(mine, other, &odd));
    PetscCall(CliUsageError(exit_code,
                            "all ranks of one mpiexec work on the same run; start others with an mpiexec of their own",
                            "rank 0 was started as 'talus%s' and rank %d as 'talus%s'", first, (int)other, odd));
    PetscCall(PetscFree(odd));
  }
  PetscCall(PetscFree(first));
  free(mine);
  PetscFunctionReturn(0);
}
