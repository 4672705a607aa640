#include "base/exchange.h"

static PetscErrorCode Offsets(PetscInt n, const PetscInt *count, PetscInt **start)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n + 1, start));
  (*start)[0] = 0;
  for (PetscInt i = 0; i < n; ++i) (*start)[i + 1] = (*start)[i] + count[i];
  PetscFunctionReturn(0);
}

PetscErrorCode ExchangeCreate(MPI_Comm comm, PetscMPIInt size, const PetscInt *per_rank, PetscMPIInt *slot, Exchange *e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(e, sizeof *e));
  PetscCall(PetscCommDuplicate(comm, &e->comm, &e->tag));
  PetscCall(PetscMalloc2(size, &e->to, size, &e->to_count));
  for (PetscMPIInt r = 0; r < size; ++r) {
    slot[r] = per_rank[r] ? e->n_to : -1;
    if (per_rank[r]) e->to[e->n_to] = r, e->to_count[e->n_to++] = per_rank[r];
  }
  PetscCall(
    PetscCommBuildTwoSided(e->comm, 1, MPIU_INT, e->n_to, e->to, e->to_count, &e->n_from, &e->from, &e->from_count));
  /* the same order at every run */
  PetscCall(PetscSortMPIIntWithIntArray(e->n_from, e->from, e->from_count));
  PetscCall(Offsets(e->n_to, e->to_count, &e->to_start));
  PetscCall(Offsets(e->n_from, e->from_count, &e->from_start));
  PetscFunctionReturn(0);
}

PetscErrorCode ExchangeDestroy(Exchange *e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(e->to, e->to_count));
  PetscCall(PetscFree(e->from));
  PetscCall(PetscFree(e->from_count));
  PetscCall(PetscFree(e->to_start));
  PetscCall(PetscFree(e->from_start));
  PetscCall(PetscCommDestroy(&e->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ExchangeItems(const Exchange *e, size_t bytes, PetscBool back, char *out, char *in)
{
  const PetscMPIInt n_out = back ? e->n_from : e->n_to, n_in = back ? e->n_to : e->n_from;
  const PetscMPIInt *to = back ? e->from : e->to, *from = back ? e->to : e->from;
  const PetscInt *out_start = back ? e->from_start : e->to_start, *in_start = back ? e->to_start : e->from_start;
  MPI_Datatype item;
  MPI_Request *request;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_contiguous((int)bytes, MPI_BYTE, &item));
  PetscCallMPI(MPI_Type_commit(&item));
  PetscCall(PetscMalloc1((size_t)(n_out + n_in), &request));
  for (PetscMPIInt i = 0; i < n_in; ++i) {
    PetscCallMPI(MPI_Irecv(in + bytes * (size_t)in_start[i], (int)(in_start[i + 1] - in_start[i]), item, from[i],
                           e->tag, e->comm, request + i));
  }
  for (PetscMPIInt i = 0; i < n_out; ++i) {
    PetscCallMPI(MPI_Isend(out + bytes * (size_t)out_start[i], (int)(out_start[i + 1] - out_start[i]), item, to[i],
                           e->tag, e->comm, request + n_in + i));
  }
  PetscCallMPI(MPI_Waitall(n_out + n_in, request, MPI_STATUSES_IGNORE));
  PetscCall(PetscFree(request));
  PetscCallMPI(MPI_Type_free(&item));
  PetscFunctionReturn(0);
}
