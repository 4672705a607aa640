/* When Newton's method settles a few nodes by themselves, and how well. */
#include "solve/newton/newton_private.h"
#include <petsctime.h>

#define ELIMINATE_AFTER 2 /* iterations: what converges by itself has by then all but done so; stiff matter has not */
/* residual of a patch over the tolerance of all, and over the last residual of all; of stiff matter */
#define SETTLED 0.1
#define SETTLED_SO_FAR 0.01
#define SETTLED_STIFF 0.05

PetscBool newton_eliminates(const StepProblem *p, const LinearProblem *linear)
{
  return linear->dynamic && !p->pressure && p->in.support->n_runs > 0 && nodal_forces_are_local(p->forces);
}

PetscErrorCode NewtonChoose(void *context, PetscInt iteration, Vec f, PetscReal norm)
{
  Newton *n = context;
  const PetscReal *values;

  PetscFunctionBeginUser;
  n->elimination.any = PETSC_FALSE;
  if (iteration < ELIMINATE_AFTER && !n->problem->stiff) PetscFunctionReturn(0);
  PetscCall(VecGetArrayRead(f, &values));
  PetscCall(EliminationChoose(&n->elimination, n->problem, values, norm));
  PetscCall(VecRestoreArrayRead(f, &values));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonSettle(void *context, Vec x)
{
  Newton *n = context;
  const PetscReal share = n->problem->stiff ? SETTLED_STIFF : SETTLED_SO_FAR;
  const PetscReal enough = PetscMax(SETTLED * newton_tolerance(n), share * n->last);
  double start, end;

  PetscFunctionBeginUser;
  if (!n->elimination.any) PetscFunctionReturn(0);
  PetscCall(PetscTime(&start));
  PetscCall(NewtonSetIncrements(n, x));
  PetscCall(EliminationApply(&n->elimination, n->problem, enough));
  PetscCall(NewtonGetUnknowns(n, x));
  PetscCall(PetscTime(&end));
  n->t_points += end - start;
  PetscFunctionReturn(0);
}
