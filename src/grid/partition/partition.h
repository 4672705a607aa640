/* Weighted recursive coordinate bisection of a lattice of voxels. */
#pragma once
#include <petscsys.h>

/* A block of voxels (or lattice nodes): lo <= index < hi along each axis. Axes beyond the dimension
 * are 0 .. 1. */
typedef struct {
  PetscInt lo[3], hi[3];
} VoxelBlock;

static inline PetscInt block_size(const VoxelBlock *b)
{
  return (b->hi[0] - b->lo[0]) * (b->hi[1] - b->lo[1]) * (b->hi[2] - b->lo[2]);
}

/* Lexicographic number of a member of the block, first axis fastest. */
static inline PetscInt block_index(const VoxelBlock *b, const PetscInt ijk[3])
{
  const PetscInt nx = b->hi[0] - b->lo[0], ny = b->hi[1] - b->lo[1];
  return ((ijk[2] - b->lo[2]) * ny + ijk[1] - b->lo[1]) * nx + ijk[0] - b->lo[0];
}

static inline PetscBool block_has(const VoxelBlock *b, const PetscInt ijk[3])
{
  for (int d = 0; d < 3; ++d)
    if (ijk[d] < b->lo[d] || ijk[d] >= b->hi[d]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Voxels that carry something, by their numbers in the lattice (first axis fastest), each named by
 * one rank only. Where cells lie anywhere the lattice is a ruler for their centres, `layer` of its
 * intervals to a cell, and all cells are listed; of a lattice of cells layer is 0. */
typedef struct {
  PetscInt counts[3]; /* of the lattice */
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
PetscErrorCode PartitionVoxels(MPI_Comm comm, PetscInt dim, const PetscInt counts[3], const VoxelWeights *weights,
                               PetscInt *cut_axis, PetscInt *cut, PetscReal *imbalance);
/* The blocks of all ranks from the cuts. */
PetscErrorCode PartitionBlocks(PetscMPIInt size, const PetscInt counts[3], const PetscInt *cut_axis,
                               const PetscInt *cut, VoxelBlock *block);
/* The rank of one voxel from the cuts. */
PetscMPIInt voxel_owner(PetscMPIInt size, const PetscInt *cut_axis, const PetscInt *cut, const PetscInt ijk[3]);
