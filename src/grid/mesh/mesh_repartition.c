/* Shares a mesh among the ranks by coordinate bisection of its cells' centres, which are read
 * off a ruler over the box around the mesh that is cut like a box grid; or cell by cell, as a
 * table says. */
#include "grid/search/directory.h"
#include "grid/mesh/mesh.h"

/* intervals to a cell; odd, so that centres of equal cells do not fall between two of them */
#define RULER 5
#define MOST_PLACES 1e9 /* that can be numbered */

/* Cells of one size would have this edge; of simplices, the square or cube that is cut into
 * them. */
static PetscReal typical_size(const Grid *grid)
{
  static const PetscReal share[] = {2, 1, 6, 1};
  PetscReal volume = share[grid->type] / (PetscReal)grid->n_cells_global;
  for (PetscInt d = 0; d < grid->dim; ++d) volume *= grid->max[d] - grid->min[d];
  return PetscPowReal(volume, 1 / (PetscReal)grid->dim);
}

/* Intervals of the ruler over a mesh, which depend on the mesh alone. */
static void mesh_ruler(const Grid *grid, PetscInt counts[LATTICE])
{
  PetscReal size = typical_size(grid) / RULER, places = MOST_PLACES + 1;
  counts[LATTICE - 1] = 1;
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
static void read_ruler(const Grid *grid, const PetscInt counts[LATTICE], PetscInt cell, PetscInt ijk[LATTICE])
{
  PetscReal centre[3];
  grid_cell_centre(grid, cell, centre);
  ijk[2] = ijk[3] = 0;
  for (PetscInt d = 0; d < grid->dim; ++d) {
    const PetscReal at = (centre[d] - grid->min[d]) / (grid->max[d] - grid->min[d]);
    ijk[d] = (PetscInt)PetscMin(PetscMax(at * (PetscReal)counts[d], 0), (PetscReal)(counts[d] - 1));
  }
}

PetscErrorCode MeshWeighCells(const Grid *grid, const PetscReal *weight, VoxelWeights *w)
{
  const PetscInt n = grid->n_cells;
  VoxelBlock all = {{0}, {0}};

  PetscFunctionBeginUser;
  mesh_ruler(grid, all.hi);
  PetscCall(PetscArraycpy(w->counts, all.hi, LATTICE));
  w->n = n;
  w->layer = RULER;
  PetscCall(PetscMalloc2(n, &w->voxel, n, &w->weight));
  for (PetscInt c = 0; c < n; ++c) {
    PetscInt ijk[LATTICE];
    read_ruler(grid, all.hi, c, ijk);
    w->voxel[c] = block_index(&all, ijk);
    w->weight[c] = whole_weight(weight[c]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MeshFromCuts(const Grid *old, const PetscInt *cut_axis, const PetscInt *cut, Grid **grid)
{
  PetscInt counts[LATTICE];
  PetscMPIInt size, *owner;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(old->comm, &size));
  mesh_ruler(old, counts);
  PetscCall(PetscMalloc1(old->n_cells, &owner));
  for (PetscInt c = 0; c < old->n_cells; ++c) {
    PetscInt ijk[LATTICE];
    read_ruler(old, counts, c, ijk);
    owner[c] = voxel_owner(size, cut_axis, cut, ijk);
  }
  PetscCall(MeshFromOwners(old, owner, grid));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}

/* Cell by cell: who shared the mesh as it was read need not do it in the same way again. */
PetscErrorCode MeshPartitionToTable(const Grid *grid, Tables *tables)
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

PetscErrorCode MeshFromPartition(const Grid *old, const Table *table, Grid **grid, char reason[256])
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
  if (!reason[0]) PetscCall(MeshFromOwners(old, owner, grid));
  PetscCall(PetscFree3(cell, from_table, owner));
  PetscFunctionReturn(0);
}
