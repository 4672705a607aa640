/* Clouds that follow the stretch of the material.
 *
 * A cloud with a radius of so many spacings of the start holds fewer and fewer nodes along a direction in which the
 * material is drawn out, and from some stretch on (1.29 with moving least squares, 1.7 with maximum entropy of usual
 * width) zigzags of the nodes grow from step to step, since each step chooses clouds anew. */
#include "base/math/eigen.h"
#include "support/cloud.h"

#define STRETCH_FREE 1.2 /* up to here clouds are round */
#define STRETCH_MOST 4   /* times as long as wide, at most */
#define GRAIN 16         /* b is rounded to a sixteenth */
#define ROUNDS 20        /* of the reduction; two or three do */

/* a -= n b, where that makes column a of A shorter. */
static PetscBool shorten(PetscInt dim, PetscInt a, PetscInt b, PetscReal A[9])
{
  PetscReal both = 0, square = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    both += A[3 * d + a] * A[3 * d + b];
    square += PetscSqr(A[3 * d + b]);
  }
  const PetscReal n = round(both / square);
  if (!(PetscAbsReal(both) > (0.5 + 1e-9) * square) || !(PetscAbsReal(n) < 1e6)) return PETSC_FALSE;
  for (PetscInt d = 0; d < dim; ++d) A[3 * d + a] -= n * A[3 * d + b];
  return PETSC_TRUE;
}

/* Nodes on a lattice that is sheared stand on one whose shortest ways are others: what was sheared by 1 is the lattice
 * that it was. Columns of A: these ways, from those of the start, which F has turned and stretched. */
static void shortest_ways(PetscInt dim, const PetscReal *F, PetscReal A[9])
{
  PetscBool shorter = PETSC_TRUE;
  for (int k = 0; k < 9; ++k) A[k] = F[k];
  for (int i = 0; i < ROUNDS && shorter; ++i) {
    shorter = PETSC_FALSE;
    for (PetscInt a = 0; a < dim; ++a)
      for (PetscInt b = 0; b < dim; ++b)
        if (a != b && shorten(dim, a, b, A)) shorter = PETSC_TRUE;
  }
}

/* A A^T, Voigt; in the plane without what happens across it. It is rounded, so that points in one state have one map:
 * else the unevenness of F of single points is that of their clouds, which makes it more uneven. */
static void left_tensor(PetscInt dim, const PetscReal *A, PetscReal b[6])
{
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      const PetscReal sum = A[3 * i] * A[3 * j] + A[3 * i + 1] * A[3 * j + 1] + A[3 * i + 2] * A[3 * j + 2];
      b[voigt_of[i][j]] = round(GRAIN * sum) / GRAIN;
    }
  if (dim == 2) b[2] = 0;
}

/* No eigenvalue of b is larger than the largest sum of a row without signs. */
static PetscReal bound_of(const PetscReal b[6])
{
  PetscReal most = 0;
  for (int i = 0; i < 3; ++i) {
    PetscReal sum = 0;
    for (int j = 0; j < 3; ++j) sum += PetscAbsReal(b[voigt_of[i][j]]);
    most = PetscMax(most, sum);
  }
  return most;
}

const NeighboursMap *cloud_stretch(PetscInt dim, const PetscReal *F, NeighboursMap *room)
{
  PetscReal A[9], b[6], square[3], axis[9];
  shortest_ways(dim, F, A);
  left_tensor(dim, A, b);
  const PetscReal bound = bound_of(b);
  if (bound <= STRETCH_FREE * STRETCH_FREE || PetscIsInfOrNanReal(bound)) return NULL;
  sym_eigen(b, square, axis);
  *room = (NeighboursMap){.longest = 1};
  for (PetscInt i = 0; i < dim; ++i) room->map[i * dim + i] = 1;
  for (int k = 0; k < 3; ++k) {
    const PetscReal s = PetscMin(PetscSqrtReal(square[k]) / STRETCH_FREE, STRETCH_MOST);
    if (!(s > 1)) continue;
    for (PetscInt i = 0; i < dim; ++i)
      for (PetscInt j = 0; j < dim; ++j) room->map[i * dim + j] -= (1 - 1 / s) * axis[3 * i + k] * axis[3 * j + k];
    room->longest = PetscMax(room->longest, s);
  }
  return room->longest > 1 ? room : NULL;
}

const NeighboursMap *cloud_stretch_of(PetscBool follows, const Points *points, PetscInt p, NeighboursMap *room)
{
  PetscReal F[9];
  if (!follows || !points->real[POINT_F]) return NULL;
  point_F(points, p, F);
  return cloud_stretch(points->dim, F, room);
}
