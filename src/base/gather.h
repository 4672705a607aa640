/* What each rank has, on all of them. */
#pragma once
#include <petscsys.h>

/* Collective. The n things of so many bytes of each rank, in the order of ranks; all: the address of a pointer to them,
 * which is to be freed with PetscFree. Overflow of MPI's counts is an error of PETSc. */
PetscErrorCode GatherAll(MPI_Comm comm, size_t bytes, PetscInt n, const void *mine, PetscInt *n_all, void *all);
