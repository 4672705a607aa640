/* Explicit dynamics solves for nothing: this only says that there is inertia. The step itself is
 * src/model/explicit/step.c. It stands in no list, since `type: explicit` chooses it. */
#include "method/time/time_scheme.h"

static TimeWeights explicit_weights(const AnalysisSpec *s, PetscReal dt)
{
  (void)s;
  return (TimeWeights){.velocity = 1 / dt, .mean = 1};
}

static void explicit_end(const AnalysisSpec *s, PetscReal dt, PetscInt n, const PetscReal *du, const PetscReal *v,
                         const PetscReal *a, PetscReal *v1, PetscReal *a1)
{
  (void)s, (void)a;
  for (PetscInt i = 0; i < n; ++i) {
    v1[i] = du[i] / dt;
    a1[i] = (v1[i] - v[i]) / dt;
  }
}

const TimeScheme time_scheme_explicit = {
  .name = "explicit",
  .help = "forces of the start of a step, which waves do not cross a cell in",
  .inertia = PETSC_TRUE,
  .weights = explicit_weights,
  .end = explicit_end,
};
