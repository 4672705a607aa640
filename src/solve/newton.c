#include "solve/newton.h"
#include "solve/line_search.h"
#include <petsctime.h>

struct Newton {
  MPI_Comm comm;
  NewtonSpec spec;
  SNES snes;
  Vec x, f;
  PetscInt built; /* system->builds that snes was set up for */
  LineSearchMemory search;
  PetscBool direct;
  PetscInt failures; /* of the iterative solver; after a few the direct one stays */
  PetscBool retry;   /* this try takes the direct solver */
  const char *linear;
  StepProblem *problem;
  NewtonReport *report;
  PetscReal reaction, external; /* norms at the last assembly, N */
  PetscReal last;               /* norm of the residual one iteration ago, N */
  double t_points, t_matrix, t_linear;
};

PetscErrorCode NewtonCreate(MPI_Comm comm, const NewtonSpec *spec, Newton **newton)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(newton));
  (*newton)->comm = comm;
  (*newton)->spec = *spec;
  (*newton)->built = -1;
  (*newton)->linear = "";
  PetscFunctionReturn(0);
}

static PetscErrorCode NewtonReset(Newton *n)
{
  PetscFunctionBeginUser;
  PetscCall(SNESDestroy(&n->snes));
  PetscCall(VecDestroy(&n->x));
  PetscCall(VecDestroy(&n->f));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonDestroy(Newton **newton)
{
  PetscFunctionBeginUser;
  if (!*newton) PetscFunctionReturn(0);
  PetscCall(NewtonReset(*newton));
  PetscCall(PetscFree(*newton));
  PetscFunctionReturn(0);
}

const char *NewtonLinearName(const Newton *n) { return n->linear; }

void NewtonTimes(const Newton *n, PetscReal *points, PetscReal *matrix, PetscReal *linear)
{
  *points = n->t_points;
  *matrix = n->t_matrix;
  *linear = n->t_linear;
}

/* Norms of reactions and of external forces over owned dofs. */
static PetscErrorCode ForceNorms(Newton *n)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  PetscReal local[2] = {0, 0}, sum[2];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->grid->n_owned * dim; ++i) {
    if (p->fixed[i]) local[0] += p->force[i] * p->force[i];
    else local[1] += p->external[i] * p->external[i];
  }
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, n->comm));
  n->reaction = PetscSqrtReal(sum[0]);
  n->external = PetscSqrtReal(sum[1]);
  PetscFunctionReturn(0);
}

/* Residual (and tangent values) at problem->du. A point that fails makes the status of all ranks bad. */
static PetscErrorCode Assemble(Newton *n)
{
  StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  double start, end;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(PetscArrayzero(p->force, p->grid->n_nodes * dim));
  PetscCall(SystemZero(p->system));
  WeakFormOutput out = {.force = p->force, .values = p->system->values, .slot = p->system->slot};
  p->in.du = p->du;
  p->in.fixed = p->fixed;
  PetscCall(p->formulation->assemble(&p->in, &out));
  if (p->constraints)
    constraints_assemble(p->constraints, p->du, p->prescribed, p->fixed, p->in.lift, out.force, out.values);
  PetscInt status = (PetscInt)out.status, worst;
  PetscCall(MPIU_Allreduce(&status, &worst, 1, MPIU_INT, MPI_MAX, n->comm));
  n->report->status = (LawStatus)worst;
  n->report->bad_point = out.bad_point;
  PetscCall(GridSumToOwners(p->grid, dim, p->force));
  for (PetscInt i = 0; i < p->grid->n_owned * dim; ++i) p->force[i] -= p->external[i];
  PetscCall(ForceNorms(n));
  PetscCall(PetscTime(&end));
  n->t_points += end - start;
  PetscFunctionReturn(0);
}

