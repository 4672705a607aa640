/* Where the energy goes: work put in, stress work, damping, and what is lost between points and
 * grid (docs/theory.md, "Energy").
 *
 * All work is taken by the trapezoidal rule between the step's start and end; where forces balance in
 * the middle of the step, that of loads and reactions is theirs there. */
#include "formulation/holding.h"
#include "material/pressure.h"
#include "model/measure/energy/mass_product.h"
#include "model/model_private.h"

static PetscReal points_kinetic(const Model *m)
{
  PetscReal sum = 0;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *v = point_real(m->points, POINT_V, p);
    for (PetscInt d = 0; d < m->dim; ++d) sum += 0.5 * m->points->real[POINT_MASS][p] * v[d] * v[d];
  }
  return sum;
}

PetscReal model_point_energy(const Model *m, PetscInt p)
{
  const Material *material = &m->materials[m->points->material[p]];
  const PetscReal *state = point_real(m->points, POINT_STATE, p);
  if (!material->law->energy) return NAN;
  if (m->formulation->pressure) return pressure_energy(material, state, m->points->real[POINT_PRESSURE][p]);
  return material->law->energy(material->parameters, state);
}

/* First points of the same material, whose energies are known together. */
static PetscInt alike(const Model *m, PetscInt first, PetscInt n)
{
  const PetscInt *material = m->points->material;
  PetscInt run = 1;
  while (run < n && material[first + run] == material[first]) ++run;
  return run;
}

void model_point_energies(const Model *m, PetscInt first, PetscInt n, PetscReal *energy)
{
  const PetscInt stride = m->points->components[POINT_STATE];
  for (PetscInt p = first, run; p < first + n; p += run, energy += run) {
    const Material *material = &m->materials[m->points->material[p]];
    const PetscReal *state = point_real(m->points, POINT_STATE, p);
    const PetscBool together = material->law->energies && !m->formulation->pressure;
    run = together ? alike(m, p, first + n - p) : 1;
    if (together) material->law->energies(material->parameters, run, stride, state, energy);
    else *energy = model_point_energy(m, p);
  }
}

static PetscReal points_elastic(const Model *m)
{
  PetscReal energy[LAW_BATCH], sum = 0;
  for (PetscInt first = 0, n; first < m->points->n; first += n) {
    n = PetscMin(LAW_BATCH, m->points->n - first);
    model_point_energies(m, first, n, energy);
    for (PetscInt k = 0; k < n; ++k) sum += m->points->real[POINT_VOLUME][first + k] * energy[k];
  }
  return sum;
}

static PetscReal points_work(const Model *m)
{
  PetscReal sum = 0;
  for (PetscInt p = 0; p < m->points->n; ++p) sum += m->points->real[POINT_WORK][p];
  return sum;
}

/* Strain that no step can tell from none: forces out of balance, up to what Newton's method may leave, over the
 * stiffness. */
#define STRAIN_OF_ROUND_OFF 1e-11
#define STRAIN_TOO_LARGE 1e-6

static PetscReal strain_unresolved(const Model *m)
{
  return PetscMax(STRAIN_OF_ROUND_OFF, PetscMin(STRAIN_TOO_LARGE, m->c->newton.residual));
}

void energy_stress(Model *m, PetscInt p)
{
  static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Material *material = &m->materials[m->points->material[p]];
  const PetscReal *old = point_real(m->points, POINT_STATE, p);
  PetscReal state[LAW_MAX_STATE], tau[6];
  PressureStress s;
  if (m->formulation->pressure) {
    pressure_update(material, material->law->update, 1, identity, m->points->real[POINT_PRESSURE] + p, old, state,
                    PETSC_FALSE, &s);
    point_set_tau(m->points, p, s.tau);
  } else {
    material->law->update(material->parameters, 1, identity, old, state, tau, NULL);
    point_set_tau(m->points, p, tau);
  }
}

PetscErrorCode EnergyStart(Model *m)
{
  PetscReal local[2] = {0, 0}, sum[2];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const Material *material = &m->materials[m->points->material[p]];
    energy_stress(m, p);
    m->points->real[POINT_WORK][p] =
      material->law->energy ? m->points->real[POINT_VOLUME][p] * model_point_energy(m, p) : 0;
    local[1] += PetscSqr(strain_unresolved(m)) * m->points->real[POINT_VOLUME][p] * material->elastic.shear;
  }
  local[0] = points_kinetic(m) + points_work(m);
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  m->most_energy = sum[0] + rigid_motion(m);
  m->start_energy = m->most_energy + rigid_away(m);
  m->least_energy = sum[1];
  PetscFunctionReturn(0);
}

