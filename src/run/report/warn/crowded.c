/* Points that have come together, so that the material fills less room than it has. */
#include "run/report/warn/warn.h"

/* share of the volume: 0.01 to 0.045 in columns, heaps and drums whose heights are right */
#define CROWD_ALLOWED 0.05

/* What has opened, and may have closed again unknown to its law, asks for no more room than before, m3. */
static PetscReal asked(const Points *points, PetscInt p)
{
  return PetscMin(1, points->real[POINT_J][p]) * points->real[POINT_VOLUME][p];
}

/* Volume of points around each node, and of the cells there, m3 (n_nodes x 2); of each cell. */
static PetscErrorCode Gather(const Model *m, PetscReal *around, PetscReal *room)
{
  const Grid *grid = m->grid;
  const Points *points = m->points;
  const PetscInt nn = grid->nodes_per_cell;
  PetscReal x[CELL_MAX_NODES * 3];

  PetscFunctionBeginUser;
  for (PetscInt cell = 0; cell < grid->n_cells; ++cell) {
    grid_cell_x(grid, cell, x);
    room[cell] = cell_volume_in(m->c->kinematics, grid_cell_type(grid, cell), x);
    for (PetscInt i = 0; i < nn; ++i) around[2 * grid->cell_node[cell * nn + i] + 1] += room[cell];
  }
  for (PetscInt p = 0; p < points->n; ++p) /* what has just left the grid is in no cell */
    for (PetscInt i = 0; i < nn && points->cell[p] >= 0; ++i)
      around[2 * grid->cell_node[points->cell[p] * nn + i]] += asked(points, p);
  PetscCall(GridSumToOwners(grid, 2, around));
  PetscCall(GridToGhosts(grid, 2, around));
  PetscFunctionReturn(0);
}

/* Volume of the material, and what of it is more than cells hold, m3, with the means of the nodes around each: points
 * that have moved through many cells are a tenth to a fifth uneven from cell to cell, which goes out. */
static PetscErrorCode AddCrowd(const Model *m, PetscReal sum[2])
{
  const Grid *grid = m->grid;
  const PetscInt nn = grid->nodes_per_cell;
  PetscReal *around, *room;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * grid->n_nodes, &around, grid->n_cells, &room));
  PetscCall(Gather(m, around, room));
  for (PetscInt cell = 0; cell < grid->n_cells; ++cell) {
    PetscReal fills = 0;
    for (PetscInt i = 0; i < nn; ++i) {
      const PetscReal *at = around + 2 * grid->cell_node[cell * nn + i];
      fills += at[0] / at[1] / (PetscReal)nn;
    }
    sum[0] += fills * room[cell];
    sum[1] += PetscMax(0, fills - 1) * room[cell];
  }
  PetscCall(PetscFree2(around, room));
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
  diag_hint(
    diag,
    "heights, densities and stresses are no longer those of the material: %sdisplacements with `basis: gimp` and "
    "nine points a cell, or `{split: ..}`, lessen it most, finer cells do not (docs/guide/limits.md)",
    m->c->stabilisation.room ? "" : "`stabilisation: {room: true}` presses apart what flows; ");
  PetscFunctionReturn(0);
}
