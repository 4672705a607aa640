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

/* Positions nearer to x than radius, nearest first, and no more than the nearest max of them: their
 * numbers and squared distances. Returns how many were written. */
PetscInt neighbours_within(const Neighbours *neighbours, const PetscReal *x, PetscReal radius, PetscInt max,
                           PetscInt *item, PetscReal *distance2);
