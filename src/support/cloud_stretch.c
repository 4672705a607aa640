/* Clouds that follow the stretch of the material.
 *
 * A cloud with a radius of so many spacings of the start holds fewer and fewer nodes along a direction in which the
 * material is drawn out, and from some stretch on (1.29 with moving least squares, 1.7 with maximum entropy of usual
 * width) zigzags of the nodes grow from step to step, since each step chooses clouds anew. */
#include "base/math/eigen.h"
#include "support/cloud.h"

#define STRETCH_FREE 1.2 /* up to here clouds are round */
#define STRETCH_MOST 4   /* times as long as wide, at most */

/* Left Cauchy-Green tensor F F^T, Voigt; in the plane without what happens across it. */
static void left_tensor(PetscInt dim, const PetscReal *F, PetscReal b[6])
{
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      b[voigt_of[i][j]] = F[3 * i] * F[3 * j] + F[3 * i + 1] * F[3 * j + 1] + F[3 * i + 2] * F[3 * j + 2];
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
  PetscReal b[6], square[3], axis[9];
  left_tensor(dim, F, b);
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
