#include "solve/newton.h"
#include "solve/line_search.h"
#include "solve/saddle.h"
#include <petsctime.h>

#define STUCK_AFTER 10    /* iterations before an iteration can count as stuck */
#define STUCK_WINDOW 5    /* the last iterations, which should have */
#define STUCK_GAIN 0.5    /* brought the residual below this share of the best before */
#define STUCK_ABOVE 1e-4  /* a smaller residual is about to converge */
#define FORGIVEN_AFTER 50 /* steps after which the iterative solver gets another chance */

struct Newton {
  MPI_Comm comm;
  NewtonSpec spec;
  SNES snes;
  Vec x, f;
  PetscInt built;      /* system->builds that snes was set up for */
  PetscReal courant;   /* of the step that it was set up in */
  PetscBool learns;    /* the preconditioner keeps something of earlier matrices: it is made anew for every solve */
  PetscInt remembered; /* system->builds whose solver was chosen with this courant before a checkpoint; -1: none */
  LineSearchMemory search;
  Saddle saddle;
  PetscBool direct;
  PetscInt failures; /* of the iterative solver; after a few the direct one stays for a while */
  PetscInt since;    /* steps since the last of them */
  PetscBool retry;   /* this try takes the direct solver */
  const char *linear;
  StepProblem *problem;
  NewtonReport *report;
  PetscReal reaction, external; /* norms at the last assembly, N */
  PetscReal last, before;       /* norms of the residual one iteration ago, and two, N; before: 0 if there was none */
  PetscBool tangent;            /* do the system's values belong to du? */
  double t_points, t_matrix, t_linear;
};

PetscErrorCode NewtonCreate(MPI_Comm comm, const NewtonSpec *spec, Newton **newton)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(newton));
  (*newton)->comm = comm;
  (*newton)->spec = *spec;
  (*newton)->built = (*newton)->remembered = -1;
  (*newton)->linear = "";
  PetscFunctionReturn(0);
}

static PetscErrorCode NewtonReset(Newton *n)
{
  PetscFunctionBeginUser;
  PetscCall(SNESDestroy(&n->snes));
  PetscCall(SaddleClear(&n->saddle));
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

void NewtonGetMemory(const Newton *n, const System *system, NewtonMemory *memory)
{
  memory->courant = system->builds > 0 && n->built == system->builds && !n->learns ? n->courant : -1;
  memory->failures = n->failures;
  memory->since = n->since;
}

void NewtonSetMemory(Newton *n, const System *system, const NewtonMemory *memory)
{
  n->failures = memory->failures;
  n->since = memory->since;
  n->courant = memory->courant;
  n->remembered = system->builds > 0 && memory->courant >= 0 ? system->builds : -1;
}

/* Internal and inertia forces -> residual, and the norms of reactions and external forces, over owned dofs. Nodes without unknowns have
 * no forces: they are often most of a grid, and are left alone. */
static PetscErrorCode Balance(Newton *n)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  PetscReal local[2] = {0, 0}, sum[2];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * dim; d < dim; ++d, ++i) {
      p->force[i] -= p->external[i];
      if (p->fixed[i]) local[0] += p->force[i] * p->force[i];
      else local[1] += p->external[i] * p->external[i];
    }
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, n->comm));
  n->reaction = PetscSqrtReal(sum[0]);
  n->external = PetscSqrtReal(sum[1]);
  PetscFunctionReturn(0);
}

/* Residual (and tangent values) at problem->du. A point that fails makes the status of all ranks bad. */
static PetscErrorCode Assemble(Newton *n, PetscBool tangent)
{
  StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  double start, end;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(SystemZeroNodes(p->system, p->force));
  if (p->volume) PetscCall(PetscArrayzero(p->volume, p->grid->n_nodes));
  if (tangent) PetscCall(SystemZero(p->system));
  n->tangent = tangent;
  WeakFormOutput out = {
    .force = p->force, .volume = p->volume, .values = tangent ? p->system->values : NULL, .slot = p->system->slot};
  p->in.du = p->du;
  p->in.pressure = p->pressure;
  p->in.fixed = p->fixed;
  PetscCall(p->formulation->assemble(&p->in, &out));
  if (p->constraints)
    constraints_assemble(p->constraints, p->du, p->prescribed, p->fixed, p->in.lift, out.force, out.values);
  PetscInt status = (PetscInt)out.status, worst;
  PetscCall(MPIU_Allreduce(&status, &worst, 1, MPIU_INT, MPI_MAX, n->comm));
  n->report->status = (LawStatus)worst;
  n->report->bad_point = out.bad_point;
  PetscCall(GridSumToOwners(p->grid, dim, p->force));
  if (p->volume) PetscCall(GridSumToOwners(p->grid, 1, p->volume));
  PetscCall(Balance(n));
  PetscCall(PetscTime(&end));
  n->t_points += end - start;
  PetscFunctionReturn(0);
}

