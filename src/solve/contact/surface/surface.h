/* Bodies that meet bodies: the material points of each that the other may reach, wherever they are, and
 * how one of them stands against the other body. In the plane and in space. */
#pragma once
#include "material/law.h"
#include "support/support.h"

#define SURFACE_NODES 27 /* most that carry a point */
#define SURFACE_SEARCH 4 /* cells around a body in which another one may be that it meets in a step */

/* A node that carries a point, by its number in the whole grid, and what it has there. */
typedef struct {
  PetscInt node;
  PetscReal N, dN[3], bend[3]; /* Basis.bends; 0: not */
} SurfaceCarrier;

/* A material point as the other body sees it. */
typedef struct {
  PetscInt64 id;
  PetscInt rank, owner; /* its rank, and its index there */
  PetscReal x[3], F[9];
  PetscReal first, corner[3]; /* POINT_REACH, POINT_CORNER, m */
  PetscReal reach;            /* what strain has made of the first on the whole, m */
  PetscReal size;             /* side of a square or cube of its part, of the section in the plane, m */
  PetscReal modulus, density; /* of its material, Pa, kg/m3 */
  PetscReal stiffer;          /* see ContactPoint */
  PetscInt n, carrier;        /* so many nodes, of Surface.carrier from there on; 0: not asked for */
} SurfacePoint;

/* Where points are: bins of a lattice around them all. */
typedef struct {
  PetscReal min[3], side;
  PetscInt counts[3];
  PetscInt *start, *point; /* of each bin, x fastest, its points */
} SurfaceBins;

/* Those of one body that are near another one, of all ranks on each, ascending along x. */
typedef struct {
  PetscInt dim, n, n_carriers;
  SurfacePoint *point;
  SurfaceCarrier *carrier;
  SurfaceBins bins;
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

/* surface_bins.c. Puts the points in order, and into bins of this side, m; SurfaceClear frees them, too. */
PetscErrorCode SurfaceSort(Surface *surface, PetscReal side);
/* Those in the bins within `radius` of x, one after the other: for (q = surface_first(..); q; q = surface_next(..)). */
typedef struct {
  const Surface *surface;
  PetscInt lo[3], hi[3], bin[3], k, end;
} SurfaceWalk;
const SurfacePoint *surface_first(const Surface *surface, const PetscReal *x, PetscReal radius, SurfaceWalk *walk);
const SurfacePoint *surface_next(SurfaceWalk *walk);

/* Where the part of another body is that a point meets. */
typedef struct {
  const SurfacePoint *other;
  PetscReal normal[3]; /* unit, out of the other body */
  PetscReal gap;       /* from the point itself to the other one's surface, m */
  PetscReal cover;     /* share of the point's surface that the other body stands before */
} SurfacePair;

/* Offset of q from p. */
static inline void surface_offset(const SurfacePoint *p, const SurfacePoint *q, PetscReal r[3])
{
  for (int d = 0; d < 3; ++d) r[d] = q->x[d] - p->x[d];
}

static inline PetscReal surface_dot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void surface_cross(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  for (int d = 0; d < 3; ++d) c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

/* surface_cover.c. SurfacePair.cover of what was found; 0: too little to count. */
PetscReal surface_cover(const Surface *a, const SurfacePoint *p, const Surface *b, const SurfacePair *pair);

/* What of b is before point p of a, on a's surface; PETSC_FALSE: nothing within h, the length of a cell. */
PetscBool surface_meet(const Surface *a, const SurfacePoint *p, const Surface *b, PetscReal h, SurfacePair *pair);
