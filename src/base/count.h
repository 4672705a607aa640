/* Products of counts, which PetscInt (32 bits here) wraps without a word at 2e9. */
#pragma once
#include <petscsys.h>

/* n things of so many numbers each: what goes to an allocation, a copy or an index. */
static inline size_t count_numbers(PetscInt n, PetscInt each) { return (size_t)n * (size_t)each; }

/* How many things of so many numbers each a PetscInt can still count the numbers of. */
static inline PetscInt count_most(PetscInt each) { return PETSC_MAX_INT / PetscMax(each, 1); }

/* had + n x each, if that is at most `most`; else PETSC_FALSE. *sum is what it would be, in any
 * case. */
static inline PetscBool count_fits(PetscInt had, PetscInt n, PetscInt each, PetscInt most, PetscInt64 *sum)
{
  *sum = had + (PetscInt64)n * each;
  return *sum <= most;
}