/* du and pressure -> unknowns. */
static PetscErrorCode GetUnknowns(const Newton *n, Vec x)
{
  const StepProblem *p = n->problem;

  PetscFunctionBeginUser;
  PetscCall(SystemFromNodes(p->system, p->du, 0, p->system->dim, x));
  if (p->pressure) PetscCall(SystemFromNodes(p->system, p->pressure, p->system->dim, 1, x));
  PetscFunctionReturn(0);
}

/* Where no unknowns are, a step has no forces, and only what is prescribed moves. */
static void rest_without_unknowns(const StepProblem *p)
{
  const PetscInt dim = p->grid->dim;
  for (PetscInt node = 0; node < p->grid->n_nodes; ++node) {
    if (p->system->row[node] >= 0) continue;
    for (PetscInt d = 0, i = node * dim; d < dim; ++d, ++i) {
      p->force[i] = 0;
      if (p->fixed[i]) p->du[i] = p->prescribed[i];
    }
  }
}

/* Unknowns -> du and pressure, keeping what is prescribed. */
static PetscErrorCode SetIncrements(Newton *n, Vec x)
{
  StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  const PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(x, &v));
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * dim; d < dim; ++d, ++i)
      p->du[i] = p->fixed[i] ? p->prescribed[i] : v[k * p->system->block + d];
  PetscCall(VecRestoreArrayRead(x, &v));
  PetscCall(GridToGhosts(p->grid, dim, p->du));
  if (p->pressure) PetscCall(SystemToNodes(p->system, p->grid, x, dim, 1, p->pressure));
  PetscFunctionReturn(0);
}

static PetscErrorCode GetResidual(Newton *n, Vec f)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim, block = p->system->block;
  PetscReal *v;

  PetscFunctionBeginUser;
  if (n->report->status != LAW_OK) {
    PetscCall(VecSet(f, PETSC_INFINITY));
    PetscFunctionReturn(0);
  }
  PetscCall(VecGetArrayWrite(f, &v));
  for (PetscInt k = 0; k < p->system->n_active; ++k) {
    const PetscInt node = p->system->active[k];
    for (PetscInt d = 0; d < dim; ++d) v[k * block + d] = p->fixed[node * dim + d] ? 0 : p->force[node * dim + d];
    if (p->pressure) v[k * block + dim] = p->idle[node] ? 0 : p->volume[node];
  }
  PetscCall(VecRestoreArrayWrite(f, &v));
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

