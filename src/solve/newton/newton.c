/* One step's nonlinear solve, and what Newton's method remembers from step to step. */
#include "solve/blocks/blocks.h"
#include "solve/contact/contact.h"
#include "solve/newton/newton_private.h"
#include <petsctime.h>

/* a first guess that goes along with walls takes at most so many steps, until so much is left of what it began with;
 * or no more than these where none of them has left less */
#define CARRIES 10
#define CARRIED 1e-4
#define CARRIES_IN_VAIN 4

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

PetscErrorCode NewtonDestroy(Newton **newton)
{
  PetscFunctionBeginUser;
  if (!*newton) PetscFunctionReturn(0);
  PetscCall(NewtonReset(*newton));
  PetscCall(PetscFree((*newton)->rigid));
  PetscCall(PetscFree(*newton));
  PetscFunctionReturn(0);
}

const char *newton_linear_name(const Newton *n) { return n->linear; }

void newton_times(const Newton *n, PetscReal *points, PetscReal *matrix, PetscReal *linear, PetscReal *rest)
{
  *points = n->t_points;
  *matrix = n->t_matrix;
  *linear = n->t_linear;
  *rest = n->t_newton;
}

void newton_get_memory(const Newton *n, const System *system, NewtonMemory *memory)
{
  memory->courant = system->builds > 0 && n->built == system->builds && !n->learns ? n->courant : -1;
  memory->failures = n->failures;
  memory->since = n->since;
  memory->calm = n->calm;
}

void newton_set_memory(Newton *n, const System *system, const NewtonMemory *memory)
{
  n->failures = memory->failures;
  n->since = memory->since;
  n->calm = memory->calm;
  n->courant = memory->courant;
  n->remembered = system->builds > 0 && memory->courant >= 0 ? system->builds : -1;
}

void newton_forget(Newton *n, const System *system, const NewtonMemory *memory)
{
  n->failures = memory->failures;
  n->since = memory->since;
  n->calm = memory->calm;
  n->courant = memory->courant;
  n->built = memory->courant >= 0 ? system->builds : -1;
}

/* The largest of what the first guess lacks of the prescribed increments, and of these, on this rank; du in the frames
 * of the nodes. */
static void largest_lack(const StepProblem *p, PetscReal largest[2])
{
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * p->grid->dim; d < p->grid->dim; ++d, ++i) {
      if (!p->fixed[i]) continue;
      largest[0] = PetscMax(largest[0], PetscAbsReal(p->prescribed[i] - p->du[i]));
      largest[1] = PetscMax(largest[1], PetscAbsReal(p->prescribed[i]));
    }
}

/* Does the first guess lack some of the prescribed increments, on any rank? What it lacks is freed by PetscFree. */
static PetscErrorCode LackOfGuess(const Newton *n, PetscBool *lacks, PetscReal **lift)
{
  const StepProblem *p = n->problem;
  const PetscInt dofs = p->grid->n_nodes * p->grid->dim;
  PetscReal local[2] = {0, 0}, all[2];

  PetscFunctionBeginUser;
  *lift = NULL;
  newton_turn(p, p->du);
  largest_lack(p, local);
  PetscCall(MPIU_Allreduce(local, all, 2, MPIU_REAL, MPIU_MAX, n->comm));
  *lacks = all[0] > 1e-12 * all[1] && all[1] != 0;
  if (*lacks) PetscCall(PetscCalloc1(dofs, lift));
  for (PetscInt i = 0; *lacks && i < dofs; ++i)
    if (p->fixed[i]) (*lift)[i] = p->prescribed[i] - p->du[i];
  newton_turn(p, p->du);
  PetscFunctionReturn(0);
}

/* One linear step from du, with what has been assembled there. *solved: PETSC_FALSE where a factorisation has failed,
 * whose result is infinite. */
