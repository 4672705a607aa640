/* Parts of a mesh on their way from rank to rank, with all that a grid is made of. Cells and nodes go by their numbers in the file, which are the
 * same on all ranks. */
#pragma once
#include "grid/grid_private.h"

typedef struct {
  PetscReal x[3];
  PetscInt64 number;
} MeshNode;

typedef enum { MEMBER_NODE, MEMBER_FACE, MEMBER_CELL } MemberKind;

/* A node, the side of a cell or a cell is in a set; the one after the last set is the outer boundary. */
typedef struct {
  PetscInt set, kind, number, side;
} MeshMember;

typedef struct {
  PetscInt n_cells,
    *cell;          /* rows of mesh_row numbers: of the cell, its nodes and the cells beyond its faces (-1: none) */
  PetscInt n_nodes; /* those that several ranks send come as often */
  MeshNode *node;
  PetscInt n_members;
  MeshMember *member;
} MeshParcel;

static inline PetscInt mesh_row(const Grid *grid) { return 1 + grid->nodes_per_cell + cells[grid->type].faces; }

/* mesh_travel.c. Collective. Every cell, and what hangs on it, goes to the rank owner[cell], which may be this one. */
PetscErrorCode MeshSend(const Grid *grid, const PetscMPIInt *owner, MeshParcel *arrived);
PetscErrorCode MeshParcelDestroy(MeshParcel *parcel);

/* mesh_settle.c. Collective. The grid of the cells that arrived, as GridDistribute would have made it; what is the same for all parts is taken from
 * `old`. */
PetscErrorCode MeshSettle(const Grid *old, const MeshParcel *arrived, Grid **grid);