/* Share of the forces that the step was solved with in its work. */
static PetscReal share_of_end(const Model *m) { return m->scheme->middle ? 1 : 0.5; }

/* What nodal forces add to gravity at both ends of the step, or twice in its middle; freed by
 * PetscFree2. NULL where there are none. */
static PetscErrorCode ForcesAtEnds(const Model *m, PetscReal dt, PetscReal **before, PetscReal **after)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  const PetscReal first = m->scheme->middle ? 0.5 : 0, last = m->scheme->middle ? 0.5 : 1;
  PetscReal *u0, *u1;

  PetscFunctionBeginUser;
  *before = *after = NULL;
  if (!m->forces.n) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(dofs, before, dofs, after));
  PetscCall(PetscMalloc2(dofs, &u0, dofs, &u1));
  for (PetscInt i = 0; i < dofs; ++i) {
    u0[i] = first * m->nodes->du[i];
    u1[i] = last * m->nodes->du[i];
  }
  const NodalScene start = nodal_scene(m, m->time + first * dt, u0), end = nodal_scene(m, m->time + last * dt, u1);
  PetscCall(NodalForcesExternal(&m->forces, &start, PETSC_TRUE, *before));
  PetscCall(NodalForcesExternal(&m->forces, &end, PETSC_TRUE, *after));
  PetscCall(PetscFree2(u0, u1));
  PetscFunctionReturn(0);
}

/* What stops points where they meet prescribed nodes acts within no time: its work is the impulse
 * times the velocity of the boundary. */
static PetscReal impulse_work(const Model *m, PetscInt i, PetscReal dt)
{
  const NodalFields *n = m->nodes;
  if (!m->scheme->inertia) return 0;
  return n->impulse[i] * n->prescribed[i] / dt;
}

/* Likewise what the acceleration that points gave a prescribed node would have been in the rate of momentum at the
 * start of the step: the boundary bears it (accept.c). */
static PetscReal lost_work(const Model *m, PetscInt i)
{
  if (!m->scheme->inertia) return 0;
  return (1 - share_of_end(m)) * m->nodes->lost_force[i] * m->nodes->prescribed[i];
}

/* Work of inertia, with the acceleration that balances the forces at both ends. */
static PetscReal inertia_work(const Model *m, PetscReal dt)
{
  const NodalFields *n = m->nodes;
  const PetscReal lag = m->scheme->weights(&m->c->analysis, dt).lag;
  const PetscReal end = share_of_end(m);
  const NodalField du = {{n->du, n->du}, {1, 0}}, a = {{n->a, n->a1}, {1 - end + 0.5 * lag, end - 0.5 * lag}};
  return mass_product(m, du, a);
}

/* What the scheme's own damping takes: work of the inertia that the forces at both ends balance, less what
 * motion gains. With Newmark's beta = 1/4, gamma = 1/2 it is nothing. mpm's nodes know of no step before. */
static PetscReal numerical_damping(const Model *m, PetscReal dt)
{
  const AnalysisSpec *a = &m->c->analysis;
  const NodalFields *n = m->nodes;
  const NodalField du = {{n->du, n->du}, {1, 0}}, echo = {{n->echo, n->echo}, {0.5, 0}};
  const NodalField mean = {{n->v, n->v1}, {0.5, 0.5}}, gain = {{n->v1, n->v}, {1, -1}};
  if (!m->scheme->inertia || m->scheme->middle) return 0;
  if (a->beta == 0.25 && a->gamma == 0.5 && m->scheme->weights(a, dt).lag == 0) return 0;
  const PetscReal before = m->method->restores_grid ? 0 : mass_product(m, du, echo);
  return inertia_work(m, dt) - before - mass_product(m, mean, gain);
}

/* Nodes that gather their motion from points start neither with the energy of the points nor with
 * the acceleration that balances the forces there. What the first takes is a difference of kinetic
 * energies; the second adds or takes the work of the forces out of balance, which is what the work
 * of all forces leaves over. `held`: work of the boundary without impulses. */
