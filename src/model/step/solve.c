/* Phase (b), the solve of a step: Newton from one first guess after another, on shorter and
 * shorter steps; and everything as it was where that does not help. */
#include "model/model_private.h"
#include "solve/levels/coarse_box.h"

#define ROUNDING 1e-9 /* of a step: one that leads back to the times asked for is a difference of times */

void model_times(const Model *m, PetscReal seconds[PHASE_N])
{
  PetscReal newton[PHASE_N] = {0};
  newton_times(m->newton, &newton[PHASE_POINTS], &newton[PHASE_MATRIX], &newton[PHASE_LINEAR], &newton[PHASE_NEWTON]);
  for (int k = 0; k < PHASE_N; ++k) seconds[k] = m->seconds[k] + newton[k];
}

static void count_try(Model *m, PetscBool again, StepReport *report)
{
  const NewtonReport *newton = &report->newton;
  const PetscInt lost = newton->lost + (newton->converged ? 0 : newton->iterations);
  m->total_iterations += newton->iterations + newton->lost;
  m->tries.again += again;
  m->tries.lost += lost;
  report->tries.again += again;
  report->tries.lost += lost;
}

static void scale(PetscInt n, PetscReal factor, PetscReal *x)
{
  for (PetscInt i = 0; i < n && factor != 1; ++i) x[i] *= factor;
}

/* From the middle of the step, if forces balance there, on to its end: there must be stress,
 * too. */
static PetscErrorCode GoOn(Model *m, PetscReal dt, StepReport *report)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  WeakFormInput in = weak_form_of(m, 0);
  WeakFormOutput out = {0};
  PetscInt status, worst;

  PetscFunctionBeginUser;
  if (!m->scheme->middle) PetscFunctionReturn(0);
  scale(dofs, 1 / time_solved(m->scheme), m->nodes->du);
  materials_step(m->c->n_materials, m->materials, m->time, dt, m->scheme->inertia);
  PetscCall(PetscCalloc1(dofs, &out.force));
  PetscCall(m->formulation->assemble(&in, &out));
  PetscCall(PetscFree(out.force));
  status = (PetscInt)out.status;
  PetscCall(MPIU_Allreduce(&status, &worst, 1, MPIU_INT, MPI_MAX, m->comm));
  report->newton.status = (LawStatus)worst;
  if (worst == (PetscInt)LAW_OK) PetscFunctionReturn(0);
  report->newton.converged = PETSC_FALSE;
  report->newton.reason = "no stress where the motion of the step's middle goes on to";
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeGuess(Model *m, FirstGuess guess, PetscReal dt)
{
  PetscFunctionBeginUser;
  guess_make(m, guess, dt, m->nodes->du);
  scale(m->grid->n_nodes * m->dim, time_solved(m->scheme), m->nodes->du);
  PetscFunctionReturn(0);
}

/* The first guesses that the next step has. In stiff matter displacements that are near may have any residual: that of
 * both motions goes first which leaves less. */
static PetscErrorCode OrderGuesses(Model *m, PetscReal dt, StepProblem *p, FirstGuess guess[GUESS_N], PetscInt *n)
{
  PetscReal miss[2];

  PetscFunctionBeginUser;
  *n = guess_order(m, guess);
  if (!p->stiff || *n < 3) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < 2; ++k) {
    PetscCall(MakeGuess(m, guess[k], dt));
    PetscCall(NewtonMiss(m->newton, p, &miss[k]));
  }
  if (miss[0] <= miss[1]) PetscFunctionReturn(0);
  const FirstGuess first = guess[0];
  guess[0] = guess[1];
  guess[1] = first;
  PetscFunctionReturn(0);
}

/* Has Newton's method lost its way in a try of a search for the factor of safety? What goes too far is another thing;
 * walls with mass have no inertia in statics that would hold them back; and where pressures at nodes lock what dilates
 * inside a cell some of it flows in pseudo-time, too, long before anything fails (docs/decisions.md, 263). */
static PetscBool is_lost(const Model *m, const StepReport *report)
{
  const PetscBool lost = (PetscBool)(!report->newton.converged && !report->newton.interrupted && !report->leap[0]);
  const PetscBool floats = (PetscBool)(m->contact && m->contact->n_rigid > 0);
  const PetscBool locks = (PetscBool)(m->formulation->pressure && case_dilates(m->c));
  return (PetscBool)(lost && m->strength.trying && !floats && !locks);
}

static PetscErrorCode SolveInPseudoTime(Model *m, StepProblem *problem, const LinearProblem *linear, StepReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(PseudoTimeSolve(m, problem, linear, report));
  if (report->newton.converged) PetscCall(StrengthJudge(m, report));
  count_try(m, PETSC_TRUE, report);
  PetscFunctionReturn(0);
}

/* Newton from a first guess; again: not the first try of the step. */
static PetscErrorCode SolveFrom(Model *m, FirstGuess guess, PetscReal dt, StepProblem *problem,
                                const LinearProblem *linear, PetscBool again, PetscLogDouble *clock, StepReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(MakeGuess(m, guess, dt));
  problem->grips = (PetscBool)(guess == GUESS_GRIPPED);
  pressure_guess(m);
  PetscCall(PhaseEnd(m->seconds, PHASE_PREPARE, clock));
  materials_step(m->c->n_materials, m->materials, case_time(m->c, m->time), dt * time_solved(m->scheme),
                 m->scheme->inertia);
  PetscCall(NewtonSolve(m->newton, problem, linear, &report->newton));
  if (report->newton.converged) PetscCall(GoOn(m, dt, report));
  if (report->newton.converged) PetscCall(UnheldJudge(m, problem, linear, report));
  if (report->newton.converged) PetscCall(JudgeStep(m, report));
  if (report->newton.converged) PetscCall(StrengthJudge(m, report));
  PetscCall(PetscTime(clock));
  count_try(m, again, report);
  PetscFunctionReturn(0);
}

