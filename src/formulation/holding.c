#include "formulation/holding.h"
#include "formulation/kernels/cloud_kernels.h"

PetscErrorCode HoldingForces(const WeakFormInput *in, PetscInt dim, PetscReal *force)
{
  const Support *w = in->support;
  CloudWork *work;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&work));
  for (PetscInt p = 0; p < w->n_groups; ++p) {
    if (!(in->soft[p] > 0)) continue;
    work->nn = support_nodes(w, p);
    work->node = w->node + w->node_start[p];
    work->soft = in->soft[p];
    if (dim == 2) cloud_hold(2, in, work, force);
    else cloud_hold(3, in, work, force);
  }
  PetscCall(PetscFree(work));
  PetscFunctionReturn(0);
}
