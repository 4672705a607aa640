/* The domain of a point: the part of its cell that it stands for. */
#include "points/seed/seed.h"

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
