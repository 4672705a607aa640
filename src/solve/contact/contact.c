#include "solve/contact/contact.h"
#include <string.h>

/* Penalty of a contact point, over the stiffness and inertia that a cell opposes to it. Gaps fall by
 * about this factor with every change of the multipliers. With 100 the sides of the law hand Newton's
 * iteration back and forth (docs/decisions.md, 106). */
#define STIFFER 5

#define WALL_NUMBERS ((PetscInt)(sizeof(WallState) / sizeof(PetscReal)))
#define RIGID_NUMBERS ((PetscInt)(sizeof(RigidState) / sizeof(PetscReal)))

#define ROUND_CORNER 0.9 /* cosine: a normal that has turned by more in a step belongs to another face */

#define LEANS 0.1 /* a normal with such a share of an axis holds along it */

#define CLOSED 1e-5 /* of a cell: gaps and slips that remain of contact */
/* Where grains flow, that share of what the surface moves in the step, up to so much of a cell. */
#define MOVED 3e-3
#define FLOWING 5e-4
#define RESTS 1e-3 /* of a cell: what moves by no more along its wall in a step may be at rest */
#define MOST_CHANGES 40
/* Where more points touch than nodes can follow, gaps of some stay, and their multipliers would grow
 * against each other for ever: a gap that falls no faster may stay, up to so much of a cell. */
#define STALLS 0.5
#define ALLOWED 1e-3
/* Of what is bonded that happens where strains change from point to point, at ends of a clamped edge, and the whole run
 * would end there: after so many changes so many times as much may stay. */
#define PATIENCE 8
#define BONDED_ALLOWED 10
/* Of a mixed formulation the penalty is measured by shear, which is what a free surface feels; where
 * matter is locked in it feels its volume, and gaps fall slowly: then the penalty rises until they fall
 * by about so much, up to what volume opposes. */
#define FALLS 10
/* Of what rubs it rises so many times where it must: a slip that stays of what sticks does work. Where nothing but a
 * gap stays it is left as it is: which of more points than nodes can follow bear the force is nobody's choice, and a
 * higher penalty takes some of them away; what is bonded all points would lock. */
#define RUBS 10
#define HIGHER 1.01 /* a penalty that could rise by less has risen: moduli that are alike differ by round-off */

PetscErrorCode ContactCreate(const Case *c, Walls *walls, Diag *diag, Contact **contact)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(contact));
  (*contact)->walls = walls;
  (*contact)->dim = c->kinematics->dim;
  (*contact)->n_walls = c->n_walls;
  (*contact)->n_partners = c->n_walls + c->n_interfaces;
  PetscCall(RigidCreate(c, walls, diag, &(*contact)->n_rigid, &(*contact)->rigid));
  PetscCall(PetscCalloc1((*contact)->n_partners, &(*contact)->wall));
  PetscCall(PetscCalloc1((*contact)->n_partners, &(*contact)->impulse));
  PetscCall(PetscMalloc1((*contact)->n_partners * c->n_bodies, &(*contact)->divisor));
  for (PetscInt i = 0; i < (*contact)->n_partners * c->n_bodies; ++i) (*contact)->divisor[i] = 1;
  (*contact)->share = (ContactShare){.mean = 1};
  PetscFunctionReturn(0);
}

PetscErrorCode ContactDestroy(Contact **contact)
{
  Contact *s = *contact;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(PetscFree(s->point));
  PetscCall(PetscFree(s->node));
  PetscCall(PetscFree(s->N));
  PetscCall(PetscFree(s->lead));
  PetscCall(PetscFree(s->slot));
  PetscCall(PetscFree(s->divisor));
  PetscCall(PetscFree(s->wall));
  PetscCall(PetscFree(s->rigid));
  PetscCall(PetscFree(s->impulse));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(0);
}

/* Those of the last step, and as much more or less as the gap that it left takes away: of a stiff body that
 * is no little force, and if it let go everywhere at once nothing would hold it; and what rests is to stay
 * where it is. What had none and touches the wall gets one so small that it counts for nothing: it is in
 * contact from the first iteration on. */
