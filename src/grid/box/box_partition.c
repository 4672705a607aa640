/* Who has which block of a box grid: by what a function of places says, by weights of the cells of
 * a grid that is there, or as it was before. */
#include "grid/box/box.h"

/* Each rank weighs its share of the voxels, and lists those that carry something. */
static PetscErrorCode WeighShare(const GridBox *box, GridWeight weight, void *context, VoxelWeights *w)
{
  const VoxelBlock voxels = box_voxels(box);
  const PetscInt64 all = block_size(&voxels);
  const PetscInt begin = (PetscInt)(all * box->rank / box->size), end = (PetscInt)(all * (box->rank + 1) / box->size);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(end - begin, &w->voxel, end - begin, &w->weight));
  w->n = 0;
  for (PetscInt v = begin; v < end; ++v) {
    PetscInt ijk[LATTICE];
    PetscReal centre[3];
    block_at(&voxels, v, ijk);
    for (PetscInt d = 0; d < box->dim; ++d) centre[d] = 0.5 * (box->line[d][ijk[d]] + box->line[d][ijk[d] + 1]);
    w->voxel[w->n] = v;
    w->weight[w->n] = whole_weight(weight(context, centre));
    w->n += w->weight[w->n] > 0;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BoxPartition(MPI_Comm comm, GridBox *box, GridWeight weight, void *context)
{
  VoxelWeights w = {0};
  PetscInt *axis, *cut;
  PetscReal imbalance;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(box->size, &axis, box->size, &cut));
  if (weight && box->size > 1) PetscCall(WeighShare(box, weight, context, &w));
  PetscCall(PartitionVoxels(comm, box->dim, box->counts, weight ? &w : NULL, axis, cut, &imbalance));
  PetscCall(PetscFree2(w.voxel, w.weight));
  PetscCall(BoxCut(box, axis, cut));
  PetscCall(PetscFree2(axis, cut));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxWeighCells(const Grid *grid, const PetscReal *weight, VoxelWeights *w)
{
  const GridBox *box = grid->box;
  const VoxelBlock *mine = box->block + box->rank;
  const VoxelBlock all = box_voxels(box);
  const PetscInt n = block_size(mine), n_sub = box->pattern[0].n_cells;
  PetscInt ijk[LATTICE], voxel = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &w->voxel, n, &w->weight));
  PetscCall(PetscArraycpy(w->counts, box->counts, LATTICE));
  for (PetscBool more = block_first(mine, ijk); more; more = block_next(mine, ijk), ++voxel) {
    w->weight[w->n] = 0;
    for (PetscInt s = 0; s < n_sub; ++s) w->weight[w->n] += whole_weight(weight[voxel * n_sub + s]);
    w->voxel[w->n] = block_index(&all, ijk);
    w->n += w->weight[w->n] > 0;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BoxWiden(const Grid *old, PetscInt halo, Grid **grid)
{
  GridBox *box = NULL;

  PetscFunctionBeginUser;
  PetscCall(BoxCopy(old->comm, old->box, &box));
  box->halo = halo;
  PetscCall(BoxCut(box, old->box->cut_axis, old->box->cut));
  PetscCall(BoxBuild(old->comm, old->ops, old->type, box, grid));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxFromCuts(const Grid *old, const PetscInt *cut_axis, const PetscInt *cut, Grid **grid)
{
  GridBox *box = NULL;

  PetscFunctionBeginUser;
  PetscCall(BoxCopy(old->comm, old->box, &box));
  PetscCall(BoxCut(box, cut_axis, cut));
  PetscCall(BoxBuild(old->comm, old->ops, old->type, box, grid));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxPartitionToTable(const Grid *grid, Tables *tables)
{
  const GridBox *box = grid->box;
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

/* Every rank has read the same table. */
static void read_cuts(const GridBox *box, const Table *table, PetscInt *axis, PetscInt *cut, char reason[256])
{
  const PetscInt64 *wide_axis = table_data(table, "cut_axis", COLUMN_INT64, 1, reason),
                   *wide_cut = table_data(table, "cut", COLUMN_INT64, 1, reason);
  if (!wide_axis || !wide_cut) return;
  if (table->rows != box->size) {
    snprintf(reason, 256, "partition: it is of another number of ranks");
    return;
  }
  for (PetscMPIInt r = 0; r < box->size; ++r) {
    const PetscInt64 a = wide_axis[r];
    if (a < 0 || a >= box->dim || wide_cut[r] < 0 || wide_cut[r] > box->counts[a]) {
      snprintf(reason, 256, "partition: a cut makes no sense");
      return;
    }
    axis[r] = (PetscInt)a;
    cut[r] = (PetscInt)wide_cut[r];
  }
}

PetscErrorCode BoxFromPartition(const Grid *old, const Table *table, Grid **grid, char reason[256])
{
  PetscInt *axis, *cut;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(old->box->size, &axis, old->box->size, &cut));
  read_cuts(old->box, table, axis, cut, reason);
  if (!reason[0]) PetscCall(BoxFromCuts(old, axis, cut, grid));
  PetscCall(PetscFree2(axis, cut));
  PetscFunctionReturn(0);
}
