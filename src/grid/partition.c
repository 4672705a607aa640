/* Weighted recursive coordinate bisection of a lattice of voxels.
 *
 * The ranks are halved together with the lattice: ranks first..last-1 share a block, and those
 * below the middle m take what lies below the cut. Entry m of `cut` is that cut, so that the tree
 * needs no pointers. Each rank weighs its share of the voxels; only histograms along the axis to be
 * cut travel. */
#include "grid/grid_private.h"

/* Weight of an empty voxel relative to the mean of those that carry something: its nodes still cost
 * memory and loops. */
static const PetscReal empty_weight = 0.05;

/* A block that ranks first .. last-1 share; the entries of one level of the tree stand in one
 * array. */
typedef struct {
  PetscMPIInt first, last;
  VoxelBlock block;
  PetscInt axis, cut;
  PetscInt start; /* of its histogram */
} Part;

/* This rank's share of the voxels: a range of the lexicographic order. */
typedef struct {
  PetscInt begin, n;
  PetscInt counts[3];
  PetscReal *weight;
  PetscInt *part; /* index into the current level */
} Share;

static inline void voxel_at(const PetscInt counts[3], PetscInt v, PetscInt ijk[3])
{
  ijk[0] = v % counts[0];
  ijk[1] = v / counts[0] % counts[1];
  ijk[2] = v / counts[0] / counts[1];
}

static PetscErrorCode ShareWeigh(MPI_Comm comm, Share *share, PetscInt dim, PetscReal *const line[3], GridWeight weight,
                                 void *context)
{
  PetscReal sums[2] = {0, 0}, total[2];

  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < share->n; ++v) {
    PetscInt ijk[3];
    PetscReal centre[3];
    voxel_at(share->counts, share->begin + v, ijk);
    for (PetscInt d = 0; d < dim; ++d) centre[d] = 0.5 * (line[d][ijk[d]] + line[d][ijk[d] + 1]);
    share->weight[v] = PetscMax(weight(context, centre), 0.0);
    sums[0] += share->weight[v];
    sums[1] += share->weight[v] > 0;
  }
  PetscCallMPI(MPI_Allreduce(sums, total, 2, MPIU_REAL, MPI_SUM, comm));
  const PetscReal least = total[0] > 0 ? empty_weight * total[0] / total[1] : 1.0;
  for (PetscInt v = 0; v < share->n; ++v) share->weight[v] = PetscMax(share->weight[v], least);
  PetscFunctionReturn(0);
}

static PetscErrorCode ShareCreate(MPI_Comm comm, PetscInt dim, const PetscInt counts[3], PetscReal *const line[3],
                                  GridWeight weight, void *context, Share *share)
{
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  const PetscInt64 all = (PetscInt64)counts[0] * counts[1] * counts[2];
  share->begin = (PetscInt)(all * rank / size);
  share->n = weight ? (PetscInt)(all * (rank + 1) / size) - share->begin : 0;
  for (int d = 0; d < 3; ++d) share->counts[d] = counts[d];
  PetscCall(PetscMalloc1(share->n, &share->weight));
  PetscCall(PetscCalloc1(share->n, &share->part));
  if (weight) PetscCall(ShareWeigh(comm, share, dim, line, weight, context));
  PetscFunctionReturn(0);
}

static PetscErrorCode ShareDestroy(Share *share)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(share->weight));
  PetscCall(PetscFree(share->part));
  PetscFunctionReturn(0);
}

/* The axis with the most voxels: the cut then touches the fewest nodes. */
static PetscInt longest_axis(const VoxelBlock *b)
{
  PetscInt axis = 0;
  for (PetscInt d = 1; d < 3; ++d)
    if (b->hi[d] - b->lo[d] > b->hi[axis] - b->lo[axis]) axis = d;
  return axis;
}

static PetscErrorCode FillHistogram(MPI_Comm comm, const Share *share, PetscBool weighted, const Part *parts,
                                    PetscInt n, PetscReal *histogram)
{
  PetscFunctionBeginUser;
  if (!weighted) {
    for (PetscInt b = 0; b < n; ++b) histogram[b] = 1.0;
    PetscFunctionReturn(0);
  }
  PetscCall(PetscArrayzero(histogram, n));
  for (PetscInt v = 0; v < share->n; ++v) {
    const Part *part = parts + share->part[v];
    PetscInt ijk[3];
    if (part->start < 0) continue;
    voxel_at(share->counts, share->begin + v, ijk);
    histogram[part->start + ijk[part->axis] - part->block.lo[part->axis]] += share->weight[v];
  }
  /* One sum for all: rounding must not let two ranks cut differently. */
  PetscMPIInt rank, count;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCallMPI(MPI_Reduce(rank ? histogram : MPI_IN_PLACE, histogram, count, MPIU_REAL, MPI_SUM, 0, comm));
  PetscCallMPI(MPI_Bcast(histogram, count, MPIU_REAL, 0, comm));
  PetscFunctionReturn(0);
}

