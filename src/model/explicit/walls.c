/* Rigid walls and interfaces in explicit dynamics: springs between a surface of the material and theirs.
 *
 * Contact points are those of implicit dynamics (solve/contact), and so is the law; but nothing is
 * solved for. What has gone into a wall is pushed by
 *
 *   p = - r g - d dg/dt >= 0,    t = t of the substep before - r s, at most friction p + min(bond, 20 p),
 *   r = A M / h,    d = A sqrt(rho M) / 2,
 *
 * of two bodies, the second of which is to the first what a wall is, one spring and dashpot behind the other;
 * g < 0 the gap, s the slip since then, A the surface that the point stands for. So a wall is as stiff as a
 * cell of the material before it: the critical substep stays as it is, material sinks in by a cell's
 * strain, and nothing drifts that sticks. Of waves that the grid resolves the dashpot takes a share
 * of (omega h / c)^2; without it the springs and second mapping (`musl`) shake a block that rests. */
#include "model/explicit/explicit.h"
#include "base/math/vector.h"

#define DASHPOT 0.5 /* of the impedance of the material */
/* (omega dt)^2 of springs alone on the nodes: 4 is unstable, of which waves have up to 4 C^2, C the Courant number; of
 * what that leaves (docs/theory.md, section 73). A full cell beside a wall has C^2 times the stiffness of contact. */
#define MOST 3.61
#define SOFTEST 2 /* by how much nodes of little mass soften a spring at most */

static PetscReal *kept_of(const Model *m, const ContactPoint *c) { return contact_kept_of(m->contact, m->points, c); }

/* Another scheme, or another stiffness, has left a force and another gap: the surface is where the spring has that
 * force. What springs had let in before stands so much nearer to it. */
static void take_over(ContactPoint *c)
{
  const PetscReal pressure = vector_dot(c->last, c->normal), off = pressure / c->law.penalty + c->open;
  const PetscReal let_in = PetscMin(off, PetscMax(0, c->behind));
  if (c->before == CONTACT_OPEN || (pressure <= 0 && c->law.kind != CONTACT_BONDED)) return;
  c->behind -= let_in;
  c->reach += off - let_in;
  c->open -= off;
}

/* Pressure beside that of the spring: what the dashpot bears; at the start of the run's step the force goes on as
 * it was at the end of the last one. */
static PetscReal beside_spring(const Explicit *e, const ContactPoint *c)
{
  const PetscReal kept = vector_dot(c->last, c->normal);
  if (e->before > 0) return c->open > 0 ? PetscMin(kept, 0) : kept;
  return c->before == CONTACT_OPEN ? 0 : kept + c->law.penalty * c->open;
}

/* Over that of a cell: what is bonded bends where it is held, and its spring is as stiff as the substep lets it be. */
static PetscReal stiffness(const Model *m, const ContactLaw *law)
{
  const AnalysisSpec *a = &m->c->analysis;
  if (law->kind != CONTACT_BONDED) return a->contact;
  return PetscMax(1, CONTACT_MARGIN * (2 / PetscSqr(case_courant(a)) - 1));
}

/* One behind the other; 0: a wall, which does not give. */
static PetscReal behind(PetscReal own, PetscReal other) { return other > 0 ? own * other / (own + other) : own; }

static PetscReal modulus_of(const ContactPoint *c) { return behind(c->modulus[0], c->modulus[1]); }

static PetscReal impedance_of(const ContactPoint *c)
{
  return behind(PetscSqrtReal(c->modulus[0] * c->density[0]), PetscSqrtReal(c->modulus[1] * c->density[1]));
}

/* A wall that appears when the run's step ends has no part in it. */
static PetscBool is_still_to_come(const Model *m, const Explicit *e, const ContactPoint *c)
{
  return (PetscBool)(c->wall < m->contact->n_walls && !wall_stands(m->walls, c->wall, e->time));
}

/* Force of one wall on one point. Between substeps it keeps what its law starts from. */
static void push(const Model *m, const Explicit *e, ContactPoint *c)
{
  const ContactPlace place = {.at = {.gap = c->open}, .push = {c->normal[0], c->normal[1], c->normal[2]}};
  static const PetscReal nowhere[3] = {0, 0, 0};
  const PetscReal pressure = vector_dot(c->last, c->normal);
  ContactForce before = {.pressure = beside_spring(e, c)};
  for (int d = 0; d < 3; ++d) before.shear[d] = c->last[d] - pressure * c->normal[d];
  c->law.bond = c->bond;
  c->state = CONTACT_OPEN;
  c->now = (ContactForce){0};
  c->gap = place.at.gap;
  if (e->dt > 0 && c->wall < m->contact->n_walls)
    wall_motion(m->walls, c->wall, e->time, e->time + e->dt, c->x, c->swept);
  if (c->section == 0 || (e->dt > 0 ? c->gone : is_still_to_come(m, e, c))) return;
  c->state = contact_law(&c->law, &place, nowhere, &before, &c->now, NULL);
}