static PetscErrorCode StepLinearly(Newton *n, PetscBool *solved)
{
  KSPConvergedReason reason;
  StepProblem *p = n->problem;
  KSP ksp;
  Vec y;
  double start;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(NewtonFillMatrix(n));
  PetscCall(NewtonForcing(n));
  PetscCall(PetscTime(&n->solving));
  n->t_matrix += n->solving - start;
  PetscCall(SNESGetKSP(n->snes, &ksp));
  PetscCall(KSPSetOperators(ksp, p->system->matrix, p->system->matrix));
  PetscCall(VecDuplicate(n->x, &y));
  PetscCall(KSPSolve(ksp, n->f, y));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  *solved = (PetscBool)(reason != KSP_DIVERGED_PC_FAILED);
  n->spoilt |= !*solved;
  PetscCall(NewtonGetUnknowns(n, n->x));
  if (*solved) PetscCall(VecAXPY(n->x, -1, y));
  PetscCall(VecDestroy(&y));
  PetscCall(NewtonSetIncrements(n, n->x));
  PetscFunctionReturn(0);
}

/* The step that carries the prescribed increments into the interior: what is left of them at du is moved to the
 * right-hand side through the columns of the tangent. Skipped if the first guess has them already. *solved: see
 * StepLinearly. */
static PetscErrorCode LiftPrescribed(Newton *n, PetscBool *solved)
{
  PetscReal *lift;
  PetscBool lacks;

  PetscFunctionBeginUser;
  *solved = PETSC_TRUE;
  PetscCall(LackOfGuess(n, &lacks, &lift));
  if (!lacks) PetscFunctionReturn(0);
  n->lift = lift;
  PetscCall(NewtonAssemble(n, PETSC_TRUE));
  n->lift = NULL;
  PetscCall(NewtonGetResidual(n, n->f));
  if (n->report->status == LAW_OK) {
    PetscCall(StepLinearly(n, solved));
    n->report->residual[0] = 1;
    n->report->iterations = 1;
    PetscCall(VecNorm(n->f, NORM_2, &n->report->reference));
  }
  PetscCall(PetscFree(lift));
  PetscFunctionReturn(0);
}

/* |R| over what is not prescribed, at du. */
static PetscErrorCode Miss(Newton *n, PetscReal *norm)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  NewtonReport report = {.bad_point = -1}, *kept = n->report;
  PetscReal square = 0, sum;

  PetscFunctionBeginUser;
  n->report = &report;
  PetscCall(NewtonAssemble(n, PETSC_FALSE));
  n->report = kept;
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * dim; d < dim; ++d, ++i)
      if (!p->fixed[i]) square += PetscSqr(p->force[i]);
  PetscCall(MPIU_Allreduce(&square, &sum, 1, MPIU_REAL, MPI_SUM, n->comm));
  *norm = report.status == LAW_OK ? PetscSqrtReal(sum) : PETSC_MAX_REAL;
  PetscFunctionReturn(0);
}

/* A step of Newton's as if nothing that was in contact could slide or open. */
static PetscErrorCode Grip(Newton *n, PetscBool *solved)
{
  Contact *contact = n->problem->scene.contact;

  PetscFunctionBeginUser;
  *solved = PETSC_FALSE;
  contact->grips = PETSC_TRUE;
  PetscCall(NewtonAssemble(n, PETSC_TRUE));
  contact->grips = PETSC_FALSE;
  PetscCall(NewtonGetResidual(n, n->f));
  if (n->report->status == LAW_OK) PetscCall(StepLinearly(n, solved));
  PetscFunctionReturn(0);
}

/* Statics, where a rough wall goes along itself, or any away: bodies that it carries are left behind by any guess but
 * the last step's, slide on it everywhere then or hang in the air, and nothing tells how far they have to go. So first
 * a few steps as if what it touches could neither slide nor open: the first turns what turns along its tangent, into
 * the wall or off it, the next ones back. What leaves the least is kept; where that is du, as where a body is held and
 * the wall passes it, it stays. */
