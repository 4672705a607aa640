/* Walls as lines (in the plane) or triangles (in space), for pictures. Of thin walls the middle; of walls
 * without an end what is in view. */
#pragma once
#include "wall/wall.h"

/* What is seen of a wall, and how fine. */
typedef struct {
  const PetscReal *min, *max; /* of the box that is looked at, m */
  PetscReal size;             /* largest piece of what is curved or cut, m */
} WallView;

/* Pieces of dim corners, each with corners of its own. */
typedef struct {
  PetscInt dim, n, capacity;
  PetscReal *x;    /* n x dim corners x 3, m */
  PetscInt *node;  /* n x dim: 0, 1, 2, ... */
  PetscReal *wall; /* n: which */
} WallMesh;

/* Not collective. Pieces of wall k where it is at time t. */
PetscErrorCode WallMeshAdd(const Walls *walls, PetscInt k, PetscReal t, const WallView *view, WallMesh *mesh);
PetscErrorCode WallMeshFree(WallMesh *mesh);
/* Keep what of a line or a convex face (n corners; closed: from the last back to the first) is on the side of a box:
 * sign x_d <= sign limit. Returns how many corners it has then, at most one more. */
PetscInt wall_mesh_cut(PetscInt n, PetscBool closed, PetscReal (*x)[3], int d, int sign, PetscReal limit);

/* --- for wall.c --- */
struct Form;
/* Pieces of a form in its own frame. */
PetscErrorCode FormMesh(const struct Form *form, const WallView *view, WallMesh *mesh);