/* Unknowns -> du, keeping what is prescribed. */
static PetscErrorCode SetIncrements(Newton *n, Vec x)
{
  StepProblem *p = n->problem;
  const PetscInt dofs = p->grid->n_nodes * p->grid->dim;

  PetscFunctionBeginUser;
  PetscCall(SystemToNodes(p->system, p->grid, x, p->du));
  for (PetscInt i = 0; i < dofs; ++i)
    if (p->fixed[i]) p->du[i] = p->prescribed[i];
  PetscFunctionReturn(0);
}

static PetscErrorCode GetResidual(Newton *n, Vec f)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  PetscReal *v;

  PetscFunctionBeginUser;
  if (n->report->status != LAW_OK) {
    PetscCall(VecSet(f, PETSC_INFINITY));
    PetscFunctionReturn(0);
  }
  PetscCall(VecGetArrayWrite(f, &v));
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0; d < dim; ++d) {
      const PetscInt i = p->system->active[k] * dim + d;
      v[k * dim + d] = p->fixed[i] ? 0 : p->force[i];
    }
  PetscCall(VecRestoreArrayWrite(f, &v));
  PetscFunctionReturn(0);
}

static PetscErrorCode Function(SNES snes, Vec x, Vec f, void *context)
{
  Newton *n = context;
  (void)snes;
  PetscFunctionBeginUser;
  PetscCall(SetIncrements(n, x));
  PetscCall(Assemble(n));
  PetscCall(GetResidual(n, f));
  PetscFunctionReturn(0);
}

static PetscErrorCode Jacobian(SNES snes, Vec x, Mat matrix, Mat preconditioner, void *context)
{
  Newton *n = context;
  double start, end;

  (void)snes, (void)matrix, (void)preconditioner;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(SystemToMatrix(n->problem->system, n->problem->fixed));
  PetscCall(PetscTime(&end));
  n->t_matrix += end - start;
  (void)x;
  PetscFunctionReturn(0);
}

/* The scale of a residual: the loads, the residual at the first guess, and (for motion driven by its boundary or by inertia)
 * a small part of reactions and inertia, well above their round-off. */
static PetscReal reference_force(const Newton *n, PetscReal first)
{
  const StepProblem *p = n->problem;
  PetscReal reference = PetscMax(first, PetscMax(p->weight, n->external));
  reference = PetscMax(reference, 1e-4 * n->reaction);
  reference = PetscMax(reference, 1e-5 * p->inertia);
  return reference > 0 ? reference : 1;
}

/* Is the increment round-off, of the step's displacement or of the size of a cell? Then a residual that falls no more has reached the
 * floor of its own round-off, whatever tolerance was asked for. */
static PetscBool at_floor(const Newton *n, PetscReal xnorm, PetscReal snorm)
{
  const PetscReal dofs = (PetscReal)(n->problem->system->n_active_global * n->problem->grid->dim);
  return snorm <= 1e-9 * xnorm || snorm <= 1e-12 * n->problem->grid->smallest * PetscSqrtReal(dofs) ? PETSC_TRUE
                                                                                                    : PETSC_FALSE;
}

static PetscErrorCode Converged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                                SNESConvergedReason *reason, void *context)
{
  Newton *n = context;
  NewtonReport *r = n->report;
  const NewtonSpec *spec = &n->spec;

  (void)snes;
  PetscFunctionBeginUser;
  *reason = SNES_CONVERGED_ITERATING;
  if (it == 0 && r->iterations == 0) r->reference = fnorm;
  const PetscReal reference = reference_force(n, r->reference), relative = fnorm / reference;
  const PetscInt k = r->iterations + it;
  const PetscBool small =
    snorm <= spec->increment * xnorm || snorm <= spec->increment_absolute ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool still = it > 0 && small && relative <= 1e3 * spec->residual ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool floored = it > 1 && fnorm > 0.25 * n->last && at_floor(n, xnorm, snorm) ? PETSC_TRUE : PETSC_FALSE;
  if (k < NEWTON_HISTORY) r->residual[k] = relative;
  if (PetscIsInfOrNanReal(fnorm)) *reason = SNES_DIVERGED_FNORM_NAN;
  else if (relative <= spec->residual || fnorm <= spec->residual_absolute) *reason = SNES_CONVERGED_FNORM_RELATIVE;
  else if (still || floored) *reason = SNES_CONVERGED_SNORM_RELATIVE;
  else if (k > 2 && relative > 1e8) *reason = SNES_DIVERGED_DTOL;
  n->last = fnorm;
  PetscFunctionReturn(0);
}