static void first_multiplier(const Contact *s, ContactPoint *c)
{
  const PetscReal whole = 1 / s->share.mean;
  c->multiplier = (ContactForce){0};
  for (int d = 0; d < 3; ++d) c->multiplier.pressure += whole * c->last[d] * c->normal[d];
  for (int d = 0; d < 3; ++d) c->multiplier.shear[d] = whole * c->last[d] - c->multiplier.pressure * c->normal[d];
  if (c->before != CONTACT_OPEN && c->open > -CLOSED * s->length) c->multiplier.pressure += c->law.penalty * c->open;
  if (c->touches && c->before == CONTACT_OPEN) c->multiplier.pressure = 0.1 * CLOSED * s->length * c->law.penalty;
}

/* What a cell of one material opposes to a pressure, N/m3; of two that stand behind each other. */
static PetscReal stiffness_of(const ContactPoint *c, PetscReal h, PetscReal inertia)
{
  const PetscReal k = c->modulus[0] / h + inertia * c->density[0] * h;
  const PetscReal other = c->modulus[1] / h + inertia * c->density[1] * h;
  return other > 0 ? k * other / (k + other) : k;
}

/* A chord of what turns leads inwards, where forces would do work that no torque does. */
static void sweep(const Contact *s, ContactPoint *c, PetscReal t, PetscReal dt)
{
  PetscReal x[3];
  wall_motion(s->walls, c->wall, t, t + dt, c->x, c->swept);
  for (int d = 0; d < 3; ++d) x[d] = c->x[d] - c->swept[d] / 2;
  wall_motion(s->walls, c->wall, t, t + dt, x, c->passes);
}

/* Grains that flow have gaps of their own (FLOWING). */
static PetscReal stiffest_of(const Contact *s, const ContactPoint *c)
{
  const PetscBool rubs = c->law.kind == CONTACT_FRICTION || c->law.kind == CONTACT_STICK;
  return PetscMax(c->stiffer, rubs && !s->share.flows ? RUBS : 1) * c->law.penalty;
}

void contact_prepare(Contact *s, PetscReal t, PetscReal dt, PetscReal inertia, ContactShare share)
{
  s->share = share;
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    c->law.penalty = STIFFER * c->section * stiffness_of(c, s->length, inertia);
    c->stiffest = stiffest_of(s, c);
    c->left = 0;
    for (int d = 0; d < 3; ++d) c->struck[d] = c->lent[d] = 0;
    for (int d = 0; d < 3 && c->before == CONTACT_OPEN; ++d) c->last[d] = 0; /* explicit dynamics keeps slips there */
    c->law.bond = c->bond / share.mean;
    if (c->wall < s->n_walls && !contact_rigid(s, c)) sweep(s, c, t, dt);
    first_multiplier(s, c);
  }
}

void contact_place(const Contact *s, const ContactPoint *c, const PetscReal *du, PetscReal whole, PetscReal x[3])
{
  for (int d = 0; d < 3; ++d) x[d] = c->x[d];
  for (PetscInt I = 0; I < c->n; ++I)
    for (PetscInt d = 0; d < s->dim; ++d) x[d] += whole * s->N[c->first + I] * du[s->node[c->first + I] * s->dim + d];
}

/* A place in the wall, beside a corner, may be nearer to another face than that which the material came to: it would be
 * pushed out there, in every step anew. Then the owner, which stands outside, sees the wall for it. */
static PetscBool see_wall(const Contact *s, const ContactPoint *c, PetscReal t, const PetscReal x[3], WallPlace *place)
{
  PetscReal along = 0, owner[3];
  if (!wall_near(s->walls, c->wall, t, x, 2 * s->near, c->side, place)) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) along += place->normal[d] * c->facing[d];
  if (along > ROUND_CORNER) return PETSC_TRUE;
  for (int d = 0; d < 3; ++d) owner[d] = x[d] + c->reach * c->facing[d];
  if (!wall_near(s->walls, c->wall, t, owner, 2 * s->near + c->reach, c->side, place)) return PETSC_FALSE;
  place->gap -= c->reach;
  return PETSC_TRUE;
}

