/* Where the energy goes: work put in, stress work, damping, and what is lost between points and grid (docs/theory.md, "Energy").
 *
 * All work is taken by the trapezoidal rule between the step's start and end. */
#include "material/pressure.h"
#include "model/model_private.h"

/* Sum of two nodal arrays with factors: one pass over the points then serves two products. */
typedef struct {
  const PetscReal *x[2];
  PetscReal factor[2];
} NodalField;

/* Dimension and nodes of a cell are constants at each call below, so that the inner loops unroll; fixed_nn 0: each group has its own. */
#define UNROLLED static inline __attribute__((always_inline))

/* The part of u M w that ties the nodes of one cell together: their deviations from the mean. */
UNROLLED PetscReal tied_product(const PetscInt dim, const PetscInt nn, const PetscReal *u, const PetscReal *w)
{
  PetscReal sum = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal u_mean = 0;
    for (PetscInt I = 0; I < nn; ++I) u_mean += u[I * dim + d] / (PetscReal)nn;
    for (PetscInt I = 0; I < nn; ++I) sum += (u[I * dim + d] - u_mean) * w[I * dim + d];
  }
  return sum;
}

UNROLLED PetscReal product_sized(const PetscInt dim, const PetscInt fixed_nn, const Model *m, const NodalField *u,
                                 const NodalField *w)
{
  const Support *support = m->stage->support;
  PetscReal sum = 0;
  for (PetscInt g = 0; g < support->n_groups; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(support, g), *node = support->node + support->node_start[g];
    const PetscReal lumped = m->stage->lumping ? m->stage->lumping[g] : 0;
    PetscReal at_node[CLOUD_MAX_NODES], un[3 * CLOUD_MAX_NODES], wn[3 * CLOUD_MAX_NODES];
    for (PetscInt I = 0; I < nn; ++I) {
      at_node[I] = 0;
      for (PetscInt d = 0, k = I * dim, i = node[I] * dim; d < dim; ++d, ++k, ++i) {
        un[k] = u->factor[0] * u->x[0][i] + u->factor[1] * u->x[1][i];
        wn[k] = w->factor[0] * w->x[0][i] + w->factor[1] * w->x[1][i];
        at_node[I] += un[k] * wn[k];
      }
    }
    if (m->stage->tie && m->stage->tie[g] > 0) sum += m->stage->tie[g] * tied_product(dim, nn, un, wn);
    for (PetscInt p = support->point_start[g]; p < support->point_start[g + 1]; ++p) {
      const PetscReal *N = support->N + support->value_start[g] + (p - support->point_start[g]) * nn;
      PetscReal uh[3] = {0, 0, 0}, wh[3] = {0, 0, 0}, nodes = 0;
      for (PetscInt I = 0; I < nn; ++I) {
        nodes += N[I] * at_node[I];
        for (PetscInt d = 0; d < dim; ++d) {
          uh[d] += N[I] * un[I * dim + d];
          wh[d] += N[I] * wn[I * dim + d];
        }
      }
      sum += m->points->real[POINT_MASS][p] *
             ((1 - lumped) * (uh[0] * wh[0] + uh[1] * wh[1] + uh[2] * wh[2]) + lumped * nodes);
    }
  }
  return sum;
}

/* The sum u M w over this rank's points, with the mass matrix of the step: cells that are not full have part of it lumped, and are tied. */
static PetscReal mass_product(const Model *m, NodalField u, NodalField w)
{
  const PetscInt dim = m->dim, nn = m->stage->support->uniform;
  if (dim == 2 && nn == 4) return product_sized(2, 4, m, &u, &w);
  if (dim == 3 && nn == 8) return product_sized(3, 8, m, &u, &w);
  return product_sized(dim, nn, m, &u, &w);
}

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
  if (m->pressure) return pressure_energy(material, state, m->points->real[POINT_PRESSURE][p]);
  return material->law->energy(material->parameters, state);
}

static PetscReal points_work(const Model *m)
{
  PetscReal sum = 0;
  for (PetscInt p = 0; p < m->points->n; ++p) sum += m->points->real[POINT_WORK][p];
  return sum;
}

#define STRAIN_OF_ROUND_OFF 1e-11

