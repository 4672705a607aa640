#include "solve/blocks.h"
#include "solve/newton_private.h"
#include <petsctime.h>

#define FORGIVEN_AFTER 50 /* steps after which the iterative solver gets another chance */

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
  PetscCall(ProjectionDestroy(&n->projection));
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

void NewtonTimes(const Newton *n, PetscReal *points, PetscReal *matrix, PetscReal *linear, PetscReal *rest)
{
  *points = n->t_points;
  *matrix = n->t_matrix;
  *linear = n->t_linear;
  *rest = n->t_newton;
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

void NewtonForget(Newton *n, const System *system, const NewtonMemory *memory)
{
  n->failures = memory->failures;
  n->since = memory->since;
  n->courant = memory->courant;
  n->built = memory->courant >= 0 ? system->builds : -1;
}

/* Internal and inertia forces -> residual, and the norms of reactions and external forces, over owned dofs. Nodes without unknowns have
 * no forces: they are often most of a grid, and are left alone. */
static PetscErrorCode Balance(Newton *n)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  PetscReal local[3] = {0, 0, p->asked && p->asked() ? 1 : 0}, sum[3];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * dim; d < dim; ++d, ++i) {
      p->force[i] -= p->external[i];
      if (p->fixed[i]) local[0] += p->force[i] * p->force[i];
      else local[1] += p->external[i] * p->external[i];
    }
  PetscCall(MPIU_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, n->comm));
  n->asked = sum[2] > 0 ? PETSC_TRUE : PETSC_FALSE;
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
    constraints_assemble(p->constraints, p->du, p->prescribed, p->fixed, p->in.lift, out.force,
                         n->projects ? NULL : out.values);
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

static PetscErrorCode Function(SNES snes, Vec x, Vec f, void *context)
{
  Newton *n = context;
  (void)snes;
  PetscFunctionBeginUser;
  PetscCall(SetIncrements(n, x));
  PetscCall(Assemble(n, !newton_is_last(n)));
  PetscCall(GetResidual(n, f));
  PetscCall(PetscTime(&n->solving)); /* for a solve that asks for no tangent: -snes_lag_jacobian */
  PetscFunctionReturn(0);
}

/* Values -> matrix; where constraints are projections they have no part in it. */
static PetscErrorCode FillMatrix(Newton *n)
{
  const StepProblem *p = n->problem;

  PetscFunctionBeginUser;
  PetscCall(SystemToMatrix(p->system, n->projects ? n->projection->held : p->fixed, p->idle));
  if (n->projects) PetscCall(ProjectionFactor(n->projection));
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
  PetscCall(FillMatrix(n));
  PetscCall(PetscTime(&end));
  n->t_matrix += end - start;
  n->solving = end; /* what SNES does next */
  (void)x;
  PetscFunctionReturn(0);
}

/* The preconditioner's set-up, factorisations too, belongs to the solve. */
static PetscErrorCode LinearSolved(KSP ksp, Vec b, Vec x, void *context)
{
  Newton *n = context;
  double end;

  (void)ksp, (void)b, (void)x;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&end));
  n->t_linear += end - n->solving;
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
  n->projects = chosen.multipliers && form == SYSTEM_BLOCKS ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(SystemUse(p->system, form, linear->symmetric));
  n->search.block = p->pressure ? p->system->block : 0;
  PetscCall(SystemCreateVec(p->system, &n->x));
  PetscCall(VecDuplicate(n->x, &n->f));
  PetscCall(SNESCreate(n->comm, &n->snes));
  PetscCall(SNESSetFunction(n->snes, n->f, Function, n));
  PetscCall(SNESSetJacobian(n->snes, p->system->matrix, p->system->matrix, Jacobian, n));
  PetscCall(SNESSetConvergenceTest(n->snes, NewtonConverged, n, NULL));
  PetscCall(SNESSetType(n->snes, SNESNEWTONLS));
  PetscCall(SNESGetLineSearch(n->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHSHELL));
  PetscCall(SNESLineSearchShellSetUserFunc(search, LineSearchDescend, &n->search));
  PetscCall(SNESGetKSP(n->snes, &ksp));
  PetscCall(KSPSetOperators(ksp, p->system->matrix, p->system->matrix)); /* some choices ask for the matrix at once */
  PetscCall(KSPSetPostSolve(ksp, LinearSolved, n));
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
  double start;

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
    PetscCall(FillMatrix(n));
    PetscCall(PetscTime(&n->solving));
    n->t_matrix += n->solving - start;
    PetscCall(SNESGetKSP(n->snes, &ksp));
    PetscCall(KSPSetOperators(ksp, p->system->matrix, p->system->matrix));
    PetscCall(VecDuplicate(n->x, &y));
    PetscCall(KSPSolve(ksp, n->f, y));
    PetscCall(GetUnknowns(n, n->x));
    PetscCall(VecAXPY(n->x, -1, y));
    PetscCall(VecDestroy(&y));
    PetscCall(SetIncrements(n, n->x));
    n->report->residual[0] = 1;
    n->report->iterations = 1;
    PetscCall(VecNorm(n->f, NORM_2, &n->report->reference));
  }
  PetscCall(PetscFree(lift));
  PetscFunctionReturn(0);
}

/* Clouds of constraints are new in every step. */
static PetscErrorCode UpdateProjection(Newton *n)
{
  const StepProblem *p = n->problem;

  PetscFunctionBeginUser;
  if (!n->projects) PetscFunctionReturn(0);
  PetscCall(ProjectionDestroy(&n->projection));
  PetscCall(ProjectionCreate(p->system, p->grid, p->constraints, p->fixed, &n->projection));
  p->system->blocks->projection = n->projection;
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

static PetscErrorCode NewtonTry(Newton *n, NewtonReport *report)
{
  SNESConvergedReason reason;
  PetscInt its;
  double start, end;
  const double parts = n->t_points + n->t_matrix + n->t_linear;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(report, sizeof(*report)));
  report->bad_point = -1;
  PetscCall(PetscTime(&start));
  rest_without_unknowns(n->problem);
  n->before = 0;
  PetscCall(UpdateSaddle(n));
  PetscCall(UpdateProjection(n));
  PetscCall(LiftPrescribed(n));
  PetscCall(GetUnknowns(n, n->x));
  PetscCall(SNESSetTolerances(n->snes, 0, 0, 0, n->spec.max_iterations - report->iterations, PETSC_MAX_INT));
  PetscCall(SNESSolve(n->snes, NULL, n->x));
  PetscCall(SNESGetConvergedReason(n->snes, &reason));
  PetscCall(SNESGetIterationNumber(n->snes, &its));
  PetscCall(SNESGetLinearSolveIterations(n->snes, &report->linear_iterations));
  report->iterations += its;
  report->converged = reason > 0 ? PETSC_TRUE : PETSC_FALSE;
  report->interrupted = reason == SNES_DIVERGED_FUNCTION_COUNT ? PETSC_TRUE : PETSC_FALSE;
  report->reason = newton_reason(reason, report->status);
  PetscCall(PetscTime(&end));
  n->t_newton += (end - start) - (n->t_points + n->t_matrix + n->t_linear - parts);
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
