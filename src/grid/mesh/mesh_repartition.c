/* Shares a mesh among the ranks by coordinate bisection of its cells' centres: they are read off a ruler over the box around the mesh, which is
 * cut like a box grid. */
#include "grid/mesh/mesh_travel.h"

#define RULER 5         /* intervals to a cell; odd, so that centres of equal cells do not fall between two of them */
#define MOST_PLACES 1e9 /* that can be numbered */

/* Cells of one size would have this edge; of simplices, the square or cube that is cut into them. */
static PetscReal typical_size(const Grid *grid)
{
  static const PetscReal share[] = {2, 1, 6, 1};
  PetscReal volume = share[grid->type] / (PetscReal)grid->n_cells_global;
  for (PetscInt d = 0; d < grid->dim; ++d) volume *= grid->max[d] - grid->min[d];
  return PetscPowReal(volume, 1 / (PetscReal)grid->dim);
}

void mesh_ruler(const Grid *grid, PetscInt counts[3])
{
  PetscReal size = typical_size(grid) / RULER, places = MOST_PLACES + 1;
  for (; places > MOST_PLACES; size *= 1.1) {
    places = 1;
    for (PetscInt d = 0; d < 3; ++d) {
      const PetscReal extent = d < grid->dim ? grid->max[d] - grid->min[d] : 0;
      const PetscReal count = PetscMax(PetscFloorReal(extent / size + 0.5), 1);
      places *= count;
      counts[d] = (PetscInt)PetscMin(count, MOST_PLACES);
    }
  }
}

/* Where the centre of a cell lies on the ruler. */
static void read_ruler(const Grid *grid, const PetscInt counts[3], PetscInt cell, PetscInt ijk[3])
{
  const PetscInt nn = grid->nodes_per_cell, dim = grid->dim;
  PetscReal x[3 * CELL_MAX_NODES];
  grid_cell_x(grid, cell, x);
  ijk[2] = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal centre = 0;
    for (PetscInt i = 0; i < nn; ++i) centre += x[i * dim + d];
    const PetscReal at = (centre / (PetscReal)nn - grid->min[d]) / (grid->max[d] - grid->min[d]);
    ijk[d] = (PetscInt)PetscMin(PetscMax(at * (PetscReal)counts[d], 0), (PetscReal)(counts[d] - 1));
  }
}

PetscErrorCode MeshWeighCells(const Grid *grid, const PetscReal *weight, VoxelWeights *w)
{
  const PetscInt n = grid->n_cells;
  VoxelBlock all = {{0, 0, 0}, {0, 0, 0}};

  PetscFunctionBeginUser;
  mesh_ruler(grid, all.hi);
  w->n = n;
  w->layer = RULER;
  PetscCall(PetscMalloc2(n, &w->voxel, n, &w->weight));
  for (PetscInt c = 0; c < n; ++c) {
    PetscInt ijk[3];
    read_ruler(grid, all.hi, c, ijk);
    w->voxel[c] = block_index(&all, ijk);
    w->weight[c] = whole_weight(weight[c]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode GridMeshFromOwners(const Grid *old, const PetscMPIInt *owner, Grid **grid)
{
  MeshParcel parcel;

  PetscFunctionBeginUser;
  PetscCall(MeshSend(old, owner, &parcel));
  PetscCall(MeshSettle(old, &parcel, grid));
  PetscCall(MeshParcelDestroy(&parcel));
  PetscFunctionReturn(0);
}

PetscErrorCode GridMeshFromCuts(const Grid *old, const PetscInt *cut_axis, const PetscInt *cut, Grid **grid)
{
  PetscInt counts[3];
  PetscMPIInt size, *owner;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(old->comm, &size));
  mesh_ruler(old, counts);
  PetscCall(PetscMalloc1(old->n_cells, &owner));
  for (PetscInt c = 0; c < old->n_cells; ++c) {
    PetscInt ijk[3];
    read_ruler(old, counts, c, ijk);
    owner[c] = voxel_owner(size, cut_axis, cut, ijk);
  }
  PetscCall(GridMeshFromOwners(old, owner, grid));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}
