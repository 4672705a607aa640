/* The domain of a point: the part of its cell that it stands for. */
#include "points/seed/seed.h"

/* Half of what the reference cell's axis k is along axis d, at xi. */
static void find_slopes(CellType type, const PetscReal *x, const PetscReal *xi, PetscReal slope[3][3])
{
  const PetscInt dim = cells[type].dim;
  PetscReal N[CELL_MAX_NODES], dN[CELL_MAX_NODES * 3];
  cell_shape(type, xi, N, dN);
  for (PetscInt d = 0; d < dim; ++d)
    for (PetscInt k = 0; k < dim; ++k) {
      slope[d][k] = 0;
      for (PetscInt i = 0; i < cells[type].nodes; ++i) slope[d][k] += x[i * dim + d] * dN[i * dim + k];
    }
}

/* In a lattice the parts are images of equal cubes, 2 / side long in the reference cell, or what the body's surface
 * leaves of them, which spreads as it does: the box with the second moments of such a parallelogram has l_d^2 =
 * sum_k (dx_d / dxi_k)^2 3 spread_k. What is no box takes one of its volume. Parts of a simplex have no sides of their
 * own, and take a square or cube. */
void seed_domain(CellType type, const PetscReal *x, const PetscReal *xi, PetscInt side, const PetscReal *spread,
                 PetscReal section, PetscReal *l)
{
  const PetscInt dim = cells[type].dim;
  PetscReal slope[3][3], volume = 1;
  find_slopes(type, x, xi, slope);
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal square = 0;
    for (PetscInt k = 0; k < dim && side; ++k)
      square += PetscSqr(slope[d][k]) * (spread ? 3 * spread[k] : 1 / (PetscReal)(side * side));
    l[d] = side ? PetscSqrtReal(square) : 0.5 * PetscPowReal(section, 1 / (PetscReal)dim);
    volume *= 2 * l[d];
  }
  for (PetscInt d = 0; d < dim && spread && side; ++d) l[d] *= PetscPowReal(section / volume, 1 / (PetscReal)dim);
}
