/* A time scheme: how velocities and accelerations follow from displacements over a step. To add
 * one: a new file, and a line in time_schemes.inc.
 *
 * At the end of a step forces balance with (1 - lag) a1 + lag a + damping v1, times the mass; if in its
 * middle, with a1 + damping (v + v1) / 2. */
#pragma once
#include "case/case.h"

typedef struct {
  PetscReal velocity, acceleration; /* derivatives of v1 and a1 with respect to du, 1/s, 1/s2 */
  /* share of the step's start in the acceleration that balances the forces of its end */
  PetscReal lag;
  PetscReal mean; /* share of the end in the mean of the forces over the step, which gives v1 - v */
} TimeWeights;

typedef struct TimeScheme {
  const char *name, *help;
  PetscBool inertia; /* has matter any? else steps end in equilibrium, and time only orders them */
  /* Do forces balance in the middle of the step, and not at its end? What is solved for is then
   * the first half of du, and the second half goes on like it. */
  PetscBool middle;
  TimeWeights (*weights)(const AnalysisSpec *analysis, PetscReal dt);
  /* Of n components: v1 and a1 at the end of a step of dt that moves them by du, linear in it. */
  void (*end)(const AnalysisSpec *analysis, PetscReal dt, PetscInt n, const PetscReal *du, const PetscReal *v,
              const PetscReal *a, PetscReal *v1, PetscReal *a1);
} TimeScheme;

extern const TimeScheme *const time_schemes[]; /* ended by NULL */
/* Of `type: explicit`, in no list. */
extern const TimeScheme time_scheme_explicit;
/* The scheme that a case asks for; NULL if there is none of that name. */
const TimeScheme *time_scheme_of(const AnalysisSpec *analysis);

/* Part of the step at whose end forces balance. */
static inline PetscReal time_solved(const TimeScheme *scheme) { return scheme->middle ? 0.5 : 1; }

/* Derivative with respect to the part of du that is solved for of what balances the forces, over
 * the mass, 1/s2. */
static inline PetscReal time_inertia(const TimeWeights *w, PetscReal solved, PetscReal damping)
{
  return (1 - w->lag) * w->acceleration / solved + damping * w->velocity;
}
