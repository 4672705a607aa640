/* Mohr-Coulomb materials and random trial strains that reach every region of the return. */
#pragma once
#include "../conformance/random.h"
#include "material/mohr_coulomb/mohr_coulomb_return.h"
#include "packed.h"

typedef struct {
  const char *name;
  PetscReal young, poisson, friction, dilatancy, cohesion, cutoff, memory; /* degrees */
} McSample;

static const McSample mc_samples[] = {
  {"cohesive soil", 1.8e6, 0.3, 25, 0, 5e3, 1e300, 0},
  {"dense sand", 0.84e6, 0.3, 31, 1, 0, 1e300, 0},
  {"sugar", 1e6, 0.3, 39, 0, 16, 1e300, 0},
  {"dilatant", 2e6, 0.3, 30, 25, 5e3, 1e300, 0},
  {"associated", 5e7, 0.25, 30, 30, 2e4, 1e300, 0},
  {"Tresca", 1e4, 0.495, 0, 0, 100, 1e300, 0},
  {"auxetic", 1e6, -0.3, 45, 10, 1e3, 1e300, 0},
  {"associated, cut off", 5e7, 0.25, 30, 30, 2e4, 1e4, 0},
  {"cohesive, cut off", 1.8e6, 0.3, 25, 0, 5e3, 3e3, 0},
  {"no tension", 2e6, 0.2, 35, 12, 4e3, 0, 0},
  {"Tresca, cut off", 1e4, 0.4, 0, 0, 100, 50, 0},
  {"dense sand that remembers", 0.84e6, 0.3, 31, 1, 0, 1e300, 1},
  {"dilatant soil that remembers half", 2e6, 0.3, 30, 25, 5e3, 1e300, 0.5},
  {"soil without tension that remembers", 2e6, 0.2, 35, 12, 4e3, 0, 1},
};

#define MC_SAMPLES ((int)(sizeof mc_samples / sizeof mc_samples[0]))

static inline const Law *mc_sample_pack(const McSample *s, PetscReal *packed)
{
  const PetscReal rad = PETSC_PI / 180.0;
  const PetscReal given[5] = {s->friction * rad, s->dilatancy * rad, s->cohesion, s->cutoff, s->memory};
  return packed_law("mohr-coulomb", s->young, s->poisson, given, packed);
}

/* A strain of the size at which the material yields (1e-3 if it has no cohesion). */
static inline PetscReal mc_sample_strain(const PetscReal *p, PetscReal young)
{
  return p[MC_Q] > 0.0 ? p[MC_Q] / young : 1e-3;
}

/* Let some of the state's volume be an opening (of a law that remembers): the trial strains stay. */
static inline void mc_sample_opening(Random *random, const PetscReal *p, PetscReal state[MC_STATE])
{
  const PetscBool open = p[MC_MEMORY] > 0.0 && random_real(random, 0, 1) < 0.5;
  state[7] = open ? pow(10, random_real(random, -6, 0)) : 0.0;
  for (int k = 0; k < 6; ++k) state[k] *= exp(-2.0 / 3.0 * state[7]);
}

static inline void mc_sort(PetscReal e[3])
{
  for (int pass = 0; pass < 2; ++pass)
    for (int a = 0; a < 2; ++a)
      if (e[a] < e[a + 1]) {
        const PetscReal kept = e[a];
        e[a] = e[a + 1], e[a + 1] = kept;
      }
}

/* Falling principal strains around the surface; some of them equal or nearly so (from 1e-2 down to
 * rounding). */
static inline void mc_sample_trial(Random *random, PetscReal scale, PetscReal e[3])
{
  const PetscReal size = scale * pow(10, random_real(random, -1, 1.5)), kind = random_real(random, 0, 5);
  const PetscReal volume = scale * random_real(random, -6, 2), near = size * pow(10, -random_real(random, 2, 17));
  for (int a = 0; a < 3; ++a) e[a] = volume + size * random_real(random, -1, 1);
  mc_sort(e);
  if (kind < 1) e[1] = e[0] - near;
  else if (kind < 2) e[1] = e[2] + near;
  else if (kind < 2.5) e[1] = e[0], e[2] = e[0] - near;
  else if (kind < 2.75) e[1] = e[0];
  else if (kind < 3) e[1] = e[2];
  mc_sort(e);
}
