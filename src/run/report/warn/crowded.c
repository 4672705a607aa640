/* Points that have come together, so that the material fills less room than it has. */
#include "run/report/warn/warn.h"

/* share of the volume: unevenness of points that have moved through many cells is 0.1 to 0.2 */
#define CROWD_ALLOWED 0.3

/* Volume of this rank's points, and what of it is more than their cells hold, m3. */
static PetscErrorCode AddCrowd(const Model *m, PetscReal sum[2])
{
  const Grid *grid = m->grid;
  PetscReal x[CELL_MAX_NODES * 3], *filled;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_cells, &filled));
  for (PetscInt p = 0; p < m->points->n; ++p) /* what has just left the grid is in none */
    if (m->points->cell[p] >= 0)
      filled[m->points->cell[p]] += m->points->real[POINT_J][p] * m->points->real[POINT_VOLUME][p];
  for (PetscInt cell = 0; cell < grid->n_cells; ++cell) {
    if (filled[cell] <= 0) continue;
    grid_cell_x(grid, cell, x);
    sum[0] += filled[cell];
    sum[1] += PetscMax(0, filled[cell] - cell_volume_in(m->c->kinematics, grid_cell_type(grid, cell), x));
  }
  PetscCall(PetscFree(filled));
  PetscFunctionReturn(0);
}

/* Points have no size of their own: where flow brings them together the material fills less room than its
 * laws believe, and nothing else tells. */
PetscErrorCode WarnOfCrowd(const Model *m, Diag *diag)
{
  PetscReal local[2] = {0, 0}, sum[2];

  PetscFunctionBeginUser;
  if (!m->method->restores_grid) PetscFunctionReturn(0);
  PetscCall(AddCrowd(m, local));
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  if (!(sum[1] > CROWD_ALLOWED * sum[0])) PetscFunctionReturn(0);
  diag_warning(diag, NULL, "points have come together: %.2g %% of the material's volume is more than its cells hold",
               (double)(100 * sum[1] / sum[0]));
  diag_hint(diag,
            "heights and densities are no longer those of the material; finer cells, or more points a cell, lessen it; "
            "grains with `opening_memory`: `stabilisation: {room: true}`");
  PetscFunctionReturn(0);
}