/* The wall as the contact point sees it at x, or the other body: a plane that goes with it. */
static PetscBool place_of(const Contact *s, const ContactPoint *c, PetscReal t, const PetscReal x[3], WallPlace *place)
{
  if (c->wall < s->n_walls) return see_wall(s, c, t, x, place);
  *place = (WallPlace){.gap = c->open};
  for (int d = 0; d < 3; ++d) {
    place->normal[d] = c->normal[d];
    place->gap += (x[d] - c->x[d]) * c->normal[d];
  }
  return PETSC_TRUE;
}

PetscBool contact_meets(const Contact *s, ContactPoint *c, const NodalScene *scene, PetscReal *K)
{
  const RigidWall *rigid = contact_rigid(s, c);
  PetscReal x[3];
  WallPlace place;
  contact_place(s, c, scene->du, scene->whole, x);
  if (rigid) rigid_sweep(rigid, c->x, x, c->swept);
  for (int d = 0; d < 3 && rigid; ++d) c->passes[d] = c->swept[d];
  c->state = CONTACT_OPEN;
  c->now = (ContactForce){0};
  c->gap = PETSC_MAX_REAL;
  if (!place_of(s, c, scene->end, x, &place)) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) c->slip[d] = x[d] - c->x[d] - c->swept[d], c->normal[d] = place.normal[d];
  c->gap = place.gap;
  c->state = contact_law(&c->law, &place, c->slip, &c->multiplier, &c->now, K);
  return c->state != CONTACT_OPEN;
}

void contact_force(const ContactPoint *c, PetscReal f[3])
{
  for (int d = 0; d < 3; ++d) f[d] = c->now.pressure * c->normal[d] + c->now.shear[d];
}

void contact_acts(const ContactPoint *c, PetscReal f[3])
{
  contact_force(c, f);
  for (int d = 0; d < 3; ++d) f[d] -= c->lent[d];
}

void contact_balance(const Contact *s, const ContactPoint *c, PetscReal f[3])
{
  contact_acts(c, f);
  for (int d = 0; d < 3; ++d) f[d] -= s->share.back * c->stays * c->last[d];
}

/* Motion of what is in contact against its wall. */
static PetscReal motion_of(const ContactPoint *c)
{
  if (c->state == CONTACT_OPEN) return 0;
  return PetscSqrtReal(PetscSqr(c->slip[0]) + PetscSqr(c->slip[1]) + PetscSqr(c->slip[2]));
}

PetscErrorCode ContactMoves(const Contact *s, MPI_Comm comm, PetscBool *moves)
{
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) here |= motion_of(c) > RESTS * s->length;
  PetscCallMPI(MPI_Allreduce(&here, moves, 1, MPIU_BOOL, MPI_LOR, comm));
  PetscFunctionReturn(0);
}

PetscReal contact_stays(const Contact *s, const ContactPoint *c)
{
  const PetscReal now = s->share.mean * c->now.pressure;
  PetscReal before = 0;
  for (int d = 0; d < 3; ++d) before += c->last[d] * c->normal[d];
  if (!s->share.inertia) return 1;
  return now == 0 ? 0 : PetscMax(0, PetscMin(1, before / now));
}

void contact_excess(const Contact *s, const ContactPoint *c, PetscReal f[3])
{
  const PetscReal stays = s->share.mean * contact_stays(s, c), lag = s->share.lag;
  PetscReal balance[3];
  contact_force(c, f);
  contact_balance(s, c, balance);
  for (int d = 0; d < 3; ++d) f[d] = (balance[d] - lag * c->stays * c->last[d]) / (1 - lag) - stays * f[d];
}