static PetscErrorCode NewtonSetUp(Newton *n, StepProblem *p, const LinearProblem *linear)
{
  KSP ksp;
  SNESLineSearch search;

  PetscFunctionBeginUser;
  if (n->built == p->system->builds) PetscFunctionReturn(0);
  PetscCall(NewtonReset(n));
  PetscCall(MatSetOption(p->system->matrix, MAT_SYMMETRIC, linear->symmetric));
  PetscCall(SystemCreateVec(p->system, &n->x));
  PetscCall(VecDuplicate(n->x, &n->f));
  PetscCall(SNESCreate(n->comm, &n->snes));
  PetscCall(SNESSetFunction(n->snes, n->f, Function, n));
  PetscCall(SNESSetJacobian(n->snes, p->system->matrix, p->system->matrix, Jacobian, n));
  PetscCall(SNESSetConvergenceTest(n->snes, Converged, n, NULL));
  PetscCall(SNESSetType(n->snes, SNESNEWTONLS));
  PetscCall(SNESGetLineSearch(n->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHSHELL));
  PetscCall(SNESLineSearchShellSetUserFunc(search, LineSearchDescend, &n->search));
  PetscCall(SNESGetKSP(n->snes, &ksp));
  PetscCall(KSPSetOperators(ksp, p->system->matrix, p->system->matrix));
  LinearProblem chosen = *linear;
  if (n->retry || n->failures >= 3) chosen.choice = LINEAR_DIRECT;
  PetscCall(LinearConfigure(ksp, &chosen, &n->direct, &n->linear));
  PetscCall(SNESSetFromOptions(n->snes));
  n->built = p->system->builds;
  PetscFunctionReturn(0);
}

/* One linear step that carries the prescribed increments into the interior: what is left of them at du is moved to the
 * right-hand side through the columns of the tangent. Skipped if the first guess has them already. */
static PetscErrorCode LiftPrescribed(Newton *n)
{
  StepProblem *p = n->problem;
  const PetscInt dofs = p->grid->n_nodes * p->grid->dim;
  PetscReal *lift, largest = 0, all, size = 0, sizes;
  KSP ksp;
  Vec y;
  double start, end;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(dofs, &lift));
  for (PetscInt i = 0; i < dofs; ++i) {
    if (!p->fixed[i]) continue;
    lift[i] = p->prescribed[i] - p->du[i];
    largest = PetscMax(largest, PetscAbsReal(lift[i]));
    size = PetscMax(size, PetscAbsReal(p->prescribed[i]));
  }
  PetscCall(MPIU_Allreduce(&largest, &all, 1, MPIU_REAL, MPIU_MAX, n->comm));
  PetscCall(MPIU_Allreduce(&size, &sizes, 1, MPIU_REAL, MPIU_MAX, n->comm));
  if (all <= 1e-12 * sizes || sizes == 0) {
    PetscCall(PetscFree(lift));
    PetscFunctionReturn(0);
  }
  p->in.lift = lift;
  PetscCall(Assemble(n));
  p->in.lift = NULL;
  PetscCall(GetResidual(n, n->f));
  if (n->report->status == LAW_OK) {
    PetscCall(PetscTime(&start));
    PetscCall(SystemToMatrix(p->system, p->fixed));
    PetscCall(SNESGetKSP(n->snes, &ksp));
    PetscCall(KSPSetOperators(ksp, p->system->matrix, p->system->matrix));
    PetscCall(VecDuplicate(n->x, &y));
    PetscCall(KSPSolve(ksp, n->f, y));
    PetscCall(SystemFromNodes(p->system, p->du, n->x));
    PetscCall(VecAXPY(n->x, -1, y));
    PetscCall(VecDestroy(&y));
    PetscCall(SetIncrements(n, n->x));
    PetscCall(PetscTime(&end));
    n->t_linear += end - start;
    n->report->residual[0] = 1;
    n->report->iterations = 1;
    PetscCall(VecNorm(n->f, NORM_2, &n->report->reference));
  }
  PetscCall(PetscFree(lift));
  PetscFunctionReturn(0);
}

