/* Steps that took points past pieces of their tables of strength. */
#include "run/report/warn/warn.h"

PetscErrorCode WarnOfPassed(const Model *m, Diag *diag)
{
  PetscReal most;

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&m->passed, &most, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (most <= TABLE_PASSED) PetscFunctionReturn(0);
  diag_warning(diag, "analysis.step",
               "a step has taken a point through up to %.2g of a piece of its table of strength (peak_strain, "
               "residual_strain): it has the strength of the end of the step, and never had that between",
               (double)most);
  diag_hint(diag, "the error goes with the step: a tenth of a piece costs 0.3 %% where a whole one costs 3 %%");
  PetscFunctionReturn(0);
}