PetscReal contact_unresolved(const Contact *s, PetscReal size)
{
  PetscReal sum = 0;
  for (PetscInt k = 0; s && k < s->n_partners; ++k) {
    const PetscReal *f = s->wall[k].mean.force;
    sum += CLOSED * size * PetscSqrtReal(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
  }
  return sum;
}

PetscReal contact_square(const Contact *s)
{
  PetscReal sum = 0;
  for (PetscInt k = 0; s && k < s->n; ++k) {
    PetscReal f[3];
    contact_force(s->point + k, f);
    for (PetscInt d = 0; d < s->dim; ++d) sum += f[d] * f[d];
  }
  return sum;
}

static void add_tangent(const Contact *s, const ContactPoint *c, const NodalScene *scene, const PetscReal *K,
                        const NodalOutput *out)
{
  const PetscInt dim = s->dim;
  for (PetscInt I = 0; I < c->n; ++I)
    for (PetscInt J = 0; J < c->n; ++J) {
      const PetscReal weight = scene->whole * s->N[c->first + I] * s->N[c->first + J];
      const PetscInt slot = s->slot[c->slot + I * c->n + J], row = s->node[c->first + I] * dim,
                     column = s->node[c->first + J] * dim;
      for (PetscInt i = 0; i < dim; ++i)
        for (PetscInt j = 0; j < dim; ++j)
          nodal_add_tangent(out, dim, slot, row + i, column + j, weight * K[3 * i + j]);
    }
}

static PetscErrorCode Assemble(void *data, const NodalScene *scene, const NodalOutput *out)
{
  const Contact *s = data;
  const PetscReal sign = out->away ? -1 : 1;
  PetscReal K[9], f[3];

  PetscFunctionBeginUser;
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscBool meets = contact_meets(s, c, scene, out->system ? K : NULL);
    contact_balance(s, c, f);
    for (PetscInt I = 0; I < c->n; ++I)
      for (PetscInt d = 0; d < s->dim; ++d)
        out->force[s->node[c->first + I] * s->dim + d] -= sign * s->N[c->first + I] * f[d];
    if (out->system && meets) add_tangent(s, c, scene, K, out);
  }
  PetscCall(RigidSums(data, scene));
  PetscFunctionReturn(0);
}

/* Gap or slip that its forces leave, m. */
static PetscReal left_of(const ContactPoint *c)
{
  PetscReal left = PetscAbsReal(c->now.pressure - c->multiplier.pressure);
  if (c->state == CONTACT_OPEN) return 0;
  for (int d = 0; d < 3 && c->state == CONTACT_STICKS; ++d)
    left = PetscMax(left, PetscAbsReal(c->now.shear[d] - c->multiplier.shear[d]));
  return left / c->law.penalty;
}

/* Does what is left fall slowly, although the penalty may rise? */
static PetscBool is_soft(const ContactPoint *c, PetscReal left)
{
  return c->left > 0 && left > STALLS * c->left && HIGHER * c->law.penalty < c->stiffest;
}

/* Gaps fall by 1 + penalty / stiffness of what is pressed: what is measured says which that is. */
static void stiffen(ContactPoint *c, PetscReal left)
{
  const PetscReal rate = PetscMin(left / c->left, 0.9);
  c->law.penalty = PetscMin(c->stiffest, c->law.penalty * (FALLS - 1) * rate / (1 - rate));
}

/* Gap or slip that may stay. */
static PetscReal allowed(const Contact *s, PetscReal moved)
{
  const PetscReal closed = CLOSED * s->length;
  if (!s->share.flows) return closed;
  return PetscMax(closed, PetscMin(MOVED * moved, FLOWING * s->length));
}

/* What counts against ALLOWED where gaps stall. */
static PetscReal stalled_of(const ContactPoint *c, PetscInt change, PetscReal left)
{
  return c->law.kind == CONTACT_BONDED && change >= PATIENCE ? left / BONDED_ALLOWED : left;
}

/* Multipliers become the forces that there are, and the balance is sought again, unless gaps and
 * slips of what is in contact have all but vanished. */
