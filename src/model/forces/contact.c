/* Walls and interfaces over the life of a model: what touches them, and what they do to motion,
 * momentum and energy. */
#include <string.h>
#include "method/transfer/mass.h"
#include "model/model_private.h"

#define SUM_NUMBERS ((PetscInt)(sizeof(ContactSum) / sizeof(PetscReal)))

#define RELEASED 1e-6 /* of the acceleration by walls may stay */
#define MOST_SWEEPS 100

#define THROUGH 1e-9 /* of a cell: material that reaches deeper into a wall at the start is a mistake */

static PetscBool rubs(ContactKind kind) { return kind == CONTACT_FRICTION || kind == CONTACT_STICK; }

PetscBool contact_rubs(const Case *c)
{
  for (PetscInt k = 0; k < c->n_walls; ++k)
    if (rubs(c->walls[k].contact)) return PETSC_TRUE;
  for (PetscInt k = 0; k < c->n_interfaces; ++k)
    if (rubs(c->interfaces[k].contact)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What stands nearer to a wall than its cell's side does touches it: the body was made to fit. A point
 * inside the wall is a mistake. *deepest: gap of the worst. */
static void look_at_wall(Model *m, PetscInt k, PetscBool fits, PetscReal *deepest, PetscReal worst[3])
{
  WallPlace place;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p);
    PetscReal *reach = point_real(m->points, POINT_REACH, p);
    const int side = wall_side(m->walls, k, m->time, x);
    if (!wall_near(m->walls, k, m->time, x, *reach, side, &place)) continue;
    if (fits && place.gap > THROUGH * m->grid->smallest) *reach = PetscMin(*reach, place.gap);
    if (place.gap >= *deepest) continue;
    *deepest = place.gap;
    for (PetscInt d = 0; d < m->dim; ++d) worst[d] = x[d];
  }
}

static PetscErrorCode TellThrough(const Model *m, PetscInt k, PetscReal deepest, PetscReal x[3], Diag *diag)
{
  struct {
    double gap;
    int rank;
  } local, all;
  PetscMPIInt rank;
  char path[64];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  local.gap = (double)deepest, local.rank = rank;
  PetscCallMPI(MPI_Allreduce(&local, &all, 1, MPI_DOUBLE_INT, MPI_MINLOC, m->comm));
  if (all.gap >= 0) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Bcast(x, 3, MPIU_REAL, all.rank, m->comm));
  PetscCall(PetscSNPrintf(path, sizeof path, "walls[%d]", (int)k));
  diag_error(diag, path, "wall '%s' goes through a body at the start: the point at (%g, %g, %g) m is %.3g m inside it",
             m->c->walls[k].name, (double)x[0], (double)x[1], (double)x[2], -all.gap);
  PetscFunctionReturn(0);
}

PetscErrorCode WallsStart(Model *m, Diag *diag)
{
  PetscFunctionBeginUser;
  if (!m->c->n_walls && !m->c->n_interfaces) PetscFunctionReturn(0);
  PetscCall(WallsCreate(m->c, diag, &m->walls));
  PetscCall(ContactCreate(m->c, m->walls, diag, &m->contact));
  rigid_check(m, diag);
  PetscCall(InterfacesStart(m, diag));
  for (PetscInt k = 0; k < m->c->n_walls; ++k) {
    PetscReal deepest = 0, x[3] = {0, 0, 0};
    look_at_wall(m, k, PETSC_TRUE, &deepest, x);
    if (m->c->stage == 0) PetscCall(TellThrough(m, k, deepest, x, diag)); /* others begin with bodies elsewhere */
  }
  PetscFunctionReturn(0);
}

/* Was the wall there before, as it is now? */
static PetscBool stood(const WallSpec *wall, const Case *c, const Case *from)
{
  for (const WallSpec *w = from->walls; w < from->walls + from->n_walls; ++w)
    if (!strcmp(w->name, wall->name)) return !w->absent && wall->since < c->stage;
  return PETSC_FALSE;
}

