/* Four numbers side by side, for the walks by cells: of four points, or of four nodes of a cell. They are passed
 * by pointer, as all lanes are (base/math/lanes.h). */
#pragma once
#include <stdint.h>
#include <string.h>
#include "base/math/lanes.h"
#include "base/math/tensor.h"
#include "model/explicit/explicit.h"

#define KERNEL static inline __attribute__((always_inline))

typedef PetscReal Four __attribute__((vector_size(4 * sizeof(PetscReal))));
/* the same anywhere in memory */
typedef Four FourAnywhere __attribute__((aligned(sizeof(PetscReal)), may_alias));
typedef int64_t FourBits __attribute__((vector_size(4 * sizeof(int64_t))));
typedef int32_t FourCells __attribute__((vector_size(4 * sizeof(int32_t))));

#define EDGE 1e-3 /* of a cell: points that leave take a step as long */

#define FOUR(at) (*(FourAnywhere *)(at))
#define FOUR_OF(at) (*(const FourAnywhere *)(at))

/* What the nodes of the box's cells are to points, four by four. */
typedef struct {
  int32_t cell[LAW_BATCH];    /* its first node in the lattice */
  PetscReal at[3][LAW_BATCH]; /* place in it, 0 to 1 along each axis */
} Place;

/* The first `n` of four numbers, the others 0; n may be any number. */
KERNEL void take(const PetscReal *from, PetscInt n, Four *to)
{
  *to = (Four){0};
  if (n >= 4) *to = FOUR_OF(from);
  else
    for (int k = 0; k < n; ++k) (*to)[k] = from[k];
}

KERNEL void put(const Four *from, PetscInt n, PetscReal *to)
{
  if (n >= 4) FOUR(to) = *from;
  else
    for (int k = 0; k < n; ++k) to[k] = (*from)[k];
}

KERNEL void turn(Four r[4]) { TRANSPOSE_FOUR(Four, r); }

/* Cells of four points along one axis, and where in them. What comes out of the box in a lap is not farther than at its
 * edge: beyond it, and at it by a last digit, nodes would have a mass below zero, and no motion. */
KERNEL void locate_along(const Lattice *l, const int d, const Four *x, FourCells *first, PetscReal *at)
{
  const Four zero = {0}, lowest = zero + (l->end[d][0] + EDGE), highest = zero + (l->end[d][1] - EDGE);
  Four s = (*x - l->origin[d]) * l->per_length[d];
  const FourBits below = s < lowest;
  const FourBits above = s > highest;
  s = (Four)((below & (FourBits)lowest) | (above & (FourBits)highest) | (~(below | above) & (FourBits)s));
  const FourBits inside = s > 0.0;
  Four low = (Four)((FourBits)s & inside), most = (Four){0} + (PetscReal)l->most[d];
  const FourBits less = low < most;
  low = (Four)(((FourBits)low & less) | ((FourBits)most & ~less));
  const FourCells i = __builtin_convertvector(low, FourCells);
  *first += i * (int32_t)l->stride[d];
  FOUR(at) = s - __builtin_convertvector(i, Four);
}
