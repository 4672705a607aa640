/* Messages among ranks that do not know beforehand who will write to them: PetscCommBuildTwoSided
 * tells every rank who writes to it and how much, then the items travel. */
#pragma once
#include <petscsys.h>

/* One two-sided exchange: partners and numbers of items each way. */
typedef struct {
  MPI_Comm comm;
  PetscMPIInt tag;
  PetscMPIInt n_to, *to, n_from, *from;
  PetscInt *to_count, *from_count;
  PetscInt *to_start, *from_start; /* one more than the partners: where each message begins */
} Exchange;

/* Collective. per_rank: items for each rank. On return slot[r] is the message's number, -1 if
 * nothing goes to r. */
PetscErrorCode ExchangeCreate(MPI_Comm comm, PetscMPIInt size, const PetscInt *per_rank, PetscMPIInt *slot,
                              Exchange *e);
PetscErrorCode ExchangeDestroy(Exchange *e);
/* Collective. Items of so many bytes; out in the order of the messages to, in of those from. Back:
 * the other way round. */
PetscErrorCode ExchangeItems(const Exchange *e, size_t bytes, PetscBool back, char *out, char *in);
