/* The grid as others see it, whatever its kind. */
#include "grid/grid_ops.h"

static PetscErrorCode SetDestroy(GridSet *set)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(set->name));
  PetscCall(PetscFree(set->nodes));
  PetscCall(PetscFree(set->face_cell));
  PetscCall(PetscFree(set->face_side));
  PetscCall(PetscFree(set->cells));
  PetscFunctionReturn(0);
}

PetscErrorCode GridDestroy(Grid **grid)
{
  Grid *g = *grid;

  PetscFunctionBeginUser;
  if (!g) PetscFunctionReturn(0);
  for (PetscInt s = 0; s < g->n_sets; ++s) PetscCall(SetDestroy(g->sets + s));
  PetscCall(SetDestroy(&g->outer));
  PetscCall(PetscFree(g->sets));
  PetscCall(PetscFree(g->cell_node));
  PetscCall(PetscFree(g->x));
  PetscCall(PetscFree(g->global_node));
  PetscCall(PetscFree(g->global_cell));
  PetscCall(PetscFree(g->rank_bounds));
  PetscCall(PetscSFDestroy(&g->node_sf));
  PetscCall(g->ops->Destroy(g));
  PetscCall(PetscFree(*grid));
  PetscFunctionReturn(0);
}

PetscErrorCode GridWiden(Grid **grid, PetscInt layers)
{
  PetscMPIInt size;
  Grid *wide;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size((*grid)->comm, &size));
  if (size == 1 || !layers || !(*grid)->ops->Widen) PetscFunctionReturn(0);
  PetscCall((*grid)->ops->Widen(*grid, layers, &wide));
  PetscCall(GridDestroy(grid));
  *grid = wide;
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

void grid_cell_centre(const Grid *grid, PetscInt cell, PetscReal centre[3])
{
  const PetscInt nn = grid_cell(grid, cell)->nodes;
  PetscReal x[3 * CELL_MAX_NODES];
  grid_cell_x(grid, cell, x);
  for (PetscInt d = 0; d < 3; ++d) centre[d] = 0;
  for (PetscInt i = 0; i < nn * grid->dim; ++i) centre[i % grid->dim] += x[i] / (PetscReal)nn;
}

void grid_shape(const Grid *grid, PetscInt cell, const PetscReal *xi, PetscReal *N)
{
  PetscReal dN[3 * CELL_MAX_NODES];
  cell_shape(grid_cell_type(grid, cell), xi, N, dN);
  for (PetscInt i = grid_cell(grid, cell)->nodes; i < grid->nodes_per_cell; ++i) N[i] = 0;
}

PetscInt grid_locate(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi)
{
  return grid->ops->locate(grid, x, guess, xi);
}

void grid_clamp(const Grid *grid, PetscReal *x) { grid->ops->clamp(grid, x); }

PetscInt grid_candidates(const Grid *grid, const PetscReal *x, PetscInt max, PetscMPIInt *ranks)
{
  return grid->ops->candidates(grid, x, max, ranks);
}

PetscBool grid_is_aligned(const Grid *grid) { return grid->ops->aligned; }

PetscBool grid_starts_alike(const Grid *grid) { return grid->ops->starts_alike; }

PetscBool grid_cells_alike(const Grid *grid) { return grid->ops->cells_alike && grid->ops->cells_alike(grid); }

PetscErrorCode GridRepartition(const Grid *old, const PetscReal *weight, PetscReal worst, PetscReal *reached,
                               Grid **grid)
{
  PetscMPIInt size;
  PetscInt *axis, *cut;
  VoxelWeights w = {0};

  PetscFunctionBeginUser;
  *grid = NULL;
  PetscCallMPI(MPI_Comm_size(old->comm, &size));
  PetscCall(PetscCalloc2(size, &axis, size, &cut));
  PetscCall(old->ops->WeighCells(old, weight, &w));
  PetscCall(PartitionVoxels(old->comm, old->dim, w.counts, &w, axis, cut, reached));
  PetscCall(PetscFree2(w.voxel, w.weight));
  if (*reached <= worst) PetscCall(old->ops->FromCuts(old, axis, cut, grid));
  PetscCall(PetscFree2(axis, cut));
  PetscFunctionReturn(0);
}

PetscErrorCode GridPartitionToTable(const Grid *grid, Tables *tables)
{
  PetscFunctionBeginUser;
  PetscCall(grid->ops->PartitionToTable(grid, tables));
  PetscFunctionReturn(0);
}

PetscErrorCode GridFromPartition(const Grid *old, const Table *table, Grid **grid, char reason[256])
{
  PetscFunctionBeginUser;
  *grid = NULL;
  PetscCall(old->ops->FromPartition(old, table, grid, reason));
  PetscFunctionReturn(0);
}
