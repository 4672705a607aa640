/* Weighted recursive coordinate bisection of a lattice of voxels.
 *
 * The ranks are halved together with the lattice: ranks first..last-1 share a block, and those
 * below the middle m take what lies below the cut. Entry m of `cut` is that cut, so that the tree
 * needs no pointers. Each rank knows the weights of some voxels; only histograms along the axes
 * travel. Weights are whole numbers, so that the cuts do not depend on who knows what. */
#include "grid/partition/partition.h"

/* Weight of an empty voxel relative to the mean of those that carry something: its nodes still cost
 * memory and loops. */
static const PetscReal empty_weight = 0.02;

/* What it costs to cut through voxels, relative to giving their weight to the wrong side. */
static const PetscReal surface_weight = 0.1;

/* A block that ranks first .. last-1 share; the entries of one level of the tree stand in one
 * array. */
typedef struct {
  PetscMPIInt first, last;
  VoxelBlock block;
  PetscInt axis, cut;
  PetscInt start[3]; /* of its histograms, one along each axis */
} Part;

/* The voxels whose weights this rank knows, and what all others weigh. */
typedef struct {
  PetscInt dim;
  VoxelBlock all;
  const VoxelWeights *weights; /* NULL: all voxels weigh the same */
  PetscInt layer;              /* layers of voxels on either side that a cut goes through */
  PetscInt64 empty;
  PetscInt *part; /* of each of these voxels: index into the current level */
} Share;

static PetscErrorCode ShareCreate(MPI_Comm comm, PetscInt dim, const PetscInt counts[LATTICE],
                                  const VoxelWeights *weights, Share *share)
{
  PetscInt64 sums[2] = {0, 0}, total[2];

  PetscFunctionBeginUser;
  *share = (Share){.dim = dim, .all = block_of(counts), .layer = 1, .empty = 1};
  if (!weights) PetscFunctionReturn(0);
  for (PetscInt v = 0; v < weights->n; ++v) {
    sums[0] += weights->weight[v];
    sums[1] += weights->weight[v] > 0;
  }
  PetscCallMPI(MPI_Allreduce(sums, total, 2, MPIU_INT64, MPI_SUM, comm));
  if (total[0] == 0 && !weights->layer) PetscFunctionReturn(0);
  share->weights = weights;
  share->layer = PetscMax(weights->layer, 1);
  if (total[0] > 0) share->empty = (PetscInt64)(empty_weight * (PetscReal)total[0] / (PetscReal)total[1]) + 1;
  PetscCall(PetscCalloc1(weights->n, &share->part));
  PetscFunctionReturn(0);
}

static PetscErrorCode ShareDestroy(Share *share)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(share->part));
  PetscFunctionReturn(0);
}

static inline PetscMPIInt middle_rank(const Part *part) { return part->first + (part->last - part->first) / 2; }

static PetscBool part_divides(const Part *part) { return part->last - part->first > 1; }

/* Both children of a part, at 2p and 2p + 1 of the next level; a part of one rank goes on as its
 * own first child. */
static void divide(const Part *part, Part children[2])
{
  children[0] = children[1] = *part;
  children[1].first = children[1].last = part->last;
  if (!part_divides(part)) return;
  children[0].last = children[1].first = middle_rank(part);
  children[0].block.hi[part->axis] = part->cut;
  children[1].block.lo[part->axis] = part->cut;
}

/* Room for the histograms of all parts that will be cut. */
static PetscInt plan_histograms(PetscInt dim, PetscInt n_parts, Part *parts)
{
  PetscInt size = 0;
  for (PetscInt p = 0; p < n_parts; ++p)
    for (PetscInt d = 0; d < dim && part_divides(parts + p); ++d) {
      parts[p].start[d] = size;
      size += parts[p].block.hi[d] - parts[p].block.lo[d];
    }
  return size;
}

