/* Strength by friction and cohesion: the parameters that such laws begin with, and their division
 * by a factor of safety. */
#pragma once
#include "material/law.h"
#include <math.h>
#include <string.h>

enum { FRICTION, DILATANCY, COHESION, CUTOFF, STRENGTH_N };

#define NO_CUTOFF 1e300
#define ENDLESS 1e30 /* Pa: what never yields */

#define STRENGTH_PARAMETERS                                                                                \
  {"friction_angle", "deg", "angle of internal friction", 0, 90, .max_open = PETSC_TRUE, .fallback = NAN}, \
    {"dilatancy_angle",      "deg",        "dilatancy angle, at most the friction angle", 0, 90,           \
     .max_open = PETSC_TRUE, .fallback = 0},                                                               \
  {                                                                                                        \
    "cohesion", "Pa", "cohesion", 0, PETSC_MAX_REAL, .fallback = NAN                                       \
  }

/* More dilatancy than friction would gain energy by shearing. */
static inline const char *strength_check(const PetscReal *given)
{
  return given[DILATANCY] > given[FRICTION] ? "the dilatancy angle must not be larger than the friction angle" : NULL;
}

/* c and tan phi over the factor; psi as it is, up to the phi that is left. */
static inline void strength_divide(PetscReal factor, PetscReal *friction, PetscReal *dilatancy, PetscReal *cohesion)
{
  *cohesion = factor > 0.0 ? *cohesion / factor : ENDLESS;
  if (factor > 0.0) *friction = atan(tan(*friction) / factor);
  *dilatancy = PetscMin(*dilatancy, *friction);
}

/* The same of all n parameters of a law, with the cut-off over the factor. */
static inline void strength_reduce(int n, const PetscReal *given, PetscReal factor, PetscReal *reduced)
{
  memcpy(reduced, given, (size_t)n * sizeof *reduced);
  if (factor == 1.0) return;
  reduced[CUTOFF] = factor > 0.0 && given[CUTOFF] < NO_CUTOFF ? given[CUTOFF] / factor : NO_CUTOFF;
  strength_divide(factor, &reduced[FRICTION], &reduced[DILATANCY], &reduced[COHESION]);
}
