/* A box of voxels on coordinate lines, and the ranks' blocks of it. */
#pragma once
#include "grid/grid_ops.h"

#define VOXEL_MAX_CELLS 6
#define VOXEL_CENTRE 8 /* code of the node in the middle of a crossed voxel */

/* How a voxel is cut into cells. A corner's code has bit d set where it lies at the upper end of
 * axis d. */
typedef struct {
  PetscInt n_cells;
  PetscInt code[VOXEL_MAX_CELLS][CELL_MAX_NODES];
  PetscReal origin[VOXEL_MAX_CELLS][3];  /* simplices: first node in the unit voxel */
  PetscReal inverse[VOXEL_MAX_CELLS][9]; /* and inverse of its edge matrix, row by row */
} VoxelPattern;

/* A box grid knows every rank's block, so that owners and global numbers need no messages. */
struct GridBox {
  PetscInt dim, counts[LATTICE];
  PetscReal *line[3];      /* counts + 1 coordinates along each axis */
  PetscReal per_length[3]; /* voxels per metre; 0 where the axis is graded */
  PetscReal tolerance;     /* how far outside a position still belongs, m */
  PetscInt halo;           /* layers of nodes that a rank has beyond those of its voxels */
  VoxelBlock nodes;        /* lattice nodes of this rank, halo and all, */
  PetscInt *lattice;       /* and the local number of each */
  PetscMPIInt rank, size;
  VoxelBlock *block; /* per rank, in voxels */
  /* the bisection: entry m parts the ranks below m from those from m on */
  PetscInt *cut_axis, *cut;
  PetscInt *first_node;    /* size + 1: first global node of each rank */
  VoxelPattern pattern[2]; /* [1]: the odd voxels of alternating diagonals */
};

/* The pattern of a voxel, chequered in each field alike. */
static inline const VoxelPattern *box_pattern(const GridBox *box, const PetscInt ijk[LATTICE])
{
  return box->pattern + ((ijk[0] + ijk[1] + ijk[2]) & 1);
}

/* All voxels. */
static inline VoxelBlock box_voxels(const GridBox *box) { return block_of(box->counts); }

/* box_blocks.c */
PetscErrorCode BoxCreate(MPI_Comm comm, const Case *c, GridBox **box);
PetscErrorCode BoxCopy(MPI_Comm comm, const GridBox *old, GridBox **box);
PetscErrorCode BoxDestroy(GridBox **box);
/* The ranks' blocks from the cuts. */
PetscErrorCode BoxCut(GridBox *box, const PetscInt *cut_axis, const PetscInt *cut);
/* Lattice nodes that a block's owner knows, those of its voxels and the halo, and that it owns. */
VoxelBlock box_nodes(const GridBox *box, const VoxelBlock *voxels);
VoxelBlock box_owned_nodes(const GridBox *box, const VoxelBlock *voxels);
PetscBool box_has_centres(const GridBox *box);

/* box_pattern.c: the patterns of even and odd voxels (both the same but for alternating
 * diagonals). */
void voxel_patterns(CellType type, Diagonal diagonal, VoxelPattern pattern[2]);

/* box_locate.c */
PetscInt box_locate(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi);
void box_clamp(const Grid *grid, PetscReal *x);
PetscInt box_candidates(const Grid *grid, const PetscReal *x, PetscInt max, PetscMPIInt *ranks);
/* The rank that owns a voxel. */
PetscMPIInt box_owner(const GridBox *box, const PetscInt ijk[LATTICE]);

/* The voxel of a local cell, from 0 along each axis, and the local number of a lattice node that
 * this rank knows. */
void box_voxel_of(const Grid *grid, PetscInt cell, PetscInt ijk[LATTICE]);
static inline PetscInt box_node(const GridBox *box, const PetscInt ijk[LATTICE])
{
  return box->lattice[block_index(&box->nodes, ijk)];
}
/* The sides of a voxel, m. */
static inline void box_voxel_size(const GridBox *box, const PetscInt ijk[LATTICE], PetscReal *size)
{
  for (PetscInt d = 0; d < box->dim; ++d) size[d] = box->line[d][ijk[d] + 1] - box->line[d][ijk[d]];
}

/* box_build.c. Collective. The grid of a box whose blocks are known; takes the box. */
PetscErrorCode BoxBuild(MPI_Comm comm, const GridOps *ops, CellType type, GridBox *box, Grid **grid);

/* box_partition.c: the ranks' blocks of a new box. Collective; see GridCreate. */
PetscErrorCode BoxPartition(MPI_Comm comm, GridBox *box, GridWeight weight, void *context);
/* See GridOps. */
PetscErrorCode BoxWeighCells(const Grid *grid, const PetscReal *weight, VoxelWeights *voxels);
PetscErrorCode BoxWiden(const Grid *old, PetscInt halo, Grid **grid);
PetscErrorCode BoxFromCuts(const Grid *old, const PetscInt *cut_axis, const PetscInt *cut, Grid **grid);
PetscErrorCode BoxPartitionToTable(const Grid *grid, Tables *tables);
PetscErrorCode BoxFromPartition(const Grid *old, const Table *table, Grid **grid, char reason[256]);
