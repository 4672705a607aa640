/* The same grid shared among the ranks in another way: by weights of its cells, or as it was before. Boxes and meshes are cut alike; they differ
 * in how a part is made. */
#include "grid/grid_private.h"

typedef struct {
  PetscMPIInt size;
  PetscInt counts[3]; /* of the lattice that is cut */
  PetscInt *axis, *cut;
} Cuts;

static PetscErrorCode CutsCreate(const Grid *grid, Cuts *cuts)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(grid->comm, &cuts->size));
  PetscCall(PetscCalloc2(cuts->size, &cuts->axis, cuts->size, &cuts->cut));
  if (grid->box) PetscCall(PetscArraycpy(cuts->counts, grid->box->counts, 3));
  else mesh_ruler(grid, cuts->counts);
  PetscFunctionReturn(0);
}

static PetscErrorCode CutsDestroy(Cuts *cuts)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(cuts->axis, cuts->cut));
  PetscFunctionReturn(0);
}

static PetscErrorCode GridFromCuts(const Grid *old, const Cuts *cuts, Grid **grid)
{
  PetscFunctionBeginUser;
  if (old->box) PetscCall(GridBoxFromCuts(old, cuts->axis, cuts->cut, grid));
  else PetscCall(GridMeshFromCuts(old, cuts->axis, cuts->cut, grid));
  PetscFunctionReturn(0);
}

PetscErrorCode GridRepartition(const Grid *old, const PetscReal *weight, PetscReal worst, PetscReal *reached,
                               Grid **grid)
{
  VoxelWeights w;
  Cuts cuts;

  PetscFunctionBeginUser;
  *grid = NULL;
  PetscCall(CutsCreate(old, &cuts));
  if (old->box) PetscCall(BoxWeighCells(old, weight, &w));
  else PetscCall(MeshWeighCells(old, weight, &w));
  PetscCall(PartitionVoxels(old->comm, old->dim, cuts.counts, &w, cuts.axis, cuts.cut, reached));
  PetscCall(PetscFree2(w.voxel, w.weight));
  if (*reached <= worst) PetscCall(GridFromCuts(old, &cuts, grid));
  PetscCall(CutsDestroy(&cuts));
  PetscFunctionReturn(0);
}

PetscErrorCode GridPartitionToTable(const Grid *grid, Tables *tables)
{
  const PetscInt *cut_axis = grid->box ? grid->box->cut_axis : grid->bins->cut_axis,
                 *cut = grid->box ? grid->box->cut : grid->bins->cut;
  PetscMPIInt size;
  Table *table;
  Column *axis_column, *cut_column;

  PetscFunctionBeginUser;
  if (!cut) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  PetscCall(TablesAdd(tables, "partition", PETSC_TRUE, size, &table));
  PetscCall(TableAdd(table, "cut_axis", NULL, COLUMN_INT64, 1, NULL, &axis_column));
  PetscCall(TableAdd(table, "cut", NULL, COLUMN_INT64, 1, NULL, &cut_column));
  for (PetscMPIInt r = 0; r < size; ++r) {
    ((PetscInt64 *)axis_column->data)[r] = cut_axis[r];
    ((PetscInt64 *)cut_column->data)[r] = cut[r];
  }
  PetscFunctionReturn(0);
}

/* Every rank has read the same table. */
static void read_cuts(PetscInt dim, const Table *table, Cuts *cuts, char reason[256])
{
  const PetscInt64 *axis = TableData(table, "cut_axis", COLUMN_INT64, 1, reason),
                   *cut = TableData(table, "cut", COLUMN_INT64, 1, reason);
  if (!axis || !cut) return;
  if (table->rows != cuts->size) {
    snprintf(reason, 256, "partition: it is of another number of ranks");
    return;
  }
  for (PetscInt64 r = 0; r < table->rows; ++r) {
    if (axis[r] < 0 || axis[r] >= dim || cut[r] < 0 || cut[r] > cuts->counts[axis[r]]) {
      snprintf(reason, 256, "partition: a cut makes no sense");
      return;
    }
    cuts->axis[r] = (PetscInt)axis[r];
    cuts->cut[r] = (PetscInt)cut[r];
  }
}

PetscErrorCode GridFromPartition(const Grid *old, const Table *table, Grid **grid, char reason[256])
{
  Cuts cuts;

  PetscFunctionBeginUser;
  *grid = NULL;
  PetscCall(CutsCreate(old, &cuts));
  read_cuts(old->dim, table, &cuts, reason);
  if (!reason[0]) PetscCall(GridFromCuts(old, &cuts, grid));
  PetscCall(CutsDestroy(&cuts));
  PetscFunctionReturn(0);
}
