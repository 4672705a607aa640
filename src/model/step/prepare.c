/* What a step starts with: who is held, what is prescribed and loaded, and history. */
#include "model/model_private.h"

/* cells that a wave crosses in a step of stiff matter: with fewer all converges by itself, with more the nodes that
 * are settled by themselves cost more time than shorter steps */
#define STIFF_WAVES 10
#define TOO_STIFF_WAVES 60

WeakFormInput weak_form_of(const Model *m, PetscReal inertia)
{
  return (WeakFormInput){
    .kinematics = m->c->kinematics,
    .points = m->points,
    .support = m->space->support,
    .materials = m->materials,
    .x = m->grid->x,
    .du = m->nodes->du,
    .history = m->nodes->history,
    .inertia = inertia,
    .symmetric = m->symmetric,
    .lumping = m->space->lumping,
    .soft = m->space->soft,
    .lattice = m->space->basis->domains,
    .tie = m->space->tie,
    .carried = !m->method->restores_grid,
    .pressure = m->nodes->scaled_pressure,
    .pressure_scale = m->pressure_scale,
    .alpha = m->c->mixed.stabilisation,
    .gravity = m->gravity,
    .weighs = m->weighs,
    .pressure_tie = m->space->pressure_tie,
    .cell_node = m->grid->cell_node,
  };
}

void pressure_guess(const Model *m)
{
  for (PetscInt node = 0; m->nodes->scaled_pressure && node < m->grid->n_nodes; ++node)
    m->nodes->scaled_pressure[node] = m->nodes->pressure[node] / m->pressure_scale;
}

void mark_fixed(Model *m)
{
  NodalFields *n = m->nodes;
  for (PetscInt node = 0, i = 0; node < m->grid->n_nodes; ++node) {
    n->idle[node] = !n->touched[node];
    for (PetscInt d = 0; d < m->dim; ++d, ++i) {
      const PetscBool held = (m->boundary->fixed[i] | n->idle[node]) != 0;
      n->fixed[i] = (held && n->dof[i] != DOF_RELEASED) || n->dof[i] == DOF_UNUSED;
    }
  }
}

PetscErrorCode ModelRoom(Model *m, PetscReal *made)
{
  PetscReal local;

  PetscFunctionBeginUser;
  *made = 0;
  if (!m->c->stabilisation.room) PetscFunctionReturn(0);
  PetscCall(DiscretisationRoom(m->space, m->formulation->cells, &local));
  PetscCall(MPIU_Allreduce(&local, made, 1, MPIU_REAL, MPI_SUM, m->comm));
  m->numerical_energy -= *made;
  PetscFunctionReturn(0);
}

PetscErrorCode PrepareUnknowns(Model *m, StepStart *start, StepReport *report)
{
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  PetscCall(ModelBalance(m, report));
  PetscCall(PhaseEnd(m->seconds, PHASE_REPARTITION, &clock));
  PetscCall(ModelActivate(m));
  m->system->frames = &m->boundary->frames;
  mark_fixed(m);
  PetscCall(UnheldHold(m));
  PetscCall(StepStartKeep(m, start));
  PetscCall(ModelRoom(m, &start->made)); /* points learn of it when they have their ranks */
  if (m->method->begin && m->scheme->inertia) PetscCall(m->method->begin(m->space));
  PetscCall(PetscArraycpy(m->nodes->v_first, m->nodes->v, m->grid->n_nodes * m->dim));
  PetscCall(PetscArraycpy(m->nodes->a_first, m->nodes->a, m->grid->n_nodes * m->dim));
  PetscCall(PhaseEnd(m->seconds, PHASE_PATTERN, &clock));
  PetscFunctionReturn(0);
}

/* Of the larger speed: what is prescribed jumps by more, and not by what Newmark's formulas are off. */
#define JUMP 1e-2

PetscErrorCode PrescribedStart(const Model *m, PetscReal dt, PetscReal *v, PetscReal *a)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  PetscReal *half, *whole;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(dofs, &half, dofs, &whole));
  boundary_increments(m->boundary, m->grid, m->time, m->time + dt / 2, half);
  boundary_increments(m->boundary, m->grid, m->time, m->time + dt, whole);
  for (PetscInt i = 0; i < dofs; ++i) {
    v[i] = (4 * half[i] - whole[i]) / dt;
    a[i] = 4 * (whole[i] - 2 * half[i]) / PetscSqr(dt);
  }
  PetscCall(PetscFree2(half, whole));
  PetscFunctionReturn(0);
}

/* What is prescribed moves so from the start of the step on: as the parabola through the middle and the end of it does.
 * Where the grid is restored a node's velocity comes from the points that hit it, which would ring for ever in
 * Newmark's formulas. A mesh that moves with the body keeps its own history, but where what is prescribed jumps (anew:
 * everywhere), which would ring likewise. */
