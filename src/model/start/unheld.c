/* analysis: {unheld: hold}. Statics of bodies that something pushes but nothing holds, in some direction or from
 * turning: the answer is known but for a rigid motion, if loads are in balance along it. Nodes are held in as few
 * directions as make it the only one, which bear nothing then (docs/theory.md, section 60). */
#include "model/start/unheld_private.h"

/* times the size of the body: the lever of a node that keeps it from turning, at least */
#define LEVER 1e-6
/* of the largest mass of a node: what has less, than a corner in space, is a poor hold */
#define ENOUGH_MASS 0.1

/* A direction of a node; strength 0: there is none. */
typedef struct {
  PetscInt axis;
  PetscReal row[RIGID], at[3]; /* at: where the node stands, m */
  PetscReal number, strength;
} Hold;

static PetscInt motions_of(const Model *m) { return m->c->kinematics->hoop ? 1 : m->dim == 3 ? 6 : 3; }

/* What each rigid motion moves the place x by along e. */
static void row_at(const Model *m, const UnheldGroup *g, const PetscReal *x, const PetscReal e[3], PetscReal row[RIGID])
{
  PetscReal r[3] = {0, 0, 0};
  for (PetscInt d = 0; d < m->dim; ++d) r[d] = (x[d] - g->centre[d]) / g->size;
  const PetscReal turns[3] = {r[1] * e[2] - r[2] * e[1], r[2] * e[0] - r[0] * e[2], r[0] * e[1] - r[1] * e[0]};
  for (PetscInt d = 0; d < g->n && d < m->dim; ++d) row[d] = g->n == 1 ? e[1] : e[d];
  for (PetscInt k = m->dim; k < g->n; ++k) row[k] = m->dim == 3 ? turns[k - 3] : turns[2];
}

void unheld_row(const Model *m, const UnheldGroup *g, PetscInt node, PetscInt axis, const PetscReal *w,
                PetscReal row[RIGID])
{
  PetscReal e[3] = {axis == 0, axis == 1, axis == 2};
  if (w) frame_turn(m->dim == 2 ? 2 : 3, w, e); /* compilers see that no more is read than is set */
  row_at(m, g, m->grid->x + node * m->dim, e, row);
}

/* Of the motions that are free: how far do they move it? */
static PetscReal strength_of(const UnheldGroup *g, const PetscReal row[RIGID], PetscReal along[RIGID])
{
  PetscReal sum = 0;
  for (PetscInt f = 0; f < g->n_free; ++f) {
    along[f] = 0;
    for (PetscInt k = 0; k < g->n; ++k) along[f] += g->free[f][k] * row[k];
    sum += along[f] * along[f];
  }
  return PetscSqrtReal(sum);
}

/* What moves along `row` is free no more: a reflection of the free motions makes it the first of them. */
static void take_away(UnheldGroup *g, const PetscReal row[RIGID])
{
  PetscReal along[RIGID] = {0}, square = 0;
  const PetscReal strength = strength_of(g, row, along);
  along[0] += along[0] < 0 ? -strength : strength;
  for (PetscInt f = 0; f < g->n_free; ++f) square += along[f] * along[f];
  for (PetscInt k = 0; k < g->n; ++k) {
    PetscReal sum = 0;
    for (PetscInt f = 0; f < g->n_free; ++f) sum += along[f] * g->free[f][k];
    for (PetscInt f = 0; f < g->n_free; ++f) g->free[f][k] -= 2 / square * along[f] * sum;
  }
  --g->n_free;
  for (PetscInt f = 0; f < g->n_free; ++f)
    for (PetscInt k = 0; k < g->n; ++k) g->free[f][k] = g->free[f + 1][k];
}

/* A number that no other direction of no other node has, the same on every rank and for any number of them. */
static PetscReal number_of(const Model *m, const UnheldGroup *g, PetscInt node, PetscInt axis)
{
  const PetscReal weight[3] = {1, 0.6180339887, 0.4142135624};
  PetscReal sum = 0.1234567 * (PetscReal)axis;
  for (PetscInt d = 0; d < m->dim; ++d) sum += weight[d] * (m->grid->x[node * m->dim + d] - g->centre[d]) / g->size;
  return sum;
}

