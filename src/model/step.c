/* One step: nodal kinematics, boundary and loads, Newton, acceptance; halved until it converges. */
#include "model/model_private.h"

WeakFormInput weak_form_of(const Model *m, PetscReal inertia)
{
  return (WeakFormInput){
    .kinematics = m->c->kinematics,
    .points = m->points,
    .support = m->stage->support,
    .materials = m->materials,
    .du = m->du,
    .history = m->history,
    .inertia = inertia,
    .lumping = m->stage->lumping,
    .soft = m->stage->soft,
    .tie = m->stage->tie,
    .fixed = m->fixed,
    .pressure = m->pressure,
    .pressure_scale = m->pressure_scale,
    .alpha = m->c->mixed.stabilisation,
    .pressure_tie = m->stage->pressure_tie,
  };
}

void pressure_guess(const Model *m)
{
  for (PetscInt node = 0; m->pressure && node < m->grid->n_nodes; ++node)
    m->pressure[node] = m->stage->pressure[node] / m->pressure_scale;
}

/* Prescribed dofs, and nodes with unknowns that no material touches. */
static void mark_fixed(Model *m)
{
  const unsigned char *dof = m->stage->dof;
  for (PetscInt node = 0, i = 0; node < m->grid->n_nodes; ++node) {
    m->idle[node] = !m->stage->touched[node];
    for (PetscInt d = 0; d < m->dim; ++d, ++i) {
      m->fixed[i] = m->boundary->fixed[i] || m->idle[node];
      if (dof && dof[i] == DOF_RELEASED) m->fixed[i] = 0;
      if (dof && dof[i] == DOF_UNUSED) m->fixed[i] = 1;
    }
  }
}

/* A prescribed node moves as prescribed from the start of the step on: where the grid is restored its velocity comes from the points
 * that hit it, which would ring for ever in Newmark's formulas. A mesh that moves with the body keeps its own history. */
static void set_boundary_kinematics(Model *m, PetscReal dt)
{
  Stage *s = m->stage;
  if (!m->method->points_move && m->step > 0) return;
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) {
    if (!m->boundary->fixed[i] || !m->fixed[i]) continue;
    s->v[i] = m->prescribed[i] / dt;
    s->a[i] = 0;
    if (m->c->analysis.keep_velocity) s->v_points[i] = s->v[i];
  }
}

/* A constraint on displacements lets the velocity of the field ring about the prescribed one, as Newmark's formulas do at any node that is stopped.
 * So the coefficients of constrained nodes start each step with the prescribed motion, like prescribed nodes themselves. */
static PetscErrorCode HoldConstraints(Model *m, PetscReal dt)
{
  const Constraints *c = m->stage->constraints;
  PetscReal *correction;

  PetscFunctionBeginUser;
  if (!m->n_constraints) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &correction));
  for (int sweep = 0; sweep < 20; ++sweep) {
    constraints_relax(c, m->boundary->fixed, m->prescribed, 1 / dt, m->stage->v, correction);
    constraints_relax(c, m->boundary->fixed, m->prescribed, 0, m->stage->a, correction);
    PetscCall(GridToGhosts(m->grid, m->dim, m->stage->v));
    PetscCall(GridToGhosts(m->grid, m->dim, m->stage->a));
  }
  PetscCall(PetscFree(correction));
  PetscFunctionReturn(0);
}

/* Norms over owned nodes that material touches: gravity, and the inertia force of stopping within the step. */
static PetscErrorCode ForceScales(const Model *m, const PetscReal *g, PetscReal dt, PetscReal *weight,
                                  PetscReal *inertia)
{
  PetscReal local[2] = {0, 0}, sum[2];
  const PetscBool dynamic = m->c->analysis.type == ANALYSIS_DYNAMIC ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    const PetscReal mass = m->stage->mass[node];
    if (mass == 0) continue;
    for (PetscInt d = 0, i = node * m->dim; d < m->dim; ++d, ++i) {
      const PetscReal stop = dynamic ? mass * m->stage->v[i] / dt : 0;
      if (!m->fixed[i]) local[0] += mass * g[d] * mass * g[d];
      local[1] += stop * stop;
    }
  }
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  *weight = PetscSqrtReal(sum[0]);
  *inertia = PetscSqrtReal(sum[1]);
  PetscFunctionReturn(0);
}

