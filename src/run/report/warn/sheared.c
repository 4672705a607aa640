/* Grains whose friction grows with the rate of shear, in steps that shear them much: within a step the axes of stretch
 * turn by a quarter of its shear, the pressure comes out smaller by as much, and where friction hardly grows with the
 * rate the speed is off many times as far (cases/bagnold). */
#include "run/report/warn/warn.h"

#define SHEAR_ALLOWED 0.012 /* in a step, mean of all: 2 % of the speed of grains on 24 degrees */

PetscErrorCode WarnOfShear(const Model *m, Diag *diag)
{
  PetscReal sum[2] = {0, 0};

  PetscFunctionBeginUser;
  if (!m->scheme->inertia || m->c->analysis.type == ANALYSIS_EXPLICIT || !m->step) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscBool rate = m->materials[m->points->material[p]].law->rate;
    const PetscReal *strain = rate ? model_state_field(m, p, "equivalent_plastic_strain") : NULL;
    if (!strain) continue;
    sum[0] += m->points->real[POINT_MASS][p];
    sum[1] += m->points->real[POINT_MASS][p] * PetscSqrtReal(3) * *strain / (PetscReal)m->step;
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  if (!(sum[1] > SHEAR_ALLOWED * sum[0])) PetscFunctionReturn(0);
  diag_warning(
    diag, "analysis.step",
    "steps shear the grains by %.2g on the average: friction is off by a part of that, and the speed of what "
    "flows calmly many times as far",
    (double)(sum[1] / sum[0]));
  diag_hint(diag, "the error goes with the step: take half of it and compare, or `analysis: {type: explicit}`");
  PetscFunctionReturn(0);
}