/* Directions of nodes: those that are held already, all that could be, those along an axis that could be. */
typedef enum { ALONG_X, ALONG_Y, ALONG_Z, ANY, BEFORE } Which;

static PetscBool may_be(const Model *m, const UnheldGroup *g, Which which, PetscInt node, PetscInt axis)
{
  const PetscInt i = node * m->dim + axis;
  if (!unheld_is_of(g, node)) return PETSC_FALSE;
  if (which == BEFORE) return m->boundary->fixed[i] != 0;
  return (which == ANY || which == (Which)axis) && !m->nodes->fixed[i] && m->nodes->dof[i] == DOF_USUAL &&
         !frame_of(&m->boundary->frames, node) && m->nodes->mass[node] >= ENOUGH_MASS * g->mass;
}

/* How much the node is worth, of 1. What strains along the axes then turns no body. */
static PetscReal worth_of(const Model *m, const UnheldGroup *g, PetscInt node, PetscInt axis)
{
  if (!g->has_plane[axis]) return 1;
  return 1 / (1 + 100 * PetscAbsReal(m->grid->x[node * m->dim + axis] - g->plane[axis]) / g->size);
}

/* Of those the farthest on this rank: of the strength in pass 0; in pass 1, of equals of `farthest`, the first by its
 * number. */
static void look_for(const Model *m, const UnheldGroup *g, Which which, const PetscReal *farthest, Hold *hold)
{
  PetscReal row[RIGID], along[RIGID];
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    const PetscInt node = i / m->dim, axis = i % m->dim;
    if (!may_be(m, g, which, node, axis)) continue;
    unheld_row(m, g, node, axis, frame_of(&m->boundary->frames, node), row);
    const PetscReal far = strength_of(g, row, along) * (which == BEFORE ? 1 : worth_of(m, g, node, axis));
    const PetscReal number = number_of(m, g, node, axis);
    if (!farthest) hold->strength = PetscMax(hold->strength, far);
    if (!farthest || far < (1 - 1e-6) * *farthest || number >= hold->number) continue;
    hold->number = number;
    hold->axis = axis;
    for (PetscInt d = 0; d < m->dim; ++d) hold->at[d] = m->grid->x[node * m->dim + d];
    for (PetscInt k = 0; k < g->n; ++k) hold->row[k] = row[k];
  }
}

/* The one of all ranks. */
static PetscErrorCode Strongest(const Model *m, const UnheldGroup *g, Which which, Hold *hold)
{
  PetscReal farthest, least, all[RIGID + 4] = {0}, along[RIGID];

  PetscFunctionBeginUser;
  *hold = (Hold){.number = PETSC_MAX_REAL};
  look_for(m, g, which, NULL, hold);
  PetscCall(MPIU_Allreduce(&hold->strength, &farthest, 1, MPIU_REAL, MPIU_MAX, m->comm));
  look_for(m, g, which, &farthest, hold);
  PetscCall(MPIU_Allreduce(&hold->number, &least, 1, MPIU_REAL, MPIU_MIN, m->comm));
  if (least == hold->number) { /* its owner tells the others */
    PetscCall(PetscArraycpy(all, hold->row, RIGID));
    PetscCall(PetscArraycpy(all + RIGID, hold->at, 3));
    all[RIGID + 3] = (PetscReal)hold->axis;
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, all, RIGID + 4, MPIU_REAL, MPIU_SUM, m->comm));
  PetscCall(PetscArraycpy(hold->row, all, RIGID));
  PetscCall(PetscArraycpy(hold->at, all + RIGID, 3));
  hold->axis = (PetscInt)(all[RIGID + 3] + 0.5);
  hold->strength = strength_of(g, hold->row, along);
  PetscFunctionReturn(0);
}

