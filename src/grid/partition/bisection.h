/* Recursive coordinate bisection of positions that lie scattered over the ranks: where each rank's
 * part of space is. */
#pragma once
#include <petscsys.h>

/* A part of space: ranks below `middle` are on the lower side of the cut. */
typedef struct {
  PetscMPIInt first, middle, end;
  PetscInt axis, lower, upper; /* children; -1: a single rank */
  PetscReal cut;
} SpacePart;

typedef struct {
  PetscInt n;
  SpacePart *part; /* the first is all of space */
} SpaceCuts;

/* Collective. Cuts that give each rank about the same number of the positions x (n x dim). */
PetscErrorCode SpaceCutsCreate(MPI_Comm comm, PetscInt dim, PetscInt n, const PetscReal *x, SpaceCuts *cuts);
PetscErrorCode SpaceCutsDestroy(SpaceCuts *cuts);
/* The rank to whose part x belongs. */
PetscMPIInt space_owner(const SpaceCuts *cuts, const PetscReal *x);
