/* When Newton's method has converged, is about to, or will not. */
#include "solve/contact/contact.h"
#include "solve/newton/newton_private.h"

#define STUCK_AFTER 10   /* iterations before an iteration can count as stuck */
#define STUCK_WINDOW 5   /* the last iterations, which should have */
#define STUCK_GAIN 0.5   /* brought the residual below this share of the best before */
#define STUCK_ABOVE 1e-4 /* a smaller residual is about to converge */

/* residual over the reference at which multipliers may be renewed before all has converged */
#define NEARLY 1e-3
#define NEARLY_FLOWS 1e-2 /* where grains flow along walls (ContactShare) */

#define EXCUSED 10 /* a first guess is excused so many times all forces that act */

/* tolerances up to which a residual may stay where increments vanish, unless it is round-off */
#define STILL 1e3
#define TOO_FAR 1e3 /* sizes of the grid that nothing goes in one iteration */

/* The scale of a residual: the loads, the residual at the first guess (a guess that is far off
 * counts no more than the forces that there are, or its step would be accepted with newtons left
 * over), and, for motion driven by its boundary or by inertia, a small part of reactions and
 * inertia, well above their round-off. */
static PetscReal reference_force(const Newton *n, PetscReal first)
{
  const StepProblem *p = n->problem;
  const PetscReal loads = PetscMax(p->weight, n->external);
  const PetscReal acting = PetscMax(PetscMax(loads, n->reaction), PetscMax(p->inertia, p->motion));
  PetscReal reference = PetscMax(acting > 0 ? PetscMin(first, EXCUSED * acting) : first, loads);
  reference = PetscMax(reference, 1e-4 * n->reaction);
  reference = PetscMax(reference, 1e-5 * p->inertia);
  return reference > 0 ? reference : 1;
}

PetscReal newton_tolerance(const Newton *n) { return n->spec.residual * reference_force(n, n->report->reference); }

PetscBool newton_is_last(const Newton *n)
{
  if (n->last == 0 && n->before == 0) return n->idle;
  return n->before > 0 && n->last * n->last < 0.1 * newton_tolerance(n) * n->before;
}

static PetscReal dofs_of(const Newton *n)
{
  return (PetscReal)(n->problem->system->n_active_global * n->problem->system->block);
}

/* Is the increment round-off, of the step's displacement or of the size of a cell? Then the
 * residual falls no more. */
static PetscBool at_floor(const Newton *n, PetscReal xnorm, PetscReal snorm)
{
  return snorm <= 1e-9 * xnorm || snorm <= 1e-12 * n->problem->grid->smallest * PetscSqrtReal(dofs_of(n));
}

/* A residual that round-off alone can leave: coordinates and increments are known to their last
 * digit, and a strain made of it acts through the stiffness of every node. A singular or useless
 * linear solve ends in vanishing increments, too, but far above this. */
static PetscBool is_round_off(const Newton *n, PetscReal fnorm)
{
  return fnorm <= n->problem->round_off * PetscSqrtReal(dofs_of(n));
}

/* The mean increment, of a linear solve that was all but singular. */
static PetscBool is_too_far(const Newton *n, PetscReal snorm)
{
  const Grid *grid = n->problem->grid;
  PetscReal size = 0;
  for (PetscInt d = 0; d < grid->dim; ++d) size += PetscSqr(grid->max[d] - grid->min[d]);
  return snorm > TOO_FAR * PetscSqrtReal(size * dofs_of(n));
}

/* An iteration that wanders between the sides of yield surfaces, as most that fail do after ten to
 * fifteen iterations, and few that would come through (counted in docs/experiments/newton.md). What is there before it
 * is no measure of progress if multipliers were renewed there, or if the load has still to do its work: a guess at rest
 * is the last step's equilibrium. */
static PetscBool is_stuck(const Newton *n, PetscInt k)
{
  const PetscReal *residual = n->report->residual;
  const PetscInt first = n->changed, counts = first + (first > 0 || n->problem->border);
  PetscReal before = PETSC_MAX_REAL, lately = PETSC_MAX_REAL;
  if (k - first < STUCK_AFTER || k >= NEWTON_HISTORY || residual[k] <= STUCK_ABOVE) return PETSC_FALSE;
  for (PetscInt i = counts; i <= k - STUCK_WINDOW; ++i) before = PetscMin(before, residual[i]);
  for (PetscInt i = k - STUCK_WINDOW + 1; i <= k; ++i) lately = PetscMin(lately, residual[i]);
  return lately > STUCK_GAIN * before;
}

/* Converged with the multipliers that there are. Others make another residual at the same place, from
 * which progress counts anew. */
