#include "formulation/sizes.h"

/* The runs of a support; clouds are one, of as many nodes as each likes. */
static PetscInt runs_of(const Support *support, SupportRun run[SUPPORT_MAX_RUNS])
{
  run[0] = (SupportRun){.nodes = 0, .first = 0, .end = support->n_groups};
  for (PetscInt r = 0; r < support->n_runs; ++r) run[r] = support->run[r];
  return support->n_groups ? PetscMax(support->n_runs, 1) : 0;
}

static PetscErrorCode FindKernels(const SizedKernels *table, const WeakFormInput *in, PetscInt nn,
                                  const SizedKernels **found)
{
  const Kinematics *kinematics = in->kinematics;

  PetscFunctionBeginUser;
  *found = NULL;
  for (const SizedKernels *k = table; k->dim; ++k)
    if (k->dim == kinematics->dim && k->nn == nn && k->hoop == kinematics->hoop) *found = k;
  PetscCheck(*found, PETSC_COMM_SELF, PETSC_ERR_SUP, "no %s kernel for %d nodes", kinematics->name, (int)nn);
  PetscFunctionReturn(0);
}

PetscErrorCode SizedAssemble(const SizedKernels *table, const WeakFormInput *in, WeakFormOutput *out)
{
  PetscInt slot = 0;
  SupportRun run[SUPPORT_MAX_RUNS];
  const SizedKernels *k;

  PetscFunctionBeginUser;
  out->status = LAW_OK;
  out->bad_point = -1;
  const PetscInt n = runs_of(in->support, run);
  for (PetscInt r = 0; r < n; ++r) {
    if (run[r].first == run[r].end) continue;
    PetscCall(FindKernels(table, in, run[r].nodes, &k));
    k->assemble(in, &run[r], slot, out);
    slot += (run[r].end - run[r].first) * run[r].nodes * run[r].nodes;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SizedCommit(const SizedKernels *table, const WeakFormInput *in, Points *points, LawStatus *status)
{
  SupportRun run[SUPPORT_MAX_RUNS];
  const SizedKernels *k;
  Batch b;

  PetscFunctionBeginUser;
  *status = LAW_OK;
  const PetscInt n = runs_of(in->support, run);
  for (PetscInt r = 0; r < n; ++r) {
    PetscCall(FindKernels(table, in, run[r].nodes, &k));
    batch_begin(&run[r], in->support, PETSC_TRUE, &b);
    while (batch_next(in, &b)) {
      *status = k->update(in, PETSC_FALSE, &b);
      if (*status != LAW_OK) PetscFunctionReturn(0);
      batch_commit(in, &b, points);
    }
  }
  PetscFunctionReturn(0);
}
