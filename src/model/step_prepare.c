/* What a step starts with: who is held, what is prescribed and loaded, and history. */
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
    .symmetric = m->symmetric,
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

void mark_fixed(Model *m)
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
  const PetscBool dynamic = m->c->analysis.type == ANALYSIS_DYNAMIC;

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
static PetscReal node_stiffness(const Model *m, PetscReal inertia)
{
  const PetscReal h = m->grid->smallest, area = m->dim == 3 ? h * h : h;
  PetscReal scale = 0;
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    scale = PetscMax(scale, m->materials[i].wave_modulus * area / h + inertia * m->materials[i].density * area * h);
  return scale;
}

/* Force at a node that the last digits of the coordinates stand for, with a margin for what laws and sums lose themselves. */
static PetscReal round_off_of(const Model *m, PetscReal inertia)
{
  PetscReal size = 0;
  for (PetscInt d = 0; d < m->dim; ++d)
    size = PetscMax(size, PetscMax(PetscAbsReal(m->grid->min[d]), PetscAbsReal(m->grid->max[d])));
  return 100 * PETSC_MACHINE_EPSILON * size * node_stiffness(m, inertia);
}

PetscErrorCode PrepareStep(Model *m, PetscReal dt, StepProblem *p)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  const PetscBool dynamic = m->c->analysis.type == ANALYSIS_DYNAMIC;
  const Newmark newmark = newmark_of(&m->c->analysis, dt);
  PetscReal g[3];

  PetscFunctionBeginUser;
  gravity_at(m->c, m->time + dt, g);
  PetscCall(PetscArrayzero(m->prescribed, dofs));
  boundary_increments(m->boundary, m->grid, m->time, m->time + dt, m->prescribed);
  if (dynamic) set_boundary_kinematics(m, dt);
  if (dynamic) PetscCall(HoldConstraints(m, dt));
  for (PetscInt node = 0; node < m->grid->n_nodes; ++node) {
    if (!m->stage->touched[node] || (m->grid->cloud && cloud_is_twin(m->grid, node))) continue;
    for (PetscInt d = 0, i = node * dim; d < dim; ++d, ++i) {
      m->history[i] = (dynamic ? newmark_history(&newmark, m->stage->v[i], m->stage->a[i]) : 0) - g[d];
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
  p->in.half = m->symmetric && !m->stage->support->n_runs;
  p->round_off = round_off_of(m, p->in.inertia);
  if (m->stage->constraints) m->stage->constraints->scale = node_stiffness(m, p->in.inertia);
  PetscCall(ForceScales(m, g, dt, &p->weight, &p->inertia));
  PetscFunctionReturn(0);
}
