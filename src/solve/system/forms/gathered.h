/* The tangent where points gathered it: no copy of it is made, and pairs of nodes whose numbers are all zero, which is
 * most of them where a pattern leaves room for points to come, are passed over. Rows that several ranks assemble are
 * never summed: each rank multiplies what its own groups gave, and the products go to the owners. */
#pragma once
#include <petscsf.h>
#include "solve/system/system.h"

typedef struct Gathered {
  const System *s;
  PetscBool symmetric; /* from the diagonals on alone */
  PetscSF ghosts;      /* roots: owned rows; leaves: ghost rows; NULL on one rank */
  MPI_Datatype vector; /* a node's numbers */
  /* pairs of each row that are not zero, the diagonal first where it is symmetric: n_rows + 1; place in the pattern,
   * and the column's row */
  PetscInt *start, *pair, *column;
  PetscReal *x, *y; /* n_rows nodes, gathered_stride numbers each */
} Gathered;

/* Numbers a node has in vectors of products, so that it fills a register, or half of one. */
static inline int gathered_stride(const int dim) { return dim == 2 ? 2 : 4; }

/* Collective. Of the system's pattern, which must live on; blocks are those of displacements alone. */
PetscErrorCode GatheredCreate(const System *system, PetscBool symmetric, Gathered **gathered);
PetscErrorCode GatheredDestroy(Gathered **gathered);
/* Which pairs are not zero now; what was made of the matrix before is old. */
PetscErrorCode GatheredFill(Gathered *gathered, Mat matrix);
/* Collective. y = A x, and the diagonal of A; for a Mat of type shell. */
PetscErrorCode GatheredMultiply(Gathered *gathered, Vec x, Vec y);
PetscErrorCode GatheredDiagonal(Gathered *gathered, Vec diagonal);
