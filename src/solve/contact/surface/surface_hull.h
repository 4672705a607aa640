/* The convex hulls of points of two bodies around a place, and the way from one to the other. */
#pragma once
#include "solve/contact/surface/surface.h"

#define SURFACE_MOST 2048 /* points around a place: a ball of two cells in space has some 300 of eight a cell */

/* Points around a place; disks and balls, as wide as their reach, are so much wider than the smallest. */
typedef struct {
  PetscInt dim, n;
  const SurfacePoint *point[SURFACE_MOST];
  PetscReal least;
} SurfacePart;

static inline void surface_part_begin(SurfacePart *part, PetscInt dim)
{
  part->dim = dim;
  part->n = 0;
  part->least = PETSC_MAX_REAL;
}

/* Beyond SURFACE_MOST they are left out. */
static inline void surface_part_add(SurfacePart *part, const SurfacePoint *p)
{
  if (part->n == SURFACE_MOST) return;
  part->point[part->n++] = p;
  part->least = PetscMin(part->least, p->reach);
}

/* The way from b to a, unit; both hold some points. Of bodies that have sunk into each other it is the shortest way out.
 * Hulls of grains that stand round another body overlap without touching it: where the way out is longer than
 * `deepest`, n stays as it came, the way from the nearest point. */
void surface_face(const SurfacePart *a, const SurfacePart *b, PetscReal deepest, PetscReal n[3]);
