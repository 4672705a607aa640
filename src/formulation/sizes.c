#include "formulation/sizes.h"
#include "formulation/walk.h"

/* NULL where there are no points to work on. */
static PetscErrorCode FindKernels(const SizedKernels *table, const WeakFormInput *in, const SizedKernels **found)
{
  const PetscInt dim = in->points->dim, nn = in->support->uniform;

  PetscFunctionBeginUser;
  *found = NULL;
  if (!points_in_groups(in->support)) PetscFunctionReturn(0);
  for (const SizedKernels *k = table; k->dim; ++k)
    if (k->dim == dim && k->nn == nn) *found = k;
  PetscCheck(*found, PETSC_COMM_SELF, PETSC_ERR_SUP, "no kernel for %d nodes in %dD", (int)nn, (int)dim);
  PetscFunctionReturn(0);
}

PetscErrorCode SizedAssemble(const SizedKernels *table, const WeakFormInput *in, WeakFormOutput *out)
{
  const SizedKernels *k;

  PetscFunctionBeginUser;
  out->status = LAW_OK;
  out->bad_point = -1;
  PetscCall(FindKernels(table, in, &k));
  if (k) k->assemble(in, out);
  PetscFunctionReturn(0);
}

PetscErrorCode SizedCommit(const SizedKernels *table, const WeakFormInput *in, Points *points, LawStatus *status)
{
  const SizedKernels *k;

  PetscFunctionBeginUser;
  PetscCall(FindKernels(table, in, &k));
  *status = k ? k->commit(in, points) : LAW_OK;
  PetscFunctionReturn(0);
}
