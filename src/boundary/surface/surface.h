/* The surface of a body that fills its shape, where the cells of the grid do not follow it.
 *
 * The shape is bounded by a few simple surfaces (surfaces.c). In each cell each of them is a
 * few segments or triangles (march.c); of these counts what bounds the whole shape and is selected (trim.c);
 * all that one surface has in a cell becomes two points, four in space, with the same area, middle and second moment
 * (gather.c), or as many pieces, that have these together. */
#pragma once
#include "boundary/sides/faces.h"
#include "case/terrain/relief.h"

typedef enum { SURFACE_PLANE, SURFACE_BALL, SURFACE_CONE, SURFACE_RELIEF } SurfaceKind;

/* Distance f of a position from it grows outwards by one a metre; f = 0 is the surface. */
typedef struct {
  SurfaceKind kind;
  PetscReal sign;     /* -1: the material is on the other side, as of what is cut away */
  PetscReal point[3]; /* of the plane, the axis; the centre */
  PetscReal normal[3];
  PetscReal radius, slope; /* of a cone where it begins, and by how much it widens a metre of its axis */
  const Relief *relief;
  PetscReal steepness;      /* f changes by no more than so much a metre */
  PetscReal min[3], max[3]; /* it is nowhere else */
} Surface;

/* The surfaces of a shape, to be freed with PetscFree. */
PetscErrorCode SurfacesCreate(const Shape *shape, PetscInt dim, PetscInt *n, Surface **surfaces);
/* f, and its gradient (three numbers). */
PetscReal surface_distance(const Surface *surface, PetscInt dim, const PetscReal *x, PetscReal *gradient);

/* What a body's surface is, and which part of it is asked for. */
typedef struct {
  const Grid *grid;
  const Kinematics *kinematics; /* by which pieces are weighed, where they are summed */
  const Shape *shape;           /* NULL: sides of cells bound it, wherever they are */
  PetscInt n_surfaces;
  Surface *surfaces;
  const Selector *on;
  /* m, in the present cell: so far surfaces are drawn in, and so far to both sides it is asked what they bound */
  PetscReal slack, step;
} BodySurface;
/* For a cell of this size, m. */
void surface_set_steps(BodySurface *body, PetscReal size);

/* Area, normal and moments of pieces about `origin`; weights of rings included. */
typedef struct {
  PetscReal origin[3], area, vector[3], first[3];
  PetscReal second[3][3]; /* of x and x */
  PetscReal turn[3][3];   /* of x and the normal: by how much forces differ along the piece */
} PieceSum;

/* Which part of a facet counts: of surface k where that bounds the shape; k < 0: of a side of a cell where the shape
 * goes on beyond it, or there is none. outward: unit normal of such a side. */
typedef struct {
  const BodySurface *body;
  PetscInt k;
  PetscReal outward[3];
} Trim;

/* A facet: a segment or a triangle, `outward` on the side where there is no material. */
typedef PetscReal Facet[3][3];
/* --- march.c: facets of surface k in a cell with nodes at x --- */
void surface_march(const Trim *trim, CellType type, const PetscReal *x, PieceSum *sum);
/* --- trim.c --- */
void surface_trim(const Trim *trim, Facet facet, const PetscReal *outward, PieceSum *sum);
/* --- gather.c: one piece with the area, middle, vector and spread of a sum --- */
void surface_piece(PetscInt dim, const PieceSum *sum, FacePoint *piece);

/* Collective. Points on the surface of a body that fills its shape, as far as the selector takes them, in the grid as
 * it is at the start; pieces: with edges, over which functions are to be averaged. Arrays for PetscFree. */
PetscErrorCode BodySurfacePoints(const Grid *grid, const Case *c, PetscInt body, const Selector *on, PetscBool pieces,
                                 PetscInt *n, PetscInt **cell, FacePoint **point);
/* Collective. The same of a body with a mesh of its own: on sides of that mesh, of which the selector's boundary is a
 * physical group, or else a side of the box; fills: as in LoadsCreate. */
PetscErrorCode BodyMeshPoints(const Grid *grid, const Case *c, PetscInt body, const Selector *on, PetscBool fills,
                              PetscBool pieces, PetscInt *n, PetscInt **cell, FacePoint **point);
/* Collective. The mesh that the body brings, or NULL: what is wrong with it was told when its points were placed. */
PetscErrorCode BodyMeshAgain(const Grid *grid, const Case *c, PetscInt body, Grid **own);
/* How a body's surface is found where a load acts on it. */
typedef enum { BORNE_BY_CELLS, BORNE_BY_SHAPE, BORNE_BY_MESH } Bearer;
Bearer body_bearer(const BodySpec *body, PetscBool fills);