/* If the residual falls by the same factor once more it is far below the tolerance: no tangent will be asked for. */
static PetscBool is_last(const Newton *n)
{
  const PetscReal enough = n->spec.residual * reference_force(n, n->report->reference);
  return n->before > 0 && n->last * n->last < 0.1 * enough * n->before ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode Function(SNES snes, Vec x, Vec f, void *context)
{
  Newton *n = context;
  (void)snes;
  PetscFunctionBeginUser;
  PetscCall(SetIncrements(n, x));
  PetscCall(Assemble(n, !is_last(n)));
  PetscCall(GetResidual(n, f));
  PetscFunctionReturn(0);
}

static PetscErrorCode Jacobian(SNES snes, Vec x, Mat matrix, Mat preconditioner, void *context)
{
  Newton *n = context;
  double start, end;

  (void)snes, (void)matrix, (void)preconditioner;
  PetscFunctionBeginUser;
  if (!n->tangent) PetscCall(Assemble(n, PETSC_TRUE)); /* du is still where the residual was taken */
  PetscCall(PetscTime(&start));
  PetscCall(SystemToMatrix(n->problem->system, n->problem->fixed, n->problem->idle));
  PetscCall(PetscTime(&end));
  n->t_matrix += end - start;
  (void)x;
  PetscFunctionReturn(0);
}

/* Is the increment round-off, of the step's displacement or of the size of a cell? Then a residual that falls no more has reached the
 * floor of its own round-off, whatever tolerance was asked for. */
static PetscBool at_floor(const Newton *n, PetscReal xnorm, PetscReal snorm)
{
  const PetscReal dofs = (PetscReal)(n->problem->system->n_active_global * n->problem->system->block);
  return snorm <= 1e-9 * xnorm || snorm <= 1e-12 * n->problem->grid->smallest * PetscSqrtReal(dofs) ? PETSC_TRUE
                                                                                                    : PETSC_FALSE;
}

/* An iteration that wanders between the sides of yield surfaces: seen in 29 of 39 failures (4 ms steps of the dry column) at 10 to 15
 * iterations, and in 5 of 165 steps that would have come through. */
static PetscBool is_stuck(const PetscReal *residual, PetscInt k)
{
  PetscReal before = PETSC_MAX_REAL, lately = PETSC_MAX_REAL;
  if (k < STUCK_AFTER || k >= NEWTON_HISTORY || residual[k] <= STUCK_ABOVE) return PETSC_FALSE;
  for (PetscInt i = 0; i <= k - STUCK_WINDOW; ++i) before = PetscMin(before, residual[i]);
  for (PetscInt i = k - STUCK_WINDOW + 1; i <= k; ++i) lately = PetscMin(lately, residual[i]);
  return lately > STUCK_GAIN * before ? PETSC_TRUE : PETSC_FALSE;
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
  else if (is_stuck(r->residual, k)) *reason = SNES_DIVERGED_LOCAL_MIN;
  n->before = it > 0 ? n->last : 0;
  n->last = fnorm;
  PetscFunctionReturn(0);
}

/* Factorisations and point methods depend on their matrix alone. Algebraic multigrid builds its interpolation once and keeps it as long as the
 * pattern lives, so that a step would depend on all steps before it, and a resumed run would be another one. */
static PetscErrorCode Learns(KSP ksp, PetscBool *learns)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, learns, PCNONE, PCJACOBI, PCPBJACOBI, PCVPBJACOBI, PCSOR,
                                      PCEISENSTAT, PCILU, PCICC, PCLU, PCCHOLESKY, PCBJACOBI, PCASM, ""));
  *learns = *learns ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscErrorCode NewtonSetUp(Newton *n, StepProblem *p, const LinearProblem *linear)
{
  KSP ksp;
  SNESLineSearch search;
  SystemForm form;
  double start, end;

  PetscFunctionBeginUser;
  if (n->built == p->system->builds && !n->learns) PetscFunctionReturn(0);
  PetscCall(PetscTime(&start));
  PetscCall(NewtonReset(n));
  LinearProblem chosen = *linear;
  if (n->remembered == p->system->builds) chosen.courant = n->courant;
  n->courant = chosen.courant;
  n->remembered = -1;
  if (n->retry || n->failures >= 3) chosen.choice = LINEAR_DIRECT;
  PetscCall(LinearForm(&chosen, &form));
  PetscCall(SystemUse(p->system, form, linear->symmetric));
  n->search.block = p->pressure ? p->system->block : 0;
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
  PetscCall(KSPSetOperators(ksp, p->system->matrix, p->system->matrix)); /* some choices ask for the matrix at once */
  PetscCall(LinearConfigure(ksp, &chosen, &n->direct, &n->linear));
  if (chosen.mixed && !n->direct) PetscCall(SaddleConfigure(&n->saddle, ksp, p->system, p->grid, chosen.dynamic));
  PetscCall(SNESSetFromOptions(n->snes));
  PetscCall(LinearRefine(ksp, p->system->matrix, &chosen));
  PetscCall(Learns(ksp, &n->learns));
  n->built = p->system->builds;
  PetscCall(PetscTime(&end));
  n->t_matrix += end - start;
  PetscFunctionReturn(0);
}

/* One linear step that carries the prescribed increments into the interior: what is left of them at du is moved to the
 * right-hand side through the columns of the tangent. Skipped if the first guess has them already. */
