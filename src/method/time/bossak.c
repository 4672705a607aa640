/* Newmark's method with Bossak's alpha: an echo of the last acceleration damps high frequencies. */
#include "method/time/newmark.h"

static TimeWeights bossak_weights(const AnalysisSpec *s, PetscReal dt)
{
  TimeWeights w = newmark_weights(s, dt);
  w.lag = s->bossak;
  return w;
}

const TimeScheme time_scheme_bossak = {
  .name = "bossak",
  .help = "Newmark's method with Bossak's alpha, which damps high frequencies",
  .inertia = PETSC_TRUE,
  .weights = bossak_weights,
  .end = newmark_end,
};