/* Stiffness and mass of the nodes: of each spring as much as any place between point and surface gives it. */
static PetscErrorCode SumSprings(const Model *m, const Explicit *e)
{
  const Contact *s = m->contact;
  PetscReal *at = e->springs;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < e->n_active; ++k) {
    at[2 * e->active[k]] = 0;
    at[2 * e->active[k] + 1] = e->sum[e->active[k] * e->width];
  }
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    for (PetscInt k = c->first; k < c->first + c->n; ++k)
      at[2 * s->node[k]] += PetscMax(PetscAbsReal(s->N[k]), PetscAbsReal(s->N[k] - s->lead[k])) * c->law.penalty;
  PetscCall(NodesShare(m, 2, at));
  PetscFunctionReturn(0);
}

/* Row sum of N M^-1 N^T k, 1/s2, which bounds the square of the frequency of the springs, where this one acts `out` of
 * the way from its point (0) to the surface (1). */
static PetscReal row_of(const Contact *s, const ContactPoint *c, const PetscReal *at, PetscReal out)
{
  PetscReal sum = 0;
  for (PetscInt k = c->first; k < c->first + c->n; ++k) {
    const PetscReal *node = at + 2 * s->node[k];
    if (node[1] > 1e-300) sum += PetscAbsReal(s->N[k] - (1 - out) * s->lead[k]) * node[0] / node[1];
  }
  return sum;
}

/* Force, torque and the gap's change are those of the place `out` of the way from its point to the surface. */
static void draw_in(const Contact *s, ContactPoint *c, PetscReal out)
{
  for (PetscInt k = c->first; k < c->first + c->n; ++k) {
    s->N[k] -= (1 - out) * s->lead[k];
    s->lead[k] *= out;
  }
  for (int d = 0; d < 3; ++d) c->x[d] += (1 - out) * c->reach * c->normal[d];
}

/* A node that points hardly reach has next to no mass, and functions at the surface give it a share of the springs all
 * the same; at the point itself the share goes with the mass. Where laws yield, and points come to such nodes and leave
 * them, springs are no stiffer than the substep bears; what that would soften more than SOFTEST times acts nearer to
 * its point instead. A spring without stiffness lets the wall in, which has it back, many times over, when the point
 * has passed the line of the grid (docs/theory.md, section 73). */
static PetscErrorCode Limit(const Model *m, const Explicit *e)
{
  const PetscReal dt = case_courant(&m->c->analysis) * e->critical;
  const PetscReal most = MOST * (1 - PetscSqr(case_courant_of_musl(&m->c->analysis))) / PetscSqr(dt);
  const Contact *s = m->contact;

  PetscFunctionBeginUser;
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) c->borne = 1;
  if (!materials_yield(m->c->n_materials, m->materials)) PetscFunctionReturn(0); /* bodies stay whole */
  PetscCall(SumSprings(m, e));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscReal surface = row_of(s, c, e->springs, 1);
    if (!(surface > most)) continue;
    const PetscReal point = row_of(s, c, e->springs, 0), row = PetscMin(surface, SOFTEST * PetscMax(most, point));
    if (row < surface) draw_in(s, c, (row - point) / (surface - point));
    c->borne = most / row;
    c->law.penalty *= c->borne;
    c->law.along *= c->borne;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode WallsPush(Model *m, Explicit *e)
{
  const PetscInt dim = m->dim;
  Contact *s = m->contact;
  PetscReal f[3];

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const RigidWall *heavy = contact_rigid(s, c);
    c->law.penalty = stiffness(m, &c->law) * c->section * modulus_of(c) / s->length;
    if (heavy) c->law.penalty *= e->ease[heavy - s->rigid];
    c->law.along = c->law.penalty;
  }
  PetscCall(Limit(m, e));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (c->section > 0 && !contact_is_sprung(*kept_of(m, c))) take_over(c);
    push(m, e, c);
    if (c->state == CONTACT_OPEN) continue;
    contact_force(c, f);
    for (PetscInt k = c->first; k < c->first + c->n; ++k)
      for (PetscInt d = 0; d < dim; ++d) e->sum[s->node[k] * e->width + 1 + dim + d] += s->N[k] * f[d];
    for (int d = 0; d < 3; ++d) f[d] *= e->kick / e->step;
    contact_add(c->x, dim, f, e->pushed + c->wall);
  }
  PetscCall(HeavyMove(m, e));
  PetscFunctionReturn(0);
}