PetscErrorCode AddBodyForce(const Model *m, PetscReal t, PetscReal *force)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  const Support *w = m->stage->support;
  PetscReal *sum, X[3], b[3];

  PetscFunctionBeginUser;
  if (!m->body_force) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(dofs, &sum));
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      for (PetscInt d = 0; d < dim; ++d)
        X[d] = point_real(m->points, POINT_X, p)[d] - point_real(m->points, POINT_U, p)[d];
      m->body_force(m->body_force_context, X, t, b);
      for (PetscInt i = 0; i < nn * dim; ++i)
        sum[node[i / dim] * dim + i % dim] += support_N(w, g, p)[i / dim] * m->points->real[POINT_MASS][p] * b[i % dim];
    }
  }
  PetscCall(GridSumToOwners(m->grid, dim, sum));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) force[i] += sum[i];
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

/* Stiffness of one node, about: multipliers over it are displacements, gaps times it are forces. */
static PetscReal constraint_scale(const Model *m, PetscReal inertia)
{
  const PetscReal h = m->grid->smallest, area = m->dim == 3 ? h * h : h;
  PetscReal scale = 0;
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    scale = PetscMax(scale, m->materials[i].wave_modulus * area / h + inertia * m->materials[i].density * area * h);
  return scale;
}

/* History, first guess, prescribed increments and loads for a step of dt. */
static PetscErrorCode Prepare(Model *m, PetscReal dt, StepProblem *p)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  const PetscBool dynamic = m->c->analysis.type == ANALYSIS_DYNAMIC ? PETSC_TRUE : PETSC_FALSE;
  const Newmark newmark = newmark_of(&m->c->analysis, dt);
  PetscReal g[3];

  PetscFunctionBeginUser;
  gravity_at(m->c, m->time + dt, g);
  PetscCall(PetscArrayzero(m->prescribed, dofs));
  boundary_increments(m->boundary, m->grid, m->time, m->time + dt, m->prescribed);
  if (dynamic) set_boundary_kinematics(m, dt);
  if (dynamic) PetscCall(HoldConstraints(m, dt));
  PetscCall(PetscArrayzero(m->du, dofs));
  for (PetscInt node = 0; node < m->grid->n_nodes; ++node) {
    if (!m->stage->touched[node] || (m->grid->cloud && cloud_is_twin(m->grid, node))) continue;
    for (PetscInt d = 0, i = node * dim; d < dim; ++d, ++i) {
      m->history[i] = (dynamic ? newmark_history(&newmark, m->stage->v[i], m->stage->a[i]) : 0) - g[d];
      m->du[i] = dynamic ? newmark_guess(&newmark, m->stage->v[i], m->stage->a[i]) : 0;
    }
  }
  PetscCall(PetscArrayzero(m->external, dofs));
  PetscCall(LoadsAdd(m->loads, m->grid, m->time + dt, m->stage->filled, m->stage->touched, m->external));
  PetscCall(AddBodyForce(m, m->time + dt, m->external));
  *p = (StepProblem){
    .grid = m->grid,
    .system = m->system,
    .formulation = m->formulation,
    .constraints = m->stage->constraints,
    .in = weak_form_of(m, dynamic ? newmark_inertia(&newmark) : 0),
    .fixed = m->fixed,
    .prescribed = m->prescribed,
    .external = m->external,
    .du = m->du,
    .force = m->force,
    .pressure = m->pressure,
    .volume = m->volume,
    .idle = m->idle,
    .asked = m->asked,
  };
  pressure_guess(m);
  if (m->stage->constraints) m->stage->constraints->scale = constraint_scale(m, p->in.inertia);
  PetscCall(ForceScales(m, g, dt, &p->weight, &p->inertia));
  PetscFunctionReturn(0);
}

/* Where a constraint holds a node, its multiplier is the force there. */
static void set_multipliers(Model *m)
{
  const Constraints *c = m->stage->constraints;
  for (PetscInt k = 0; c && k < c->n; ++k)
    for (PetscInt d = 0; d < m->dim; ++d)
      if (!m->fixed[c->twin[k] * m->dim + d])
        m->force[c->at[k] * m->dim + d] = c->scale * m->du[c->twin[k] * m->dim + d];
}