PetscErrorCode WallsCome(Model *m, const Case *from, Diag *diag)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_walls; ++k) {
    PetscReal deepest = 0, x[3] = {0, 0, 0};
    if (m->c->walls[k].absent || stood(&m->c->walls[k], m->c, from)) continue;
    look_at_wall(m, k, PETSC_FALSE, &deepest, x);
    PetscCall(TellThrough(m, k, deepest, x, diag));
  }
  PetscFunctionReturn(0);
}

static ContactMotion motion_of(const Model *m, const ContactMass *whole, PetscReal *motion, PetscReal dt,
                               PetscBool start)
{
  return (ContactMotion){.grid = m->grid,
                         .mass = m->nodes->mass,
                         .whole = whole && whole->multiply ? whole : NULL,
                         .frames = &m->boundary->frames,
                         .fixed = m->nodes->fixed,
                         .motion = motion,
                         .du = m->nodes->du,
                         .rate = 1 / dt,
                         .pulls = !start,
                         .start = start};
}

/* A scheme that balances forces in the middle of the step remembers none, and lets nothing ring. */
static PetscBool holds(const Model *m) { return m->scheme->inertia && !m->scheme->middle; }

/* What a wall's force is of what the balance at the end of a step asks for: with inertia it acts over the
 * whole step, and Newmark's formulas would weigh it as that of one end (docs/theory.md 18). */
static PetscReal share_of_force(const Model *m)
{
  const TimeWeights w = m->scheme->weights(&m->c->analysis, 1);
  return holds(m) ? w.mean / (1 - w.lag) : 1;
}

void contact_take(Model *m, const Case *from)
{
  const TimeScheme *before = time_scheme_of(&from->analysis);
  const PetscInt n = CONTACT_KEPT(m->dim);
  if (!m->contact || m->c->analysis.type != ANALYSIS_EXPLICIT || !before->inertia || before->middle) return;
  const TimeWeights w = before->weights(&from->analysis, 1);
  for (PetscInt i = 0; i < m->points->n * m->points->components[POINT_CONTACT]; ++i)
    if (i % n >= 2) m->points->real[POINT_CONTACT][i] *= w.mean / (1 - w.lag);
}

/* Can walls' forces be taken out of the acceleration where they acted, at the end of the step? Where points carry
 * it to others and the mass is consistent, single forces are accelerations of both signs of nodes hardly reached. */
static PetscBool releases(const Model *m)
{
  return holds(m) && (!m->method->restores_grid || m->c->analysis.mass == MASS_LUMPED);
}

/* Collective. Does anything touch, or has anything touched at the start of the step? */
static PetscErrorCode Touches(const Contact *s, MPI_Comm comm, PetscBool *any)
{
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c)
    here |= c->touches || c->before != CONTACT_OPEN || c->state != CONTACT_OPEN;
  PetscCallMPI(MPI_Allreduce(&here, any, 1, MPIU_BOOL, MPI_LOR, comm));
  PetscFunctionReturn(0);
}

/* Sets the velocity of what is in contact to its wall's. */
static PetscErrorCode Project(const Model *m, PetscReal *v, PetscReal dt, PetscBool start)
{
  ContactMass whole;
  PetscBool any;

  PetscFunctionBeginUser;
  PetscCall(Touches(m->contact, m->comm, &any));
  if (!any) PetscFunctionReturn(0);
  PetscCall(ContactMassCreate(m, &whole));
  const ContactMotion motion = motion_of(m, &whole, v, dt, start);
  PetscCall(ContactProject(m->contact, &motion, m->contact->impulse));
  PetscCall(ContactMassDestroy(&whole));
  PetscFunctionReturn(0);
}

/* The forces of the last step are taken out of what Newmark's formulas remember, or they would push what
 * leaves; and what was in contact starts with its wall's velocity, as a prescribed node does. Where points
 * carry the acceleration the first has been done (release). */
