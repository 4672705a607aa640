/* How exactly a direction is computed where the linear solver iterates, and with which preconditioner. Both depend
 * on this step alone, and on counts, never on a clock: a resumed run does the same. */
#include "solve/contact/contact.h"
#include "solve/newton/newton_private.h"

/* Of the residual of the linear system: what a direction far from the solution may lack, and the least that is
 * ever asked for (Eisenstat and Walker 1996; docs/experiments/linear-solvers.md). */
#define LOOSEST 1e-4
#define TIGHTEST 1e-8
/* share of Newton's tolerance that the last solve may leave */
#define UNSEEN 1e-3
/* linear iterations that a set-up of multigrid costs */
#define SETUP_COSTS 20

/* Newton's method at its best leaves (last / before)^2 of the residual: a tenth of that, and no more than what its
 * tolerance would not see. */
static PetscReal forcing_term(const Newton *n)
{
  if (n->before <= 0) return LOOSEST;
  const PetscReal falls = PetscSqr(n->last / n->before), unseen = UNSEEN * newton_tolerance(n) / n->last;
  return PetscMax(TIGHTEST, PetscMin(LOOSEST, PetscMax(0.1 * falls, unseen)));
}

/* A wall or a load that is one more unknown takes both of its solves as exact. */
static PetscBool is_bordered(const Newton *n)
{
  const StepProblem *p = n->problem;
  return p->border || (p->scene.contact && p->scene.contact->n_rigid > 0);
}

/* A preconditioner stays until a solve has taken so many iterations more than the first as another costs. */
static PetscErrorCode KeepPreconditioner(Newton *n, KSP ksp)
{
  PetscInt its;

  PetscFunctionBeginUser;
  if (n->solves > 0) {
    PetscCall(KSPGetIterationNumber(ksp, &its));
    const PetscReal digits = -PetscLog10Real(n->forcing);
    if (n->solves == 1) n->rate = (PetscReal)its / digits;
    if ((PetscReal)its - n->rate * digits > SETUP_COSTS) n->solves = 0;
  }
  n->stale = n->solves > 0;
  PetscCall(SNESSetLagPreconditioner(n->snes, n->stale ? -1 : 1)); /* SNES sets the next line anew */
  PetscCall(KSPSetReusePreconditioner(ksp, n->stale));
  ++n->solves;
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonForcing(Newton *n)
{
  KSP ksp;

  PetscFunctionBeginUser;
  if (!n->learns) PetscFunctionReturn(0);
  PetscCall(SNESGetKSP(n->snes, &ksp));
  if (n->keeps) PetscCall(KeepPreconditioner(n, ksp));
  if (n->asked_tolerance) PetscFunctionReturn(0);
  n->forcing = is_bordered(n) ? TIGHTEST : forcing_term(n);
  PetscCall(KSPSetTolerances(ksp, n->forcing, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonForcingSetUp(Newton *n)
{
  KSP ksp;

  PetscFunctionBeginUser;
  n->solves = 0;
  n->stale = PETSC_FALSE;
  n->keeps = n->learns && !n->anew;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-ksp_rtol", &n->asked_tolerance));
  PetscCall(SNESGetKSP(n->snes, &ksp));
  PetscCall(KSPGetTolerances(ksp, &n->forcing, NULL, NULL, NULL));
  PetscFunctionReturn(0);
}
