/* What nodes do in a substep: balance of momentum with lumped mass, and prescribed motion. */
#include "method/extend/extend.h"
#include "model/explicit/explicit.h"
#include "model/measure/measure.h"

/* Loops over nodes are compiled for each number of axes: they are a tenth of a substep. */
#define KERNEL static inline __attribute__((always_inline))

#define HARDLY 0.003 /* of the heaviest node of a cell: less carries nothing there */

PetscErrorCode NodesShare(const Model *m, PetscInt components, PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(GridSumToOwners(m->grid, components, values));
  PetscCall(GridToGhosts(m->grid, components, values));
  PetscFunctionReturn(0);
}

/* Contact alone, or all others. */
static PetscErrorCode Begin(const Model *m, const NodalScene *scene, PetscBool contact)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->forces.n; ++k) {
    const NodalForce *kind = m->forces.one[k].kind;
    if (kind->begin && (m->forces.one[k].data == m->contact) == contact)
      PetscCall(kind->begin(m->forces.one[k].data, scene));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ForcesBegin(Model *m, Explicit *e)
{
  PetscFunctionBeginUser;
  if (!m->forces.n) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(m->nodes->du, m->grid->n_nodes * m->dim));
  NodalScene scene = nodal_scene(m, e->time, m->nodes->du);
  scene.bends = NULL; /* springs give more than that */
  if (e->box) {
    PetscCall(NearSee(m, e));
    scene.support = e->near.support;
    scene.seen = e->near.point;
  }
  PetscCall(Begin(m, &scene, PETSC_TRUE));
  PetscCall(WallsTouchSurface(m, e, &scene));
  PetscCall(WallsPush(m, e));
  PetscFunctionReturn(0);
}

static PetscReal mass_of(const Explicit *e, PetscInt node) { return e->sum[node * e->width]; }

/* A force on a node that points hardly reach throws it away, and whoever goes with it. seen: nodes of followers, NULL:
 * those of their cells. */
static void leave_out(const Model *m, const Explicit *e, const Points *followers, const Support *seen)
{
  for (PetscInt p = 0; p < followers->n && (!seen || p < seen->n_groups); ++p) {
    if (followers->cell[p] < 0) continue;
    const PetscInt nn = seen ? support_nodes(seen, p) : m->grid->nodes_per_cell;
    const PetscInt *node =
      seen ? seen->node + seen->node_start[p] : m->grid->cell_node + followers->cell[p] * m->grid->nodes_per_cell;
    PetscReal most = 0;
    for (PetscInt I = 0; I < nn; ++I) most = PetscMax(most, mass_of(e, node[I]));
    for (PetscInt I = 0; I < nn; ++I)
      if (mass_of(e, node[I]) < HARDLY * most) e->mark[node[I]] = 1;
  }
}

