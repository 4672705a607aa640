/* How exactly a direction is computed where the linear solver iterates, and what of earlier ones it is computed with:
 * preconditioner and tangent. All depends on this step alone, on counts, and on what checkpoints hold (`calm`), never
 * on a clock: a resumed run does the same. */
#include "solve/contact/contact.h"
#include "solve/newton/newton_private.h"

/* Of the residual of the linear system: what a direction far from the solution may lack, and the least that is
 * ever asked for (Eisenstat and Walker 1996; docs/experiments/linear-solvers.md). */
#define LOOSEST 1e-4
#define TIGHTEST 1e-8
/* The same where an iteration of the preconditioner costs no more than a product, and its tangent, of grains that flow,
 * is wrong by more (docs/experiments/linear-solvers.md). */
#define LOOSEST_CHEAP 3e-3
#define TIGHTEST_CHEAP 1e-4
/* Which of the points that touch bear, and by how much they rub, is settled on the way. */
#define LOOSEST_TOUCHING 1e-3
/* share of Newton's tolerance that the last solve may leave */
#define UNSEEN 1e-3
/* linear iterations that a set-up of multigrid costs */
#define SETUP_COSTS 20
/* share of the residual that an iteration leaves whose tangent is good for one more (docs/theory.md, section 70) */
#define KEPT 1e-2

/* Newton's method at its best leaves (last / before)^2 of the residual: a share of that, and no more than what its
 * tolerance would not see. */
static PetscReal forcing_term(const Newton *n, PetscReal share, PetscReal tightest, PetscReal loosest)
{
  if (n->before <= 0) return loosest;
  const PetscReal falls = PetscSqr(n->last / n->before), unseen = UNSEEN * newton_tolerance(n) / n->last;
  return PetscMax(tightest, PetscMin(loosest, PetscMax(share * falls, unseen)));
}

/* A wall or a load that is one more unknown takes both of its solves as exact. */
static PetscBool is_bordered(const Newton *n)
{
  const StepProblem *p = n->problem;
  return p->border || (p->scene.contact && p->scene.contact->n_rigid > 0);
}

/* The loosest of cheap ones. Tangents of what is elastic foretell much; and where what is stiff opens and closes steps
 * are near to fail as it is. */
static PetscReal loosest_cheap(const Newton *n)
{
  if (n->problem->in.symmetric || n->problem->stiff) return TIGHTEST_CHEAP;
  return n->problem->scene.contact ? LOOSEST_TOUCHING : LOOSEST_CHEAP;
}

/* In dynamics inertia rules the tangent, and with wide functions making one takes longer than several iterations. What
 * is eliminated reads tangents. */
static PetscBool may_stay(const Newton *n)
{
  const StepProblem *p = n->problem;
  return p->wide && p->in.inertia > 0 && !is_bordered(n) && !n->elimination.any && !n->lift;
}

PetscBool newton_fell(const Newton *n) { return n->before > 0 && n->last <= KEPT * n->before; }

PetscBool newton_will_keep(const Newton *n)
{
  return may_stay(n) && n->last > 0 && (n->before > 0 ? newton_fell(n) : n->calm);
}

PetscBool newton_keeps(const Newton *n) { return !n->tangent && may_stay(n) && newton_fell(n); }

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
  PetscCall(SNESGetKSP(n->snes, &ksp));
  if (n->keeps) PetscCall(KeepPreconditioner(n, ksp));
  if (n->asked_tolerance) PetscFunctionReturn(0);
  if (n->learns) n->forcing = is_bordered(n) ? TIGHTEST : forcing_term(n, 0.1, TIGHTEST, LOOSEST);
  else n->forcing = is_bordered(n) ? TIGHTEST_CHEAP : forcing_term(n, 0.01, TIGHTEST_CHEAP, loosest_cheap(n));
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