/* Is it this one, on a rank that may not own it? */
static PetscBool is_hold(const Model *m, const UnheldGroup *g, const Hold *hold, PetscInt node, PetscInt axis)
{
  PetscReal apart = 0;
  for (PetscInt d = 0; d < m->dim; ++d)
    apart = PetscMax(apart, PetscAbsReal(m->grid->x[node * m->dim + d] - hold->at[d]) / g->size);
  return unheld_is_of(g, node) && axis == hold->axis && apart < 1e-9;
}

/* It holds. */
static void count_in(UnheldGroup *g, const Hold *hold)
{
  if (!g->has_plane[hold->axis]) g->plane[hold->axis] = hold->at[hold->axis];
  g->has_plane[hold->axis] = PETSC_TRUE;
  take_away(g, hold->row);
}

void unheld_add_place(const Model *m, const UnheldGroup *g, const PetscReal *x, const PetscReal normal[3],
                      PetscBool rubs, PetscReal *sum)
{
  for (PetscInt d = 0; d < (rubs ? m->dim : 1); ++d) {
    const PetscReal axis[3] = {d == 0, d == 1, d == 2};
    PetscReal row[RIGID] = {0};
    row_at(m, g, x, rubs ? axis : normal, row);
    for (PetscInt k = 0; k < g->n * g->n; ++k) sum[k] += row[k / g->n] * row[k % g->n];
  }
}

/* Does it touch a wall there, or a body that is not of it? */
static PetscBool leans_on(const Contact *s, const UnheldGroup *g, const ContactPoint *c)
{
  const PetscBool own = unheld_is_of(g, s->node[c->first]);
  if (!contact_bears(c)) return PETSC_FALSE;
  return c->wall < s->n_walls ? own : (PetscBool)(own != unheld_is_of(g, s->node[c->first + c->own]));
}

/* Of a wall with mass that moves with the group: along, and about, what it is not free to. */
static void add_guides(const Model *m, const UnheldGroup *g, const RigidWall *wall, PetscReal *sum)
{
  PetscReal centre[3];
  for (PetscInt d = 0; d < 3; ++d) centre[d] = wall->body.centre[d] + wall->now.moved[d];
  for (PetscInt d = 0; d < m->dim; ++d) {
    const PetscReal axis[3] = {d == 0, d == 1, d == 2};
    if (!wall->free[d]) unheld_add_place(m, g, centre, axis, PETSC_FALSE, sum);
  }
  for (PetscInt k = m->dim; k < g->n; ++k)
    if (!wall->free[m->dim == 3 ? k : RIGID - 1]) sum[k * (g->n + 1)] += 1;
}

static void add_contact(const Model *m, const UnheldGroup *g, PetscReal *sum)
{
  const Contact *s = m->contact;
  for (const ContactPoint *c = s ? s->point : NULL; s && c < s->point + s->n; ++c) {
    const RigidWall *wall = meet_as_one(g->meet, c) ? contact_rigid(s, c) : NULL;
    if (!leans_on(s, g, c)) continue;
    if (wall) add_guides(m, g, wall, sum);
    else unheld_add_place(m, g, c->x, c->normal, c->law.kind != CONTACT_FRICTIONLESS, sum);
  }
}

/* Of what other forces hold, as springs do: along the axes. */
static PetscErrorCode AddForces(const Model *m, const UnheldGroup *g, PetscReal *sum)
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  unsigned char *held;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &held));
  for (PetscInt k = 0; k < m->forces.n; ++k)
    if (m->forces.one[k].kind->hold && m->forces.one[k].data != m->contact)
      m->forces.one[k].kind->hold(m->forces.one[k].data, &scene, held);
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    const PetscInt node = i / m->dim, d = i % m->dim;
    const PetscReal axis[3] = {d == 0, d == 1, d == 2};
    if (held[i] && unheld_is_of(g, node)) unheld_add_place(m, g, m->grid->x + node * m->dim, axis, PETSC_FALSE, sum);
  }
  PetscCall(PetscFree(held));
  PetscFunctionReturn(0);
}

