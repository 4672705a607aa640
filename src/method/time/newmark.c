#include "method/time/newmark.h"

TimeWeights newmark_weights(const AnalysisSpec *s, PetscReal dt)
{
  return (TimeWeights){
    .velocity = s->gamma / (s->beta * dt), .acceleration = 1 / (s->beta * dt * dt), .mean = s->gamma};
}

void newmark_end(const AnalysisSpec *s, PetscReal dt, PetscInt n, const PetscReal *du, const PetscReal *v,
                 const PetscReal *a, PetscReal *v1, PetscReal *a1)
{
  const PetscReal weight = s->beta * dt * dt, old = 0.5 / s->beta - 1, gamma = s->gamma;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal end = (du[i] - dt * v[i]) / weight - old * a[i];
    v1[i] = v[i] + dt * ((1 - gamma) * a[i] + gamma * end);
    a1[i] = end;
  }
}

const TimeScheme time_scheme_newmark = {
  .name = "newmark",
  .help = "Newmark's method, the trapezoidal rule unless beta and gamma say otherwise",
  .inertia = PETSC_TRUE,
  .weights = newmark_weights,
  .end = newmark_end,
};
