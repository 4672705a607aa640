/* A time scheme from outside: backward Euler, v1 = du / dt and a1 = (v1 - v) / dt. */
#include "method/time/time_scheme.h"

static TimeWeights weights(const AnalysisSpec *analysis, PetscReal dt)
{
  (void)analysis;
  return (TimeWeights){.velocity = 1 / dt, .acceleration = 1 / (dt * dt), .mean = 1};
}

static void end(const AnalysisSpec *analysis, PetscReal dt, PetscInt n, const PetscReal *du, const PetscReal *v,
                const PetscReal *a, PetscReal *v1, PetscReal *a1)
{
  (void)analysis, (void)a;
  for (PetscInt i = 0; i < n; ++i) {
    v1[i] = du[i] / dt;
    a1[i] = (v1[i] - v[i]) / dt;
  }
}

const TimeScheme time_scheme_backward_euler = {
  .name = "backward-euler",
  .help = "the first order: damps whatever a step does not resolve",
  .inertia = PETSC_TRUE,
  .weights = weights,
  .end = end,
};
