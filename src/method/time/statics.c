#include "method/time/time_scheme.h"

/* Reactions are those of the end. */
static TimeWeights statics_weights(const AnalysisSpec *s, PetscReal dt)
{
  (void)s, (void)dt;
  return (TimeWeights){.mean = 1};
}

static void statics_end(const AnalysisSpec *s, PetscReal dt, PetscInt n, const PetscReal *du, const PetscReal *v,
                        const PetscReal *a, PetscReal *v1, PetscReal *a1)
{
  (void)s, (void)dt, (void)du, (void)v, (void)a;
  for (PetscInt i = 0; i < n; ++i) v1[i] = a1[i] = 0;
}

const TimeScheme time_scheme_statics = {
  .name = "static",
  .help = "equilibrium at every step, no inertia",
  .weights = statics_weights,
  .end = statics_end,
};
