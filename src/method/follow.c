/* Tracers and carriers of loads follow the field; where they have left the grid, the nodes of its
 * edge carry them, as they would in a larger one: until they are a cell away. */
#include "method/discretisation.h"

static PetscBool within_reach(const Discretisation *s, const Points *followers, PetscInt p)
{
  const PetscInt dim = s->grid->dim;
  const PetscReal *overhang = point_real(followers, POINT_OVERHANG, p);
  PetscReal x[3 * CELL_MAX_NODES];
  grid_cell_x(s->grid, followers->cell[p], x);
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal low = x[d], high = x[d];
    for (PetscInt I = 1; I < s->grid->nodes_per_cell; ++I) {
      low = PetscMin(low, x[I * dim + d]);
      high = PetscMax(high, x[I * dim + d]);
    }
    if (!(PetscAbsReal(overhang[d]) < high - low)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscBool cell_carries(const Discretisation *s, const Points *followers, PetscInt p)
{
  PetscReal N[CELL_MAX_NODES];
  if (followers->cell[p] < 0 || !within_reach(s, followers, p)) return PETSC_FALSE;
  return touched_shape(s->grid, followers->cell[p], point_real(followers, POINT_XI, p), reached_nodes(s), N);
}