static PetscBool has_tracers(const Case *c)
{
  for (PetscInt k = 0; k < c->n_measures; ++k)
    if (measure_has_tracer(&c->measures[k])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Which nodes carry loads and tracers in this substep? All ranks say the same of a node. */
static PetscErrorCode Touch(Model *m, Explicit *e)
{
  PetscFunctionBeginUser;
  PetscCall(Lead(m, e));
  if (!m->c->n_loads && !has_tracers(m->c)) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < e->n_active; ++k) e->mark[e->active[k]] = 0;
  leave_out(m, e, m->loads->carriers, m->loads->support);
  leave_out(m, e, m->tracers, followers_see(m->space, m->tracers));
  PetscCall(NodesShare(m, 1, e->mark));
  for (PetscInt k = 0; k < e->n_active; ++k) {
    const PetscInt node = e->active[k];
    m->nodes->touched[node] = is_led(m, e, node) || (mass_of(e, node) > 0 && !(e->mark[node] > 0));
  }
  PetscFunctionReturn(0);
}

/* What carriers of loads see where they have come to; in laps points look for themselves. */
static PetscErrorCode Carry(Model *m)
{
  const BasisInput basis = {.spec = &m->c->basis, .grid = m->grid, .hoop = m->c->kinematics->hoop};

  PetscFunctionBeginUser;
  PetscCall(DiscretisationCarry(m->space, &basis));
  PetscFunctionReturn(0);
}

/* Forces of loads, summed over the ranks, go to those that the points gave. */
static PetscErrorCode AddLoads(Model *m, Explicit *e)
{
  NodalFields *n = m->nodes;

  PetscFunctionBeginUser;
  if (!e->loaded) PetscFunctionReturn(0);
  const NodalScene scene = nodal_scene(m, e->time, n->du);
  PetscCall(Begin(m, &scene, PETSC_FALSE));
  PetscCall(NodalForcesExternal(&m->forces, &scene, PETSC_TRUE, n->external));
  PetscCall(GridToGhosts(m->grid, m->dim, n->external));
  PetscFunctionReturn(0);
}

/* Velocities at the end of the substep, and what forces give. */
KERNEL void move(const int dim, const Model *m, const Explicit *e)
{
  const PetscReal kept = 1 - e->fade;
  for (PetscInt k = 0; k < e->n_active; ++k) {
    const PetscInt node = e->active[k];
    const PetscReal *s = e->sum + node * (1 + 2 * dim), mass = s[0], inverse = mass > 1e-300 ? 1 / mass : 0;
    PetscReal *v = e->motion + node * 2 * dim;
    for (int d = 0; d < dim; ++d) {
      const PetscReal load = mass * e->g[d] + (e->loaded ? m->nodes->external[node * dim + d] : 0);
      const PetscReal gain = e->act * inverse * (s[1 + dim + d] + load);
      v[d] = kept * inverse * s[1 + d] + gain;
      v[dim + d] = gain;
    }
  }
}

/* Velocities of what is prescribed in the next dt, < 0: in the last, s. */
static void prescribe(Model *m, Explicit *e, PetscReal dt)
{
  PetscReal *increment = m->nodes->prescribed;
  if (!e->moved && !m->boundary->field) return;
  for (PetscInt k = 0; k < e->n_held; ++k) increment[e->held[k].node * m->dim + e->held[k].axis] = 0;
  boundary_increments(m->boundary, m->grid, e->time, e->time + dt, increment);
  for (PetscInt k = 0; k < e->n_held; ++k)
    e->held[k].velocity = increment[e->held[k].node * m->dim + e->held[k].axis] / dt;
}

/* Of the substep: by its last part nodes tell how fast they go at its end, whatever corner lies before that. */
#define GLANCE 0.0625

/* Velocities of what is prescribed at this instant, which ends a substep. */
static void prescribe_now(Model *m, Explicit *e)
{
  prescribe(m, e, -GLANCE * e->before);
  for (Held *h = e->held; h < e->held + e->n_held; ++h) h->glanced = h->velocity;
  prescribe(m, e, -0.5 * GLANCE * e->before);
  if (!e->moved && !m->boundary->field) return;
  for (Held *h = e->held; h < e->held + e->n_held; ++h) h->velocity = 2 * h->velocity - h->glanced;
}

/* The component of v in the frame of the node becomes what is prescribed; returns by how much. */
static PetscReal hold(const Model *m, const Held *h, PetscReal *v, PetscReal change[3])
{
  const PetscReal *w = frame_of(&m->boundary->frames, h->node);
  for (int d = 0; d < 3; ++d) change[d] = 0;
  if (!w) {
    change[h->axis] = h->velocity - v[h->axis];
    v[h->axis] = h->velocity;
    return change[h->axis];
  }
  frame_turn(m->dim, w, v);
  change[h->axis] = h->velocity - v[h->axis];
  v[h->axis] = h->velocity;
  const PetscReal by = change[h->axis];
  frame_turn(m->dim, w, v);
  frame_turn(m->dim, w, change);
  return by;
}

/* Half of the work of loads over the substep that ends, with the forces that they have now: those of its start have
 * had the other half, so that what varies or turns meanwhile has the mean of both. The way is that of the points; where
 * they go as they are strained, held nodes go as prescribed. */
KERNEL void end_work(const int dim, Model *m, Explicit *e)
{
  PetscReal power = 0, change[3];
  for (PetscInt k = 0; k < e->n_active; ++k) {
    const PetscInt node = e->active[k];
    const PetscReal *s = e->sum + node * (1 + 2 * dim), inverse = s[0] > 1e-300 ? 1 / s[0] : 0;
    for (int d = 0; d < dim; ++d) e->motion[node * 2 * dim + d] = inverse * s[1 + d];
  }
  if (e->as_strained && e->before > 0) prescribe(m, e, -e->before);
  for (const Held *h = e->held; e->as_strained && h < e->held + e->n_held; ++h)
    (void)hold(m, h, e->motion + h->node * 2 * dim, change);
  for (PetscInt k = 0; k < e->n_active; ++k) {
    const PetscInt node = e->active[k];
    for (int d = 0; d < dim && node < m->grid->n_owned; ++d)
      power += m->nodes->external[node * dim + d] * e->motion[node * 2 * dim + d];
  }
  e->external += 0.5 * e->before * power;
}

PetscErrorCode NodesMove(Model *m, Explicit *e)
{
  PetscFunctionBeginUser;
  gravity_at(m->c, e->time, e->g);
  if (e->box && m->c->n_loads) PetscCall(Carry(m));
  PetscCall(Touch(m, e));
  PetscCall(AddLoads(m, e));
  PetscCall(SumsGive(m, e));
  if (e->loaded) PetscCall(NodesGive(m, e, m->dim, m->nodes->external));
  if (e->loaded && m->dim == 2) end_work(2, m, e);
  if (e->loaded && m->dim == 3) end_work(3, m, e);
  if (m->dim == 2) move(2, m, e);
  else move(3, m, e);
  PetscFunctionReturn(0);
}

void nodes_hold(Model *m, Explicit *e)
{
  const PetscInt dim = m->dim;
  if (e->dt > 0) prescribe(m, e, e->dt);
  else prescribe_now(m, e); /* points do not move: velocities become those of the step's end */
  for (const Held *h = e->held; h < e->held + e->n_held; ++h) {
    PetscReal *v = e->motion + h->node * 2 * dim, change[3];
    const PetscReal mass = e->sum[h->node * e->width] * e->kick / e->act; /* for the force that it takes */
    const PetscReal impulse = mass * hold(m, h, v, change);
    for (PetscInt d = 0; d < dim; ++d) v[dim + d] += change[d];
    if (h->node >= m->grid->n_owned) continue;
    for (PetscInt d = 0; d < dim; ++d) m->nodes->reaction[h->node * dim + d] += mass * change[d] / e->step;
    e->boundary += impulse * h->velocity;
  }
}

/* Momentum becomes velocity; without the second mapping strain takes that of the substep's end. */
KERNEL void strain(const int dim, const PetscBool again, Explicit *e)
{
  for (PetscInt k = 0; k < e->n_active; ++k) {
    const PetscInt node = e->active[k];
    const PetscReal mass = e->sum[node * (1 + 2 * dim)], inverse = mass > 1e-300 ? 1 / mass : 0;
    PetscReal *v = e->straining + node * dim;
    for (int d = 0; d < dim; ++d) v[d] = again ? v[d] * inverse : e->motion[node * 2 * dim + d];
  }
}

/* Work of gravity, along the way that points go: of one that changes its mean, as its impulses have it. And half of
 * that of loads, which have the rest when the substep ends. */
KERNEL void work(const int dim, const Model *m, Explicit *e)
{
  PetscReal power = 0, g[3];
  gravity_at(m->c, e->time + e->dt, g);
  for (int d = 0; d < dim; ++d) g[d] = 0.5 * (g[d] + e->g[d]);
  for (PetscInt k = 0; k < e->n_active; ++k) {
    const PetscInt node = e->active[k];
    if (node >= m->grid->n_owned) continue;
    const PetscReal mass = e->sum[node * (1 + 2 * dim)], *v = explicit_way(e, dim, node);
    for (int d = 0; d < dim; ++d)
      power += (mass * g[d] + (e->loaded ? 0.5 * m->nodes->external[node * dim + d] : 0)) * v[d];
  }
  e->external += e->dt * power;
}

PetscErrorCode NodesStrain(const Model *m, Explicit *e)
{
  const PetscInt dim = m->dim;
  const PetscBool again = m->c->analysis.update == EXPLICIT_MUSL;
  PetscReal change[3];

  PetscFunctionBeginUser;
  if (again) PetscCall(NodesShare(m, dim, e->straining));
  if (again) PetscCall(MomentumGive(m, e, e->straining));
  if (dim == 2) strain(2, again, e);
  else strain(3, again, e);
  for (const Held *h = e->held; again && h < e->held + e->n_held; ++h)
    (void)hold(m, h, e->straining + h->node * dim, change);
  if (again) PetscCall(NodesTake(m, e, dim, e->straining));
  if (dim == 2) work(2, m, e);
  else work(3, m, e);
  PetscFunctionReturn(0);
}

static PetscErrorCode Follow(Model *m, Points *followers)
{
  LostPoint *ignored;
  PetscInt n_ignored;

  PetscFunctionBeginUser;
  PetscCall(DiscretisationMoveCarried(m->space, followers));
  PetscCall(PointsRelocate(followers, m->grid, OUTSIDE_KEEP, &n_ignored, &ignored));
  PetscCall(PetscFree(ignored));
  PetscFunctionReturn(0);
}

/* Pressures stay along the normal of their surface. */
static PetscErrorCode Turn(Model *m, const Explicit *e)
{
  const NodalScene scene = nodal_scene(m, e->time, m->nodes->du);

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->forces.n; ++k)
    if (m->forces.one[k].kind == &nodal_force_pressures)
      PetscCall(nodal_force_pressures.commit(m->forces.one[k].data, &scene));
  PetscFunctionReturn(0);
}