static PetscErrorCode Carry(Newton *n)
{
  StepProblem *p = n->problem;
  Contact *contact = p->scene.contact;
  const PetscInt dofs = p->grid->n_nodes * p->grid->dim;
  PetscReal *best, least, miss, first;
  PetscBool carries = PETSC_FALSE, solved = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (contact && !p->pressure && !p->border && !contact->n_rigid) PetscCall(ContactCarries(contact, n->comm, &carries));
  if (!carries && !p->grips) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(dofs, &best));
  PetscCall(PetscArraycpy(best, p->du, dofs));
  PetscCall(Miss(n, &first));
  least = first;
  for (PetscInt k = 0; k < (least < first ? CARRIES : CARRIES_IN_VAIN) && solved && least >= CARRIED * first; ++k) {
    PetscCall(Grip(n, &solved));
    PetscCall(Miss(n, &miss));
    if (!(miss < least) && !p->grips) continue;
    least = miss;
    PetscCall(PetscArraycpy(best, p->du, dofs));
  }
  PetscCall(PetscArraycpy(p->du, best, dofs));
  PetscCall(PetscFree(best));
  n->report->status = LAW_OK;
  PetscFunctionReturn(0);
}

/* Clouds of constraints are new in every step. */
static PetscErrorCode UpdateProjection(Newton *n)
{
  const StepProblem *p = n->problem;

  PetscFunctionBeginUser;
  if (!n->projects) PetscFunctionReturn(0);
  PetscCall(ProjectionDestroy(&n->projection));
  PetscCall(ProjectionCreate(p->system, p->grid, nodal_forces_constraints(p->forces), p->fixed, &n->projection));
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

PetscErrorCode NewtonMiss(Newton *n, StepProblem *p, PetscReal *norm)
{
  PetscFunctionBeginUser;
  n->problem = p;
  newton_rest_without_unknowns(p);
  PetscCall(Miss(n, norm));
  PetscFunctionReturn(0);
}

/* A factorisation for which the machines have no room would end the run without a word. */
static const char no_room[] = "the linear iteration failed, and a factorisation needs more memory than there is";

/* From the first guess on; without a lift there is nowhere to begin. */
static PetscErrorCode Iterate(Newton *n, NewtonReport *report, SNESConvergedReason *reason)
{
  PetscInt its;
  PetscBool solved;

  PetscFunctionBeginUser;
  *reason = SNES_DIVERGED_LINEAR_SOLVE;
  PetscCall(LiftPrescribed(n, &solved));
  if (solved) {
    PetscCall(NewtonGetUnknowns(n, n->x));
    PetscCall(SNESSetTolerances(n->snes, 0, 0, 0, n->spec.max_iterations - report->iterations, PETSC_MAX_INT));
    PetscCall(SNESSolve(n->snes, NULL, n->x));
    PetscCall(SNESGetConvergedReason(n->snes, reason));
    PetscCall(SNESGetIterationNumber(n->snes, &its));
    PetscCall(SNESGetLinearSolveIterations(n->snes, &report->linear_iterations));
    report->iterations += its;
  }
  newton_turn(n->problem, n->problem->force);
  report->converged = *reason > 0;
  report->negative = n->negative;
  n->idle = report->converged && report->iterations == 0;
  report->interrupted = *reason == SNES_DIVERGED_FUNCTION_COUNT;
  PetscFunctionReturn(0);
}

/* Why the iteration ended, in words: what stands behind it, if that is known. */
static PetscErrorCode Explain(Newton *n, SNESConvergedReason reason, NewtonReport *report)
{
  const PetscBool gone = !report->converged && !report->interrupted;
  const PetscBool singular =
    reason == SNES_DIVERGED_LINEAR_SOLVE || reason == SNES_DIVERGED_INNER || reason == SNES_DIVERGED_FUNCTION_DOMAIN;
  const char *loose = gone ? newton_rigid_reason(n) : NULL;

  PetscFunctionBeginUser;
  if (!loose && gone && singular) PetscCall(NewtonLooseReason(n, &loose));
  if (!loose && gone && reason == SNES_DIVERGED_FUNCTION_DOMAIN) PetscCall(NewtonFarReason(n, &loose));
  report->reason = loose ? loose : newton_reason(reason, report->status);
  PetscFunctionReturn(0);
}

/* What the solver is told of the step. */
static PetscErrorCode Begin(Newton *n)
{
  StepProblem *p = n->problem;

  PetscFunctionBeginUser;
  n->search.enough = p->stiff || p->weaker ? ENOUGH_STIFF : ENOUGH;
  n->search.wary = p->weaker;
  PetscCall(EliminationBegin(&n->elimination, p));
  PetscCall(UpdateSaddle(n));
  PetscCall(UpdateProjection(n));
  PetscCall(SystemPrescribe(p->system, n->projects ? n->projection->held : p->fixed, p->idle));
  PetscFunctionReturn(0);
}

/* With a solver that has no factorisation behind it that failed. */
static PetscErrorCode BeginAnew(Newton *n, const LinearProblem *linear)
{
  PetscFunctionBeginUser;
  n->built = -1;
  PetscCall(NewtonSetUp(n, n->problem, linear));
  PetscCall(Begin(n));
  PetscFunctionReturn(0);
}

static PetscErrorCode NewtonTry(Newton *n, const LinearProblem *linear, NewtonReport *report)
{
  const StepProblem *p = n->problem;
  SNESConvergedReason reason;
  double start, end;
  const double parts = n->t_points + n->t_matrix + n->t_linear;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(report, sizeof(*report)));
  report->bad_point = -1;
  PetscCall(PetscTime(&start));
  newton_rest_without_unknowns(p);
  n->before = n->last = 0;
  n->changes = n->changed = n->rescues = 0;
  n->negative = -1;
  PetscCall(Begin(n));
  PetscCall(Carry(n));
  if (n->spoilt) PetscCall(BeginAnew(n, linear));
  PetscCall(Iterate(n, report, &reason));
  PetscCall(Explain(n, reason, report));
  PetscCall(PetscTime(&end));
  n->t_newton += (end - start) - (n->t_points + n->t_matrix + n->t_linear - parts);
  if (reason == SNES_DIVERGED_LINEAR_SOLVE) n->built = -1; /* see spoilt */
  const PetscBool useless = reason == SNES_DIVERGED_LINEAR_SOLVE || reason == SNES_DIVERGED_INNER;
  n->retry = useless && !n->direct;
  n->anew = n->retry && n->stale;
  if (n->retry && !n->anew && !linear_factor_fits(linear)) n->retry = PETSC_FALSE, report->reason = no_room;
  if (n->retry) n->built = -1; /* with other set-ups, or another solver */
  newton_count_failure(n, report);
  if (reason == SNES_DIVERGED_LINEAR_SOLVE && n->direct) PetscCall(NewtonLeaveMoreRoom(n, &n->retry));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonSolve(Newton *n, StepProblem *p, const LinearProblem *linear, NewtonReport *report)
{
  const PetscInt nodes = p->grid->n_nodes, dofs = nodes * p->grid->dim;
  const Contact *contact = p->scene.contact;
  PetscReal *guess, *pressure, *walls;

  PetscFunctionBeginUser;
  n->problem = p;
  n->report = report;
  PetscCall(
    PetscMalloc3(dofs, &guess, p->pressure ? nodes : 0, &pressure, contact ? RIGID * contact->n_rigid : 0, &walls));
  newton_rigid_get(n, walls);
  PetscCall(PetscArraycpy(guess, p->du, dofs));
  if (p->pressure) PetscCall(PetscArraycpy(pressure, p->pressure, nodes));
  n->anew = PETSC_FALSE;
  PetscCall(NewtonSetUp(n, p, linear));
  PetscCall(NewtonTry(n, linear, report));
  const PetscBool again = n->retry;
  while (n->retry) { /* once more, with set-ups of their own, or with the direct solver */
    const PetscInt lost = report->lost + report->iterations;
    PetscCall(PetscArraycpy(p->du, guess, dofs));
    newton_rigid_set(n, walls);
    if (p->pressure) PetscCall(PetscArraycpy(p->pressure, pressure, nodes));
    PetscCall(NewtonSetUp(n, p, linear));
    PetscCall(NewtonTry(n, linear, report));
    report->lost = lost;
  }
  newton_count_step(n, report, again);
  PetscCall(PetscFree3(guess, pressure, walls));
  PetscFunctionReturn(0);
}
