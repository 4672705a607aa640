/* Parts of a mesh on their way from rank to rank, with all that a grid is made of. Cells and nodes
 * go by their numbers in the file, which are the same on all ranks. */
#pragma once
#include "grid/mesh/mesh.h"

typedef struct {
  PetscReal x[3];
  PetscInt64 number;
} MeshNode;

typedef enum { MEMBER_NODE, MEMBER_FACE, MEMBER_CELL } MemberKind;

/* A node, the side of a cell or a cell is in a set; the one after the last set is the outer
 * boundary. */
typedef struct {
  PetscInt set, kind, number, side;
} MeshMember;

typedef struct {
  PetscInt n_cells,
    /* rows of mesh_row numbers: of the cell, its nodes and the cells beyond its faces (-1: none) */
    *cell;
  PetscInt n_nodes; /* those that several ranks send come as often */
  MeshNode *node;
  PetscInt n_members;
  MeshMember *member;
} MeshPart;

static inline PetscInt mesh_row(const Grid *grid) { return 1 + grid->nodes_per_cell + mesh_faces(grid); }

/* mesh_send.c. Collective. Every cell, and what hangs on it, goes to the rank owner[cell], which
 * may be this one. */
PetscErrorCode MeshSend(const Grid *grid, const PetscMPIInt *owner, MeshPart *arrived);
PetscErrorCode MeshPartDestroy(MeshPart *part);