/* The nearest guess once more where strong friction may have thrown the iteration back; a search goes on in its own
 * ways. */
static PetscErrorCode SolveSoftened(Model *m, FirstGuess guess, PetscReal dt, StepProblem *problem,
                                    const LinearProblem *linear, PetscLogDouble *clock, StepReport *report)
{
  PetscBool softer;

  PetscFunctionBeginUser;
  if (!m->contact || m->strength.trying) PetscFunctionReturn(0);
  PetscCall(ContactSoften(m->contact, m->comm, &softer));
  if (softer) PetscCall(SolveFrom(m, guess, dt, problem, linear, PETSC_TRUE, clock, report));
  PetscFunctionReturn(0);
}

static PetscBool is_over(const StepReport *report)
{
  return (PetscBool)(report->newton.converged || report->newton.interrupted);
}

/* Newton from the nearest first guess, and where it fails from the others: a step is halved only
 * if none of them leads to its solution. */
static PetscErrorCode SolveFromGuesses(Model *m, PetscReal dt, const LinearProblem *linear, StepReport *report)
{
  FirstGuess guess[GUESS_N];
  StepProblem problem;
  PetscInt guesses;
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  PetscCall(PrepareStep(m, dt, &problem));
  PetscCall(OrderGuesses(m, dt, &problem, guess, &guesses));
  for (PetscInt k = 0; k < guesses && !(k > 0 && is_over(report)); ++k)
    PetscCall(SolveFrom(m, guess[k], dt, &problem, linear, (PetscBool)(k > 0), &clock, report));
  if (!is_over(report)) PetscCall(SolveSoftened(m, guess[0], dt, &problem, linear, &clock, report));
  if (is_lost(m, report)) PetscCall(SolveInPseudoTime(m, &problem, linear, report));
  PetscFunctionReturn(0);
}

static LinearProblem linear_problem(const Model *m, PetscReal dt)
{
  return (LinearProblem){
    .choice = m->c->linear,
    .dim = m->dim,
    .unknowns = m->system->n_active_global * m->system->block,
    .pairs = m->system->n_pairs_global,
    .block = m->system->block,
    .symmetric = m->symmetric,
    .failing = case_seeks(&m->c->analysis),
    .levels = coarse_box_fits(m->grid),
    .mixed = m->formulation->pressure,
    .undetermined = m->c->mixed.stabilisation == 0,
    .multipliers = m->n_constraints > 0,
    .idle_ranks = !m->system->n_active_least,
    .dynamic = m->scheme->inertia,
    .courant = m->courant_speed * dt / m->grid->smallest,
    .memory = m->machine_memory,
  };
}

PetscErrorCode SolveStep(Model *m, PetscReal *dt, StepReport *report)
{
  const PetscReal smallest = m->raised.rising ? m->c->analysis.limit.step / 1024 : m->c->analysis.smallest;

  PetscFunctionBeginUser;
  for (;; *dt = step_control_cut(&m->control, *dt)) {
    const LinearProblem linear = linear_problem(m, *dt);
    PetscCall(SolveFromGuesses(m, *dt, &linear, report));
    if (report->newton.converged || report->newton.interrupted) PetscFunctionReturn(0);
    ++m->cuts;
    ++report->cuts;
    if (m->strength.trying || m->initial.seeking || *dt / 2 < (1 - ROUNDING) * smallest) break;
  }
  report->outcome = STEP_TOO_SMALL;
  report->dt = *dt;
  snprintf(report->reason, sizeof report->reason,
           "Newton did not converge with a step of %g s (%s), and half of it is less than analysis.smallest = %g s",
           (double)*dt, report->newton.reason, (double)smallest);
  PetscCall(LimitDescribe(m, report));
  PetscCall(ContactDescribe(m, report));
  PetscFunctionReturn(0);
}

PetscErrorCode StepStartKeep(Model *m, StepStart *start)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  *start = (StepStart){.control = m->control, .cuts = m->cuts, .iterations = m->total_iterations, .tries = m->tries};
  newton_get_memory(m->newton, m->system, &start->newton);
  if (m->method->restores_grid) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(m->nodes->v_start, m->nodes->v, dofs));
  PetscCall(PetscArraycpy(m->nodes->a_start, m->nodes->a, dofs));
  PetscCall(PetscArraycpy(m->nodes->echo_start, m->nodes->echo, dofs));
  PetscFunctionReturn(0);
}

PetscErrorCode StepStartRestore(Model *m, const StepStart *start, StepReport *report)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  PetscCall(MaterialsBack(m));
  rigid_back(m);
  discretisation_room_back(m->space);
  m->numerical_energy += start->made;
  if (m->method->restores_grid) m->space->present = PETSC_FALSE; /* points tell the nodes again */
  else {
    PetscCall(PetscArraycpy(m->nodes->v, m->nodes->v_start, dofs));
    PetscCall(PetscArraycpy(m->nodes->a, m->nodes->a_start, dofs));
    PetscCall(PetscArraycpy(m->nodes->echo, m->nodes->echo_start, dofs));
  }
  if (!report->newton.interrupted) PetscFunctionReturn(0);
  m->control = start->control;
  m->cuts = start->cuts;
  m->total_iterations = start->iterations;
  m->tries = start->tries;
  newton_forget(m->newton, m->system, &start->newton);
  report->outcome = STEP_INTERRUPTED;
  PetscFunctionReturn(0);
}
