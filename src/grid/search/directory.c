/* The directory itself is spread over the ranks in equal shares, so that no rank knows all
 * numbers. */
#include "grid/search/directory.h"

PetscErrorCode ReasonShare(MPI_Comm comm, char reason[256])
{
  PetscMPIInt rank, size, mine, first;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  mine = reason[0] ? rank : size;
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, comm));
  if (first < size) PetscCallMPI(MPI_Bcast(reason, 256, MPI_CHAR, first, comm));
  PetscFunctionReturn(0);
}

/* Leaves are n numbers, roots the shares of the directory. Leaves without a number (-1) are left
 * out. */
static PetscErrorCode ShareGraph(MPI_Comm comm, PetscLayout layout, PetscInt n, const PetscInt *number, PetscSF *sf)
{
  PetscInt *local, *remote, k = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &local, n, &remote));
  for (PetscInt i = 0; i < n; ++i)
    if (number[i] >= 0) local[k] = i, remote[k++] = number[i];
  PetscCall(PetscSFCreate(comm, sf));
  PetscCall(PetscSFSetGraphLayout(*sf, layout, k, local, PETSC_COPY_VALUES, remote));
  PetscCall(PetscFree2(local, remote));
  PetscFunctionReturn(0);
}

PetscErrorCode DirectoryFind(MPI_Comm comm, PetscInt n_numbers, PetscInt n_have, const PetscInt *have, PetscInt n_want,
                             const PetscInt *want, DirectoryPlace *place)
{
  PetscLayout layout;
  PetscSF from, to;
  PetscMPIInt rank;
  PetscInt share;
  DirectoryPlace *mine, *directory;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscLayoutCreateFromSizes(comm, PETSC_DECIDE, n_numbers, 1, &layout));
  PetscCall(PetscLayoutGetLocalSize(layout, &share));
  PetscCall(PetscMalloc2(n_have, &mine, share, &directory));
  for (PetscInt i = 0; i < n_have; ++i) mine[i] = (DirectoryPlace){rank, i};
  for (PetscInt i = 0; i < share; ++i) directory[i] = (DirectoryPlace){-1, -1};
  for (PetscInt i = 0; i < n_want; ++i) place[i] = (DirectoryPlace){-1, -1};
  PetscCall(ShareGraph(comm, layout, n_have, have, &from));
  PetscCall(PetscSFReduceBegin(from, MPIU_2INT, mine, directory, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(from, MPIU_2INT, mine, directory, MPI_REPLACE));
  PetscCall(ShareGraph(comm, layout, n_want, want, &to));
  PetscCall(PetscSFBcastBegin(to, MPIU_2INT, directory, place, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(to, MPIU_2INT, directory, place, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&from));
  PetscCall(PetscSFDestroy(&to));
  PetscCall(PetscFree2(mine, directory));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscFunctionReturn(0);
}

PetscErrorCode DirectoryLowest(MPI_Comm comm, PetscInt n_numbers, PetscInt n, const PetscInt *number, PetscInt *lowest)
{
  PetscLayout layout;
  PetscSF sf;
  PetscMPIInt rank;
  PetscInt share, *directory;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscLayoutCreateFromSizes(comm, PETSC_DECIDE, n_numbers, 1, &layout));
  PetscCall(PetscLayoutGetLocalSize(layout, &share));
  PetscCall(PetscMalloc1(share, &directory));
  for (PetscInt i = 0; i < share; ++i) directory[i] = PETSC_MAX_INT;
  for (PetscInt i = 0; i < n; ++i) lowest[i] = rank;
  PetscCall(ShareGraph(comm, layout, n, number, &sf));
  PetscCall(PetscSFReduceBegin(sf, MPIU_INT, lowest, directory, MPI_MIN));
  PetscCall(PetscSFReduceEnd(sf, MPIU_INT, lowest, directory, MPI_MIN));
  PetscCall(PetscSFBcastBegin(sf, MPIU_INT, directory, lowest, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_INT, directory, lowest, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(PetscFree(directory));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscFunctionReturn(0);
}