PetscErrorCode UnheldTake(const Model *m, UnheldGroup *g, PetscReal *sum)
{
  PetscReal trace = 0;

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(g->n * g->n), MPIU_REAL, MPIU_SUM, m->comm));
  for (PetscInt k = 0; k < g->n; ++k) trace += sum[k * (g->n + 1)];
  while (g->n_free) {
    PetscReal most = 0, held[RIGID];
    for (PetscInt f = 0; f < g->n_free; ++f) {
      PetscReal row[RIGID] = {0}, moved = 0;
      for (PetscInt k = 0; k < g->n * g->n; ++k) row[k / g->n] += sum[k] * g->free[f][k % g->n];
      for (PetscInt k = 0; k < g->n; ++k) moved += row[k] * g->free[f][k];
      if (moved <= most) continue;
      most = moved;
      for (PetscInt k = 0; k < g->n; ++k) held[k] = row[k];
    }
    if (most <= LEVER * trace) break;
    take_away(g, held);
  }
  PetscFunctionReturn(0);
}

/* What walls and other bodies hold that it touches is not free, as long as they push, nor what other forces hold. */
static PetscErrorCode ForcesHold(const Model *m, UnheldGroup *g)
{
  PetscReal sum[RIGID * RIGID] = {0};

  PetscFunctionBeginUser;
  add_contact(m, g, sum);
  PetscCall(AddForces(m, g, sum));
  PetscCall(UnheldTake(m, g, sum));
  PetscFunctionReturn(0);
}

/* Where the group is, and which motions are left to it by what is prescribed. *any: does it touch a node? */
static PetscErrorCode GroupLook(const Model *m, UnheldGroup *g, PetscBool *any)
{
  PetscReal bounds[7], square = 0;
  Hold hold;

  PetscFunctionBeginUser;
  for (int k = 0; k < 7; ++k) bounds[k] = k < 6 ? PETSC_MIN_REAL : 0;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    if (!unheld_is_of(g, node)) continue;
    for (PetscInt d = 0; d < m->dim; ++d) {
      bounds[d] = PetscMax(bounds[d], m->grid->x[node * m->dim + d]);
      bounds[3 + d] = PetscMax(bounds[3 + d], -m->grid->x[node * m->dim + d]);
    }
    bounds[6] = PetscMax(bounds[6], m->nodes->mass[node]);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, bounds, 7, MPIU_REAL, MPIU_MAX, m->comm));
  *any = bounds[6] > 0;
  if (!*any) PetscFunctionReturn(0);
  for (PetscInt d = 0; d < m->dim; ++d) {
    g->centre[d] = (bounds[d] - bounds[3 + d]) / 2;
    square += (bounds[d] + bounds[3 + d]) * (bounds[d] + bounds[3 + d]) / 4;
  }
  g->size = PetscSqrtReal(square);
  g->mass = bounds[6];
  g->n = g->n_free = motions_of(m);
  for (PetscInt k = 0; k < g->n; ++k) g->free[k][k] = 1;
  while (g->n_free) {
    PetscCall(Strongest(m, g, BEFORE, &hold));
    if (hold.strength < LEVER) break;
    count_in(g, &hold);
  }
  PetscCall(ForcesHold(m, g));
  PetscFunctionReturn(0);
}

void unheld_keep_from_turning(const Model *m, UnheldGroup *g)
{
  PetscReal along[RIGID];
  for (PetscInt k = m->dim; k < g->n; ++k) {
    PetscReal row[RIGID] = {0};
    row[k] = 1;
    if (strength_of(g, row, along) > LEVER) take_away(g, row);
  }
}