/* What its place on the surface moves by (against the other body): with its point, and beyond that with what strains
 * it. lead: along the normal, of that alone, in its own body. */
static void move_of(const Model *m, const Explicit *e, const ContactPoint *c, PetscReal move[3], PetscReal *lead)
{
  const Contact *s = m->contact;
  *lead = move[0] = move[1] = move[2] = 0;
  for (PetscInt k = c->first; k < c->first + c->n; ++k)
    for (PetscInt d = 0; d < m->dim; ++d) {
      const PetscReal beyond = e->dt * s->lead[k] * e->straining[s->node[k] * m->dim + d];
      move[d] += e->dt * (s->N[k] - s->lead[k]) * explicit_way(e, m->dim, s->node[k])[d] + beyond;
      if (k < c->first + c->own) *lead += c->normal[d] * beyond;
    }
}

/* Work that sliding by s takes: of the slip that the spring does not keep, against the force that it then has. What the
 * spring takes it gives back, or has when contact opens: that goes the way of all springs. */
static PetscReal sliding_work(const ContactPoint *c, const PetscReal s[3])
{
  PetscReal square = 0;
  for (int d = 0; d < 3; ++d) square += PetscSqr(c->now.shear[d] - c->law.along * s[d]);
  const PetscReal most = contact_most(&c->law, c->now.pressure), size = PetscSqrtReal(square);
  if (c->law.kind != CONTACT_FRICTION || !(size > most)) return 0;
  return most * (size - most) / c->law.along;
}

/* Work of a wall that goes as it is told, along what its matter there goes by while the force acts: from the middle of
 * the last substep to that of this one. A way that began where the force acts would lead into what turns, half a
 * substep off (docs/theory.md, section 88). */
static PetscReal driven_work(const Model *m, const Explicit *e, const ContactPoint *c)
{
  PetscReal before[3], after[3], work = 0;
  if (c->state == CONTACT_OPEN || c->wall >= m->contact->n_walls || contact_rigid(m->contact, c)) return 0;
  wall_motion(m->walls, c->wall, e->time, e->time - e->before / 2, c->x, before);
  wall_motion(m->walls, c->wall, e->time, e->time + e->dt / 2, c->x, after);
  for (int d = 0; d < 3; ++d) work += (c->now.pressure * c->normal[d] + c->now.shear[d]) * (after[d] - before[d]);
  return work;
}

/* What its law starts from in the next substep; after the last one of the run's step, the force itself. move: of
 * its place on the surface against the wall. */
static void keep(const Model *m, Explicit *e, const ContactPoint *c, const PetscReal move[3], PetscReal *kept)
{
  const PetscReal closing = vector_dot(move, c->normal), rubs = c->law.kind != CONTACT_FRICTIONLESS;
  const PetscBool heavy = contact_rigid(m->contact, c) != NULL;
  const PetscReal dashpot =
    DASHPOT * c->borne * c->section * impedance_of(c) * (heavy ? heavy_substep(e) / e->critical : 1);
  const PetscReal along = e->dt > 0 ? -dashpot * closing / e->dt : c->now.pressure;
  PetscReal slip[3];
  for (int d = 0; d < 3; ++d) slip[d] = move[d] - closing * c->normal[d];
  if (rubs) e->rubbed[c->wall] += sliding_work(c, slip);
  for (PetscInt d = 0; d < m->dim; ++d)
    kept[d] = along * c->normal[d] + rubs * (c->now.shear[d] - c->law.along * slip[d]);
  e->boundary += driven_work(m, e, c);
}

/* Of an open wall: what sinks in further than it is thick has come from where it came. */
static void keep_side(const ContactPoint *c, PetscInt dim, PetscReal towards, PetscReal *kept)
{
  if (!c->side) return;
  kept[KEPT_SIDE(dim)] = c->side;
  kept[KEPT_DISTANCE(dim)] = c->open - c->behind + c->reach + towards;
}