static PetscErrorCode Augment(void *data, const NodalScene *scene, PetscInt change, PetscBool *again)
{
  Contact *s = data;
  PetscReal worst[4] = {0}, of_all[4]; /* left of all points, of those that may be stiffened; motion; stalled_of */

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscReal left = left_of(c);
    worst[0] = PetscMax(worst[0], left);
    if (is_soft(c, left)) worst[1] = PetscMax(worst[1], left);
    worst[2] = PetscMax(worst[2], motion_of(c));
    worst[3] = PetscMax(worst[3], stalled_of(c, change, left));
  }
  PetscCall(MPIU_Allreduce(worst, of_all, 4, MPIU_REAL, MPIU_MAX, scene->grid->comm));
  const PetscBool slow = change > 0 && of_all[0] > STALLS * s->worst, soft = of_all[1] > CLOSED * s->length;
  const PetscBool stalls = slow && !soft && of_all[3] <= ALLOWED * s->length;
  *again = of_all[0] > allowed(s, of_all[2]) && change < MOST_CHANGES && !stalls;
  s->worst = of_all[0];
  if (!*again) PetscFunctionReturn(0);
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscReal left = left_of(c);
    if (is_soft(c, left)) stiffen(c, left);
    c->multiplier = c->now;
    c->left = left;
  }
  PetscFunctionReturn(0);
}

void contact_again(Contact *s)
{
  (void)memset(s->impulse, 0, (size_t)s->n_partners * sizeof *s->impulse);
  s->driven = 0;
  for (RigidWall *b = s->rigid; b < s->rigid + s->n_rigid; ++b) {
    b->lost = 0;
    for (int d = 0; d < 3; ++d) b->given[d] = 0;
    rigid_restore(b, s->walls);
  }
}

static PetscErrorCode Begin(void *data, const NodalScene *scene)
{
  Contact *s = data;

  PetscFunctionBeginUser;
  for (RigidWall *b = s->rigid; b < s->rigid + s->n_rigid; ++b) b->start = b->now;
  contact_again(s);
  PetscCall(ContactFind(s, scene));
  PetscFunctionReturn(0);
}

static PetscBool meets(const ContactPoint *c) { return (PetscBool)(c->touches || c->before != CONTACT_OPEN); }

/* What touches a wall cannot leave through it, nor along it if it rubs. A wall that only pushes may turn out to hold
 * one way alone: whoever asks looks again after the run (ModelWarnLoose). */
static void hold(const void *data, const NodalScene *scene, unsigned char *held)
{
  const Contact *s = data;
  (void)scene;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    for (PetscInt e = c->first; e < c->first + c->n && meets(c) && !contact_rigid(s, c); ++e)
      for (PetscInt d = 0; d < s->dim; ++d)
        if (c->law.kind != CONTACT_FRICTIONLESS || PetscAbsReal(c->normal[d]) > LEANS)
          held[s->node[e] * s->dim + d] = 1;
}

static PetscBool find_slots(void *data, const System *system)
{
  Contact *s = data;
  PetscInt missing = 0;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    missing += !nodal_find_slots(system, c->n, s->node + c->first, s->slot + c->slot);
  return !missing;
}