/* Reactions: what the balance lacks on prescribed dofs, and the impulse that stopped the points there at the start of the step. */
static void store_reactions(Model *m, PetscReal dt)
{
  const Stage *s = m->stage;
  const PetscBool dynamic = m->c->analysis.type == ANALYSIS_DYNAMIC ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    m->held[i] = m->boundary->fixed[i] ? m->force[i] : 0;
    m->reaction[i] = m->held[i];
    if (dynamic && m->boundary->fixed[i]) m->reaction[i] += s->mass[i / m->dim] * (s->v[i] - s->v_points[i]) / dt;
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
    }
  s->fade = m->c->analysis.type == ANALYSIS_DYNAMIC ? 1 - PetscExpReal(-m->c->analysis.damping * dt) : 0;
  set_multipliers(m);
  PetscCall(EnergyOfNodes(m, dt, &energy));
  store_reactions(m, dt);
  WeakFormInput in = weak_form_of(m, 0);
  PetscCall(m->formulation->commit(&in, m->points, &status));
  PetscCheck(status == LAW_OK, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a converged state could not be committed");
  for (PetscInt node = 0; m->pressure && node < m->grid->n_nodes; ++node)
    s->pressure[node] = m->pressure_scale * m->pressure[node];
  PetscCall(PhaseEnd(m->seconds, PHASE_COMMIT, &clock));
  s->prescribed = m->prescribed;
  PetscCall(m->method->convect(s, m->du));
  PetscCall(PhaseEnd(m->seconds, PHASE_MOVE, &clock));
  m->time += dt;
  ++m->step;
  PetscCall(EnergyClose(m, &energy));
  PetscCall(MeasuresRemember(m, dt));
  PetscCall(m->method->initialise(s)); /* nodal fields of the new state, for output and for the next step */
  PetscCall(PhaseEnd(m->seconds, PHASE_INITIALISE, &clock));
  report->outcome = STEP_ACCEPTED;
  report->dt = dt;
  PetscFunctionReturn(0);
}

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
  const PetscBool flows = m->method->points_move && a->type == ANALYSIS_DYNAMIC ? PETSC_TRUE : PETSC_FALSE;
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

void ModelTimes(const Model *m, PetscReal seconds[PHASE_N])
{
  for (int k = 0; k < PHASE_N; ++k) seconds[k] = m->seconds[k];
  NewtonTimes(m->newton, &seconds[PHASE_POINTS], &seconds[PHASE_MATRIX], &seconds[PHASE_LINEAR],
              &seconds[PHASE_NEWTON]);
}

/* Newton from the motion that inertia alone would bring, and if that fails from rest: where a flow starts or stops the second finds its way. */
static PetscErrorCode Solve(Model *m, PetscReal dt, const LinearProblem *linear, StepReport *report)
{
  StepProblem problem;
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  PetscCall(Prepare(m, dt, &problem));
  PetscCall(PhaseEnd(m->seconds, PHASE_PREPARE, &clock));
  for (PetscInt guess = 0; guess < (linear->dynamic ? 2 : 1); ++guess) {
    if (guess) PetscCall(PetscArrayzero(m->du, m->grid->n_nodes * m->dim));
    if (guess) pressure_guess(m);
    PetscCall(NewtonSolve(m->newton, &problem, linear, &report->newton));
    m->total_iterations += report->newton.iterations;
    if (report->newton.converged || report->newton.interrupted) break;
  }
  PetscFunctionReturn(0);
}

/* What tries of a step change although it is not accepted. */
typedef struct {
  StepControl control;
  PetscInt cuts, iterations;
  NewtonMemory newton;
  PetscReal *v, *a; /* n_nodes x dim, where constraints shift what nodes remember; else NULL */
} BeforeStep;

static PetscErrorCode Remember(const Model *m, BeforeStep *before)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  *before = (BeforeStep){.control = m->control, .cuts = m->cuts, .iterations = m->total_iterations};
  NewtonGetMemory(m->newton, m->system, &before->newton);
  if (!m->n_constraints) PetscFunctionReturn(0);
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
  NewtonForget(m->newton, m->system, &before->newton);
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
      .undetermined = m->c->mixed.stabilisation == 0 ? PETSC_TRUE : PETSC_FALSE,
      .multipliers = m->n_constraints > 0 ? PETSC_TRUE : PETSC_FALSE,
      .idle_ranks = m->system->n_active_least ? PETSC_FALSE : PETSC_TRUE,
      .dynamic = m->c->analysis.type == ANALYSIS_DYNAMIC ? PETSC_TRUE : PETSC_FALSE,
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
  PetscCall(PhaseEnd(m->seconds, PHASE_PATTERN, &clock));
  const PetscBool shortened = limit < m->control.next ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(Try(m, PetscMin(m->control.next, limit), report));
  PetscCall(Restore(m, &before, report));
  if (report->outcome != STEP_ACCEPTED) PetscFunctionReturn(0);
  PetscCall(ChooseNextStep(m, shortened && !report->cuts ? PETSC_TRUE : PETSC_FALSE, report));
  if (m->stage->n_lost && m->c->grid.outside == OUTSIDE_STOP) {
    report->outcome = STEP_POINTS_LOST;
    describe_lost(m, report);
  }
  PetscFunctionReturn(0);
}