static const char *reason_in_words(SNESConvergedReason reason, LawStatus status)
{
  switch (reason) {
  case SNES_CONVERGED_FNORM_RELATIVE: return "residual small enough";
  case SNES_CONVERGED_SNORM_RELATIVE: return "increment small enough";
  case SNES_DIVERGED_MAX_IT: return "too many iterations";
  case SNES_DIVERGED_LINEAR_SOLVE: return "the linear solver failed (is the body held anywhere?)";
  case SNES_DIVERGED_DTOL: return "the residual grew without bound";
  default: break;
  }
  switch (status) {
  case LAW_INVERTED: return "a point was turned inside out";
  case LAW_NOT_CONVERGED: return "a return mapping did not converge";
  case LAW_NOT_FINITE: return "a stress was not finite";
  default: return "no convergence";
  }
}

static PetscErrorCode NewtonTry(Newton *n, StepProblem *p, NewtonReport *report)
{
  SNESConvergedReason reason;
  PetscInt its;
  double start, end, points = n->t_points, matrix = n->t_matrix, before = n->t_linear;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(report, sizeof(*report)));
  report->bad_point = -1;
  PetscCall(PetscTime(&start));
  PetscCall(LiftPrescribed(n));
  PetscCall(SystemFromNodes(p->system, p->du, n->x));
  PetscCall(SNESSetTolerances(n->snes, 0, 0, 0, n->spec.max_iterations - report->iterations, PETSC_MAX_INT));
  PetscCall(SNESSolve(n->snes, NULL, n->x));
  PetscCall(SNESGetConvergedReason(n->snes, &reason));
  PetscCall(SNESGetIterationNumber(n->snes, &its));
  PetscCall(SNESGetLinearSolveIterations(n->snes, &report->linear_iterations));
  report->iterations += its;
  report->converged = reason > 0 ? PETSC_TRUE : PETSC_FALSE;
  report->reason = reason_in_words(reason, report->status);
  PetscCall(PetscTime(&end));
  n->t_linear = before + (end - start) - (n->t_points - points) - (n->t_matrix - matrix);
  if (reason == SNES_DIVERGED_LINEAR_SOLVE) n->built = -1; /* PETSc would not factorise again after a zero pivot */
  n->retry = reason == SNES_DIVERGED_LINEAR_SOLVE && !n->direct ? PETSC_TRUE : PETSC_FALSE;
  n->failures += n->retry;
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonSolve(Newton *n, StepProblem *p, const LinearProblem *linear, NewtonReport *report)
{
  PetscReal *guess;

  PetscFunctionBeginUser;
  n->problem = p;
  n->report = report;
  PetscCall(PetscMalloc1(p->grid->n_nodes * p->grid->dim, &guess));
  PetscCall(PetscArraycpy(guess, p->du, p->grid->n_nodes * p->grid->dim));
  PetscCall(NewtonSetUp(n, p, linear));
  PetscCall(NewtonTry(n, p, report));
  if (n->retry) { /* once more, with the direct solver */
    PetscCall(PetscArraycpy(p->du, guess, p->grid->n_nodes * p->grid->dim));
    PetscCall(NewtonSetUp(n, p, linear));
    PetscCall(NewtonTry(n, p, report));
    n->built = n->failures < 3 ? -1 : n->built;
  }
  PetscCall(PetscFree(guess));
  PetscFunctionReturn(0);
}
