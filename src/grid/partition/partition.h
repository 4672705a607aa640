/* Weighted recursive coordinate bisection of a lattice of voxels. */
#pragma once
#include <petscsys.h>

/* Axes of a lattice: those of space and, last, the velocity fields, in each of which all of it stands. Nothing is cut
 * along these. */
#define LATTICE 4

/* A block of voxels (or lattice nodes): lo <= index < hi along each axis. Axes beyond the dimension
 * are 0 .. 1. */
typedef struct {
  PetscInt lo[LATTICE], hi[LATTICE];
} VoxelBlock;

/* All of a lattice with so many along each axis. */
static inline VoxelBlock block_of(const PetscInt counts[LATTICE])
{
  VoxelBlock all = {{0}, {0}};
  for (int d = 0; d < LATTICE; ++d) all.hi[d] = counts[d];
  return all;
}

static inline PetscInt block_size(const VoxelBlock *b)
{
  PetscInt size = 1;
  for (int d = 0; d < LATTICE; ++d) size *= b->hi[d] - b->lo[d];
  return size;
}

/* Lexicographic number of a member of the block, first axis fastest. */
static inline PetscInt block_index(const VoxelBlock *b, const PetscInt ijk[LATTICE])
{
  PetscInt index = 0;
  for (int d = LATTICE - 1; d >= 0; --d) index = index * (b->hi[d] - b->lo[d]) + ijk[d] - b->lo[d];
  return index;
}

/* Where the member with this number is. */
static inline void block_at(const VoxelBlock *b, PetscInt index, PetscInt ijk[LATTICE])
{
  for (int d = 0; d < LATTICE; ++d) {
    ijk[d] = b->lo[d] + index % (b->hi[d] - b->lo[d]);
    index /= b->hi[d] - b->lo[d];
  }
}

/* All members in the order of their numbers: for (more = block_first(b, ijk); more; more = block_next(b, ijk)). */
static inline PetscBool block_first(const VoxelBlock *b, PetscInt ijk[LATTICE])
{
  for (int d = 0; d < LATTICE; ++d) ijk[d] = b->lo[d];
  return (PetscBool)(block_size(b) > 0);
}

static inline PetscBool block_next(const VoxelBlock *b, PetscInt ijk[LATTICE])
{
  for (int d = 0; d < LATTICE; ++d) {
    if (++ijk[d] < b->hi[d]) return PETSC_TRUE;
    ijk[d] = b->lo[d];
  }
  return PETSC_FALSE;
}

static inline PetscBool block_has(const VoxelBlock *b, const PetscInt ijk[LATTICE])
{
  for (int d = 0; d < LATTICE; ++d)
    if (ijk[d] < b->lo[d] || ijk[d] >= b->hi[d]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Voxels that carry something, by their numbers in the lattice (first axis fastest), each named by
 * one rank only. Where cells lie anywhere the lattice is a ruler for their centres, `layer` of its
 * intervals to a cell, and all cells are listed; of a lattice of cells layer is 0. */
typedef struct {
  PetscInt counts[LATTICE]; /* of the lattice */
  PetscInt n, *voxel;
  PetscInt64 *weight;
  PetscInt layer;
} VoxelWeights;

#define WEIGHT_UNIT 64 /* weights are whole numbers of this fraction of a point */

static inline PetscInt64 whole_weight(PetscReal weight)
{
  return weight > 0 ? (PetscInt64)(weight * WEIGHT_UNIT + 0.5) : 0;
}

/* Fills the cuts (entries 1 .. size-1). weights: NULL where all weigh the same. imbalance: the
 * largest weight of a rank over the mean. Collective. */
PetscErrorCode PartitionVoxels(MPI_Comm comm, PetscInt dim, const PetscInt counts[LATTICE], const VoxelWeights *weights,
                               PetscInt *cut_axis, PetscInt *cut, PetscReal *imbalance);
/* The blocks of all ranks from the cuts. */
PetscErrorCode PartitionBlocks(PetscMPIInt size, const PetscInt counts[LATTICE], const PetscInt *cut_axis,
                               const PetscInt *cut, VoxelBlock *block);
/* The rank of one voxel from the cuts. */
PetscMPIInt voxel_owner(PetscMPIInt size, const PetscInt *cut_axis, const PetscInt *cut, const PetscInt ijk[LATTICE]);
