/* Krylov methods on constrained systems: the iteration stays where all constraints hold (Gould,
 * Hribar, Nocedal 2001).
 *
 * The system K y - s C^T mu = f, -s C y = g has its unknowns mu on the twins
 * (solve/forces/constraints.h). With D the diagonal of K and S = C D^-1 C^T the projections are 1 -
 * D^-1 C^T S^-1 C for motions and its transpose for forces. S is small, sparse and definite; every
 * rank holds and factorises all of it, so that a projection costs one sum over ranks. */
#pragma once
#include "solve/forces/constraints.h"

typedef struct Projection {
  MPI_Comm comm;
  const System *system;
  const Grid *grid;
  unsigned char *held;      /* n_nodes x dim: fixed, and the twins: rows that K leaves empty */
  PetscInt m, first, n_own; /* rows of C: all, the first of this rank, its number */
  PetscInt *twin;           /* n_own: where in a vector the row's multiplier stands */
  PetscReal scale;          /* s */
  /* columns of C, over all ranks: rows start[j] .. start[j + 1] - 1 */
  PetscInt n_dofs, *start, *row;
  PetscReal *N; /* their numbers */
  /* n_dofs: the column's dof in this rank's vectors, -1 if another rank has it */
  PetscInt *place;
  PetscReal *inverse; /* n_dofs: of D */
  PetscReal *shift;   /* n_dofs: what the preconditioner has on its diagonal beyond K */
  PetscInt n_pairs;
  PetscReal *pair; /* values of S before they are summed up */
  Mat S, factor;
  Vec b, x;
  PetscReal *t, *lambda; /* m: right-hand side and solution, arrays of b and x */
  PetscReal *nodes[2];   /* n_nodes x dim: of a product */
  PetscBool singular;
} Projection;

/* Collective. For the constraints whose twins are not fixed; the pattern of the system, grid and
 * constraints must live on. */
PetscErrorCode ProjectionCreate(const System *system, const Grid *grid, const Constraints *constraints,
                                const unsigned char *fixed, Projection **projection);
PetscErrorCode ProjectionDestroy(Projection **projection);
/* Collective. Take the diagonal of the values that the system holds now. */
PetscErrorCode ProjectionFactor(Projection *projection);
/* After that: add the shift to the singles of the system, of which the preconditioner is made; q -=
 * shift z takes it out of a product with them. */
void projection_strengthen(const Projection *projection);
void projection_weaken(const Projection *projection, const PetscReal *z, PetscReal *q);

/* Collective, on this rank's part of vectors. q = K p. */
PetscErrorCode ProjectionMultiply(Projection *projection, const PetscReal *p, PetscReal *q);
/* Take out of r what multipliers balance, and of z what constraints forbid. */
PetscErrorCode ProjectionForces(Projection *projection, PetscReal *r);
PetscErrorCode ProjectionMotion(Projection *projection, PetscReal *z);
/* y: a motion that closes the gaps that stand on the twins in f; the multipliers on the twins in y
 * that balance r. */
PetscErrorCode ProjectionCloseGaps(Projection *projection, const PetscReal *f, PetscReal *y);
PetscErrorCode ProjectionMultipliers(Projection *projection, const PetscReal *r, PetscReal *y);