static PetscReal transfer_of_nodes(const Model *m, PetscReal dt, const EnergyStep *e, PetscReal held)
{
  const NodalFields *n = m->nodes;
  const NodalField mean = {{n->v, n->v1}, {0.5, 0.5}}, gain = {{n->v1, n->v}, {1, -1}};
  PetscReal sum = 0;
  /* |v1|^2 / 2 - |v|^2 / 2 */
  if (m->scheme->inertia) sum = points_kinetic(m) + mass_product(m, mean, gain);
  if (!m->method->restores_grid) return sum;
  if (m->scheme->inertia) sum -= inertia_work(m, dt);
  return sum + e->external + held - e->friction - e->damped + points_work(m);
}

/* What damping takes from the velocity of points beyond that of the nodes: mpm's points fade
 * towards what the nodes see of them. */
static PetscReal faded(const Model *m)
{
  const Support *w = m->space->support;
  const NodalFields *n = m->nodes;
  const PetscReal fade = m->space->fade;
  PetscReal sum = 0;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt d = 0; d < m->dim; ++d) {
        const PetscReal *N = support_N(w, g, p);
        PetscReal v = point_real(m->points, POINT_V, p)[d], unseen = v;
        for (PetscInt k = w->node_start[g]; k < w->node_start[g + 1]; ++k, ++N) {
          const PetscInt i = w->node[k] * m->dim + d;
          v += *N * (n->v1[i] - n->v_points[i]);
          unseen -= *N * n->v_points[i];
        }
        sum += m->points->real[POINT_MASS][p] * fade * unseen * (v - 0.5 * fade * unseen);
      }
  return sum;
}

/* Work against what holds nodes that points hardly reach, which grows with the increments of the step. */
static PetscReal held_work(const Model *m)
{
  const WeakFormInput in = weak_form_of(m, 0);
  return m->space->basis->domains ? holding_work(&in, m->dim) : 0;
}

/* What of that was remembered while everything rested gives back: it is no load, though it stands among them. */
static PetscErrorCode RestWork(const Model *m, PetscReal *work)
{
  const PetscInt owned = m->grid->n_owned * m->dim;
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  PetscReal *force;

  PetscFunctionBeginUser;
  *work = 0;
  for (PetscInt k = 0; k < m->forces.n; ++k) {
    const NodalForce *kind = m->forces.one[k].kind;
    if (!kind->dead || !kind->apart) continue;
    PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &force));
    const NodalOutput out = {.force = force};
    PetscCall(kind->assemble(m->forces.one[k].data, &scene, &out));
    for (PetscInt i = 0; i < owned; ++i) *work -= force[i] * m->nodes->du[i];
    PetscCall(PetscFree(force));
  }
  PetscFunctionReturn(0);
}

/* What forces out of balance, as the step left them, may have done: whatever the sign, or the way that they turned with
 * their node. Where a constraint holds a node its force is the reaction by now (accept.c), and nothing is open. */
static PetscReal open_work(const Model *m)
{
  const NodalFields *n = m->nodes;
  PetscReal sum = 0;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    PetscReal force = 0, way = 0;
    if (!n->touched[node]) continue;
    for (PetscInt d = 0, i = node * m->dim; d < m->dim; ++d, ++i) {
      if (!n->fixed[i] && !m->boundary->fixed[i]) force += PetscSqr(n->force[i]);
      way += PetscSqr(n->du[i]);
    }
    sum += PetscSqrtReal(force * way);
  }
  return sum;
}