/* Hold one more direction of a node, on every rank that knows it. */
static PetscErrorCode HoldOne(Model *m, UnheldGroup *g, Which which)
{
  Hold hold;

  PetscFunctionBeginUser;
  PetscCall(Strongest(m, g, which, &hold));
  PetscCheck(hold.strength > LEVER, m->comm, PETSC_ERR_PLIB, "no node could hold body %d", (int)g->body);
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) {
    if (!is_hold(m, g, &hold, i / m->dim, i % m->dim)) continue;
    m->nodes->fixed[i] = 1;
    m->unheld.turns[m->unheld.n] = which == ANY;
    m->unheld.dof[m->unheld.n++] = i;
  }
  m->unheld.turning += which == ANY;
  count_in(g, &hold);
  PetscFunctionReturn(0);
}

PetscErrorCode UnheldEach(Model *m, MeetKind meet, Diag *diag,
                          PetscErrorCode (*visit)(Model *m, UnheldGroup *g, Diag *diag))
{
  PetscReal *of;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->grid->n_nodes, &of));
  PetscCall(JoinedBodies(m, meet, of));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    UnheldGroup g = {.body = b, .of = of, .meet = meet};
    PetscCall(GroupLook(m, &g, &any));
    if (any && g.n_free) PetscCall((*visit)(m, &g, diag));
  }
  PetscCall(PetscFree(of));
  PetscFunctionReturn(0);
}

void unheld_name_free(const Model *m, const UnheldGroup *g, char text[64])
{
  const PetscInt lines = PetscMin(m->dim, g->n);
  PetscReal along[RIGID];
  PetscInt n = 0;
  text[0] = 0;
  for (PetscInt k = 0; k < g->n; ++k) {
    PetscReal row[RIGID] = {0};
    row[k] = 1;
    if (strength_of(g, row, along) < (k < lines ? 0.99 : 0.1)) continue;
    const size_t length = strlen(text);
    if (k < lines) snprintf(text + length, 64 - length, "%s%c", n ? " and " : "in ", g->n == 1 ? 'y' : "xyz"[k]);
    else {
      snprintf(text + length, 64 - length, "%sfrom turning", n ? " and " : "");
      break;
    }
    ++n;
  }
  if (!text[0]) snprintf(text, 64, "along a line that leans");
}

/* Along which axes; of rings that is y. */
static void note_free(Model *m, const UnheldGroup *g)
{
  PetscReal along[RIGID];
  for (PetscInt k = 0; k < PetscMin(m->dim, g->n); ++k) {
    PetscReal row[RIGID] = {0};
    row[k] = 1;
    if (strength_of(g, row, along) >= 0.99) m->unheld.along[g->n == 1 ? 1 : k] = PETSC_TRUE;
  }
}

/* What may be missing of the balance of pressures: of those that press a body all round, alike everywhere, whose sum is
 * zero whatever becomes of the body; of others, which may be a push. */
#define CLOSED 1e-3
#define OPEN 1e-4

PetscReal unheld_open_surface(const Model *m)
{
  if (!case_load_follows(m->c) || m->contact) return OPEN;
  for (PetscInt k = 0; k < case_acting_loads(m->c); ++k) {
    const LoadSpec *load = &m->c->loads[k];
    const Selector *on = &load->on;
    if (load->kind != LOAD_PRESSURE || !load_pushes(load)) continue;
    if (!on->body || on->boundary || on->has_shape || on->has[0] || on->has[1] || on->has[2]) return OPEN;
    if (load->factor || m->loads->asked[k].ask) return OPEN;
  }
  return CLOSED;
}

