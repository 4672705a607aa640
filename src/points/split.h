/* Points that have become too long for the grid are split in two (docs/theory.md, "Points that are split"). */
#pragma once
#include "points/points.h"

/* A point was seeded with the number in the lower bits of its id; above them stands which of the halves of halves
 * it is: 0 for the whole, else 1 and then a bit for each time it was split. */
#define POINT_SEED_BITS 40
#define POINT_MOST_SPLITS 12 /* ids stay below 2^53, so that they are exact as real numbers */

static inline PetscInt64 point_seed_id(PetscInt64 id) { return id & (((PetscInt64)1 << POINT_SEED_BITS) - 1); }

/* Of one of the halves, side 0 or 1. */
static inline PetscInt64 point_half_id(PetscInt64 id, PetscInt side)
{
  const PetscInt64 whole = PetscMax(id >> POINT_SEED_BITS, 1);
  return ((2 * whole + side) << POINT_SEED_BITS) + point_seed_id(id);
}

typedef struct {
  PetscReal cells;        /* points whose neighbours have come to stand farther than so many cells away are split */
  PetscBool hoop;         /* are they rings? */
  const PetscBool *opens; /* of each material: does it part where it is pulled, so that what is open is not matter? */
} SplitRule;

/* Points with domains in a box are split in two along the edge of their domain that brings neighbours nearest. Mass,
 * volume, momentum, angular momentum, energies and the places of the start are those of before; velocity, stress and
 * state are handed on. Halves stand in the cell of the whole, to be located. Returns how many were split on this
 * rank. Not collective. */
PetscErrorCode PointsSplit(Points *points, const Grid *grid, const SplitRule *rule, PetscInt *n);
/* The largest distance of neighbours at the start, over the cell. */
PetscReal points_farthest(const Points *points, const Grid *grid);
