#include "base/gather.h"

PetscErrorCode GatherAll(MPI_Comm comm, size_t bytes, PetscInt n, const void *mine, PetscInt *n_all, void *all)
{
  PetscMPIInt ranks, sent, width, *count, *start;
  MPI_Datatype type;
  void *gathered;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  PetscCall(PetscMPIIntCast(n, &sent));
  PetscCall(PetscMPIIntCast((PetscInt)bytes, &width));
  PetscCallMPI(MPI_Type_contiguous(width, MPI_BYTE, &type));
  PetscCallMPI(MPI_Type_commit(&type));
  PetscCall(PetscMalloc2(ranks, &count, ranks + 1, &start));
  PetscCallMPI(MPI_Allgather(&sent, 1, MPI_INT, count, 1, MPI_INT, comm));
  *n_all = start[0] = 0;
  for (PetscMPIInt r = 0; r < ranks; ++r) {
    *n_all += count[r];
    PetscCall(PetscMPIIntCast(*n_all, start + r + 1));
  }
  PetscCall(PetscMalloc((size_t)*n_all * bytes, &gathered));
  PetscCallMPI(MPI_Allgatherv(mine, sent, type, gathered, count, start, type, comm));
  PetscCallMPI(MPI_Type_free(&type));
  PetscCall(PetscFree2(count, start));
  *(void **)all = gathered;
  PetscFunctionReturn(0);
}