/* Weight of each layer of voxels, along each axis of each part. */
static PetscErrorCode FillHistograms(MPI_Comm comm, const Share *share, PetscInt n_parts, const Part *parts, PetscInt n,
                                     PetscInt64 *histogram)
{
  const VoxelWeights *w = share->weights;
  /* of those that are listed, the others are no cells */
  const PetscInt64 each = w && w->layer ? share->empty : 0;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(histogram, n));
  for (PetscInt v = 0; w && v < w->n; ++v) {
    const Part *part = parts + share->part[v];
    PetscInt ijk[LATTICE];
    if (!part_divides(part)) continue;
    block_at(&share->all, w->voxel[v], ijk);
    for (PetscInt d = 0; d < share->dim; ++d)
      histogram[part->start[d] + ijk[d] - part->block.lo[d]] += w->weight[v] + each;
  }
  if (w) {
    PetscMPIInt count;
    PetscCall(PetscMPIIntCast(n, &count));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, histogram, count, MPIU_INT64, MPI_SUM, comm));
  }
  for (PetscInt p = 0; p < n_parts && !each; ++p)
    for (PetscInt d = 0; d < share->dim && part_divides(parts + p); ++d) {
      const PetscInt layers = parts[p].block.hi[d] - parts[p].block.lo[d];
      const PetscInt64 layer = layers > 0 ? share->empty * (block_size(&parts[p].block) / layers) : 0;
      for (PetscInt b = 0; b < layers; ++b) histogram[parts[p].start[d] + b] += layer;
    }
  PetscFunctionReturn(0);
}

/* Where `fraction` of the histogram lies below; never at an end, unless there is but one layer:
 * then the lower half takes it. *cost: what lies on the wrong side, and what is cut through, of
 * all. */
static PetscInt best_cut(PetscInt n, PetscInt layer, const PetscInt64 *histogram, PetscReal fraction, PetscReal *cost)
{
  PetscReal total = 0, below = 0;
  PetscInt best = n;
  for (PetscInt b = 0; b < n; ++b) total += (PetscReal)histogram[b];
  if (total == 0) total = 1; /* there are no cells here: anywhere will do */
  *cost = PETSC_MAX_REAL;
  for (PetscInt b = 1; b < n; ++b) {
    below += (PetscReal)histogram[b - 1];
    const PetscReal miss = PetscAbsReal(below - fraction * total) / total;
    PetscInt64 through = 0;
    for (PetscInt k = PetscMax(b - layer, 0); k < PetscMin(b + layer, n); ++k) through += histogram[k];
    const PetscReal cut = (PetscReal)through / total;
    if (miss + surface_weight * cut >= *cost) continue;
    best = b;
    *cost = miss + surface_weight * cut;
  }
  return best;
}

/* The axis along which the cut costs least; the longest one where several do. */
static void choose_cut(const Share *share, const PetscInt64 *histogram, Part *part)
{
  const PetscReal fraction = (PetscReal)(middle_rank(part) - part->first) / (PetscReal)(part->last - part->first);
  PetscReal least = PETSC_MAX_REAL, cost;
  PetscInt longest = -1;
  for (PetscInt d = 0; d < share->dim; ++d) {
    const PetscInt n = part->block.hi[d] - part->block.lo[d];
    const PetscInt at = best_cut(n, share->layer, histogram + part->start[d], fraction, &cost);
    if (longest >= 0 && (cost > least || (cost == least && n <= longest))) continue;
    least = cost;
    longest = n;
    part->axis = d;
    part->cut = part->block.lo[d] + at;
  }
}

/* One level: cut every part that still has several ranks. */
static PetscErrorCode CutLevel(MPI_Comm comm, Share *share, PetscInt n_parts, Part *parts, PetscInt *cut_axis,
                               PetscInt *cut)
{
  const PetscInt size = plan_histograms(share->dim, n_parts, parts);
  PetscInt64 *histogram;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size, &histogram));
  PetscCall(FillHistograms(comm, share, n_parts, parts, size, histogram));
  for (PetscInt p = 0; p < n_parts; ++p) {
    if (!part_divides(parts + p)) continue;
    choose_cut(share, histogram, parts + p);
    cut_axis[middle_rank(parts + p)] = parts[p].axis;
    cut[middle_rank(parts + p)] = parts[p].cut;
  }
  for (PetscInt v = 0; share->weights && v < share->weights->n; ++v) {
    const Part *part = parts + share->part[v];
    PetscInt ijk[LATTICE];
    block_at(&share->all, share->weights->voxel[v], ijk);
    share->part[v] = 2 * share->part[v] + (part_divides(part) && ijk[part->axis] >= part->cut);
  }
  PetscCall(PetscFree(histogram));
  PetscFunctionReturn(0);
}

