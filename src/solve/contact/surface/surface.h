/* Bodies that meet bodies: the material points of each that the other may reach, wherever they are, and
 * how one of them stands against the other body. In the plane and in space. */
#pragma once
#include "material/law.h"
#include "support/support.h"

#define SURFACE_SEARCH 4 /* cells around a body in which another one may be that it meets in a step */

/* A node that carries a point. */
typedef struct {
  PetscInt node; /* its number in the whole grid */
  PetscReal N, dN[3];
  PetscReal bend[3]; /* Basis.bends; 0: not */
} SurfaceCarrier;

/* A material point as the other body sees it. In the plane x[2] and corner[2] are 0. */
typedef struct {
  PetscInt64 id;
  PetscInt rank, owner; /* its rank, and its index there */
  PetscReal x[3], F[9];
  PetscReal first, corner[3]; /* POINT_REACH, POINT_CORNER, m */
  PetscReal shift[3];         /* from x to the middle of the disk, in space ball, that touches all sides beside it, m */
  PetscBool bent;             /* does it stand beside several sides of its body, as at a corner? */
  PetscReal reach;            /* what strain has made of the first on the whole, m */
  /* side of a square of its part of the section, in space of a cube of its volume, m; of a part that the body's surface
   * cuts what one has that it does not: others stand so far off */
  PetscReal size;
  PetscReal own;     /* that of its part, cut or not, m */
  PetscReal face[3]; /* of the body's surface, as a vector outwards, m2 (in the plane m); 0: it knows of none */
  PetscReal flat;    /* how many times as wide along its surface as it is deep, if that is flat; else 0 */
  PetscReal modulus, density; /* of its material, Pa, kg/m3 */
  PetscReal stiffer, softer;  /* see ContactPoint */
  PetscInt row[2];            /* where it stands among those of its body: see surface_sort */
  PetscInt first_carrier, n;  /* its nodes, of Surface.carrier; n = 0: not asked for */
} SurfacePoint;

/* Those of one body that are near another one, of all ranks on each: ascending along x, in space row by row. */
typedef struct Surface {
  PetscInt dim, n;
  SurfacePoint *point;
  PetscInt n_carriers;
  SurfaceCarrier *carrier;
  /* by surface_sort */
  PetscReal reach; /* the largest of its points, m */
  PetscReal low[2], side;
  PetscInt rows[2];
} Surface;

typedef struct {
  MPI_Comm comm;
  const Kinematics *kinematics;
  const Grid *grid;
  const Points *points;
  const Material *materials;
  const BodySpec *bodies;
  const Support *support;                                                           /* NULL: nodes are not wanted */
  PetscBool (*bends)(const void *context, PetscInt p, PetscInt n, PetscReal *bend); /* see NodalScene */
  const void *bends_context;
} SurfaceInput;

/* Collective. Boxes around all bodies: n_bodies x 6, min and then minus max. */
PetscErrorCode SurfaceBounds(const SurfaceInput *in, PetscInt n_bodies, PetscReal *bounds);
PetscBool surface_near(const PetscReal *x, PetscInt dim, const PetscReal *box, PetscReal within);
/* Collective. Points of `body` that are `within` (m) of the box. */
PetscErrorCode SurfaceGather(const SurfaceInput *in, PetscInt body, const PetscReal *bounds, PetscReal within,
                             Surface *surface);
PetscErrorCode SurfaceClear(Surface *surface);

/* Where the part of another body is that a point meets. */
typedef struct {
  const SurfacePoint *other;
  PetscReal normal[3]; /* unit, out of the other body */
  PetscReal gap;       /* from the point itself to the other one's surface, m */
  PetscReal cover;     /* share of the point's surface that the other body stands before */
} SurfacePair;

/* surface_walk.c. Points into the order in which they are looked for, the same on however many ranks. */
void surface_sort(Surface *s);

/* A walk over all points that are no farther than a distance from a place, along each axis, and some more. */
typedef struct {
  const Surface *surface;
  PetscReal low, high; /* along x, m; high may be lowered on the way */
  PetscInt from[2], to[2], row[2], next;
} SurfaceWalk;

SurfaceWalk surface_walk(const Surface *s, const PetscReal x[3], PetscReal distance);
/* NULL: that was all. */
const SurfacePoint *surface_next(SurfaceWalk *walk);

/* surface_cover.c. SurfacePair.cover of what was found; 0: too little to count. */
PetscReal surface_cover(const Surface *a, const SurfacePoint *p, const Surface *b, const SurfacePair *pair);

/* What of b is before point p of a, on a's surface; PETSC_FALSE: nothing within h, the length of a cell. */
PetscBool surface_meet(const Surface *a, const SurfacePoint *p, const Surface *b, PetscReal h, SurfacePair *pair);
