/* One step: Newton from one first guess after another, acceptance; halved until it converges. */
#include "model/model_private.h"

/* Where a constraint holds a node, its multiplier is the force there. */
static void set_multipliers(Model *m)
{
  const Constraints *c = m->stage->constraints;
  for (PetscInt k = 0; c && k < c->n; ++k)
    for (PetscInt d = 0; d < m->dim; ++d)
      if (!m->fixed[c->twin[k] * m->dim + d])
        m->force[c->at[k] * m->dim + d] = c->scale * m->du[c->twin[k] * m->dim + d];
}

/* Reactions: in statics what the balance lacks on prescribed dofs; in dynamics the mean over the step, so that times dt it is all momentum
 * that came from the boundary. Newmark's velocities weigh the forces of both ends, Bossak's balance gives each an echo of those before, and what
 * prescribed motion replaced of the nodes' own at the start of the step is an impulse (docs/theory.md, "Reactions"). */
static void store_reactions(Model *m, PetscReal dt)
{
  const Stage *s = m->stage;
  const AnalysisSpec *a = &m->c->analysis;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    const PetscReal mass = s->mass[i / m->dim];
    const PetscReal before = m->rate[i] + mass * (s->a[i] - s->a_points[i]);
    const PetscBool fixed = m->boundary->fixed[i] != 0;
    m->reaction[i] = m->held[i] = fixed ? m->force[i] : 0;
    if (a->type != ANALYSIS_DYNAMIC) continue;
    m->rate[i] = fixed ? (m->held[i] - a->bossak * before) / (1 - a->bossak) : 0;
    if (!fixed) continue;
    m->reaction[i] = (1 - a->gamma) * before + a->gamma * m->rate[i] + mass * (s->v[i] - s->v_points[i]) / dt;
  }
}

static PetscErrorCode Accept(Model *m, PetscReal dt, StepReport *report)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  const Newmark newmark = newmark_of(&m->c->analysis, dt);
  Stage *s = m->stage;
  LawStatus status;
  EnergyStep energy;
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  if (m->c->analysis.type == ANALYSIS_DYNAMIC)
    for (PetscInt i = 0; i < dofs; ++i) {
      s->a1[i] = newmark_acceleration(&newmark, m->du[i], s->v[i], s->a[i]);
      s->v1[i] = newmark_velocity(&newmark, s->v[i], s->a[i], s->a1[i]);
      m->echo[i] = newmark.bossak * (s->a1[i] - s->a[i]);
    }
  s->fade = m->c->analysis.type == ANALYSIS_DYNAMIC ? 1 - PetscExpReal(-m->c->analysis.damping * dt) : 0;
  set_multipliers(m);
  PetscCall(EnergyOfNodes(m, dt, &energy));
  store_reactions(m, dt);
  PetscCall(GuessLearn(m, dt));
  PetscCall(LimitWatch(m, dt));
  WeakFormInput in = weak_form_of(m, 0);
  PetscCall(m->formulation->commit(&in, m->points, &status));
  PetscCheck(status == LAW_OK, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a converged state could not be committed");
  for (PetscInt node = 0; m->pressure && node < m->grid->n_nodes; ++node)
    s->pressure[node] = m->pressure_scale * m->pressure[node];
  const NodalScene scene = nodal_scene(m, m->time + dt, m->du);
  PetscCall(NodalForcesCommit(&m->forces, &scene));
  PetscCall(PhaseEnd(m->seconds, PHASE_COMMIT, &clock));
  s->prescribed = m->prescribed;
  PetscCall(m->method->convect(s, m->du));
  PetscCall(PhaseEnd(m->seconds, PHASE_MOVE, &clock));
  m->time += dt;
  ++m->step;
  PetscCall(EnergyClose(m, &energy));
  PetscCall(OutsideAdd(m, report));
  PetscCall(MeasuresRemember(m, dt));
  PetscCall(m->method->initialise(s)); /* nodal fields of the new state, for output and for the next step */
  PetscCall(FollowersEnd(m));
  PetscCall(PhaseEnd(m->seconds, PHASE_INITIALISE, &clock));
  report->outcome = STEP_ACCEPTED;
  report->dt = dt;
  PetscFunctionReturn(0);
}

