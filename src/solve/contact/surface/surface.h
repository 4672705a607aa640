/* Bodies that meet bodies: the material points of each that the other may reach, wherever they are, and
 * how one of them stands against the other body. In the plane. */
#pragma once
#include "material/law.h"
#include "support/support.h"

#define SURFACE_NODES 9
#define SURFACE_SEARCH 4 /* cells around a body in which another one may be that it meets in a step */

/* A material point as the other body sees it. */
typedef struct {
  PetscInt64 id;
  PetscInt rank, owner; /* its rank, and its index there */
  PetscReal x[3], F[9];
  PetscReal first, corner[2]; /* POINT_REACH, POINT_CORNER, m */
  PetscReal reach;            /* what strain has made of the first on the whole, m */
  PetscReal size;             /* side of a square of its part of the section, m */
  PetscReal modulus, density; /* of its material, Pa, kg/m3 */
  PetscReal stiffer;          /* see ContactPoint */
  PetscInt n;                 /* its nodes, by their numbers in the whole grid; 0: not asked for */
  PetscInt node[SURFACE_NODES];
  PetscReal N[SURFACE_NODES], dN[2 * SURFACE_NODES];
  PetscReal bend[2 * SURFACE_NODES]; /* Basis.bends; 0: not */
} SurfacePoint;

/* Those of one body that are near another one, of all ranks on each, ascending along x. */
typedef struct {
  PetscInt n;
  SurfacePoint *point;
} Surface;

typedef struct {
  MPI_Comm comm;
  const Kinematics *kinematics;
  const Grid *grid;
  const Points *points;
  const Material *materials;
  const Support *support;                                                           /* NULL: nodes are not wanted */
  PetscBool (*bends)(const void *context, PetscInt p, PetscInt n, PetscReal *bend); /* see NodalScene */
  const void *bends_context;
} SurfaceInput;

/* Collective. Boxes around all bodies: n_bodies x 6, min and then minus max. */
PetscErrorCode SurfaceBounds(const SurfaceInput *in, PetscInt n_bodies, PetscReal *bounds);
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

/* Index of the first point that is at least at x. */
PetscInt surface_first_at(const Surface *s, PetscReal x);
/* surface_cover.c. SurfacePair.cover of what was found; 0: too little to count. */
PetscReal surface_cover(const Surface *a, const SurfacePoint *p, const Surface *b, const SurfacePair *pair);

/* What of b is before point p of a, on a's surface; PETSC_FALSE: nothing within h, the length of a cell. */
PetscBool surface_meet(const Surface *a, const SurfacePoint *p, const Surface *b, PetscReal h, SurfacePair *pair);