/* Largest weight of a rank over the mean. */
static PetscErrorCode Imbalance(MPI_Comm comm, PetscMPIInt size, const Share *share, const Part *parts,
                                PetscReal *imbalance)
{
  PetscInt64 *sum, total = 0, largest = 0;

  PetscFunctionBeginUser;
  *imbalance = 1;
  if (!share->weights) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(size, &sum));
  for (PetscInt v = 0; v < share->weights->n; ++v) sum[parts[share->part[v]].first] += share->weights->weight[v];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, size, MPIU_INT64, MPI_SUM, comm));
  for (PetscMPIInt r = 0; r < size; ++r) {
    total += sum[r];
    largest = PetscMax(largest, sum[r]);
  }
  if (total > 0) *imbalance = (PetscReal)largest * (PetscReal)size / (PetscReal)total;
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

PetscErrorCode PartitionVoxels(MPI_Comm comm, PetscInt dim, const PetscInt counts[LATTICE], const VoxelWeights *weights,
                               PetscInt *cut_axis, PetscInt *cut, PetscReal *imbalance)
{
  PetscMPIInt size;
  PetscInt n_parts = 1;
  Part *parts, *next;
  Share share;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(ShareCreate(comm, dim, counts, size > 1 ? weights : NULL, &share));
  PetscCall(PetscCalloc2(2 * size, &parts, 2 * size, &next));
  parts[0].last = size;
  parts[0].block = block_of(counts);
  while (n_parts < size) {
    PetscCall(CutLevel(comm, &share, n_parts, parts, cut_axis, cut));
    for (PetscInt p = 0; p < n_parts; ++p) divide(parts + p, next + 2 * p);
    n_parts *= 2;
    PetscCall(PetscArraycpy(parts, next, n_parts));
  }
  PetscCall(Imbalance(comm, size, &share, parts, imbalance));
  PetscCall(PetscFree2(parts, next));
  PetscCall(ShareDestroy(&share));
  PetscFunctionReturn(0);
}

PetscMPIInt voxel_owner(PetscMPIInt size, const PetscInt *cut_axis, const PetscInt *cut, const PetscInt ijk[LATTICE])
{
  PetscMPIInt first = 0, last = size;
  while (last - first > 1) {
    const PetscMPIInt m = first + (last - first) / 2;
    if (ijk[cut_axis[m]] < cut[m]) last = m;
    else first = m;
  }
  return first;
}

PetscErrorCode PartitionBlocks(PetscMPIInt size, const PetscInt counts[LATTICE], const PetscInt *cut_axis,
                               const PetscInt *cut, VoxelBlock *block)
{
  PetscInt n_parts = 1;
  Part *parts, *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * size, &parts, 2 * size, &next));
  parts[0].last = size;
  parts[0].block = block_of(counts);
  while (n_parts < size) {
    for (PetscInt p = 0; p < n_parts; ++p) {
      parts[p].axis = cut_axis[middle_rank(parts + p)];
      const VoxelBlock *shared = &parts[p].block;
      const PetscInt d = parts[p].axis;
      parts[p].cut = PetscMin(PetscMax(cut[middle_rank(parts + p)], shared->lo[d]), shared->hi[d]);
      divide(parts + p, next + 2 * p);
    }
    n_parts *= 2;
    PetscCall(PetscArraycpy(parts, next, n_parts));
  }
  for (PetscInt p = 0; p < n_parts; ++p)
    if (parts[p].last > parts[p].first) block[parts[p].first] = parts[p].block;
  PetscCall(PetscFree2(parts, next));
  PetscFunctionReturn(0);
}
