/* The domain of a point: the part of its cell that it stands for. */
#include "points/seed/seed.h"

#define NEXT 1.5 /* times the distance of the nearest points: layers of a rule are farther apart */

/* In a lattice the parts are images of equal cubes, 2 / side long in the reference cell: the box with
 * the second moments of such a parallelogram has l_d^2 = sum_k (dx_d / dxi_k)^2 / side^2. Those of a
 * simplex have no sides of their own, and take a square or cube of their volume. */
void seed_domain(CellType type, const PetscReal *x, const PetscReal *xi, PetscInt side, PetscReal section, PetscReal *l)
{
  const PetscInt dim = cells[type].dim;
  PetscReal N[CELL_MAX_NODES], dN[CELL_MAX_NODES * 3];
  cell_shape(type, xi, N, dN);
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal square = 0;
    for (PetscInt k = 0; k < dim; ++k) {
      PetscReal slope = 0;
      for (PetscInt i = 0; i < cells[type].nodes; ++i) slope += x[i * dim + d] * dN[i * dim + k];
      square += PetscSqr(slope / (PetscReal)side);
    }
    l[d] = side ? PetscSqrtReal(square) : 0.5 * PetscPowReal(section, 1 / (PetscReal)dim);
  }
}

/* From the line or plane of a side: through its first nodes. */
static PetscReal distance_to_side(const Cell *cell, PetscInt side, const PetscReal *x, const PetscReal *position)
{
  const PetscInt dim = cell->dim;
  const PetscReal *a = x + cell->face[side][0] * dim, *b = x + cell->face[side][1] * dim;
  const PetscReal *c = x + cell->face[side][dim - 1] * dim;
  PetscReal e[3] = {0, 0, 0}, f[3] = {0, 0, 1}, r[3] = {0, 0, 0}, normal[3], along = 0, square = 0;
  for (PetscInt d = 0; d < dim; ++d) e[d] = b[d] - a[d], r[d] = position[d] - a[d];
  for (PetscInt d = 0; d < dim && dim == 3; ++d) f[d] = c[d] - a[d];
  for (int d = 0; d < 3; ++d) normal[d] = e[(d + 1) % 3] * f[(d + 2) % 3] - e[(d + 2) % 3] * f[(d + 1) % 3];
  for (int d = 0; d < 3; ++d) along += normal[d] * r[d], square += normal[d] * normal[d];
  return PetscAbsReal(along) / PetscSqrtReal(square);
}

/* Is the q-th point of the rule in the layer of its cell that is next to this side? */
static PetscBool is_next_to(const Cell *cell, PetscInt side, const SeedRule *rule, PetscInt q)
{
  PetscReal x[CELL_MAX_NODES * 3], nearest = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < cell->nodes; ++i)
    for (PetscInt d = 0; d < cell->dim; ++d) x[i * cell->dim + d] = cell->reference[i][d];
  for (PetscInt p = 0; p < rule->n; ++p)
    nearest = PetscMin(nearest, distance_to_side(cell, side, x, rule->xi + p * cell->dim));
  return distance_to_side(cell, side, x, rule->xi + q * cell->dim) < NEXT * nearest;
}

PetscReal seed_reach(CellType type, const PetscReal *x, const PetscReal *position, PetscReal section,
                     const SeedRule *rule, PetscInt q, const unsigned char *outer)
{
  const Cell *cell = cells + type;
  PetscReal reach = 0.5 * PetscPowReal(section, 1 / (PetscReal)cell->dim), surface = PETSC_MAX_REAL;
  for (PetscInt side = 0; side < cell->faces; ++side) {
    const PetscReal distance = distance_to_side(cell, side, x, position);
    reach = PetscMin(reach, distance);
    if (outer[side] && is_next_to(cell, side, rule, q)) surface = PetscMin(surface, distance);
  }
  return surface < PETSC_MAX_REAL ? surface : reach;
}