static PetscErrorCode StartPrescribed(Model *m, PetscReal dt, PetscBool anew)
{
  NodalFields *n = m->nodes;
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  const PetscBool kept = (PetscBool)(anew && m->c->analysis.keep_velocity);
  PetscReal *v, *a, *motion[] = {n->v, n->a, n->v_points};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(dofs, &v, dofs, &a));
  PetscCall(PrescribedStart(m, dt, v, a));
  for (int k = 0; k < 3; ++k) frames_turn(&m->boundary->frames, m->dim, motion[k]);
  for (PetscInt i = 0; i < dofs; ++i) {
    const PetscReal fastest = PetscMax(PetscAbsReal(v[i]), PetscAbsReal(n->v[i]));
    if (!m->boundary->fixed[i] || !n->fixed[i]) continue;
    if (!anew && PetscAbsReal(v[i] - n->v[i]) <= JUMP * fastest) continue;
    n->v[i] = v[i];
    n->a[i] = a[i];
    if (kept) n->v_points[i] = v[i];
  }
  for (int k = 0; k < 3; ++k) frames_turn(&m->boundary->frames, m->dim, motion[k]);
  PetscCall(PetscFree2(v, a));
  PetscFunctionReturn(0);
}

/* A constraint on displacements lets the velocity of the field ring about the prescribed one, as
 * Newmark's formulas do at any node that is stopped. So the coefficients of constrained nodes start
 * each step with the prescribed motion and its acceleration. */
static PetscErrorCode HoldConstraints(Model *m, PetscReal dt)
{
  NodalFields *n = m->nodes;
  const Constraints *c = m->space->constraints;
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  PetscReal *v, *a, *correction;

  PetscFunctionBeginUser;
  if (!m->n_constraints) PetscFunctionReturn(0);
  PetscCall(PetscCalloc3(dofs, &correction, dofs, &v, dofs, &a));
  PetscCall(PrescribedStart(m, dt, v, a));
  for (int sweep = 0; sweep < 20; ++sweep) {
    constraints_relax(c, m->boundary->fixed, v, n->v, correction);
    constraints_relax(c, m->boundary->fixed, a, n->a, correction);
    PetscCall(GridToGhosts(m->grid, m->dim, n->v));
    PetscCall(GridToGhosts(m->grid, m->dim, n->a));
  }
  PetscCall(PetscFree3(correction, v, a));
  PetscFunctionReturn(0);
}

PetscErrorCode ForceScales(const Model *m, const PetscReal *g, PetscReal dt, StepProblem *p)
{
  const NodalFields *n = m->nodes;
  PetscReal local[3] = {0, 0, 0}, sum[3];

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    const PetscReal mass = n->mass[node], *w = frame_of(&m->boundary->frames, node);
    PetscReal pull[3] = {g[0], g[1], g[2]};
    if (mass == 0) continue;
    if (w) frame_turn(m->dim, w, pull);
    for (PetscInt d = 0, i = node * m->dim; d < m->dim; ++d, ++i) {
      const PetscReal stop = m->scheme->inertia ? mass * n->v[i] / dt : 0;
      const PetscReal going = m->scheme->inertia ? mass * n->a[i] : 0;
      if (!n->fixed[i]) local[0] += mass * pull[d] * mass * pull[d];
      local[1] += stop * stop;
      local[2] += going * going;
    }
  }
  PetscCall(MPIU_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  p->weight = PetscSqrtReal(sum[0]);
  p->inertia = PetscSqrtReal(sum[1]);
  p->motion = PetscSqrtReal(sum[2]);
  PetscFunctionReturn(0);
}

/* Stiffness of one node, of the outermost ring: multipliers over it are displacements, gaps times
 * it are forces. */
static PetscReal node_stiffness(const Model *m, PetscReal inertia)
{
  const PetscReal h = m->grid->smallest;
  const PetscReal area = m->dim == 3 ? h * h : h * kinematics_weight(m->c->kinematics, m->grid->max[0]);
  PetscReal scale = 0;
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    scale = PetscMax(scale, m->materials[i].wave_modulus * area / h + inertia * m->materials[i].density * area * h);
  return scale;
}

/* Force at a node that the last digits of the coordinates stand for, with a margin for what laws
 * and sums lose themselves. */
static PetscReal round_off_of(const Model *m, PetscReal inertia)
{
  PetscReal size = 0;
  for (PetscInt d = 0; d < m->dim; ++d)
    size = PetscMax(size, PetscMax(PetscAbsReal(m->grid->min[d]), PetscAbsReal(m->grid->max[d])));
  return 100 * PETSC_MACHINE_EPSILON * size * node_stiffness(m, inertia);
}

/* What balances the forces besides inertia times du: over the mass, and with gravity. */
static void set_history(Model *m, PetscReal dt, const PetscReal *g)
{
  const AnalysisSpec *analysis = &m->c->analysis;
  const TimeWeights w = m->scheme->weights(analysis, dt);
  const PetscReal solved = time_solved(m->scheme);
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  NodalFields *n = m->nodes;
  for (PetscInt i = 0; i < dofs; ++i) n->du[i] = 0;
  m->scheme->end(analysis, dt, dofs, n->du, n->v, n->a, n->v1, n->a1);
  for (PetscInt node = 0; node < m->grid->n_nodes; ++node) {
    if (!node_moves(m, node)) continue;
    for (PetscInt d = 0, i = node * dim; d < dim; ++d, ++i) {
      const PetscReal v = n->v[i] + solved * (n->v1[i] - n->v[i]);
      n->history[i] = (1 - w.lag) * n->a1[i] + w.lag * n->a[i] + analysis->damping * v - g[d];
    }
  }
}

