/* Normals at the nodes of walls along which material slides. */
#pragma once
#include "grid/grid.h"

/* Directions along which a node of walls is held: the normal; two that span those of walls that
 * meet in an edge; all, at a corner. */
typedef struct {
  PetscInt node, entry;   /* local; of the case's boundary: the first that has the node slide */
  PetscInt n;             /* directions; 0: no wall at the node */
  PetscReal direction[9]; /* n x 3, orthonormal */
} WallNode;

/* Of a node at which several entries meet, each with the normal of its own sides. */
typedef struct {
  PetscInt node, entry;
  PetscReal normal[3];
} WallSide;

/* Walls whose normals differ by more than this angle hold the node along both, rad. */
#define WALL_CORNER (40 * PETSC_PI / 180)

/* Collective. The nodes that entries with `fix: [normal]` select, ascending, in their walls: the
 * sides of cells that the same entries take. All entries make one wall. The normal is that through
 * which nothing flows: n_I = integral of N_I n over the wall, around the circle where rings
 * strain. To be freed with PetscFree. */
PetscErrorCode WallNormals(const Grid *grid, const Case *c, const PetscInt *field, PetscInt *n, WallNode **nodes);

/* Collective. The sides of the nodes that several entries with `fix: [normal]` select, ascending by node and entry. To
 * be freed with PetscFree. */
PetscErrorCode WallSides(const Grid *grid, const Case *c, const PetscInt *field, PetscInt *n, WallSide **sides);
