/* Walls and interfaces in a step: what they do to motion, momentum and energy. */
#include "base/math/vector.h"
#include "model/model_private.h"

#define BRIEF 0.1 /* of the step that is wanted: shorter ones are those that outputs and changes cut off */
/* Of the step: by its first and last part a wall tells how fast it goes at its ends, whatever corner lies between. */
#define GLANCE 0.0625
#define SUM_NUMBERS ((PetscInt)(sizeof(ContactSum) / sizeof(PetscReal)))

static PetscBool rubs(ContactKind kind) { return kind == CONTACT_FRICTION || kind == CONTACT_STICK; }

PetscBool contact_rubs(const Case *c)
{
  return (PetscBool)(case_has_contact(c, CONTACT_FRICTION) || case_has_contact(c, CONTACT_STICK));
}

PetscBool contact_turns(const Case *c)
{
  for (PetscInt k = 0; k < c->n_walls; ++k)
    if (c->walls[k].contact != CONTACT_BONDED && wall_turns(c->walls + k)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static ContactMotion motion_of(const Model *m, const ContactMass *whole, PetscReal *motion, PetscReal *given,
                               PetscReal dt, PetscBool start)
{
  return (ContactMotion){.grid = m->grid,
                         .mass = m->nodes->mass,
                         .whole = whole->multiply ? whole : NULL,
                         .frames = &m->boundary->frames,
                         .fixed = m->nodes->fixed,
                         .motion = motion,
                         .given = given,
                         .du = m->nodes->du,
                         .time = start ? m->time : m->time + dt,
                         .glance = start ? GLANCE * dt : -GLANCE * dt,
                         .rate = 1 / dt,
                         .pulls = !start,
                         .start = start,
                         .jumps = m->scheme->middle};
}

PetscBool contact_holds(const Model *m) { return m->scheme->inertia && !m->scheme->middle; }

/* The midpoint rule has exact ways of all that goes on as it came, impacts too. Where a wall's own velocity jumps, what
 * it touches would have twice the jump and nothing in turns, for ever (docs/theory.md 18). */
static PetscBool starts_with_walls(const Model *m)
{
  return (PetscBool)(contact_holds(m) || (m->scheme->middle && !m->initial.seeking));
}

/* Who asks for less of forces out of balance asks for as much less of gaps. */
#define USUAL_RESIDUAL 1e-8
#define LEAST_ASKED 1e-6 /* beyond it all is round-off */

/* With inertia a wall's force acts over the whole step, and Newmark's formulas would weigh it as that of one end:
 * so it is asked for as much larger, and what they remember of the last step's is taken back, or it would push what
 * leaves. What rests asks for just the force that is remembered (docs/theory.md 18). */
static ContactShare share_of_force(const Model *m)
{
  const TimeWeights w = m->scheme->weights(&m->c->analysis, 1);
  const PetscBool yields = materials_yield(m->c->n_materials, m->materials);
  const PetscReal asked = PetscMax(LEAST_ASKED, PetscMin(1, m->c->newton.residual / USUAL_RESIDUAL));
  if (!contact_holds(m))
    return (ContactShare){.mean = 1,
                          .asked = asked,
                          .yields = yields,
                          .moves = m->scheme->inertia,
                          .fades = m->method->restores_grid && m->control.wait == 0 && !m->initial.seeking};
  return (ContactShare){.inertia = PETSC_TRUE,
                        .asked = asked,
                        .flows = yields,
                        .yields = yields,
                        .moves = PETSC_TRUE,
                        .mean = w.mean / (1 - w.lag),
                        .back = (1 - w.lag) * (1 - w.mean) / w.mean - w.lag,
                        .lag = w.lag};
}

static void forget(Model *m, const ContactPoint *c)
{
  PetscReal *kept = contact_kept_of(m->contact, m->points, c);
  for (PetscInt d = 0; d < m->dim; ++d) kept[KEPT_FORCE + d] = 0;
}

/* Of the last force: what nodes remember of it as acceleration, or all, but for walls that are gone. */
static PetscReal share_of_last(const ContactPoint *c, PetscBool remembered)
{
  if (c->before == CONTACT_OPEN) return 0;
  return remembered ? c->stays : !c->gone;
}

static PetscErrorCode AddLast(Model *m, PetscBool remembered, PetscReal *external)
{
  const PetscInt dim = m->dim;
  Contact *s = m->contact;
  PetscReal *force;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  PetscCall(ContactFind(s, &scene));
  PetscCall(PetscCalloc1(m->grid->n_nodes * dim, &force));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscReal share = share_of_last(c, remembered);
    for (PetscInt e = c->first; e < c->first + c->n && share > 0; ++e)
      for (PetscInt d = 0; d < dim; ++d) force[s->node[e] * dim + d] += s->N[e] * share * c->last[d];
    if (c->gone && !remembered) forget(m, c);
  }
  PetscCall(GridSumToOwners(m->grid, dim, force));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) external[i] += force[i];
  PetscCall(PetscFree(force));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactGoOn(Model *m, PetscReal *external)
{
  PetscFunctionBeginUser;
  PetscCall(AddLast(m, PETSC_FALSE, external));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactRemembered(Model *m, PetscReal *external)
{
  PetscFunctionBeginUser;
  PetscCall(AddLast(m, PETSC_TRUE, external));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactBegin(Model *m, PetscBool remembered)
{
  Contact *s = m->contact;
  const PetscInt n = s ? s->n_partners : 0;
  ContactSum *sum;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(n, &sum));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    const PetscReal share = share_of_last(c, remembered);
    const PetscReal f[3] = {share * c->last[0], share * c->last[1], share * c->last[2]};
    if (share > 0) contact_add(c->x, m->dim, f, sum + c->wall);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(n * SUM_NUMBERS), MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt k = 0; k < n; ++k) s->wall[k].rate = sum[k];
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactTell(Model *m)
{
  Contact *s = m->contact;

  PetscFunctionBeginUser;
  PetscCall(ContactBegin(m, PETSC_FALSE));
  for (PetscInt k = 0; s && k < s->n_partners; ++k) s->wall[k].mean = s->wall[k].rate;
  PetscCall(ContactBegin(m, PETSC_TRUE));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactTouches(const Contact *s, MPI_Comm comm, PetscBool *any)
{
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    here |= c->touches || c->before != CONTACT_OPEN || c->state != CONTACT_OPEN;
  PetscCallMPI(MPI_Allreduce(&here, any, 1, MPIU_BOOL, MPI_LOR, comm));
  PetscFunctionReturn(0);
}

/* Sets the velocity of what is in contact to its wall's. */
static PetscErrorCode Project(const Model *m, PetscReal *v, PetscReal *given, PetscReal dt, PetscBool start)
{
  ContactMass whole;
  PetscBool any;

  PetscFunctionBeginUser;
  PetscCall(ContactTouches(m->contact, m->comm, &any));
  if (!any) PetscFunctionReturn(0);
  PetscCall(ContactMassCreate(m, &whole));
  const ContactMotion motion = motion_of(m, &whole, v, given, dt, start);
  PetscCall(ContactProject(m->contact, &motion, m->contact->impulse));
  PetscCall(ContactMassDestroy(&whole));
  PetscFunctionReturn(0);
}

/* Of what is too deep as the step begins: to close that in a step much shorter than the others takes a force that grows
 * with the square of its shortness, and the next one takes it for what acts. So it is closed in proportion. */
static PetscReal left_deep(const Model *m, PetscReal dt)
{
  return contact_holds(m) && dt < BRIEF * m->control.next ? 1 - dt / m->control.next : 0;
}

/* What was in contact starts with its wall's velocity, as a prescribed node does. */
PetscErrorCode ContactHold(Model *m, PetscReal dt, PetscReal inertia)
{
  PetscFunctionBeginUser;
  if (!m->contact) PetscFunctionReturn(0);
  contact_again(m->contact);
  ContactShare share = share_of_force(m);
  share.leaves = left_deep(m, dt);
  /* no time passes where an equilibrium is sought: walls stand still */
  contact_prepare(m->contact, m->time, m->initial.seeking ? 0 : dt, inertia, share);
  if (case_has_contact(m->c, CONTACT_BONDED)) PetscCall(ContactFindAlone(m->contact, m->grid, m->method->clouds));
  contact_find_held(m->contact, m->boundary->fixed, m->nodes->prescribed, &m->boundary->frames);
  for (RigidWall *b = m->contact->rigid; b < m->contact->rigid + m->contact->n_rigid; ++b)
    rigid_begin(b, m->walls, m->c, m->time, dt, share_of_force(m).mean, m->scheme->middle);
  if (!starts_with_walls(m)) PetscFunctionReturn(0);
  PetscCall(Project(m, m->nodes->v, m->nodes->impulse, dt, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* Impulses at the end of the step, which prescribed nodes do not feel: they are the boundary's. */
static PetscErrorCode ProjectEnd(Model *m, PetscReal dt, EnergyStep *energy)
{
  NodalFields *n = m->nodes;
  PetscReal *given;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &given));
  PetscCall(Project(m, n->v1, given, dt, PETSC_FALSE));
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    if (given[i] == 0) continue; /* all but everywhere */
    const PetscReal work = given[i] * n->prescribed[i] / dt;
    n->impulse[i] += given[i];
    energy->boundary += work;
    energy->transfer += work;
  }
  PetscCall(PetscFree(given));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactEnd(Model *m, PetscReal dt, EnergyStep *energy)
{
  Contact *s = m->contact;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; s && k < s->n_rigid; ++k) rigid_end(s->rigid + k);
  if (!s || !m->scheme->inertia) PetscFunctionReturn(0);
  if (contact_holds(m)) PetscCall(ProjectEnd(m, dt, energy));
  for (PetscInt k = 0; k < s->n_partners; ++k) {
    energy->friction += s->impulse[k].sliding;
    energy->transfer -= s->impulse[k].sliding;
  }
  energy->boundary += s->driven;
  energy->transfer += s->driven;
  PetscFunctionReturn(0);
}

/* How often `passing` looks for the matter that it asks: each look leaves half the wall's turn of what the last one was
 * off by. */
#define LOOKS 4

/* The way of the wall's matter that has its middle where that of the material to x has it: along that a force does what
 * its torque does. Of what sticks it is its own. A way that began where the material does would lead into what turns,
 * by half of its turn, and a smooth drum would work against what it carries (docs/theory.md, section 88). */
static void passing(const Model *m, const ContactPoint *c, PetscReal dt, const PetscReal x[3], PetscReal passes[3])
{
  const Contact *s = m->contact;
  PetscReal start[3];
  for (int d = 0; d < 3; ++d) passes[d] = c->swept[d];
  if (c->wall >= s->n_walls || contact_rigid(s, c)) return;
  for (int look = 0; look < LOOKS; ++look) {
    for (int d = 0; d < 3; ++d) start[d] = 0.5 * (c->x[d] + x[d] - passes[d]);
    wall_motion(s->walls, c->wall, m->time, m->time + dt, start, passes);
  }
}

/* What of the way of a wall that goes as it is told does no work: that by which it passes held nodes, where the
 * boundary bears its force. Along a wall that rubs they slide. */
static void idling(const Model *m, const ContactPoint *c, const PetscReal passes[3], PetscReal idle[3])
{
  const PetscBool told = (PetscBool)!contact_rigid(m->contact, c);
  PetscReal let[3];
  const PetscReal passed = contact_let_pass(c, passes, let);
  for (int d = 0; d < 3; ++d) idle[d] = !told ? 0 : rubs(c->law.kind) ? (passed - c->behind) * c->facing[d] : let[d];
}

static PetscBool is_none(const PetscReal f[3]) { return (PetscBool)(f[0] == 0 && f[1] == 0 && f[2] == 0); }

/* Of the mean force in the step: with inertia that of its end, in statics of both ends, each with the normal that it
 * has there. */
static ContactWork point_work(const Model *m, const ContactPoint *c, PetscReal dt)
{
  const PetscReal end = m->scheme->inertia ? share_of_force(m).mean : 0.5, first = m->scheme->inertia ? 0 : 0.5;
  PetscReal acts[3], balance[3], x[3], passes[3], idle[3];
  ContactWork work = {0};
  contact_acts(c, acts);
  if (is_none(acts) && is_none(c->last)) return work; /* most that is near a wall has not met it */
  contact_balance(m->contact, c, balance);
  contact_place(m->contact, c, m->nodes->du, 1, x);
  passing(m, c, dt, x, passes);
  idling(m, c, passes, idle);
  const PetscReal pressed = first * vector_dot(c->last, c->facing), presses = end * vector_dot(acts, c->push);
  for (int d = 0; d < 3; ++d) {
    const PetscReal f = first * c->last[d] + end * acts[d], pressure = pressed * c->facing[d] + presses * c->push[d];
    const PetscReal went = x[d] - c->x[d], way = went - passes[d] + idle[d], start = c->stays * c->last[d];
    work.start += 0.5 * start * went;
    work.more += (f - 0.5 * (start + balance[d])) * went;
    work.moving += f * (passes[d] - idle[d]);
    work.closing += pressure * way;
    work.sliding -= (f - pressure) * way;
  }
  if (!rubs(c->law.kind)) { /* along a wall that does not rub only a force does work that had another normal before */
    work.closing -= work.sliding;
    work.sliding = 0;
  }
  if (!m->scheme->inertia || m->scheme->middle) work.more = 0; /* the balance has all of it */
  return work;
}

ContactWork contact_work(const Model *m, PetscReal dt)
{
  const Contact *s = m->contact;
  ContactWork sum = {0};
  for (PetscInt k = 0; s && k < s->n; ++k) {
    const ContactWork work = point_work(m, s->point + k, dt);
    if (contact_rigid(s, s->point + k)) sum.rigid += work.moving;
    sum.start += work.start;
    sum.moving += work.moving;
    sum.sliding += work.sliding;
    sum.closing += work.closing;
    sum.more += work.more;
  }
  return sum;
}

/* That of the end of the step: strained it is, but not yet moved. */
static void take_section(const Model *m, const NodalScene *scene, ContactPoint *c)
{
  const Contact *s = m->contact;
  PetscReal x[3], r = point_real(m->points, POINT_X, c->owner)[0];
  contact_place(s, c, m->nodes->du, 1, x);
  for (PetscInt e = c->first; e < c->first + c->own; ++e)
    r += (s->N[e] - s->lead[e]) * m->nodes->du[s->node[e] * m->dim];
  c->section = c->cover * contact_section(scene, c->owner, c->normal, (PetscReal[]){r, x[0]});
}

/* dt: of the step that has slid them; 0: none has. */
static PetscErrorCode Survey(Model *m, PetscReal dt)
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  const Contact *s = m->contact;
  PetscReal *sums, *deepest;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  const PetscInt n = s->n_partners;
  PetscCall(PetscCalloc2(2 * n, &sums, n, &deepest));
  PetscCall(ContactCover(m->contact, m->grid));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (dt > 0) sums[c->wall] += point_work(m, c, dt).sliding;
    if (!c->covered) continue;
    take_section(m, &scene, c);
    sums[n + c->wall] += c->section;
    deepest[c->wall] = PetscMax(deepest[c->wall], -c->gap);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sums, (PetscMPIInt)(2 * n), MPIU_REAL, MPI_SUM, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, deepest, (PetscMPIInt)n, MPIU_REAL, MPI_MAX, m->comm));
  for (PetscInt k = 0; k < n; ++k) {
    s->wall[k].friction += sums[k];
    s->wall[k].area = sums[n + k];
    s->wall[k].deepest = deepest[k];
  }
  PetscCall(PetscFree2(sums, deepest));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactSurvey(Model *m, PetscReal dt)
{
  PetscFunctionBeginUser;
  PetscCall(Survey(m, dt));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactStand(Model *m)
{
  PetscFunctionBeginUser;
  if (!m->contact) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(m->nodes->du, m->grid->n_nodes * m->dim));
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  PetscCall(ContactFind(m->contact, &scene));
  contact_stand(m->contact, share_of_force(m).mean);
  PetscCall(Survey(m, 0));
  PetscFunctionReturn(0);
}

/* sum += factor x */
static void add(ContactSum *sum, PetscReal factor, const ContactSum *x)
{
  for (int d = 0; d < 3; ++d) {
    sum->force[d] += factor * x->force[d];
    sum->torque[d] += factor * x->torque[d];
  }
}

/* A wall with mass has lost what the material got, to the last bit: also where that got it by the force of
 * the last step on what has gone away since. */
static void settle(Model *m, PetscReal dt)
{
  for (RigidWall *b = m->contact->rigid; b < m->contact->rigid + m->contact->n_rigid; ++b) {
    PetscReal p[RIGID] = {0, 0, 0, 0, 0, 0};
    for (int d = 0; d < 3; ++d) p[d] = b->given[d] - dt * m->contact->wall[b->wall].mean.force[d];
    if (m->scheme->inertia) rigid_push(b, p);
  }
}

/* Of a wall in the step: forces of the balance where they act in the middle of the way, and at its end; impulses; what
 * is taken out of those of the end; by how much the torque of what nodes remember grows from the step's start to its
 * middle. */
enum { MIDDLE, AT_END, IMPULSES, EXCESS, REMEMBERED, PARTS };

static void sum_point(const Model *m, const ContactPoint *c, PetscInt n, ContactSum *now)
{
  const Contact *s = m->contact;
  PetscReal f[3], start[3], middle[3], end[3], last[3], moved[3];
  contact_place(s, c, m->nodes->du, 0, start);
  contact_place(s, c, m->nodes->du, 0.5, middle);
  contact_place(s, c, m->nodes->du, 1, end);
  contact_balance(s, c, f);
  /* as angular momentum has it; in statics forces are those at the end */
  contact_add(m->scheme->inertia ? middle : end, m->dim, f, now + MIDDLE * n + c->wall);
  contact_add(end, m->dim, f, now + AT_END * n + c->wall);
  contact_excess(s, c, f);
  contact_add(end, m->dim, f, now + EXCESS * n + c->wall);
  for (int d = 0; d < 3; ++d) last[d] = c->stays * c->last[d], moved[d] = middle[d] - start[d];
  contact_add(moved, m->dim, last, now + REMEMBERED * n + c->wall);
}

/* Forces that nodes remember of the last step, where these have come to by so many halves of their way. */
static ContactSum remembered(const ContactSum *rate, const ContactSum *moved, PetscReal halves)
{
  ContactSum sum = *rate;
  for (int d = 0; d < 3; ++d) sum.torque[d] += halves * moved->torque[d];
  return sum;
}

/* As reactions of the boundary (accept.c): over the step the scheme weighs the forces of both ends,
 * and impulses count besides. */
PetscErrorCode ContactForces(Model *m, PetscReal dt)
{
  const TimeWeights w = m->scheme->weights(&m->c->analysis, dt);
  Contact *s = m->contact;
  const PetscInt n = s ? s->n_partners : 0;
  ContactSum *now;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(PARTS * n, &now));
  for (PetscInt k = 0; k < s->n; ++k) sum_point(m, s->point + k, n, now);
  PetscCall(PetscArraycpy(now + IMPULSES * n, s->impulse, n));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, now, (PetscMPIInt)(PARTS * n * SUM_NUMBERS), MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt k = 0; k < n; ++k) {
    WallState *wall = s->wall + k;
    const ContactSum *moved = now + REMEMBERED * n + k;
    const ContactSum middle = remembered(&wall->rate, moved, 1), end = remembered(&wall->rate, moved, 2);
    wall->mean = wall->rate = (ContactSum){0};
    wall->friction += now[IMPULSES * n + k].sliding;
    if (m->scheme->inertia) {
      add(&wall->mean, 1 - w.mean - w.mean * w.lag / (1 - w.lag), &middle);
      add(&wall->mean, w.mean / (1 - w.lag), now + MIDDLE * n + k);
      add(&wall->mean, 1 / dt, now + IMPULSES * n + k);
    } else add(&wall->mean, 1, now + MIDDLE * n + k);
    add(&wall->rate, 1 / (1 - w.lag), now + AT_END * n + k);
    add(&wall->rate, -w.lag / (1 - w.lag), &end);
    add(&wall->rate, -1, now + EXCESS * n + k);
  }
  PetscCall(PetscFree(now));
  settle(m, dt);
  PetscCall(ContactRelease(m, dt));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelTractions(const Model *m, PetscInt wall, PetscInt *n, ContactTraction **tractions)
{
  PetscFunctionBeginUser;
  *n = 0, *tractions = NULL;
  if (!m->contact) PetscFunctionReturn(0);
  PetscCall(ContactTractions(m->contact, m->grid, wall, m->nodes->du, share_of_force(m).mean, n, tractions));
  PetscFunctionReturn(0);
}

void contact_force_on(const Model *m, PetscInt p, PetscReal force[3])
{
  const PetscInt sides = contact_sides(m->c);
  force[0] = force[1] = force[2] = 0;
  for (PetscInt i = 0; i < (m->c->n_walls + m->c->n_interfaces) * sides; ++i) {
    const PetscReal *kept = contact_kept(m->points, p, i / sides, sides, i % sides);
    const PetscBool open = (PetscBool)((int)(kept[KEPT_STATE] + 0.5) == CONTACT_OPEN);
    for (PetscInt d = 0; d < m->dim && !open; ++d) force[d] += kept[KEPT_FORCE + d];
  }
}