/* `width` numbers of each node start anew. */
KERNEL void forget(const int width, const Explicit *e, PetscReal *values)
{
  for (PetscInt k = 0; k < e->n_active; ++k) {
    PetscReal *value = values + e->active[k] * width;
#pragma GCC unroll 8
    for (int i = 0; i < width; ++i) value[i] = 0;
  }
}

PetscErrorCode NodesCarry(Model *m, Explicit *e)
{
  const PetscInt dim = m->dim;
  NodalFields *n = m->nodes;
  const PetscBool tracers = has_tracers(m->c);

  PetscFunctionBeginUser;
  for (PetscInt k = 0; (tracers || m->c->n_loads) && k < e->n_active; ++k) {
    const PetscInt node = e->active[k];
    for (PetscInt d = 0, i = node * dim; d < dim; ++d, ++i) {
      n->v1[i] = e->motion[node * 2 * dim + d];
      n->a1[i] = e->motion[node * 2 * dim + dim + d] / e->act;
      n->du[i] = e->dt * explicit_way(e, dim, node)[d];
    }
  }
  PetscCall(Turn(m, e));
  if (tracers) PetscCall(Follow(m, m->tracers));
  if (m->c->n_loads) PetscCall(Follow(m, m->loads->carriers));
  if (dim == 2) forget(1 + 2 * 2, e, e->sum);
  else forget(1 + 2 * 3, e, e->sum);
  PetscFunctionReturn(0);
}

void nodes_forget(const Model *m, Explicit *e)
{
  if (m->dim == 2) forget(2, e, e->straining);
  else forget(3, e, e->straining);
}