/* Points whose position is no number are lost under every policy, and stand first. */
static PetscBool is_somewhere(const LostPoint *l) { return !PetscIsInfOrNanReal(l->x[0] + l->x[1] + l->x[2]); }

static void describe_lost(const Model *m, StepReport *report)
{
  PetscSNPrintf(report->reason, sizeof report->reason, "%d point(s) left the grid:", (int)m->stage->n_lost);
  for (PetscInt k = 0; k < PetscMin(m->stage->n_lost, 2); ++k) {
    const LostPoint *l = &m->stage->lost[k];
    const size_t length = strlen(report->reason);
    snprintf(report->reason + length, sizeof report->reason - length,
             " point %lld at (%g, %g, %g) m with velocity (%g, %g, %g) m/s, last in cell %d, step %d;",
             (long long)l->id, (double)l->x[0], (double)l->x[1], (double)l->x[2], (double)l->v[0], (double)l->v[1],
             (double)l->v[2], (int)l->last_cell, (int)m->step);
  }
  const size_t length = strlen(report->reason);
  snprintf(report->reason + length, sizeof report->reason - length,
           " make the grid larger, or say grid: {outside: remove} or {outside: keep-on-boundary}");
}

/* The step in which the fastest point travels as far as it may; without limit where points stay in their cells. */
static PetscReal reach_of(const Model *m, PetscReal speed)
{
  const AnalysisSpec *a = &m->c->analysis;
  const PetscBool flows = m->method->points_move && a->type == ANALYSIS_DYNAMIC;
  return flows && a->travel > 0 && speed > 0 ? a->travel * m->grid->smallest / speed : PETSC_MAX_REAL;
}

static PetscErrorCode ChooseNextStep(Model *m, PetscBool shortened, const StepReport *report)
{
  PetscReal fastest = 0, speed;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *v = point_real(m->points, POINT_V, p);
    PetscReal square = 0;
    for (PetscInt d = 0; d < m->dim; ++d) square += v[d] * v[d];
    fastest = PetscMax(fastest, square);
  }
  PetscCall(MPIU_Allreduce(&fastest, &speed, 1, MPIU_REAL, MPIU_MAX, m->comm));
  const StepTaken taken = {.dt = report->dt,
                           .iterations = report->newton.iterations,
                           .shortened = shortened,
                           .reach = reach_of(m, PetscSqrtReal(speed))};
  step_control_accept(&m->control, &m->c->analysis, m->c->newton.ease, &taken);
  PetscFunctionReturn(0);
}

void model_times(const Model *m, PetscReal seconds[PHASE_N])
{
  for (int k = 0; k < PHASE_N; ++k) seconds[k] = m->seconds[k];
  newton_times(m->newton, &seconds[PHASE_POINTS], &seconds[PHASE_MATRIX], &seconds[PHASE_LINEAR],
               &seconds[PHASE_NEWTON]);
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

/* Newton from the nearest first guess, and where it fails from the others: a step is halved only if none of them leads to its solution. */
static PetscErrorCode Solve(Model *m, PetscReal dt, const LinearProblem *linear, StepReport *report)
{
  FirstGuess guess[GUESS_N];
  StepProblem problem;
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  PetscCall(PrepareStep(m, dt, &problem));
  const PetscInt guesses = guess_order(m, guess);
  for (PetscInt k = 0; k < guesses; ++k) {
    guess_make(m, guess[k], dt, m->du);
    pressure_guess(m);
    PetscCall(PhaseEnd(m->seconds, PHASE_PREPARE, &clock));
    PetscCall(NewtonSolve(m->newton, &problem, linear, &report->newton));
    if (report->newton.converged) PetscCall(JudgeStep(m, report));
    PetscCall(PetscTime(&clock));
    count_try(m, k > 0, report);
    if (report->newton.converged || report->newton.interrupted) break;
  }
  PetscFunctionReturn(0);
}

/* What tries of a step change although it is not accepted. */
typedef struct {
  StepControl control;
  PetscInt cuts, iterations;
  Tries tries;
  NewtonMemory newton;
  PetscReal *v, *a; /* n_nodes x dim, where the method or constraints shift what nodes remember; else NULL */
} BeforeStep;

static PetscErrorCode Remember(const Model *m, BeforeStep *before)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  *before = (BeforeStep){.control = m->control, .cuts = m->cuts, .iterations = m->total_iterations, .tries = m->tries};
  newton_get_memory(m->newton, m->system, &before->newton);
  if (!m->method->begin) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(dofs, &before->v, dofs, &before->a));
  PetscCall(PetscArraycpy(before->v, m->stage->v, dofs));
  PetscCall(PetscArraycpy(before->a, m->stage->a, dofs));
  PetscFunctionReturn(0);
}

