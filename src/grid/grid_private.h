/* What the files of this room share and no other room sees. */
#pragma once
#include "grid/grid.h"

/* A block of voxels (or lattice nodes): lo <= index < hi along each axis. Axes beyond the dimension
 * are 0 .. 1. */
typedef struct {
  PetscInt lo[3], hi[3];
} VoxelBlock;

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
  PetscInt dim, counts[3];
  PetscReal *line[3];      /* counts + 1 coordinates along each axis */
  PetscReal per_length[3]; /* voxels per metre; 0 where the axis is graded */
  PetscReal tolerance;     /* how far outside a position still belongs, m */
  PetscMPIInt rank, size;
  VoxelBlock *block;        /* per rank, in voxels */
  PetscInt *cut_axis, *cut; /* the bisection: entry m parts the ranks below m from those from m on */
  PetscInt *first_node;     /* size + 1: first global node of each rank */
  VoxelPattern pattern[2];  /* [1]: the odd voxels of alternating diagonals */
};

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

/* Is this an odd voxel of a chequered pattern? */
static inline int voxel_odd(const PetscInt ijk[3]) { return (int)((ijk[0] + ijk[1] + ijk[2]) & 1); }

/* Collective. An error for each of the grid's parameters that no .geo of the case mentions. */
PetscErrorCode GeoCheckParameters(MPI_Comm comm, const Case *c, Diag *diag);
/* box.c, box_pattern.c, box_locate.c */
PetscErrorCode GridCreate_Box(MPI_Comm comm, const Case *c, GridWeight weight, void *context, Diag *diag, Grid **grid);
PetscErrorCode GridBoxDestroy(GridBox **box);
/* The patterns of even and odd voxels (both the same but for alternating diagonals). */
void voxel_patterns(CellType type, Diagonal diagonal, VoxelPattern pattern[2]);
/* The rank that owns a voxel. */
PetscMPIInt box_owner(const GridBox *box, const PetscInt ijk[3]);
/* The voxel that holds x; PETSC_FALSE outside the grid. */
PetscBool box_voxel(const GridBox *box, const PetscReal *x, PetscInt ijk[3]);
PetscInt box_locate(const Grid *grid, const PetscReal *x, PetscReal *xi);
PetscInt box_candidates(const GridBox *box, const PetscReal *x, PetscInt max, PetscMPIInt *ranks);

/* Nodes that the owner of a block of voxels owns. */
PetscInt box_owned_nodes(const GridBox *box, const VoxelBlock *voxels);
/* Collective. The grid of a box whose blocks are known; takes the box. */
PetscErrorCode GridFromBox(MPI_Comm comm, CellType type, GridBox *box, Grid **grid);

/* Voxels that carry something, by their numbers in the lattice (first axis fastest), each named by one rank only. Where cells lie anywhere the
 * lattice is a ruler for their centres, `layer` of its intervals to a cell, and all cells are listed; of a lattice of cells layer is 0. */
typedef struct {
  PetscInt n, *voxel;
  PetscInt64 *weight;
  PetscInt layer;
} VoxelWeights;

#define WEIGHT_UNIT 64 /* weights are whole numbers of this fraction of a point */

static inline PetscInt64 whole_weight(PetscReal weight)
{
  return weight > 0 ? (PetscInt64)(weight * WEIGHT_UNIT + 0.5) : 0;
}

/* partition.c: weighted recursive coordinate bisection of the voxels. Fills the cuts (entries 1 .. size-1). imbalance: the
 * largest weight of a rank over the mean. Collective. */
PetscErrorCode PartitionVoxels(MPI_Comm comm, PetscInt dim, const PetscInt counts[3], const VoxelWeights *weights,
                               PetscInt *cut_axis, PetscInt *cut, PetscReal *imbalance);
/* The blocks of all ranks from the cuts. */
PetscErrorCode PartitionBlocks(PetscMPIInt size, const PetscInt counts[3], const PetscInt *cut_axis,
                               const PetscInt *cut, VoxelBlock *block);
/* The rank of one voxel from the cuts. */
PetscMPIInt voxel_owner(PetscMPIInt size, const PetscInt *cut_axis, const PetscInt *cut, const PetscInt ijk[3]);

