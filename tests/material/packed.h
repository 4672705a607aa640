/* Laws by name with parameters as a test gives them. */
#pragma once
#include "material/elasticity.h"
#include <math.h>

static inline const Law *packed_law(const char *name, PetscReal young, PetscReal poisson, const PetscReal *given,
                                    PetscReal *packed)
{
  const PetscReal value[ELASTIC_CONSTANTS] = {young, poisson};
  Elasticity elastic;
  const Law *law = law_find(name);
  if (law && elasticity_from_two(3u, value, &elastic)) law->prepare(&elastic, given, packed);
  return law;
}

static inline PetscReal packed_largest(PetscInt n, const PetscReal *v)
{
  PetscReal largest = 0.0;
  for (PetscInt k = 0; k < n; ++k) largest = PetscMax(largest, fabs(v[k]));
  return largest;
}
