/* By how much forces are out of balance, as a share: over what acts, or, where nothing does, over what holds
 * (docs/theory.md, "Initial state"). */
#include "model/model_private.h"

#define NOTHING 1e-9 /* of the forces of the stress: round-off, over which no share means anything */

PetscReal stress_force(const Model *m, PetscInt p)
{
  PetscReal tau[6], square = 0;
  point_tau(m->points, p, tau);
  for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * tau[k] * tau[k];
  return PetscSqrtReal(square) * m->points->real[POINT_VOLUME][p] / m->grid->smallest;
}

/* Square of the norm of what stress asks of all points, each for itself: none of them balances another's. N2. */
static PetscReal stress_forces2(const Model *m)
{
  PetscReal sum = 0;
  for (PetscInt p = 0; p < m->points->n; ++p) sum += PetscSqr(stress_force(m, p));
  return sum;
}

PetscErrorCode LackOfBalance(Model *m, const AtRest *at, PetscReal *lack)
{
  enum { LACKS, ACTS, HOLDS, STRESS, N };
  PetscReal local[N] = {0}, sum[N];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    const PetscReal holds = at->fixed[i] ? at->force[i] : at->external[i] - at->acting[i];
    local[HOLDS] += holds * holds;
    if (at->fixed[i]) continue;
    local[LACKS] += at->force[i] * at->force[i];
    local[ACTS] += at->acting[i] * at->acting[i];
  }
  local[STRESS] = stress_forces2(m);
  PetscCall(MPIU_Allreduce(local, sum, N, MPIU_REAL, MPI_SUM, m->comm));
  const PetscReal stress = PetscSqrtReal(sum[STRESS]), acts = PetscMax(at->weight, PetscSqrtReal(sum[ACTS])),
                  holds = PetscSqrtReal(sum[HOLDS]), nothing = NOTHING * stress;
  m->initial.acts = (PetscBool)(acts > nothing);
  const PetscReal scale = acts > nothing ? acts : holds > nothing ? holds : stress;
  *lack = scale > 0 ? PetscSqrtReal(sum[LACKS]) / scale : 0;
  PetscFunctionReturn(0);
}