/* Walls couple nodes of the same points, bodies those of two. */
static PetscErrorCode Couple(const void *data, const NodalScene *scene, NodeGroups *groups)
{
  const Contact *s = data;

  (void)scene;
  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    if (c->wall >= s->n_walls) PetscCall(NodeGroupsAdd(groups, c->n, s->node + c->first));
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(const NodalScene *scene, Diag *diag, void **data)
{
  (void)diag;
  PetscFunctionBeginUser;
  *data = scene->contact;
  PetscFunctionReturn(0);
}

/* Distance of the material point from its surface at the end of the step: that of where both have gone,
 * so that the next step starts with the gap that this one ends with. */
static PetscReal reach_at_end(const Contact *s, const ContactPoint *c, const NodalScene *scene)
{
  const PetscReal first = scene->points->real[POINT_REACH][c->owner];
  PetscReal reach = c->reach;
  for (PetscInt e = c->first; e < c->first + c->own; ++e)
    for (PetscInt d = 0; d < s->dim; ++d) reach -= c->normal[d] * s->lead[e] * scene->du[s->node[e] * s->dim + d];
  return PetscMax(THINNEST * first, PetscMin(contact_farthest(scene->points, c->owner), reach));
}

static void mark(const void *data, unsigned char *node)
{
  const Contact *s = data;
  for (PetscInt e = 0; e < s->n_nodes; ++e) node[s->node[e]] = 1;
}

/* Carriers keep what acted on them. */
static PetscErrorCode Commit(void *data, const NodalScene *scene)
{
  const Contact *s = data;
  const PetscInt dim = s->dim;
  PetscReal f[3];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(scene->points->real[POINT_CONTACT], scene->points->n * s->n_partners * CONTACT_KEPT(dim)));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    PetscReal *kept = point_real(scene->points, POINT_CONTACT, c->owner) + c->wall * CONTACT_KEPT(dim);
    kept[0] = (PetscReal)c->state;
    kept[1] = reach_at_end(s, c, scene);
    contact_force(c, f);
    for (PetscInt d = 0; d < dim && c->state != CONTACT_OPEN; ++d) kept[2 + d] = s->share.mean * f[d];
    kept[2 + dim] = contact_stays(s, c);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ToTables(const void *data, const NodalScene *scene, Tables *tables)
{
  const Contact *s = data;
  Table *table;
  Column *column;

  (void)scene;
  PetscFunctionBeginUser;
  PetscCall(TablesAdd(tables, "walls", PETSC_TRUE, s->n_partners, &table));
  PetscCall(TableAdd(table, "state", NULL, COLUMN_REAL, WALL_NUMBERS, NULL, &column));
  PetscCall(PetscMemcpy(column->data, s->wall, (size_t)s->n_partners * sizeof *s->wall));
  if (!s->n_rigid) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "rigid_walls", PETSC_TRUE, s->n_rigid, &table));
  PetscCall(TableAdd(table, "state", NULL, COLUMN_REAL, RIGID_NUMBERS, NULL, &column));
  for (PetscInt k = 0; k < s->n_rigid; ++k)
    PetscCall(PetscMemcpy((PetscReal *)column->data + k * RIGID_NUMBERS, &s->rigid[k].now, sizeof s->rigid->now));
  PetscFunctionReturn(0);
}

/* Walls with mass, and where they are. */
static void rigid_from_tables(Contact *s, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "rigid_walls");
  const PetscReal *state = table ? table_data(table, "state", COLUMN_REAL, RIGID_NUMBERS, reason) : NULL;
  if (reason[0]) return;
  if ((table ? table->rows : 0) != s->n_rigid) {
    snprintf(reason, 256, "walls with mass are others");
    return;
  }
  for (PetscInt k = 0; k < s->n_rigid; ++k) {
    (void)memcpy(&s->rigid[k].start, state + k * RIGID_NUMBERS, sizeof s->rigid->start);
    rigid_restore(s->rigid + k, s->walls);
  }
}

static PetscErrorCode FromTables(void *data, const NodalScene *scene, const Tables *tables, char reason[256])
{
  Contact *s = data;
  const Table *table = tables_find(tables, "walls");

  (void)scene;
  PetscFunctionBeginUser;
  if (!table) {
    snprintf(reason, 256, "walls is missing");
    PetscFunctionReturn(0);
  }
  const PetscReal *state = table_data(table, "state", COLUMN_REAL, WALL_NUMBERS, reason);
  if (state && table->rows != s->n_partners) snprintf(reason, 256, "walls are others");
  if (state && !reason[0]) PetscCall(PetscMemcpy(s->wall, state, (size_t)s->n_partners * sizeof *s->wall));
  if (state && !reason[0]) rigid_from_tables(s, tables, reason);
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_contact = {
  .name = "contact",
  .help = "rigid walls that material meets, and bodies that meet each other, with friction",
  .apart = PETSC_TRUE,
  .create = Create,
  .begin = Begin,
  .hold = hold,
  .couple = Couple,
  .find_slots = find_slots,
  .assemble = Assemble,
  .augment = Augment,
  .mark = mark,
  .commit = Commit,
  .to_tables = ToTables,
  .from_tables = FromTables,
};