static PetscErrorCode LiftPrescribed(Newton *n)
{
  StepProblem *p = n->problem;
  const PetscInt dofs = p->grid->n_nodes * p->grid->dim;
  PetscReal *lift, local[2] = {0, 0}, all[2]; /* largest increments: what is left of them, and whole */
  KSP ksp;
  Vec y;
  double start, end;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * p->grid->dim; d < p->grid->dim; ++d, ++i) {
      if (!p->fixed[i]) continue;
      local[0] = PetscMax(local[0], PetscAbsReal(p->prescribed[i] - p->du[i]));
      local[1] = PetscMax(local[1], PetscAbsReal(p->prescribed[i]));
    }
  PetscCall(MPIU_Allreduce(local, all, 2, MPIU_REAL, MPIU_MAX, n->comm));
  if (all[0] <= 1e-12 * all[1] || all[1] == 0) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(dofs, &lift));
  for (PetscInt i = 0; i < dofs; ++i)
    if (p->fixed[i]) lift[i] = p->prescribed[i] - p->du[i];
  p->in.lift = lift;
  PetscCall(Assemble(n, PETSC_TRUE));
  p->in.lift = NULL;
  PetscCall(GetResidual(n, n->f));
  if (n->report->status == LAW_OK) {
    PetscCall(PetscTime(&start));
    PetscCall(SystemToMatrix(p->system, p->fixed, p->idle));
    PetscCall(SNESGetKSP(n->snes, &ksp));
    PetscCall(KSPSetOperators(ksp, p->system->matrix, p->system->matrix));
    PetscCall(VecDuplicate(n->x, &y));
    PetscCall(KSPSolve(ksp, n->f, y));
    PetscCall(GetUnknowns(n, n->x));
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

/* Points have moved since the last step: so has what stands in for the Schur complement. */
static PetscErrorCode UpdateSaddle(Newton *n)
{
  const StepProblem *p = n->problem;
  PetscReal *nodes;

  PetscFunctionBeginUser;
  if (!n->saddle.schur) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(p->grid->n_nodes, &nodes));
  p->formulation->schur(&p->in, nodes);
  PetscCall(GridSumToOwners(p->grid, 1, nodes));
  PetscCall(SaddleUpdate(&n->saddle, p->system, nodes));
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(0);
}

static const char *reason_in_words(SNESConvergedReason reason, LawStatus status)
{
  switch (reason) {
  case SNES_CONVERGED_FNORM_RELATIVE: return "residual small enough";
  case SNES_CONVERGED_SNORM_RELATIVE: return "increment small enough";
  case SNES_DIVERGED_MAX_IT: return "too many iterations";
  case SNES_DIVERGED_LINEAR_SOLVE: return "the linear solver failed (is the body held anywhere?)";
  case SNES_DIVERGED_LOCAL_MIN: return "the iteration went in circles";
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

static PetscErrorCode NewtonTry(Newton *n, NewtonReport *report)
{
  SNESConvergedReason reason;
  PetscInt its;
  double start, end, points = n->t_points, matrix = n->t_matrix, before = n->t_linear;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(report, sizeof(*report)));
  report->bad_point = -1;
  PetscCall(PetscTime(&start));
  rest_without_unknowns(n->problem);
  n->before = 0;
  PetscCall(UpdateSaddle(n));
  PetscCall(LiftPrescribed(n));
  PetscCall(GetUnknowns(n, n->x));
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
  const PetscInt nodes = p->grid->n_nodes, dofs = nodes * p->grid->dim;
  PetscReal *guess, *pressure;

  PetscFunctionBeginUser;
  n->problem = p;
  n->report = report;
  PetscCall(PetscMalloc2(dofs, &guess, p->pressure ? nodes : 0, &pressure));
  PetscCall(PetscArraycpy(guess, p->du, dofs));
  if (p->pressure) PetscCall(PetscArraycpy(pressure, p->pressure, nodes));
  PetscCall(NewtonSetUp(n, p, linear));
  PetscCall(NewtonTry(n, report));
  if (n->retry) { /* once more, with the direct solver */
    PetscCall(PetscArraycpy(p->du, guess, dofs));
    if (p->pressure) PetscCall(PetscArraycpy(p->pressure, pressure, nodes));
    PetscCall(NewtonSetUp(n, p, linear));
    PetscCall(NewtonTry(n, report));
    n->built = n->failures < 3 ? -1 : n->built;
    n->since = 0;
  } else if (n->failures && ++n->since >= FORGIVEN_AFTER) {
    n->failures = n->since = 0;
    n->built = -1;
  }
  PetscCall(PetscFree2(guess, pressure));
  PetscFunctionReturn(0);
}
