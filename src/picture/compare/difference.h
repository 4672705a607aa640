/* How far two curves over time are apart. */
#pragma once
#include <petscsys.h>

/* Values at times that do not decrease; where several have the same time the last one counts. Entries without a
 * value (NaN) are passed over: `lack` says where that tells curves apart. */
typedef struct {
  PetscInt n;
  const PetscReal *time, *value; /* s, the measure's unit */
} Curve;

typedef struct {
  PetscReal from, to;    /* the time that both have in common, s */
  PetscReal size;        /* largest |a| in it */
  PetscReal largest, at; /* b - a where it is farthest from 0, and when that is, s */
  PetscReal last;        /* b - a at the end; NaN: one of them has no value there */
  PetscReal relative;    /* |largest| / size; infinite for a = 0 */
} Difference;

/* Both curves are linear between their entries, so that their difference is largest at one of the times of either
 * one: nothing is missed. PETSC_FALSE if they have no time in common. */
PetscBool curve_difference(const Curve *a, const Curve *b, Difference *difference);
/* |largest| of a difference over a size, its own or another. */
PetscReal difference_relative_to(const Difference *difference, PetscReal size);
