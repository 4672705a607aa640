#include "boundary/load_factors.h"
#include "boundary/loads.h"

static PetscErrorCode Ones(PetscInt n, PetscReal **f)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * n + 1, f)); /* never NULL */
  for (PetscInt i = 0; i < 3 * n; ++i) (*f)[i] = 1;
  PetscFunctionReturn(0);
}

PetscErrorCode LoadFactorsOfFaces(const Loads *l, PetscInt load, PetscReal t, PetscReal **f)
{
  const LoadFaces *faces = &l->faces[load];
  const LoadAsked *asked = &l->asked[load];

  PetscFunctionBeginUser;
  *f = NULL;
  if (!asked->ask || !faces->used) PetscFunctionReturn(0);
  PetscCall(Ones(faces->n, f));
  asked->ask(asked->context, faces->n, faces->x, faces->x, t, *f);
  PetscFunctionReturn(0);
}

/* One load's carriers, gathered from among all, and their factors put back. */
static PetscErrorCode Ask(const Loads *l, PetscInt load, PetscReal t, PetscReal *f)
{
  const Points *carriers = l->carriers;
  const PetscInt dim = l->dim;
  PetscReal *X, *x, *one;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < carriers->n; ++p) n += carriers->body[p] == load;
  PetscCall(PetscCalloc2(3 * n, &X, 3 * n, &x));
  PetscCall(Ones(n, &one));
  n = 0;
  for (PetscInt p = 0; p < carriers->n; ++p) {
    if (carriers->body[p] != load) continue;
    for (PetscInt d = 0; d < dim; ++d) {
      x[3 * n + d] = point_real(carriers, POINT_X, p)[d];
      X[3 * n + d] = x[3 * n + d] - point_real(carriers, POINT_U, p)[d];
    }
    ++n;
  }
  l->asked[load].ask(l->asked[load].context, n, X, x, t, one);
  n = 0;
  for (PetscInt p = 0; p < carriers->n; ++p)
    for (int d = 0; carriers->body[p] == load && d < 3; ++d) f[3 * p + d] = one[n++];
  PetscCall(PetscFree2(X, x));
  PetscCall(PetscFree(one));
  PetscFunctionReturn(0);
}

PetscErrorCode LoadFactorsOfCarriers(const Loads *l, PetscBool pressures, PetscReal t, PetscReal **f)
{
  PetscFunctionBeginUser;
  *f = NULL;
  for (PetscInt k = 0; k < l->c->n_loads; ++k) {
    if (!l->asked[k].ask || l->faces[k].used || (l->c->loads[k].kind == LOAD_PRESSURE) != pressures) continue;
    if (!*f) PetscCall(Ones(l->carriers->n, f));
    PetscCall(Ask(l, k, t, *f));
  }
  PetscFunctionReturn(0);
}
