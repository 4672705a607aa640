/* One load more that is unknown, and one equation: displacement control of a load that is given as forces.
 *
 *   R(u, lambda) = f_int(u) - f_ext - lambda q = 0,   q . du = W
 *
 * Each direction of Newton's method is made of two, K y = R and K z = q, so that the second equation, which
 * is linear, holds behind a full step: du -= y - dlambda z. Wherever the load works, W > 0 leads on,
 * uphill, over a plateau or down (Batoz and Dhatt 1979). */
#include "solve/newton/newton_private.h"
#include <petsctime.h>

#define WORK_ENOUGH 1e-9

PetscBool newton_border_met(const Newton *n) { return !n->problem->border || n->problem->border->lacks <= WORK_ENOUGH; }

/* The load at free dofs, as a right-hand side. */
static PetscErrorCode LoadVec(const Newton *n, Vec *q)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim, block = p->system->block;
  PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(n->x, q));
  PetscCall(VecSet(*q, 0));
  PetscCall(VecGetArrayWrite(*q, &v));
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * dim; d < dim; ++d, ++i)
      v[k * block + d] = p->fixed[i] ? 0 : p->border->load[i];
  PetscCall(VecRestoreArrayWrite(*q, &v));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonBorderBegin(void *context, Vec x, Vec y)
{
  Newton *n = context;
  LoadBorder *b = n->problem->border;
  PetscReal stiff, there, more;
  Vec q, z;
  KSP ksp;

  PetscFunctionBeginUser;
  PetscCall(NewtonRigidBegin(n, y));
  if (!b) PetscFunctionReturn(0);
  PetscCall(LoadVec(n, &q));
  PetscCall(VecDuplicate(q, &z));
  PetscCall(SNESGetKSP(n->snes, &ksp));
  PetscCall(PetscTime(&n->solving));
  PetscCall(KSPSolve(ksp, q, z));
  PetscCall(VecDot(q, z, &stiff));
  PetscCall(VecDot(q, x, &there));
  PetscCall(VecDot(q, y, &more));
  if (b->unit == 0) {
    b->unit = stiff;
    b->work *= stiff;
  }
  b->from = b->factor;
  b->along = stiff != 0 ? (b->work - there + more) / stiff : 0;
  b->lacks = PetscAbsReal(b->work - there) / PetscAbsReal(b->work);
  PetscCall(VecAXPY(y, -b->along, z));
  PetscCall(VecDestroy(&q));
  PetscCall(VecDestroy(&z));
  PetscFunctionReturn(0);
}

void newton_border_place(void *context, PetscReal length)
{
  LoadBorder *b = ((Newton *)context)->problem->border;
  newton_rigid_place(context, length);
  if (b) b->factor = b->from + length * b->along;
}

void newton_border_end(void *context, PetscReal length)
{
  LoadBorder *b = ((Newton *)context)->problem->border;
  if (b) b->lacks *= PetscAbsReal(1 - length);
}