static PetscErrorCode AugmentForces(Newton *n, PetscInt iteration, SNESConvergedReason *reason)
{
  PetscBool again;
  Vec f;

  PetscFunctionBeginUser;
  PetscCall(NewtonAugment(n, &again));
  if (!again) PetscFunctionReturn(0);
  ++n->changes;
  *reason = SNES_CONVERGED_ITERATING;
  PetscCall(SNESGetFunction(n->snes, &f, NULL, NULL));
  PetscCall(NewtonGetResidual(n, f));
  PetscCall(VecNorm(f, NORM_2, &n->last));
  n->before = 0;
  n->search.best = PETSC_MAX_REAL;
  n->search.stale = 0;
  n->changed = iteration;
  PetscFunctionReturn(0);
}

/* May multipliers be renewed at this residual, over the reference? */
static PetscErrorCode MayAugment(const Newton *n, PetscInt it, PetscReal relative, SNESConvergedReason reason,
                                 PetscBool *may)
{
  const Contact *contact = n->problem->scene.contact;

  PetscFunctionBeginUser;
  *may = reason > 0;
  if (reason != SNES_CONVERGED_ITERATING || it == 0) PetscFunctionReturn(0);
  *may = relative <= NEARLY;
  if (!*may && relative <= NEARLY_FLOWS && contact && contact->share.flows)
    PetscCall(ContactMoves(contact, n->comm, may));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonConverged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                               SNESConvergedReason *reason, void *context)
{
  Newton *n = context;
  NewtonReport *r = n->report;
  const NewtonSpec *spec = &n->spec;
  PetscBool may;

  (void)snes;
  PetscFunctionBeginUser;
  *reason = SNES_CONVERGED_ITERATING;
  if (it == 0 && r->iterations == 0) r->reference = fnorm;
  const PetscReal reference = reference_force(n, r->reference), relative = fnorm / reference;
  const PetscInt k = r->iterations + it;
  const PetscBool small = snorm <= spec->increment * xnorm || snorm <= spec->increment_absolute;
  const PetscBool near = relative <= STILL * spec->residual;
  const PetscBool still = it > 0 && small && near;
  const PetscBool floored = it > 1 && fnorm > 0.25 * n->last && at_floor(n, xnorm, snorm);
  if (k < NEWTON_HISTORY) r->residual[k] = relative;
  const PetscBool met = newton_border_met(n) && newton_rigid_met(n);
  if (PetscIsInfOrNanReal(fnorm)) *reason = SNES_DIVERGED_FNORM_NAN;
  else if (!met && (n->asked || relative <= 1)) /* the load has still to do its work, or a wall moves on */
    *reason = n->asked ? SNES_DIVERGED_FUNCTION_COUNT : SNES_CONVERGED_ITERATING;
  else if (relative <= spec->residual || fnorm <= PetscMax(spec->residual_absolute, n->problem->enough))
    *reason = SNES_CONVERGED_FNORM_RELATIVE;
  else if (still || (floored && (near || is_round_off(n, fnorm)))) *reason = SNES_CONVERGED_SNORM_RELATIVE;
  else if (n->asked) *reason = SNES_DIVERGED_FUNCTION_COUNT; /* no more than it wants to evaluate */
  else if (floored) *reason = SNES_DIVERGED_INNER;
  else if (it > 0 && is_too_far(n, snorm)) *reason = SNES_DIVERGED_FUNCTION_DOMAIN;
  else if (k > 2 && relative > 1e8) *reason = SNES_DIVERGED_DTOL;
  else if (is_stuck(n, k)) *reason = SNES_DIVERGED_LOCAL_MIN;
  n->before = it > 0 ? n->last : 0;
  n->last = fnorm;
  if (it == 1) n->calm = newton_fell(n);
  PetscCall(MayAugment(n, it, relative, *reason, &may));
  if (may) PetscCall(AugmentForces(n, k, reason));
  PetscFunctionReturn(0);
}

const char *newton_reason(SNESConvergedReason reason, LawStatus status)
{
  switch (reason) {
  case SNES_CONVERGED_FNORM_RELATIVE: return "residual small enough";
  case SNES_CONVERGED_SNORM_RELATIVE: return "increment small enough";
  case SNES_DIVERGED_MAX_IT: return "too many iterations";
  case SNES_DIVERGED_LINEAR_SOLVE: return "the linear solver failed (is the body held anywhere?)";
  case SNES_DIVERGED_LOCAL_MIN: return "the iteration went in circles";
  case SNES_DIVERGED_FUNCTION_COUNT: return "it was interrupted";
  case SNES_DIVERGED_INNER:
    return "increments vanished and the residual did not: the tangent is singular, or the linear solver does nothing";
  case SNES_DIVERGED_FUNCTION_DOMAIN:
    return "an increment of a thousand times the grid's size: the tangent is singular, something is not held";
  case SNES_DIVERGED_DTOL: return "the residual grew without bound";
  default: break;
  }
  if (status != LAW_OK) return law_status_text(status);
  return reason == SNES_DIVERGED_FNORM_NAN ? "a force is not a finite number" : "no convergence";
}