/* A step that was not accepted leaves nodes as they were; one that was interrupted has never been. */
static PetscErrorCode Restore(Model *m, BeforeStep *before, StepReport *report)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  if (!report->newton.converged && before->v) {
    PetscCall(PetscArraycpy(m->stage->v, before->v, dofs));
    PetscCall(PetscArraycpy(m->stage->a, before->a, dofs));
  }
  PetscCall(PetscFree2(before->v, before->a));
  if (!report->newton.converged && m->method->points_move) PetscCall(m->method->initialise(m->stage));
  if (!report->newton.interrupted) PetscFunctionReturn(0);
  m->control = before->control;
  m->cuts = before->cuts;
  m->total_iterations = before->iterations;
  m->tries = before->tries;
  newton_forget(m->newton, m->system, &before->newton);
  report->outcome = STEP_INTERRUPTED;
  PetscFunctionReturn(0);
}

/* Steps of dt, and halves of it, until one is accepted, too small or given up. */
static PetscErrorCode Try(Model *m, PetscReal dt, StepReport *report)
{
  PetscFunctionBeginUser;
  for (;; dt = step_control_cut(&m->control, dt)) {
    const LinearProblem linear = {
      .choice = m->c->linear,
      .dim = m->dim,
      .unknowns = m->system->n_active_global * m->system->block,
      .symmetric = m->symmetric,
      .mixed = m->formulation->pressure,
      .undetermined = m->c->mixed.stabilisation == 0,
      .multipliers = m->n_constraints > 0,
      .idle_ranks = !m->system->n_active_least,
      .dynamic = m->c->analysis.type == ANALYSIS_DYNAMIC,
      .courant = m->courant_speed * dt / m->grid->smallest,
    };
    PetscCall(Solve(m, dt, &linear, report));
    if (report->newton.converged) PetscCall(Accept(m, dt, report));
    if (report->newton.converged || report->newton.interrupted) PetscFunctionReturn(0);
    ++m->cuts;
    ++report->cuts;
    if (dt / 2 < m->c->analysis.smallest) break;
  }
  report->outcome = STEP_TOO_SMALL;
  report->dt = dt;
  snprintf(report->reason, sizeof report->reason,
           "Newton did not converge with a step of %g s (%s), and half of it is less than analysis.smallest = %g s",
           (double)dt, report->newton.reason, (double)m->c->analysis.smallest);
  PetscCall(LimitDescribe(m, report));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelStep(Model *m, PetscReal limit, StepReport *report)
{
  PetscLogDouble clock;
  BeforeStep before;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  PetscCall(PetscMemzero(report, sizeof *report));
  PetscCall(ModelBalance(m, report));
  PetscCall(PhaseEnd(m->seconds, PHASE_REPARTITION, &clock));
  PetscCall(ModelActivate(m));
  if (m->method->points_move) PetscCall(BoundaryMove(m->boundary, m->grid, m->time));
  mark_fixed(m);
  PetscCall(Remember(m, &before));
  if (m->method->begin && m->c->analysis.type == ANALYSIS_DYNAMIC) PetscCall(m->method->begin(m->stage));
  PetscCall(PhaseEnd(m->seconds, PHASE_PATTERN, &clock));
  const PetscBool shortened = limit < m->control.next;
  PetscCall(Try(m, PetscMin(m->control.next, limit), report));
  PetscCall(Restore(m, &before, report));
  if (report->outcome != STEP_ACCEPTED) PetscFunctionReturn(0);
  PetscCall(ChooseNextStep(m, shortened && !report->cuts, report));
  if (m->stage->n_lost && (m->c->grid.outside == OUTSIDE_STOP || !is_somewhere(&m->stage->lost[0]))) {
    report->outcome = STEP_POINTS_LOST;
    describe_lost(m, report);
  }
  PetscFunctionReturn(0);
}
