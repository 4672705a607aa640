/* Surfaces made of flat pieces: segments in the plane, triangles in space. Distance, sign and
 * derivatives at a position come from the nearest feature: a face, an edge or a corner.
 *
 * The sign is that of the angle-weighted pseudonormal of the feature (Baerentzen & Aanaes 2005),
 * which is right wherever the nearest feature is. */
#pragma once
#include "grid/search/box_tree.h"
#include "wall/wall.h"

/* How near a position is: not within reach; within; or nearest to the rim of a surface without an
 * inside, there rather over one of its sides or beyond it. */
typedef enum { NEAR_NOT, NEAR, NEAR_OVER_RIM, NEAR_RIM } Nearness;
/* Over it are directions within 45 degrees of the normal. */
#define RIM_COSINE 0.7071

typedef struct Facets {
  PetscInt dim, n;               /* 2: segments, 3: triangles */
  PetscReal (*corner)[3][3];     /* n, of each its dim corners */
  PetscReal (*normal)[3];        /* n, unit */
  PetscInt (*vertex)[3];         /* n, of each its dim corners by number */
  PetscInt (*edge)[3];           /* n, 3D: edge k joins corners k and k + 1 */
  PetscInt n_vertices, n_edges;  /* */
  PetscReal (*vertex_normal)[3]; /* n_vertices, unit pseudonormals */
  PetscReal (*edge_normal)[3];   /* n_edges */
  PetscBool *vertex_rim;         /* does the surface end there? */
  PetscBool *edge_rim;           /* n_edges */
  PetscReal bounds[6];           /* m */
  BoxTree *tree;
  struct FarField *far; /* where the surface is far, and on which side; NULL: not worth it */
} Facets;

/* Segments between n vertices (n x 2), in their order. Normals point out of a polygon, which is
 * closed by itself (counter-clockwise or not), and to the right of a line. axis: x = 0 is an axis of symmetry;
 * segments on it are no surface. */
PetscErrorCode FacetsOfLine(PetscInt n, const PetscReal *vertices, PetscBool closed, PetscBool axis, Facets **facets);
/* Triangles (n x 3 corners) of vertices x (n_vertices x 3); edge (n x 3): numbers of their edges.
 * They are oriented alike. */
PetscErrorCode FacetsOfTriangles(PetscInt n_vertices, const PetscReal *x, PetscInt n, PetscInt (*vertex)[3],
                                 PetscInt n_edges, PetscInt (*edge)[3], PetscReal (*normal)[3], Facets **facets);
PetscErrorCode FacetsDestroy(Facets **facets);

/* The signed distance times flip (1 or -1) where that is at most `high`: gap, normal and curvature
 * of `place`, all times flip. thin: there is no inside, and what counts is the distance alone. */
Nearness facets_near(const Facets *facets, const PetscReal x[3], int flip, PetscBool thin, PetscReal high,
                     WallPlace *place);
/* Of one form, before those that are hidden are left out. */
#define WALL_SIDES_FOUND 16
typedef struct {
  PetscInt n;
  WallPlace place[WALL_SIDES_FOUND];
} WallSides;
/* Is a nearer one there with a normal like it? */
PetscBool sides_have(const WallSides *sides, const WallPlace *place);
/* A place more, unless a nearer one has a normal like it. */
void sides_add(WallSides *sides, const WallPlace *place);
/* Adds the places whose normal leads to x, within `high` on the side flip of them. */
void facets_sides(const Facets *facets, const PetscReal x[3], int flip, PetscReal high, WallSides *sides);
/* The same without a look at what is known of places far away. least: no facet is farther, m. */
Nearness facets_search(const Facets *facets, const PetscReal x[3], PetscReal least, WallPlace *place);

/* --- far_field.c: distances on a lattice of the box around the surface --- */
PetscErrorCode FarFieldCreate(Facets *facets);
PetscErrorCode FarFieldDestroy(struct FarField **far);
/* Signed distance of a lattice point near x, and how far x is from it; PETSC_FALSE if x is
 * outside. */
PetscBool far_field_at(const struct FarField *far, const PetscReal x[3], PetscReal *gap, PetscReal *away);
