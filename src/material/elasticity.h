/* The five elastic constants, of which any two give the others. */
#pragma once
#include "material/law.h"

typedef struct {
  const char *name, *unit, *help;
  PetscReal min, max; /* open range */
} ElasticConstant;

extern const ElasticConstant elastic_constants[ELASTIC_CONSTANTS];

/* Its place in the table; -1 if it is none. */
int elastic_index(const char *name);
#define ELASTIC_ALL ((1u << ELASTIC_CONSTANTS) - 1)
/* "young, bulk": those whose bits are set. Returns text. */
const char *elastic_list(unsigned given, char *text, size_t size);

/* All five from two: `given` has the bits (1 << index) of the two, `value` their numbers. The two
 * given are kept as they are. PETSC_FALSE if they contradict each other or a stable solid (bulk and
 * shear positive). */
PetscBool elasticity_from_two(unsigned given, const PetscReal value[ELASTIC_CONSTANTS], Elasticity *elastic);
/* The same of an exactly incompressible solid: one of the two is poisson 0.5 or an infinite bulk
 * modulus, the other young or shear. bulk and lame are infinite. PETSC_FALSE if it is none. */
PetscBool elasticity_incompressible(unsigned given, const PetscReal value[ELASTIC_CONSTANTS], Elasticity *elastic);
