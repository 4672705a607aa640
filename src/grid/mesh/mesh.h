/* Cells that lie anywhere: how they know each other, how a position finds them, and how they go to
 * other ranks. */
#pragma once
#include "grid/search/box_tree.h"
#include "grid/grid_ops.h"

struct GridMesh {
  /* n_cells x faces: local cell beyond, -1 outside the grid, -2 - r on rank r */
  PetscInt *neighbour;
  /* numbers of the cells on other ranks, in the order in which neighbour names them */
  PetscInt *far_cell;
  PetscInt *file_node; /* n_nodes: place among the nodes in the file, whatever the ranks */
  /* does each rank know all nodes of all cells at the outer boundary, where bodies meet? */
  PetscBool knows_surface;
  BoxTree *cell_tree;  /* bounding boxes of the cells */
  BoxTree *face_tree;  /* and of the faces on the outer boundary, as grid->outer lists them */
  PetscReal tolerance; /* how far outside a cell a position still belongs, in reference units */
};

/* Sides of a cell in `neighbour`, and wherever a side is called cell * faces + side: those of the
 * grid's type. */
static inline PetscInt mesh_faces(const Grid *grid) { return cells[grid->type].faces; }

/* mesh_locate.c */
PetscErrorCode MeshCellTree(const Grid *grid, BoxTree **tree);
PetscInt mesh_locate(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi);
PetscInt mesh_candidates(const Grid *grid, const PetscReal *x, PetscInt max, PetscMPIInt *ranks);

/* mesh_clamp.c */
PetscErrorCode MeshFaceTree(const Grid *grid, BoxTree **tree);
void mesh_clamp(const Grid *grid, PetscReal *x);

/* mesh_repartition.c: see GridOps. */
PetscErrorCode MeshWeighCells(const Grid *grid, const PetscReal *weight, VoxelWeights *voxels);
PetscErrorCode MeshFromCuts(const Grid *old, const PetscInt *cut_axis, const PetscInt *cut, Grid **grid);
PetscErrorCode MeshPartitionToTable(const Grid *grid, Tables *tables);
PetscErrorCode MeshFromPartition(const Grid *old, const Table *table, Grid **grid, char reason[256]);

/* mesh_build.c. Collective. The same mesh with each local cell of `old` on the rank owner[cell]. */
PetscErrorCode MeshFromOwners(const Grid *old, const PetscMPIInt *owner, Grid **grid);
/* See GridOps. */
PetscErrorCode MeshWiden(const Grid *old, PetscInt layers, Grid **grid);