PetscErrorCode ContactHold(Model *m, PetscReal dt, PetscReal inertia)
{
  PetscFunctionBeginUser;
  if (!m->contact) PetscFunctionReturn(0);
  contact_prepare(m->contact, m->time, dt, inertia, share_of_force(m));
  for (RigidWall *b = m->contact->rigid; b < m->contact->rigid + m->contact->n_rigid; ++b)
    rigid_begin(b, m->walls, m->c, m->time, dt, share_of_force(m), m->scheme->middle);
  if (!holds(m)) PetscFunctionReturn(0);
  const ContactMotion a = motion_of(m, NULL, m->nodes->a, dt, PETSC_TRUE);
  const PetscReal lag = m->scheme->weights(&m->c->analysis, dt).lag;
  if (!releases(m))
    PetscCall(ContactRelease(m->contact, &a, 1 / (1 - lag), m->contact->impulse + m->contact->n_partners));
  PetscCall(Project(m, m->nodes->v, dt, PETSC_TRUE));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactEnd(Model *m, PetscReal dt, EnergyStep *energy)
{
  Contact *s = m->contact;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; s && k < s->n_rigid; ++k) rigid_end(s->rigid + k);
  if (!s || !holds(m)) PetscFunctionReturn(0);
  PetscCall(Project(m, m->nodes->v1, dt, PETSC_FALSE));
  for (PetscInt k = 0; k < s->n_partners; ++k) {
    energy->friction += s->impulse[k].sliding;
    energy->transfer -= s->impulse[k].sliding;
  }
  PetscFunctionReturn(0);
}

/* Of the mean force in the step. */
static ContactWork point_work(const Model *m, const ContactPoint *c)
{
  const PetscReal end = m->scheme->inertia ? share_of_force(m) : 0.5, first = m->scheme->inertia ? 0 : 0.5;
  PetscReal f[3], x[3], pressure = 0, closing = 0;
  ContactWork work = {0};
  contact_force(c, f);
  contact_place(m->contact, c, m->nodes->du, 1, x);
  for (int d = 0; d < 3; ++d) {
    f[d] = first * c->start[d] + end * f[d];
    pressure += f[d] * c->normal[d];
    closing += (x[d] - c->x[d] - c->swept[d]) * c->normal[d];
  }
  for (int d = 0; d < 3; ++d) {
    work.start += 0.5 * c->start[d] * (x[d] - c->x[d]);
    work.moving += f[d] * c->swept[d];
    work.sliding -= (f[d] - pressure * c->normal[d]) * (x[d] - c->x[d] - c->swept[d]);
  }
  work.closing = pressure * closing;
  if (m->scheme->inertia) work.more = (1 - 0.5 / end) * (work.closing + work.moving - work.sliding);
  return work;
}

ContactWork contact_work(const Model *m)
{
  const Contact *s = m->contact;
  ContactWork sum = {0};
  for (PetscInt k = 0; s && k < s->n; ++k) {
    const ContactWork work = point_work(m, s->point + k);
    if (contact_rigid(s, s->point + k)) sum.rigid += work.moving;
    if (!releases(m)) sum.start += work.start;
    sum.moving += work.moving;
    sum.sliding += work.sliding;
    sum.closing += work.closing;
    sum.more += work.more;
  }
  return sum;
}

/* What measures ask of each wall after the step. */
static PetscErrorCode Survey(const Model *m)
{
  const Contact *s = m->contact;
  const PetscInt n = s->n_partners;
  PetscReal *sums, *deepest;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * n, &sums, n, &deepest));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    sums[c->wall] += point_work(m, c).sliding;
    if (c->state == CONTACT_OPEN) continue;
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

/* sum += factor x */
static void add(ContactSum *sum, PetscReal factor, const ContactSum *x)
{
  for (int d = 0; d < 3; ++d) {
    sum->force[d] += factor * x->force[d];
    sum->torque[d] += factor * x->torque[d];
  }
}

/* lack = forces of walls at the end of the step, as rates of momentum of free dofs. */
static PetscErrorCode SumForces(const Model *m, PetscReal share, MassSolve *c)
{
  const Contact *s = m->contact;
  const PetscInt dim = m->dim;

  PetscFunctionBeginUser;
  for (const ContactPoint *p = s->point; p < s->point + s->n; ++p) {
    PetscReal f[3];
    contact_force(p, f);
    for (PetscInt e = p->first; e < p->first + p->n; ++e)
      for (PetscInt d = 0; d < dim; ++d)
        c->lack[s->node[e] * c->width + ACCELERATION * dim + d] += share * s->N[e] * f[d];
  }
  PetscCall(GridSumToOwners(m->grid, c->width, c->lack));
  mass_turn(c, c->lack);
  for (PetscInt i = 0; i < m->grid->n_owned * c->width; ++i)
    if (m->nodes->fixed[i / c->width * dim + i % dim]) c->lack[i] = c->inverse[i] = 0;
  PetscFunctionReturn(0);
}