PetscErrorCode EnergyOfNodes(Model *m, PetscReal dt, EnergyStep *e)
{
  const PetscReal damping = model_damping(m);
  const NodalFields *n = m->nodes;
  const PetscReal end = share_of_end(m);
  const ContactWork contact = contact_work(m, dt);
  PetscReal g0[3], g1[3], *before, *after, held = 0, impulse = 0, unbalanced = 0, rest;

  PetscFunctionBeginUser;
  *e = (EnergyStep){0};
  PetscCall(ForcesAtEnds(m, dt, &before, &after));
  gravity_at(m->c, raised_time(m, m->time + (m->scheme->middle ? 0.5 : 0) * dt), g0);
  gravity_at(m->c, raised_time(m, m->time + time_solved(m->scheme) * dt), g1);
  for (PetscInt node = 0, i = 0; node < m->grid->n_owned; ++node)
    for (PetscInt d = 0; d < m->dim; ++d, ++i) {
      const PetscReal more = before ? before[i] + after[i] : 0;
      e->external += 0.5 * (n->mass[node] * (g0[d] + g1[d]) + more) * n->du[i];
      /* what a place that moves has let go it held at the start (let_go.c) */
      if (!m->boundary->fixed[i] && m->let_go && m->scheme->inertia) held += (1 - end) * n->held[i] * n->du[i];
      if (!m->boundary->fixed[i]) continue;
      held += ((1 - end) * n->held[i] + end * n->force[i]) * n->prescribed[i];
      impulse += impulse_work(m, i, dt) + lost_work(m, i);
    }
  PetscCall(UnbalancedWork(m, dt, g0, before, &unbalanced));
  if (!m->method->restores_grid) unbalanced -= contact.start;
  PetscCall(PetscFree2(before, after));
  if (damping > 0) {
    const NodalField du = {{n->du, n->du}, {1, 0}}, mean = {{n->v, n->v1}, {0.5, 0.5}};
    e->damped = damping * mass_product(m, du, mean);
  }
  PetscCall(RestWork(m, &rest));
  e->external -= rest;
  e->held = held_work(m) - rest;
  e->open = open_work(m);
  e->friction = contact.sliding;
  held += contact.moving;
  e->boundary = held + impulse - contact.rigid;
  e->transfer = impulse - unbalanced + transfer_of_nodes(m, dt, e, held);
  e->transfer -= m->method->restores_grid ? contact.more : contact.closing;
  e->numerical = numerical_damping(m, dt) + contact.more;
  if (m->method->restores_grid && m->space->fade > 0) {
    const PetscReal more = faded(m);
    e->damped += more;
    e->transfer -= more;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode EnergyClose(Model *m, EnergyStep *e)
{
  const OutsideTally *gone = &m->points->outside;
  PetscReal local[8], sum[8];

  PetscFunctionBeginUser;
  if (m->scheme->inertia) e->transfer -= points_kinetic(m) + gone->kinetic;
  /* of the step: what is gone counts apart */
  if (m->method->restores_grid) e->transfer -= points_work(m) + gone->work;
  local[0] = e->external, local[1] = e->boundary, local[2] = e->damped, local[3] = e->transfer;
  local[4] = e->friction, local[5] = e->numerical, local[6] = e->held, local[7] = e->open;
  PetscCall(MPIU_Allreduce(local, sum, 8, MPIU_REAL, MPI_SUM, m->comm));
  m->external_work += sum[0];
  m->boundary_work += sum[1];
  m->damped_energy += sum[2];
  m->transfer_energy += sum[3] + rigid_lost(m);
  m->friction_energy += sum[4];
  m->numerical_energy += sum[5];
  m->held_energy += sum[6];
  m->open_energy += sum[7];
  energy_note_most(m);
  PetscFunctionReturn(0);
}

PetscReal energy_at_start(const Model *m) { return m->start_energy - rigid_away(m); }

void energy_note_most(Model *m)
{
  const PetscReal all = energy_at_start(m) + m->external_work + m->boundary_work + rigid_work(m);
  m->most_energy = PetscMax(m->most_energy, all);
}

void energy_of_points(const Model *m, PetscReal energy[2])
{
  energy[0] = points_kinetic(m);
  energy[1] = points_work(m);
}

PetscReal energy_unresolved(const Model *m)
{
  return m->least_energy + m->open_energy + contact_unresolved(m->contact, m->grid->smallest);
}

PetscErrorCode ModelEnergies(Model *m, Energies *e)
{
  PetscReal local[3] = {points_kinetic(m), points_elastic(m), points_work(m)}, sum[3];

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  *e = (Energies){.kinetic = sum[0] + rigid_motion(m),
                  .elastic = sum[1],
                  .dissipated = sum[2] - sum[1],
                  .external = m->external_work + rigid_work(m),
                  .boundary = m->boundary_work,
                  .damped = m->damped_energy,
                  .transfer = m->transfer_energy,
                  .friction = m->friction_energy,
                  .numerical = m->numerical_energy,
                  .held = m->held_energy,
                  .outside = m->outside.energy,
                  .start = energy_at_start(m)};
  PetscFunctionReturn(0);
}
