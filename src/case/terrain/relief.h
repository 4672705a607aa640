/* Terrain: heights on a lattice in x and y, as elevation models give them, and the solid below.
 * Between its posts the surface is two triangles a square, cut along the diagonal from the lower
 * left. */
#pragma once
#include <petscsys.h>

typedef struct Relief {
  PetscInt n[2];          /* posts along x and y */
  PetscReal low[2], step; /* of the first post; between posts, m */
  PetscReal *height;      /* n[0] x n[1], x fastest, m; NaN: none */
  PetscReal bottom;       /* where the solid ends below, m: deeper than any use of it */
} Relief;

/* An ESRI ASCII grid (.asc), or a GeoTIFF by GDAL's gdal_translate: x = scale X + offset for all
 * of its coordinates and heights. If it cannot be read, *relief is NULL and `message` says the
 * reason, with the line. Not collective. */
PetscErrorCode ReliefRead(const char *path, PetscReal scale, const PetscReal offset[3], Relief **relief, size_t size,
                          char *message);
PetscErrorCode ReliefDestroy(Relief **relief);
/* Is x in the solid, or within a tolerance (m) of it? Where posts have no height there is none. */
PetscBool relief_contains(const Relief *relief, const PetscReal x[3], PetscReal tolerance);
/* Distance above the surface, m, across the triangle that is over or under x; gradient: that triangle's unit normal.
 * Far above where there is no height. */
PetscReal relief_distance(const Relief *relief, const PetscReal x[3], PetscReal gradient[3]);
/* By how much that distance may change a metre, since triangles are steep in different ways. */
PetscReal relief_steepness(const Relief *relief);
/* The box around the solid where posts have heights, m. */
void relief_bounds(const Relief *relief, PetscReal min[3], PetscReal max[3]);
/* No surface is lower in a rectangle; the bottom where that has posts without a height, or none. */
PetscReal relief_lowest(const Relief *relief, const PetscReal min[2], const PetscReal max[2]);
/* How high the surface is in a rectangle, m; -PETSC_MAX_REAL where there is none. */
PetscReal relief_highest(const Relief *relief, const PetscReal min[2], const PetscReal max[2]);
/* Height of post (i, j). */
static inline PetscReal relief_post(const Relief *r, PetscInt i, PetscInt j) { return r->height[j * r->n[0] + i]; }
