/* The grid as others see it: which builder, which search, and its end. */
#include "grid/cloud/cloud.h"
#include "grid/grid_private.h"

PetscErrorCode GridCreate(MPI_Comm comm, const Case *c, GridWeight weight, void *context, Diag *diag, Grid **grid)
{
  PetscFunctionBeginUser;
  if (c->grid.kind == GRID_MESH) PetscCall(GeoCheckParameters(comm, c, diag));
  if (c->grid.kind == GRID_BOX) PetscCall(GridCreate_Box(comm, c, weight, context, diag, grid));
  else
    PetscCall(GridCreateMesh(comm, &c->grid, kinematics_dim(c->kinematics), "grid.mesh", weight, context, diag, grid));
  PetscFunctionReturn(0);
}

PetscErrorCode GridDestroy(Grid **grid)
{
  Grid *g = *grid;

  PetscFunctionBeginUser;
  if (!g) PetscFunctionReturn(0);
  for (PetscInt s = 0; s < g->n_sets; ++s) PetscCall(GridSetDestroy(g->sets + s));
  PetscCall(GridSetDestroy(&g->outer));
  PetscCall(PetscFree(g->sets));
  PetscCall(PetscFree(g->cell_node));
  PetscCall(PetscFree(g->x));
  PetscCall(PetscFree(g->global_node));
  PetscCall(PetscFree(g->global_cell));
  PetscCall(PetscFree(g->rank_bounds));
  PetscCall(PetscSFDestroy(&g->node_sf));
  PetscCall(GridBoxDestroy(&g->box));
  PetscCall(GridBinsDestroy(&g->bins));
  PetscCall(GridCloudDestroy(&g->cloud));
  PetscCall(PetscFree(*grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode GatherBounds(Grid *grid)
{
  PetscMPIInt size;
  PetscReal mine[6];

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; ++d) mine[d] = PETSC_MAX_REAL, mine[3 + d] = -PETSC_MAX_REAL;
  for (PetscInt n = 0; n < grid->n_nodes; ++n)
    for (PetscInt d = 0; d < grid->dim; ++d) {
      mine[d] = PetscMin(mine[d], grid->x[n * grid->dim + d]);
      mine[3 + d] = PetscMax(mine[3 + d], grid->x[n * grid->dim + d]);
    }
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  PetscCall(PetscMalloc1(size, &grid->rank_bounds));
  PetscCallMPI(MPI_Allgather(mine, 6, MPIU_REAL, grid->rank_bounds, 6, MPIU_REAL, grid->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode GridFinish(Grid *grid)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFSetUp(grid->node_sf));
  PetscCall(GatherBounds(grid));
  PetscFunctionReturn(0);
}

PetscInt grid_locate(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi)
{
  return grid->box ? box_locate(grid, x, xi) : mesh_locate(grid, x, guess, xi);
}

void grid_clamp(const Grid *grid, PetscReal *x)
{
  if (!grid->box) {
    mesh_clamp(grid, x);
    return;
  }
  for (PetscInt d = 0; d < grid->dim; ++d) x[d] = PetscMin(PetscMax(x[d], grid->min[d]), grid->max[d]);
}

PetscInt grid_candidates(const Grid *grid, const PetscReal *x, PetscInt max, PetscMPIInt *ranks)
{
  return grid->box ? box_candidates(grid->box, x, max, ranks) : mesh_candidates(grid, x, max, ranks);
}
