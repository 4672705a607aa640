/* Lattices: all sums with whole numbers of dim vectors a[0], a[1], ..., which are a basis of it among many. */
#pragma once
#include <petscsys.h>

#define LATTICE_TURNS 64 /* each shortens a vector; far fewer are taken */

static inline PetscReal lattice_dot(PetscInt dim, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0;
  for (PetscInt d = 0; d < dim; ++d) sum += a[d] * b[d];
  return sum;
}

/* a_i -= n a_j with the n that leaves the shortest a_i. Was it shortened? */
static inline PetscBool lattice_shorten(PetscInt dim, PetscReal *a_i, const PetscReal *a_j)
{
  const PetscReal square = lattice_dot(dim, a_j, a_j), along = lattice_dot(dim, a_i, a_j);
  /* halves of the way round to either side: neither is shorter */
  if (!(PetscAbsReal(along) > (0.5 + 1e-9) * square) || square == 0) return PETSC_FALSE;
  const PetscReal n = PetscFloorReal(along / square + 0.5);
  for (PetscInt d = 0; d < dim; ++d) a_i[d] -= n * a_j[d];
  return PETSC_TRUE;
}

/* The reduction of Lagrange (1773), in space of each pair: a basis of the same lattice of which no vector is
 * shortened by multiples of another. */
static inline void lattice_reduce(PetscInt dim, PetscReal a[3][3])
{
  PetscBool shorter = PETSC_TRUE;
  for (int turn = 0; shorter && turn < LATTICE_TURNS; ++turn) {
    shorter = PETSC_FALSE;
    for (PetscInt i = 0; i < dim; ++i)
      for (PetscInt j = 0; j < dim; ++j)
        if (i != j && lattice_shorten(dim, a[i], a[j])) shorter = PETSC_TRUE;
  }
}

/* How long the vectors of a basis are: the longest, and the root of the sum of all squares. */
typedef struct {
  PetscReal longest, all;
} LatticeSize;

static inline LatticeSize lattice_size(PetscInt dim, PetscReal a[3][3])
{
  PetscReal most = 0, sum = 0;
  for (PetscInt i = 0; i < dim; ++i) {
    const PetscReal square = lattice_dot(dim, a[i], a[i]);
    most = PetscMax(most, square);
    sum += square;
  }
  return (LatticeSize){.longest = PetscSqrtReal(most), .all = PetscSqrtReal(sum)};
}