PetscBool model_is_pressed(const Model *m)
{
  const AnalysisSpec *analysis = &m->c->analysis;
  return analysis->type == ANALYSIS_LIMIT && analysis->limit.kind == RAISE_BOUNDARY;
}

/* Does stiffness decide how Newton's method goes (StepProblem.stiff)? Points at the edge of what is pressed, which bear
 * next to nothing, open and close as those of stiff matter do, and nothing has inertia. */
static PetscBool is_stiff(const Model *m, PetscReal dt)
{
  if (m->dim != 2 || !materials_yield(m->c->n_materials, m->materials)) return PETSC_FALSE;
  const PetscReal waves = m->courant_speed * dt / m->grid->smallest;
  const PetscBool crossed = waves > STIFF_WAVES && waves < TOO_STIFF_WAVES;
  return model_is_pressed(m) || (m->scheme->inertia && m->method->restores_grid && crossed);
}

/* Pressures bear a caller's body force as they bear the weight. */
static PetscErrorCode AskPull(Model *m, const NodalScene *scene)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->pull));
  if (!m->body_force || !m->formulation->pressure) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(3 * (size_t)m->points->n + 1, &m->pull));
  PetscCall(BodyForceAsk(scene, m->pull));
  PetscFunctionReturn(0);
}

PetscErrorCode PrepareStep(Model *m, PetscReal dt, StepProblem *p)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  const TimeWeights weights = m->scheme->weights(&m->c->analysis, dt);
  const PetscReal passes = m->initial.seeking ? 0 : dt;
  const PetscReal solved = time_solved(m->scheme), t = m->time + solved * passes;
  const PetscReal inertia = time_inertia(&weights, solved, m->c->analysis.damping);
  PetscReal *g = m->gravity;

  PetscFunctionBeginUser;
  m->raised.border.factor = m->raised.factor; /* a try that failed has left another one, and other velocities */
  PetscCall(PetscArraycpy(m->nodes->v, m->nodes->v_first, dofs));
  PetscCall(PetscArraycpy(m->nodes->a, m->nodes->a_first, dofs));
  gravity_at(m->c, raised_time(m, t), g);
  PetscCall(MaterialsAt(m, m->time + passes));
  PetscCall(PetscArrayzero(m->nodes->prescribed, dofs));
  boundary_increments(m->boundary, m->grid, m->time, m->time + passes, m->nodes->prescribed);
  const PetscBool anew = (PetscBool)(m->method->restores_grid || m->step == 0);
  if (m->scheme->inertia) PetscCall(StartPrescribed(m, dt, anew));
  if (m->scheme->inertia) PetscCall(HoldConstraints(m, dt));
  if (m->scheme->inertia && m->method->hold && (m->method->restores_grid || !anew))
    PetscCall(m->method->hold(m->space));
  else discretisation_impulses(m->space);
  PetscCall(ContactHold(m, dt, inertia));
  set_history(m, dt, g);
  for (PetscInt i = 0; solved != 1 && i < dofs; ++i) m->nodes->prescribed[i] *= solved;
  const NodalScene scene = nodal_scene(m, t, m->nodes->du);
  PetscCall(NodalForcesExternal(&m->forces, &scene, PETSC_FALSE, m->nodes->external));
  PetscCall(AskPull(m, &scene));
  frames_turn(&m->boundary->frames, m->dim, m->nodes->external);
  *p = (StepProblem){
    .grid = m->grid,
    .system = m->system,
    .formulation = m->formulation,
    .forces = &m->forces,
    .scene = scene,
    .in = weak_form_of(m, inertia),
    .fixed = m->nodes->fixed,
    .prescribed = m->nodes->prescribed,
    .external = m->nodes->external,
    .du = m->nodes->du,
    .force = m->nodes->force,
    .pressure = m->nodes->scaled_pressure,
    .volume = m->nodes->volume,
    .idle = m->nodes->idle,
    .asked = m->asked,
    .stiff = is_stiff(m, dt),
    .weaker = m->strength.trying,
    .wide = m->space->basis->nodes != BASIS_OF_CELLS,
  };
  p->in.middle = m->scheme->middle;
  p->in.pull = m->pull;
  p->in.half = m->symmetric && !m->space->support->n_runs;
  p->round_off = round_off_of(m, inertia);
  m->space->constraints->scale = node_stiffness(m, inertia);
  PetscCall(ForceScales(m, g, dt, p));
  PetscCall(EquilibriumPrepare(m, p));
  PetscCall(RaisedPrepare(m, dt, p));
  PetscFunctionReturn(0);
}
