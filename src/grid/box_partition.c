/* Who has which block of a box grid: by what a function of places says, by weights of the cells of a grid that is there, or as it was
 * before. */
#include "grid/grid_private.h"

#define WEIGHT_UNIT 64 /* weights are whole numbers of this fraction of a point */

static inline PetscInt64 whole_weight(PetscReal weight)
{
  return weight > 0 ? (PetscInt64)(weight * WEIGHT_UNIT + 0.5) : 0;
}

/* What depends on the cuts alone. */
static PetscErrorCode BoxRanks(GridBox *box)
{
  PetscFunctionBeginUser;
  PetscCall(PartitionBlocks(box->size, box->counts, box->cut_axis, box->cut, box->block));
  for (PetscMPIInt r = 0; r < box->size; ++r)
    box->first_node[r + 1] = box->first_node[r] + box_owned_nodes(box, box->block + r);
  PetscFunctionReturn(0);
}

static PetscErrorCode BoxRanksCreate(MPI_Comm comm, GridBox *box)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &box->rank));
  PetscCallMPI(MPI_Comm_size(comm, &box->size));
  PetscCall(PetscCalloc4(box->size, &box->block, box->size, &box->cut_axis, box->size, &box->cut, box->size + 1,
                         &box->first_node));
  PetscFunctionReturn(0);
}

/* Each rank weighs its share of the voxels, and lists those that carry something. */
static PetscErrorCode WeighShare(const GridBox *box, GridWeight weight, void *context, VoxelWeights *w)
{
  const PetscInt *counts = box->counts;
  const PetscInt64 all = (PetscInt64)counts[0] * counts[1] * counts[2];
  const PetscInt begin = (PetscInt)(all * box->rank / box->size), end = (PetscInt)(all * (box->rank + 1) / box->size);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(end - begin, &w->voxel, end - begin, &w->weight));
  w->n = 0;
  for (PetscInt v = begin; v < end; ++v) {
    const PetscInt ijk[3] = {v % counts[0], v / counts[0] % counts[1], v / counts[0] / counts[1]};
    PetscReal centre[3];
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
  PetscReal imbalance;

  PetscFunctionBeginUser;
  PetscCall(BoxRanksCreate(comm, box));
  if (weight && box->size > 1) PetscCall(WeighShare(box, weight, context, &w));
  PetscCall(PartitionVoxels(comm, box->dim, box->counts, weight ? &w : NULL, box->cut_axis, box->cut, &imbalance));
  PetscCall(PetscFree2(w.voxel, w.weight));
  PetscCall(BoxRanks(box));
  PetscFunctionReturn(0);
}

/* The voxels of this rank that weigh something. */
static PetscErrorCode WeighCells(const Grid *grid, const PetscReal *weight, VoxelWeights *w)
{
  const GridBox *box = grid->box;
  const VoxelBlock *mine = box->block + box->rank;
  const VoxelBlock all = {{0, 0, 0}, {box->counts[0], box->counts[1], box->counts[2]}};
  const PetscInt n = block_size(mine), n_sub = box->pattern[0].n_cells;
  PetscInt ijk[3], voxel = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &w->voxel, n, &w->weight));
  w->n = 0;
  for (ijk[2] = mine->lo[2]; ijk[2] < mine->hi[2]; ++ijk[2])
    for (ijk[1] = mine->lo[1]; ijk[1] < mine->hi[1]; ++ijk[1])
      for (ijk[0] = mine->lo[0]; ijk[0] < mine->hi[0]; ++ijk[0], ++voxel) {
        w->weight[w->n] = 0;
        for (PetscInt s = 0; s < n_sub; ++s) w->weight[w->n] += whole_weight(weight[voxel * n_sub + s]);
        w->voxel[w->n] = block_index(&all, ijk);
        w->n += w->weight[w->n] > 0;
      }
  PetscFunctionReturn(0);
}

/* The same box, for other blocks. */
static PetscErrorCode BoxCopy(MPI_Comm comm, const GridBox *old, GridBox **out)
{
  GridBox *box;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&box));
  box->dim = old->dim;
  box->tolerance = old->tolerance;
  for (int d = 0; d < 3; ++d) {
    box->counts[d] = old->counts[d];
    box->per_length[d] = old->per_length[d];
    PetscCall(PetscMalloc1(box->counts[d] + 1, &box->line[d]));
    PetscCall(PetscArraycpy(box->line[d], old->line[d], box->counts[d] + 1));
  }
  for (int odd = 0; odd < 2; ++odd) box->pattern[odd] = old->pattern[odd];
  PetscCall(BoxRanksCreate(comm, box));
  *out = box;
  PetscFunctionReturn(0);
}

PetscErrorCode GridRepartition(const Grid *old, const PetscReal *weight, PetscReal worst, PetscReal *reached,
                               Grid **grid)
{
  VoxelWeights w;
  GridBox *box;

  PetscFunctionBeginUser;
  *grid = NULL;
  PetscCall(BoxCopy(old->comm, old->box, &box));
  PetscCall(WeighCells(old, weight, &w));
  PetscCall(PartitionVoxels(old->comm, box->dim, box->counts, &w, box->cut_axis, box->cut, reached));
  PetscCall(PetscFree2(w.voxel, w.weight));
  if (*reached > worst) {
    PetscCall(GridBoxDestroy(&box));
    PetscFunctionReturn(0);
  }
  PetscCall(BoxRanks(box));
  PetscCall(GridFromBox(old->comm, old->type, box, grid));
  PetscFunctionReturn(0);
}

PetscErrorCode GridPartitionToTable(const Grid *grid, Tables *tables)
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

PetscErrorCode GridFromPartition(const Grid *old, const Table *table, Grid **grid, char reason[256])
{
  const PetscInt64 *axis = TableData(table, "cut_axis", COLUMN_INT64, 1, reason),
                   *cut = TableData(table, "cut", COLUMN_INT64, 1, reason);
  GridBox *box;

  PetscFunctionBeginUser;
  *grid = NULL;
  if (!axis || !cut) PetscFunctionReturn(0); /* every rank has read the same */
  if (table->rows != old->box->size) snprintf(reason, 256, "partition: it is of another number of ranks");
  for (PetscInt64 r = 0; !reason[0] && r < table->rows; ++r)
    if (axis[r] < 0 || axis[r] >= old->dim || cut[r] < 0 || cut[r] > old->box->counts[axis[r]])
      snprintf(reason, 256, "partition: a cut makes no sense");
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(BoxCopy(old->comm, old->box, &box));
  for (PetscMPIInt r = 0; r < box->size; ++r) {
    box->cut_axis[r] = (PetscInt)axis[r];
    box->cut[r] = (PetscInt)cut[r];
  }
  PetscCall(BoxRanks(box));
  PetscCall(GridFromBox(old->comm, old->type, box, grid));
  PetscFunctionReturn(0);
}