/* What is open keeps its slip, too: when it closes it has been sliding. */
void walls_follow(Model *m, Explicit *e)
{
  const Contact *s = m->contact;
  if (!s) return;
  if (e->dt > 0) near_forget(m, e);
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    PetscReal *kept = kept_of(m, c);
    const PetscReal first = m->points->real[POINT_REACH][c->owner];
    PetscReal move[3], lead;
    if (c->state == CONTACT_OPEN && !(e->dt > 0)) continue;
    if (c->state != CONTACT_OPEN) e->sunk[c->wall] = PetscMax(e->sunk[c->wall], -c->gap);
    move_of(m, e, c, move, &lead);
    for (int d = 0; d < 3; ++d) move[d] -= c->swept[d];
    kept[KEPT_STATE] = (PetscReal)c->state + CONTACT_SPRING;
    kept[KEPT_REACH] = PetscMax(THINNEST * first, PetscMin(contact_farthest(m->points, c->owner), c->reach - lead));
    keep(m, e, c, move, kept + KEPT_FORCE);
    kept[KEPT_STAYS(m->dim)] = 1;
    kept[KEPT_PASSED(m->dim)] = c->behind;
    keep_side(c, m->dim, vector_dot(move, c->normal) - lead, kept);
    contact_keep_normal(kept, m->dim, s->sides, c->normal);
  }
  heavy_go(m);
}

/* Of each partner what acts on its material at the end of the step: implicit steps that follow begin with it. */
static PetscErrorCode TakeRates(Model *m)
{
  Contact *s = m->contact;
  ContactSum *now;
  PetscReal f[3];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->n_partners, &now));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (c->state == CONTACT_OPEN) continue;
    contact_force(c, f);
    contact_add(c->x, m->dim, f, now + c->wall);
  }
  const size_t numbers = (size_t)s->n_partners * sizeof *now / sizeof(PetscReal);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, now, (PetscMPIInt)numbers, MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt k = 0; k < s->n_partners; ++k) s->wall[k].rate = now[k];
  PetscCall(PetscFree(now));
  PetscFunctionReturn(0);
}

/* What has gone into walls on the way, and through open ones. */
static PetscErrorCode AddSunk(Contact *s, PetscReal *sunk, MPI_Comm comm)
{
  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sunk, (PetscMPIInt)s->n_partners, MPIU_REAL, MPI_MAX, comm));
  for (PetscInt k = 0; k < s->n_partners; ++k) s->sunk[k] = PetscMax(s->sunk[k], sunk[k]);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, s->crosses, (PetscMPIInt)s->n_partners, MPIU_REAL, MPI_SUM, comm));
  for (PetscInt k = 0; k < s->n_partners; ++k) s->crossed[k] += s->crosses[k];
  PetscCall(PetscArrayzero(s->crosses, s->n_partners));
  PetscFunctionReturn(0);
}

/* What measures ask of each wall after a step of the run. */
PetscErrorCode WallsAccount(Model *m, Explicit *e)
{
  Contact *s = m->contact;
  PetscReal *area, *deepest;

  PetscFunctionBeginUser;
  e->friction = 0;
  if (!s) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(s->n_partners, &area, s->n_partners, &deepest));
  PetscCall(ContactCover(s, m->grid));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (c->covered) area[c->wall] += c->section;
    if (c->state != CONTACT_OPEN) deepest[c->wall] = PetscMax(deepest[c->wall], -c->gap);
  }
  for (PetscInt k = 0; k < s->n_partners; ++k) e->friction += e->rubbed[k];
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, area, (PetscMPIInt)s->n_partners, MPIU_REAL, MPI_SUM, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, deepest, (PetscMPIInt)s->n_partners, MPIU_REAL, MPI_MAX, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, e->rubbed, (PetscMPIInt)s->n_partners, MPIU_REAL, MPI_SUM, m->comm));
  const size_t numbers = (size_t)s->n_partners * sizeof *e->pushed / sizeof(PetscReal);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, e->pushed, (PetscMPIInt)numbers, MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt k = 0; k < s->n_partners; ++k) {
    s->wall[k].mean = e->pushed[k];
    s->wall[k].friction += e->rubbed[k];
    s->wall[k].area = area[k];
    s->wall[k].deepest = deepest[k];
  }
  PetscCall(AddSunk(s, e->sunk, m->comm));
  PetscCall(TakeRates(m));
  PetscCall(PetscFree2(area, deepest));
  PetscFunctionReturn(0);
}