/* Work of the loads of the first step along its free motions. */
static PetscErrorCode CheckGroup(Model *m, UnheldGroup *g, Diag *diag)
{
  PetscReal sums[RIGID + 1] = {0}, row[RIGID], pull[3], most = 0;
  char text[64], path[64];

  PetscFunctionBeginUser;
  gravity_at(m->c, raised_time(m, m->time + m->c->analysis.step), pull);
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    if (!unheld_is_of(g, i / m->dim)) continue;
    const PetscReal force = unheld_load(m, pull, i);
    unheld_row(m, g, i / m->dim, i % m->dim, NULL, row);
    for (PetscInt f = 0; f < g->n_free; ++f)
      for (PetscInt k = 0; k < g->n; ++k) sums[f] += g->free[f][k] * row[k] * force;
    sums[RIGID] += PetscAbsReal(force);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sums, RIGID + 1, MPIU_REAL, MPIU_SUM, m->comm));
  for (PetscInt f = 0; f < g->n_free; ++f) most = PetscMax(most, PetscAbsReal(sums[f]));
  snprintf(path, sizeof path, "bodies[%d]", (int)g->body);
  unheld_name_free(m, g, text);
  if (most > (case_load_follows(m->c) ? unheld_open_surface(m) : UNHELD_BALANCE) * sums[RIGID]) {
    diag_error(diag, path, "nothing holds '%s' %s, and loads push it that way: %.3g of %.3g N are out of balance",
               m->c->bodies[g->body].name, text, (double)most, (double)sums[RIGID]);
    diag_hint(diag, "analysis.unheld: hold is for loads in balance; fix a boundary, or analysis: {type: dynamic}");
  } else
    diag_warning(diag, path, "nothing holds '%s' %s: held in %d direction(s) of nodes, which bear nothing",
                 m->c->bodies[g->body].name, text, (int)g->n_free);
  PetscFunctionReturn(0);
}

PetscErrorCode UnheldCheck(Model *m, PetscBool arrived, Diag *diag)
{
  const AnalysisSpec *a = &m->c->analysis;
  const NodalScene scene = nodal_scene(m, m->time + a->step, m->nodes->du);
  PetscInt errors;

  PetscFunctionBeginUser;
  if (a->unheld != UNHELD_HOLD) PetscFunctionReturn(0);
  if (a->type != ANALYSIS_STATIC || m->method->clouds || m->c->n_interfaces || (m->contact && m->contact->n_rigid))
    diag_error(diag, "analysis.unheld",
               "unheld: hold is for type static, methods mpm and fem, without interfaces and walls with mass");
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (errors || !arrived) PetscFunctionReturn(0);
  PetscCall(NodalForcesBegin(&m->forces, &scene));
  PetscCall(NodalForcesExternal(&m->forces, &scene, PETSC_TRUE, m->nodes->external));
  PetscCall(UnheldEach(m, MEET_NONE, diag, CheckGroup));
  PetscFunctionReturn(0);
}

/* Where it is, and then how it is turned: the latter can be let go. */
static PetscErrorCode HoldGroup(Model *m, UnheldGroup *g, Diag *diag)
{
  PetscReal along[RIGID];

  PetscFunctionBeginUser;
  (void)diag;
  for (PetscInt k = 0; k < PetscMin(g->n, m->dim); ++k) {
    PetscReal row[RIGID] = {0};
    row[k] = 1;
    if (strength_of(g, row, along) > 1 - 1e-6) PetscCall(HoldOne(m, g, g->n == 1 ? ALONG_Y : (Which)k));
  }
  while (g->n_free) PetscCall(HoldOne(m, g, ANY));
  m->unheld.size = PetscMax(m->unheld.size, g->size);
  PetscFunctionReturn(0);
}

/* In the first step of a run, or after it was resumed. */
static PetscErrorCode HoldFirst(Model *m, UnheldGroup *g, Diag *diag)
{
  PetscFunctionBeginUser;
  note_free(m, g);
  PetscCall(HoldGroup(m, g, diag));
  PetscFunctionReturn(0);
}

PetscErrorCode UnheldHold(Model *m)
{
  const PetscBool first = (PetscBool)!m->unheld.dof;

  PetscFunctionBeginUser;
  m->unheld.n = m->unheld.turning = 0;
  m->unheld.size = 0;
  if (m->c->analysis.unheld != UNHELD_HOLD) PetscFunctionReturn(0);
  if (first) PetscCall(PetscMalloc2(RIGID * m->c->n_bodies, &m->unheld.dof, RIGID * m->c->n_bodies, &m->unheld.turns));
  PetscCall(UnheldEach(m, MEET_NONE, NULL, first ? HoldFirst : HoldGroup));
  PetscFunctionReturn(0);
}