/* box_partition.c: the ranks' blocks of a box. Collective; see GridCreate. */
PetscErrorCode BoxPartition(MPI_Comm comm, GridBox *box, GridWeight weight, void *context);
/* The voxels of this rank that weigh something; arrays to be freed with PetscFree2. */
PetscErrorCode BoxWeighCells(const Grid *grid, const PetscReal *weight, VoxelWeights *voxels);
/* Collective. The same box for other cuts. */
PetscErrorCode GridBoxFromCuts(const Grid *old, const PetscInt *cut_axis, const PetscInt *cut, Grid **grid);

/* mesh_repartition.c: intervals of the ruler over a mesh, which depend on the mesh alone. */
void mesh_ruler(const Grid *grid, PetscInt counts[3]);
PetscErrorCode MeshWeighCells(const Grid *grid, const PetscReal *weight, VoxelWeights *voxels);
PetscErrorCode GridMeshFromCuts(const Grid *old, const PetscInt *cut_axis, const PetscInt *cut, Grid **grid);
/* Collective. The same mesh with each local cell of `old` on the rank owner[cell]. */
PetscErrorCode GridMeshFromOwners(const Grid *old, const PetscMPIInt *owner, Grid **grid);

/* sets.c */
PetscErrorCode GridSetDestroy(GridSet *set);
/* Fill grid->outer of a box from its sides. */
PetscErrorCode GridOuterFromSets(Grid *grid);
PetscErrorCode GridSortUnique(PetscInt *n, PetscInt *values);

/* grid.c: what every builder ends with. Collective. */
PetscErrorCode GridFinish(Grid *grid);

/* A mistake of the user, the same on all ranks: said once. */
#define GridError(comm, diag, path, ...)                           \
  do {                                                             \
    PetscMPIInt grid_error_rank;                                   \
    PetscCallMPI(MPI_Comm_rank((comm), &grid_error_rank));         \
    if (!grid_error_rank) diag_error((diag), (path), __VA_ARGS__); \
  } while (0)

/* search.c: everything that only unstructured grids need besides their cells. */
typedef struct BoxTree BoxTree;
struct GridBins {
  PetscInt *neighbour; /* n_cells x faces: local cell beyond, -1 outside the grid, -2 - r on rank r */
  PetscInt *far_cell;  /* numbers of the cells on other ranks, in the order in which neighbour names them */
  PetscInt *file_node; /* n_nodes: place among the nodes in the file, whatever the ranks */
  BoxTree *cell_tree;  /* bounding boxes of the cells */
  BoxTree *face_tree;  /* and of the faces on the outer boundary, as grid->outer lists them */
  PetscReal tolerance; /* how far outside a cell a position still belongs, in reference units */
};
/* Takes the arrays. */
PetscErrorCode GridBinsCreate(Grid *grid, PetscInt *neighbour, PetscInt *far_cell, PetscInt *file_node);
PetscErrorCode GridBinsDestroy(GridBins **bins);
PetscInt mesh_locate(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi);
PetscInt mesh_candidates(const Grid *grid, const PetscReal *x, PetscInt max, PetscMPIInt *ranks);
void mesh_clamp(const Grid *grid, PetscReal *x);

/* box_tree.c: bounding boxes (6 numbers each: min[3], max[3]; axes beyond dim 0) in a balanced
 * tree. Cells of very different sizes cost no more than equal ones, as they would in uniform bins. */
PetscErrorCode BoxTreeCreate(PetscInt n, PetscReal (*bounds)[6], BoxTree **tree);
PetscErrorCode BoxTreeDestroy(BoxTree **tree);
/* Call `visit` for the boxes that hold x, until it returns PETSC_FALSE. */
typedef PetscBool (*BoxVisit)(void *context, PetscInt index);
void box_tree_holding(const BoxTree *tree, const PetscReal x[3], BoxVisit visit, void *context);
/* The nearest object, by `distance` (squared), which is never less than that of its box; -1: there
 * is none. */
typedef PetscReal (*BoxDistance)(void *context, PetscInt index);
PetscInt box_tree_nearest(const BoxTree *tree, const PetscReal x[3], BoxDistance distance, void *context);
