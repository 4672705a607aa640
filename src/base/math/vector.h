/* Products of vectors of space; those of the plane have 0 as their third component. */
#pragma once
#include <petscsys.h>

static inline PetscReal vector_dot(const PetscReal *a, const PetscReal *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* c = a x b; it may be one of them. */
static inline void vector_cross(const PetscReal *a, const PetscReal *b, PetscReal *c)
{
  const PetscReal r[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  for (int d = 0; d < 3; ++d) c[d] = r[d];
}
