/* Parts of bodies around a place, and the way between their convex hulls. */
#pragma once
#include "base/math/vector.h"
#include "solve/contact/surface/surface.h"

#define PART_MOST 2048

/* Points around a place; disks, in space balls, are so much wider than the smallest. */
typedef struct {
  PetscInt dim, n;
  PetscReal least;
  const SurfacePoint *point[PART_MOST];
} Part;

static inline void part_begin(Part *part, PetscInt dim)
{
  part->dim = dim;
  part->n = 0;
  part->least = PETSC_MAX_REAL;
}

/* What there is no room for is left out. */
static inline void part_add(Part *part, const SurfacePoint *p)
{
  if (part->n == PART_MOST) return;
  part->point[part->n++] = p;
  part->least = PetscMin(part->least, p->reach);
}

/* The way from b to a, unit: of bodies that have sunk into each other the shortest way out. Hulls of grains that stand
 * round another body overlap without touching it: those deeper than `deepest` leave n as it comes, that from the
 * nearest point. Both hold some. */
void hull_face(const Part *a, const Part *b, PetscReal deepest, PetscReal n[3]);
