/* The midpoint rule: M (v1 - v) / dt = f((x + x1) / 2), x1 - x = dt (v + v1) / 2. Nothing but v
 * goes from step to step: where the grid is new in every step, no acceleration of the old one is
 * out of balance in it (docs/theory.md, "The midpoint rule"). */
#include "method/time/time_scheme.h"

static TimeWeights midpoint_weights(const AnalysisSpec *s, PetscReal dt)
{
  (void)s;
  return (TimeWeights){.velocity = 2 / dt, .acceleration = 2 / (dt * dt), .mean = 1};
}

static void midpoint_end(const AnalysisSpec *s, PetscReal dt, PetscInt n, const PetscReal *du, const PetscReal *v,
                         const PetscReal *a, PetscReal *v1, PetscReal *a1)
{
  (void)s, (void)a;
  for (PetscInt i = 0; i < n; ++i) {
    a1[i] = 2 * (du[i] / dt - v[i]) / dt;
    v1[i] = v[i] + dt * a1[i];
  }
}

const TimeScheme time_scheme_midpoint = {
  .name = "midpoint",
  .help = "the midpoint rule, which looks back on no acceleration: for mpm",
  .inertia = PETSC_TRUE,
  .middle = PETSC_TRUE,
  .weights = midpoint_weights,
  .end = midpoint_end,
};