PetscErrorCode EnergyStart(Model *m)
{
  static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal state[LAW_MAX_STATE], tau[6], local[2] = {0, 0}, sum[2];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const Material *material = &m->materials[m->points->material[p]];
    const PetscReal *old = point_real(m->points, POINT_STATE, p);
    if (m->pressure) {
      PressureStress s;
      pressure_update(material, 1, identity, m->points->real[POINT_PRESSURE] + p, old, state, PETSC_FALSE, &s);
      point_set_tau(m->points, p, s.tau);
    } else {
      material->law->update(material->parameters, 1, identity, old, state, tau, NULL);
      point_set_tau(m->points, p, tau);
    }
    m->points->real[POINT_WORK][p] = m->points->real[POINT_VOLUME][p] * model_point_energy(m, p);
    local[1] += PetscSqr(STRAIN_OF_ROUND_OFF) * m->points->real[POINT_VOLUME][p] * material->elastic.shear;
  }
  local[0] = points_kinetic(m) + points_work(m);
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  m->start_energy = m->most_energy = sum[0];
  m->least_energy = sum[1];
  PetscFunctionReturn(0);
}

/* Dead forces at the nodes at the step's start: the same places, another time. */
static PetscErrorCode ForcesBefore(const Model *m, PetscReal **force)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, force));
  if (m->c->n_loads) PetscCall(LoadsAdd(m->loads, m->grid, m->time, m->stage->filled, m->stage->touched, *force));
  PetscCall(AddBodyForce(m, m->time, *force));
  PetscFunctionReturn(0);
}

/* What stops points where they meet prescribed nodes acts within no time: its work is the impulse times the velocity of the boundary. */
static PetscReal impulse_work(const Model *m, PetscInt i, PetscReal dt)
{
  const Stage *s = m->stage;
  if (m->c->analysis.type != ANALYSIS_DYNAMIC) return 0;
  return s->mass[i / m->dim] * (s->v[i] - s->v_points[i]) * m->prescribed[i] / dt;
}

/* Work of inertia, with Newmark's effective acceleration at both ends. */
static PetscReal inertia_work(const Model *m)
{
  const Stage *s = m->stage;
  const PetscReal alpha = m->c->analysis.bossak;
  const NodalField du = {{m->du, m->du}, {1, 0}}, a = {{s->a, s->a1}, {0.5 * (1 + alpha), 0.5 * (1 - alpha)}};
  return mass_product(m, du, a);
}

/* Where clouds are new in every step, what balanced the forces at the end of the last one no longer does in these: the work of what is out of
 * balance, by the trapezoidal rule. `external`: of nodes at the step's start. */
static PetscErrorCode OutOfBalance(const Model *m, const PetscReal *g, const PetscReal *external, PetscReal *work)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  const PetscBool dynamic = m->c->analysis.type == ANALYSIS_DYNAMIC;
  const PetscReal damping = m->c->analysis.damping;
  const Stage *s = m->stage;
  WeakFormInput in = weak_form_of(m, 0);
  PetscReal *zero, *force, *history;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(dofs, &zero, dofs, &force, dofs, &history));
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i)
    if (s->touched[i / m->dim] && !cloud_is_twin(m->grid, i / m->dim))
      history[i] = (dynamic ? s->a[i] - m->echo[i] + damping * s->v[i] : 0) - g[i % m->dim];
  PetscCall(GridToGhosts(m->grid, m->dim, history));
  in.du = zero;
  in.history = history;
  WeakFormOutput out = {.force = force};
  PetscCall(m->formulation->assemble(&in, &out));
  PetscCall(GridSumToOwners(m->grid, m->dim, force));
  *work = 0;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    if (!cloud_is_twin(m->grid, i / m->dim)) *work += 0.5 * m->du[i] * (force[i] - external[i]);
    if (m->boundary->fixed[i]) *work -= 0.5 * m->prescribed[i] * m->held[i];
  }
  PetscCall(PetscFree3(zero, force, history));
  PetscFunctionReturn(0);
}

/* Nodes that gather their motion from points start neither with the energy of the points nor with the acceleration that balances the
 * forces there. What the first takes is a difference of kinetic energies; the second adds or takes the work of the forces out of balance,
 * which is what the work of all forces leaves over. `held`: work of the boundary without impulses. */
static PetscReal transfer_of_nodes(const Model *m, const EnergyStep *e, PetscReal held)
{
  const Stage *s = m->stage;
  const NodalField mean = {{s->v, s->v1}, {0.5, 0.5}}, gain = {{s->v1, s->v}, {1, -1}};
  PetscReal sum = 0;
  if (m->c->analysis.type == ANALYSIS_DYNAMIC)
    sum = points_kinetic(m) + mass_product(m, mean, gain); /* |v1|^2 / 2 - |v|^2 / 2 */
  if (!m->method->points_move) return sum;
  if (m->c->analysis.type == ANALYSIS_DYNAMIC) sum -= inertia_work(m);
  return sum + e->external + held - e->damped + points_work(m);
}

