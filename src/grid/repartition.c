/* The same grid shared among the ranks in another way: by weights of its cells, or as it was before. Boxes and meshes are cut alike; they differ
 * in how a part is made. */
#include "grid/directory.h"
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

static PetscErrorCode CutsToTable(const GridBox *box, Tables *tables)
{
  Table *table;
  Column *axis, *cut;

  PetscFunctionBeginUser;
  PetscCall(TablesAdd(tables, "partition", PETSC_TRUE, box->size, &table));
  PetscCall(TableAdd(table, "cut_axis", NULL, COLUMN_INT64, 1, NULL, &axis));
  PetscCall(TableAdd(table, "cut", NULL, COLUMN_INT64, 1, NULL, &cut));
  for (PetscMPIInt r = 0; r < box->size; ++r) {
    ((PetscInt64 *)axis->data)[r] = box->cut_axis[r];
    ((PetscInt64 *)cut->data)[r] = box->cut[r];
  }
  PetscFunctionReturn(0);
}

/* Cell by cell: who shared the mesh as it was read need not do it in the same way again. */
static PetscErrorCode OwnersToTable(const Grid *grid, Tables *tables)
{
  PetscMPIInt rank;
  Table *table;
  Column *cell, *owner;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCall(TablesAdd(tables, "partition", PETSC_FALSE, grid->n_cells, &table));
  PetscCall(TableAdd(table, "cell", NULL, COLUMN_INT64, 1, NULL, &cell));
  PetscCall(TableAdd(table, "rank", NULL, COLUMN_INT32, 1, NULL, &owner));
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    ((PetscInt64 *)cell->data)[c] = grid->global_cell[c];
    ((int32_t *)owner->data)[c] = rank;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode GridPartitionToTable(const Grid *grid, Tables *tables)
{
  PetscFunctionBeginUser;
  if (grid->box) PetscCall(CutsToTable(grid->box, tables));
  else PetscCall(OwnersToTable(grid, tables));
  PetscFunctionReturn(0);
}

/* Every rank has read the same table. */
static void read_cuts(PetscInt dim, const Table *table, Cuts *cuts, char reason[256])
{
  const PetscInt64 *axis = table_data(table, "cut_axis", COLUMN_INT64, 1, reason),
                   *cut = table_data(table, "cut", COLUMN_INT64, 1, reason);
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

/* The table's cells as PetscInt; no number is trusted. */
static void read_owners(const Grid *grid, PetscMPIInt size, const Table *table, PetscInt *cell, PetscMPIInt *owner,
                        char reason[256])
{
  const PetscInt64 *number = table_data(table, "cell", COLUMN_INT64, 1, reason);
  const int32_t *rank = table_data(table, "rank", COLUMN_INT32, 1, reason);
  for (PetscInt64 i = 0; i < table->rows; ++i) {
    cell[i] = -1;
    owner[i] = 0;
    if (reason[0]) continue;
    if (number[i] < 0 || number[i] >= grid->n_cells_global || rank[i] < 0 || rank[i] >= size) {
      snprintf(reason, 256, "partition: there is no such cell or rank");
      continue;
    }
    cell[i] = (PetscInt)number[i];
    owner[i] = rank[i];
  }
}

/* Local cells ask the ranks that have their rows. */
static PetscErrorCode FetchOwners(const Grid *grid, PetscInt rows, const PetscInt *cell, const PetscMPIInt *from_table,
                                  PetscMPIInt *owner, char reason[256])
{
  const PetscInt n = grid->n_cells;
  DirectoryPlace *place;
  PetscSFNode *remote;
  PetscSF sf;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &place, n, &remote));
  PetscCall(DirectoryFind(grid->comm, grid->n_cells_global, rows, cell, n, grid->global_cell, place));
  for (PetscInt c = 0; c < n; ++c) {
    if (place[c].rank < 0) snprintf(reason, 256, "partition: a cell of the grid is missing");
    remote[c] = (PetscSFNode){.rank = place[c].rank, .index = place[c].index};
  }
  PetscCall(ReasonShare(grid->comm, reason));
  if (!reason[0]) {
    PetscCall(PetscSFCreate(grid->comm, &sf));
    PetscCall(PetscSFSetGraph(sf, rows, n, NULL, PETSC_COPY_VALUES, remote, PETSC_COPY_VALUES));
    PetscCall(PetscSFBcastBegin(sf, MPI_INT, from_table, owner, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(sf, MPI_INT, from_table, owner, MPI_REPLACE));
    PetscCall(PetscSFDestroy(&sf));
  }
  PetscCall(PetscFree2(place, remote));
  PetscFunctionReturn(0);
}

static PetscErrorCode GridFromOwners(const Grid *old, const Table *table, Grid **grid, char reason[256])
{
  const PetscInt rows = (PetscInt)table->rows;
  PetscMPIInt size, *from_table, *owner;
  PetscInt *cell;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(old->comm, &size));
  PetscCall(PetscMalloc3(rows, &cell, rows, &from_table, old->n_cells, &owner));
  read_owners(old, size, table, cell, from_table, reason);
  PetscCall(ReasonShare(old->comm, reason));
  if (!reason[0]) PetscCall(FetchOwners(old, rows, cell, from_table, owner, reason));
  if (!reason[0]) PetscCall(GridMeshFromOwners(old, owner, grid));
  PetscCall(PetscFree3(cell, from_table, owner));
  PetscFunctionReturn(0);
}

PetscErrorCode GridFromPartition(const Grid *old, const Table *table, Grid **grid, char reason[256])
{
  Cuts cuts;

  PetscFunctionBeginUser;
  *grid = NULL;
  if (!old->box) {
    PetscCall(GridFromOwners(old, table, grid, reason));
    PetscFunctionReturn(0);
  }
  PetscCall(CutsCreate(old, &cuts));
  read_cuts(old->dim, table, &cuts, reason);
  if (!reason[0]) PetscCall(GridFromCuts(old, &cuts, grid));
  PetscCall(CutsDestroy(&cuts));
  PetscFunctionReturn(0);
}