/* Where `fraction` of the histogram lies below; never at an end, unless there is but one bin: then
 * the lower half takes it. */
static PetscInt best_cut(PetscInt n, const PetscReal *histogram, PetscReal fraction)
{
  PetscReal total = 0, below = 0, best_miss = PETSC_MAX_REAL;
  PetscInt best = n;
  for (PetscInt b = 0; b < n; ++b) total += histogram[b];
  for (PetscInt b = 1; b < n; ++b) {
    below += histogram[b - 1];
    const PetscReal miss = PetscAbsReal(below - fraction * total);
    if (miss < best_miss) best = b, best_miss = miss;
  }
  return best;
}

static inline PetscMPIInt middle_rank(const Part *part) { return part->first + (part->last - part->first) / 2; }

static PetscBool part_divides(const Part *part) { return part->last - part->first > 1 ? PETSC_TRUE : PETSC_FALSE; }

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

static PetscErrorCode PlanHistograms(PetscInt n_parts, Part *parts, PetscInt *size)
{
  PetscFunctionBeginUser;
  *size = 0;
  for (PetscInt p = 0; p < n_parts; ++p) {
    Part *part = parts + p;
    part->start = -1;
    if (!part_divides(part)) continue;
    part->axis = longest_axis(&part->block);
    part->start = *size;
    *size += part->block.hi[part->axis] - part->block.lo[part->axis];
  }
  PetscFunctionReturn(0);
}

/* One level: cut every part that still has several ranks. */
static PetscErrorCode CutLevel(MPI_Comm comm, Share *share, PetscBool weighted, PetscInt n_parts, Part *parts,
                               PetscInt *cut_axis, PetscInt *cut)
{
  PetscInt size;
  PetscReal *histogram;

  PetscFunctionBeginUser;
  PetscCall(PlanHistograms(n_parts, parts, &size));
  PetscCall(PetscMalloc1(size, &histogram));
  PetscCall(FillHistogram(comm, share, weighted, parts, size, histogram));
  for (PetscInt p = 0; p < n_parts; ++p) {
    Part *part = parts + p;
    if (!part_divides(part)) continue;
    const PetscMPIInt m = middle_rank(part);
    const PetscInt lo = part->block.lo[part->axis], n = part->block.hi[part->axis] - lo;
    part->cut = lo + best_cut(n, histogram + part->start, (PetscReal)(m - part->first) / (part->last - part->first));
    cut_axis[m] = part->axis;
    cut[m] = part->cut;
  }
  for (PetscInt v = 0; v < share->n; ++v) {
    const Part *part = parts + share->part[v];
    PetscInt ijk[3];
    voxel_at(share->counts, share->begin + v, ijk);
    share->part[v] = 2 * share->part[v] + (part_divides(part) && ijk[part->axis] >= part->cut);
  }
  PetscCall(PetscFree(histogram));
  PetscFunctionReturn(0);
}

PetscErrorCode PartitionVoxels(MPI_Comm comm, PetscInt dim, const PetscInt counts[3], PetscReal *const line[3],
                               GridWeight weight, void *context, VoxelBlock *block, PetscInt *cut_axis, PetscInt *cut)
{
  PetscMPIInt size;
  PetscInt n_parts = 1;
  Part *parts, *next;
  Share share;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1) weight = NULL;
  PetscCall(ShareCreate(comm, dim, counts, line, weight, context, &share));
  PetscCall(PetscCalloc2(2 * size, &parts, 2 * size, &next));
  parts[0].last = size;
  for (int d = 0; d < 3; ++d) parts[0].block.hi[d] = counts[d];
  while (n_parts < size) {
    PetscCall(CutLevel(comm, &share, weight ? PETSC_TRUE : PETSC_FALSE, n_parts, parts, cut_axis, cut));
    for (PetscInt p = 0; p < n_parts; ++p) divide(parts + p, next + 2 * p);
    n_parts *= 2;
    PetscCall(PetscArraycpy(parts, next, n_parts));
  }
  for (PetscInt p = 0; p < n_parts; ++p)
    if (parts[p].last > parts[p].first) block[parts[p].first] = parts[p].block;
  PetscCall(PetscFree2(parts, next));
  PetscCall(ShareDestroy(&share));
  PetscFunctionReturn(0);
}