/* What damping takes from the velocity of points beyond that of the nodes: mpm's points fade towards what the nodes see of them. */
static PetscReal faded(const Model *m)
{
  const Stage *s = m->stage;
  const Support *w = s->support;
  const PetscInt dim = m->dim;
  PetscReal sum = 0;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt d = 0; d < dim; ++d) {
        PetscReal v = point_real(m->points, POINT_V, p)[d], unseen = v;
        for (PetscInt I = 0; I < support_nodes(w, g); ++I) {
          const PetscInt i = w->node[w->node_start[g] + I] * dim + d;
          v += support_N(w, g, p)[I] * (s->v1[i] - s->v_points[i]);
          unseen -= support_N(w, g, p)[I] * s->v_points[i];
        }
        sum += m->points->real[POINT_MASS][p] * s->fade * unseen * (v - 0.5 * s->fade * unseen);
      }
  return sum;
}

PetscErrorCode EnergyOfNodes(Model *m, PetscReal dt, EnergyStep *e)
{
  const PetscReal damping = m->c->analysis.type == ANALYSIS_DYNAMIC ? m->c->analysis.damping : 0;
  const Stage *s = m->stage;
  PetscReal g0[3], g1[3], *before, held = 0, impulse = 0, unbalanced = 0;

  PetscFunctionBeginUser;
  *e = (EnergyStep){0};
  PetscCall(ForcesBefore(m, &before));
  gravity_at(m->c, m->time, g0);
  gravity_at(m->c, m->time + dt, g1);
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    const PetscInt d = i % m->dim;
    e->external += 0.5 * (s->mass[i / m->dim] * (g0[d] + g1[d]) + before[i] + m->external[i]) * m->du[i];
    if (!m->boundary->fixed[i]) continue;
    held += 0.5 * (m->held[i] + m->force[i]) * m->prescribed[i];
    impulse += impulse_work(m, i, dt);
  }
  if (m->method->begin) PetscCall(OutOfBalance(m, g0, before, &unbalanced));
  PetscCall(PetscFree(before));
  if (damping > 0) {
    const NodalField du = {{m->du, m->du}, {1, 0}}, mean = {{s->v, s->v1}, {0.5, 0.5}};
    e->damped = damping * mass_product(m, du, mean);
  }
  e->boundary = held + impulse;
  e->transfer = impulse - unbalanced + transfer_of_nodes(m, e, held);
  if (m->method->points_move && s->fade > 0) {
    const PetscReal more = faded(m);
    e->damped += more;
    e->transfer -= more;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode EnergyClose(Model *m, EnergyStep *e)
{
  const OutsideTally *gone = &m->points->outside;
  PetscReal local[4], sum[4];

  PetscFunctionBeginUser;
  if (m->c->analysis.type == ANALYSIS_DYNAMIC) e->transfer -= points_kinetic(m) + gone->kinetic;
  if (m->method->points_move) e->transfer -= points_work(m) + gone->work; /* of the step: what is gone counts apart */
  local[0] = e->external, local[1] = e->boundary, local[2] = e->damped, local[3] = e->transfer;
  PetscCall(MPIU_Allreduce(local, sum, 4, MPIU_REAL, MPI_SUM, m->comm));
  m->external_work += sum[0];
  m->boundary_work += sum[1];
  m->damped_energy += sum[2];
  m->transfer_energy += sum[3];
  m->most_energy = PetscMax(m->most_energy, m->start_energy + m->external_work + m->boundary_work);
  PetscFunctionReturn(0);
}

PetscErrorCode ModelEnergies(Model *m, Energies *e)
{
  PetscReal local[3] = {points_kinetic(m), 0, points_work(m)}, sum[3];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) local[1] += m->points->real[POINT_VOLUME][p] * model_point_energy(m, p);
  PetscCall(MPIU_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  *e = (Energies){.kinetic = sum[0],
                  .elastic = sum[1],
                  .dissipated = sum[2] - sum[1],
                  .external = m->external_work,
                  .boundary = m->boundary_work,
                  .damped = m->damped_energy,
                  .transfer = m->transfer_energy,
                  .outside = m->outside.energy,
                  .start = m->start_energy};
  PetscFunctionReturn(0);
}
