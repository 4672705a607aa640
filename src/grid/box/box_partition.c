/* Who has which block of a box grid: by what a function of places says, by weights of the cells of a grid that is there, or as it was
 * before. */
#include "grid/grid_private.h"

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

PetscErrorCode BoxWeighCells(const Grid *grid, const PetscReal *weight, VoxelWeights *w)
{
  const GridBox *box = grid->box;
  const VoxelBlock *mine = box->block + box->rank;
  const VoxelBlock all = {{0, 0, 0}, {box->counts[0], box->counts[1], box->counts[2]}};
  const PetscInt n = block_size(mine), n_sub = box->pattern[0].n_cells;
  PetscInt ijk[3], voxel = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &w->voxel, n, &w->weight));
  w->n = w->layer = 0;
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

PetscErrorCode GridBoxFromCuts(const Grid *old, const PetscInt *cut_axis, const PetscInt *cut, Grid **grid)
{
  GridBox *box = NULL;

  PetscFunctionBeginUser;
  PetscCall(BoxCopy(old->comm, old->box, &box));
  PetscCall(PetscArraycpy(box->cut_axis, cut_axis, box->size));
  PetscCall(PetscArraycpy(box->cut, cut, box->size));
  PetscCall(BoxRanks(box));
  PetscCall(GridFromBox(old->comm, old->type, box, grid));
  PetscFunctionReturn(0);
}
