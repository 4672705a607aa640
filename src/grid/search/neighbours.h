/* Positions in uniform bins: who is near a place, in constant time each. */
#pragma once
#include <petscsys.h>

typedef struct {
  PetscInt dim, n;
  PetscReal origin[3], size; /* edge of a bin, m */
  PetscInt counts[3];
  PetscInt *start, *item; /* per bin */
  PetscReal *x;           /* n x dim, in the order of item */
  PetscReal *at;          /* the positions by their numbers */
} Neighbours;

/* The first n of the positions, and then more of them (each x dim); those with skip[i], counted
 * through both, are left out (NULL: none). Bins have an edge of `size` or more. */
PetscErrorCode NeighboursCreate(PetscInt dim, PetscInt n, const PetscReal *x, PetscInt n_more, const PetscReal *more,
                                const unsigned char *skip, PetscReal size, Neighbours *neighbours);
PetscErrorCode NeighboursDestroy(Neighbours *neighbours);

/* Distances in a space that is stretched: a vector d counts as |map d|, and no d is longer than `longest` |map d|. */
typedef struct {
  PetscReal map[9], longest; /* dim x dim, symmetric */
} NeighboursMap;

/* |a - b|^2 by the distances of a map; NULL: by those there are. */
static inline PetscReal neighbours_square(const PetscInt dim, const NeighboursMap *map, const PetscReal *a,
                                          const PetscReal *b)
{
  PetscReal d2 = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal off = map ? 0 : a[d] - b[d];
    for (PetscInt k = 0; k < dim && map; ++k) off += map->map[d * dim + k] * (a[k] - b[k]);
    d2 += off * off;
  }
  return d2;
}

/* Positions nearer to x than radius, nearest first, and no more than the nearest max of them: their
 * numbers and squared distances. Returns how many were written. */
PetscInt neighbours_within(const Neighbours *neighbours, const PetscReal *x, PetscReal radius, PetscInt max,
                           PetscInt *item, PetscReal *distance2);
/* The same by the distances of a map; NULL: by those there are. */
PetscInt neighbours_mapped(const Neighbours *neighbours, const NeighboursMap *map, const PetscReal *x, PetscReal radius,
                           PetscInt max, PetscInt *item, PetscReal *distance2);