/* Points that carry acceleration to other nodes do so without what walls made of it, taken out at the
 * nodes that felt their forces: to others, of which some have hardly any mass, they would be leaps. */
static PetscErrorCode Release(Model *m, PetscReal dt)
{
  const PetscReal lag = m->scheme->weights(&m->c->analysis, dt).lag;
  PetscReal enough[MOTIONS];
  PetscBool any;
  MassSolve c;

  PetscFunctionBeginUser;
  if (!releases(m)) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < m->contact->n_partners; ++k) m->contact->wall[k].rate = (ContactSum){0};
  PetscCall(Touches(m->contact, m->comm, &any));
  if (!any) PetscFunctionReturn(0);
  PetscCall(MassSolveCreate(m->space, &c));
  c.framed = PETSC_TRUE;
  PetscCall(SumForces(m, 1 / (1 - lag), &c));
  PetscCall(MassLack(&c, enough));
  enough[ACCELERATION] *= PetscSqr(RELEASED);
  PetscCall(MassSolveRun(&c, enough, MOST_SWEEPS));
  PetscCall(MassSolveClose(&c));
  mass_turn(&c, c.x);
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) {
    const PetscReal by_walls = c.x[i / m->dim * c.width + ACCELERATION * m->dim + i % m->dim];
    m->nodes->a1[i] -= by_walls;
    m->nodes->echo[i] -= lag * by_walls;
  }
  PetscCall(MassSolveDestroy(&c));
  PetscFunctionReturn(0);
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
  PetscCall(PetscCalloc1(3 * n, &now)); /* forces at the end, impulses, forces lost at the start */
  for (PetscInt k = 0; k < s->n; ++k) {
    PetscReal f[3];
    contact_force(s->point + k, f);
    contact_add(s->point + k, m->dim, f, now + s->point[k].wall);
  }
  PetscCall(PetscArraycpy(now + n, s->impulse, 2 * n));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, now, (PetscMPIInt)(3 * n * SUM_NUMBERS), MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt k = 0; k < n; ++k) {
    WallState *wall = s->wall + k;
    ContactSum before = wall->rate;
    wall->mean = wall->rate = (ContactSum){0};
    add(&before, 1, now + 2 * n + k);
    add(&wall->rate, 1 / (1 - w.lag), now + k);
    add(&wall->rate, -w.lag / (1 - w.lag), &before);
    wall->friction += now[n + k].sliding;
    if (m->scheme->inertia) {
      add(&wall->mean, 1 - w.mean, &before);
      add(&wall->mean, w.mean, &wall->rate);
      add(&wall->mean, 1 / dt, now + n + k);
    } else add(&wall->mean, 1, now + k);
  }
  PetscCall(PetscFree(now));
  settle(m, dt);
  PetscCall(Survey(m));
  PetscCall(Release(m, dt));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelTractions(const Model *m, PetscInt wall, PetscInt *n, ContactTraction **tractions)
{
  PetscFunctionBeginUser;
  *n = 0, *tractions = NULL;
  if (!m->contact) PetscFunctionReturn(0);
  PetscCall(ContactTractions(m->contact, m->grid, wall, m->nodes->du, share_of_force(m), n, tractions));
  PetscFunctionReturn(0);
}

void contact_force_on(const Model *m, PetscInt p, PetscReal force[3])
{
  const PetscReal *kept = point_real(m->points, POINT_CONTACT, p);
  force[0] = force[1] = force[2] = 0;
  for (PetscInt k = 0; k < m->c->n_walls + m->c->n_interfaces; ++k, kept += CONTACT_KEPT(m->dim))
    for (PetscInt d = 0; d < m->dim && (int)(kept[0] + 0.5) != CONTACT_OPEN; ++d)
      force[d] += share_of_force(m) * kept[2 + d];
}
