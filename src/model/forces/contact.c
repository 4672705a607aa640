/* Walls and interfaces over the life of a model: what touches them, and what they do to motion,
 * momentum and energy. */
#include <string.h>
#include "method/transfer/mass.h"
#include "model/model_private.h"

#define SUM_NUMBERS ((PetscInt)(sizeof(ContactSum) / sizeof(PetscReal)))

#define RELEASED 1e-3 /* of what walls have given too much may stay; at rest that is nothing */
#define MOST_SWEEPS 100
#define LUMPED_SHARE 0.1 /* between the mass matrix and the lumped one */

#define THROUGH 1e-9 /* of a cell: material that reaches deeper into a wall at the start is a mistake */
#define FITS 1e-3    /* of the distance of a wall: so near to it ends what stands on it */
#define PART 0.5     /* likewise, as its volume and its share of the surface tell it */
#define DENT 0.01    /* of a cell: a surface that is taken back by more to fit a wall may be one, too */

static PetscBool rubs(ContactKind kind) { return kind == CONTACT_FRICTION || kind == CONTACT_STICK; }

PetscBool contact_rubs(const Case *c)
{
  for (PetscInt k = 0; k < c->n_walls; ++k)
    if (rubs(c->walls[k].contact)) return PETSC_TRUE;
  for (PetscInt k = 0; k < c->n_interfaces; ++k)
    if (rubs(c->interfaces[k].contact)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The worst of something over points: how much, 0 if there is none, and where. */
typedef struct {
  PetscReal depth, x[3];
} Worst;

static void take_worse(const Model *m, PetscReal depth, const PetscReal *x, Worst *worst)
{
  if (depth <= worst->depth) return;
  worst->depth = depth;
  for (PetscInt d = 0; d < m->dim; ++d) worst->x[d] = x[d];
}

/* Collective. Of all ranks. */
static PetscErrorCode FindWorst(const Model *m, Worst *worst)
{
  struct {
    double depth;
    int rank;
  } local, all;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  local.depth = (double)worst->depth, local.rank = rank;
  PetscCallMPI(MPI_Allreduce(&local, &all, 1, MPI_DOUBLE_INT, MPI_MAXLOC, m->comm));
  worst->depth = (PetscReal)all.depth;
  PetscCallMPI(MPI_Bcast(worst->x, 3, MPIU_REAL, all.rank, m->comm));
  PetscFunctionReturn(0);
}

/* Does the part that the point stands for end there? */
static PetscBool reaches_wall(const Model *m, PetscInt p, const WallPlace *place)
{
  const PetscReal weight = kinematics_weight(m->c->kinematics, point_real(m->points, POINT_X, p)[0]);
  const PetscReal face = contact_face(m->points, p, place->normal);
  const PetscReal half = face > 0 ? 0.5 * m->points->real[POINT_VOLUME][p] / (weight * face) : 0;
  return (PetscBool)(PetscAbsReal(place->gap - half) < PART * half);
}

/* At an edge of a body its surface is elsewhere for each wall: does the body end at this one straight before the point,
 * although that is nearer to another side? */
static PetscBool stands_on(const Model *m, PetscInt p, const WallPlace *place)
{
  const BodySpec *body = m->c->bodies + m->points->body[p];
  const PetscReal *x = point_real(m->points, POINT_X, p);
  PetscReal within[3], beyond[3];
  if (!body->has_shape || body->mesh || place->gap <= m->points->real[POINT_REACH][p]) return PETSC_FALSE;
  if (!reaches_wall(m, p, place)) return PETSC_FALSE;
  for (PetscInt d = 0; d < m->dim; ++d) {
    within[d] = x[d] - (1 - FITS) * place->gap * place->normal[d];
    beyond[d] = x[d] - (1 + FITS) * place->gap * place->normal[d];
  }
  return (PetscBool)(shape_contains(&body->shape, m->dim, within, 0) &&
                     !shape_contains(&body->shape, m->dim, beyond, 0));
}

/* What stands nearer to a wall than its cell's side does touches it: the body was made to fit, and its surface is taken
 * back (dent) to the wall. A point inside the wall is a mistake (inside). */
static void look_at_wall(Model *m, PetscInt k, PetscBool fits, Worst *inside, Worst *dent)
{
  WallPlace place;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p);
    PetscReal *reach = point_real(m->points, POINT_REACH, p);
    const int side = wall_side(m->walls, k, m->time, x);
    if (!wall_near(m->walls, k, m->time, x, fits ? THICKEST * *reach : *reach, side, &place)) continue;
    if (fits && !m->c->stage && stands_on(m, p, &place))
      point_real(m->points, POINT_CONTACT, p)[k * CONTACT_KEPT(m->dim) + 1] = place.gap;
    take_worse(m, -place.gap, x, inside);
    if (!fits || place.gap <= THROUGH * m->grid->smallest || place.gap >= *reach) continue;
    take_worse(m, *reach - place.gap, x, dent);
    *reach = place.gap;
  }
}

static PetscErrorCode TellThrough(const Model *m, PetscInt k, Worst *inside, Diag *diag)
{
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(FindWorst(m, inside));
  if (inside->depth <= 0) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "walls[%d]", (int)k));
  diag_error(diag, path, "wall '%s' goes through a body at the start: the point at (%g, %g, %g) m is %.3g m inside it",
             m->c->walls[k].name, (double)inside->x[0], (double)inside->x[1], (double)inside->x[2],
             (double)inside->depth);
  PetscFunctionReturn(0);
}

/* How deep nodes of bodies are in the wall. */
static void look_at_nodes(const Model *m, PetscInt k, Worst *inside)
{
  WallPlace place;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    const PetscReal *x = m->grid->x + node * m->dim;
    if (wall_near(m->walls, k, m->time, x, 0, 0, &place)) take_worse(m, -place.gap, x, inside);
  }
}

/* Meshes that move with their body know where that ends. (In a corner one side of a point's cell is nearer to it than
 * the other: only where nodes are in the wall, too, is there a dent.) */
static PetscErrorCode TellDent(const Model *m, PetscInt k, Worst *dent, Diag *diag)
{
  Worst inside = {0};
  char path[64];

  PetscFunctionBeginUser;
  if (m->method->restores_grid) PetscFunctionReturn(0);
  look_at_nodes(m, k, &inside);
  PetscCall(FindWorst(m, dent));
  PetscCall(FindWorst(m, &inside));
  if (PetscMin(dent->depth, inside.depth) <= DENT * m->grid->smallest) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "walls[%d]", (int)k));
  diag_warning(
    diag, path,
    "wall '%s' cuts into a body at the start, by %.3g m near (%g, %g, %g) m, %.2g of a cell: its surface there "
    "is taken to be made to fit, with a dent of that depth",
    m->c->walls[k].name, (double)dent->depth, (double)dent->x[0], (double)dent->x[1], (double)dent->x[2],
    (double)(dent->depth / m->grid->smallest));
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
    Worst inside = {0}, dent = {0};
    look_at_wall(m, k, PETSC_TRUE, &inside, &dent);
    if (m->c->stage) continue; /* bodies are elsewhere */
    PetscCall(TellThrough(m, k, &inside, diag));
    PetscCall(TellDent(m, k, &dent, diag));
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
    Worst inside = {0}, dent = {0};
    if (m->c->walls[k].absent || stood(&m->c->walls[k], m->c, from)) continue;
    look_at_wall(m, k, PETSC_FALSE, &inside, &dent);
    PetscCall(TellThrough(m, k, &inside, diag));
  }
  PetscFunctionReturn(0);
}

static ContactMotion motion_of(const Model *m, const ContactMass *whole, PetscReal *motion, PetscReal dt,
                               PetscBool start)
{
  return (ContactMotion){.grid = m->grid,
                         .mass = m->nodes->mass,
                         .whole = whole->multiply ? whole : NULL,
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

/* With inertia a wall's force acts over the whole step, and Newmark's formulas would weigh it as that of one end:
 * so it is asked for as much larger, and what they remember of the last step's is taken back, or it would push what
 * leaves. What rests asks for just the force that is remembered (docs/theory.md 18). */
static ContactShare share_of_force(const Model *m)
{
  const TimeWeights w = m->scheme->weights(&m->c->analysis, 1);
  if (!holds(m)) return (ContactShare){.mean = 1};
  return (ContactShare){.inertia = PETSC_TRUE,
                        .flows = materials_yield(m->c->n_materials, m->materials),
                        .mean = w.mean / (1 - w.lag),
                        .back = (1 - w.lag) * (1 - w.mean) / w.mean - w.lag,
                        .lag = w.lag};
}

static void forget(Model *m, const ContactPoint *c)
{
  PetscReal *kept = point_real(m->points, POINT_CONTACT, c->owner) + c->wall * CONTACT_KEPT(m->dim);
  for (PetscInt d = 0; d < m->dim; ++d) kept[2 + d] = 0;
}

PetscErrorCode ContactGoOn(Model *m, PetscReal *external)
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
    for (PetscInt e = c->first; e < c->first + c->n && c->before != CONTACT_OPEN && !c->gone; ++e)
      for (PetscInt d = 0; d < dim; ++d) force[s->node[e] * dim + d] += s->N[e] * c->last[d];
    if (c->gone) forget(m, c);
  }
  PetscCall(GridSumToOwners(m->grid, dim, force));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) external[i] += force[i];
  PetscCall(PetscFree(force));
  PetscFunctionReturn(0);
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

/* What was in contact starts with its wall's velocity, as a prescribed node does. */
PetscErrorCode ContactHold(Model *m, PetscReal dt, PetscReal inertia)
{
  PetscFunctionBeginUser;
  if (!m->contact) PetscFunctionReturn(0);
  contact_prepare(m->contact, m->time, dt, inertia, share_of_force(m));
  for (RigidWall *b = m->contact->rigid; b < m->contact->rigid + m->contact->n_rigid; ++b)
    rigid_begin(b, m->walls, m->c, m->time, dt, share_of_force(m).mean, m->scheme->middle);
  if (!holds(m)) PetscFunctionReturn(0);
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
  energy->boundary += s->driven;
  energy->transfer += s->driven;
  PetscFunctionReturn(0);
}

/* Of the mean force in the step. */
static ContactWork point_work(const Model *m, const ContactPoint *c)
{
  const PetscReal end = m->scheme->inertia ? share_of_force(m).mean : 0.5, first = m->scheme->inertia ? 0 : 0.5;
  PetscReal f[3], balance[3], x[3], pressure = 0, closing = 0;
  ContactWork work = {0};
  contact_force(c, f);
  contact_balance(m->contact, c, balance);
  contact_place(m->contact, c, m->nodes->du, 1, x);
  for (int d = 0; d < 3; ++d) {
    f[d] = first * c->last[d] + end * f[d];
    pressure += f[d] * c->normal[d];
    closing += (x[d] - c->x[d] - c->swept[d]) * c->normal[d];
  }
  for (int d = 0; d < 3; ++d) {
    const PetscReal start = c->stays * c->last[d];
    work.start += 0.5 * start * (x[d] - c->x[d]);
    work.more += (f[d] - 0.5 * (start + balance[d])) * (x[d] - c->x[d]);
    work.moving += f[d] * c->passes[d];
    work.closing += f[d] * (c->swept[d] - c->passes[d]);
    work.sliding -= (f[d] - pressure * c->normal[d]) * (x[d] - c->x[d] - c->swept[d]);
  }
  work.closing += pressure * closing;
  if (!m->scheme->inertia || m->scheme->middle) work.more = 0; /* the balance has all of it */
  return work;
}

ContactWork contact_work(const Model *m)
{
  const Contact *s = m->contact;
  ContactWork sum = {0};
  for (PetscInt k = 0; s && k < s->n; ++k) {
    const ContactWork work = point_work(m, s->point + k);
    if (contact_rigid(s, s->point + k)) sum.rigid += work.moving;
    sum.start += work.start;
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

/* lack = what of walls' forces the acceleration at the end of the step has more than their mean, in rates of
 * momentum of free dofs. */
static PetscErrorCode SumExcess(const Model *m, MassSolve *c)
{
  const Contact *s = m->contact;
  const PetscInt dim = m->dim;

  PetscFunctionBeginUser;
  for (const ContactPoint *p = s->point; p < s->point + s->n; ++p) {
    PetscReal f[3];
    contact_excess(s, p, f);
    for (PetscInt e = p->first; e < p->first + p->n; ++e)
      for (PetscInt d = 0; d < dim; ++d) c->lack[s->node[e] * c->width + ACCELERATION * dim + d] += s->N[e] * f[d];
  }
  PetscCall(GridSumToOwners(m->grid, c->width, c->lack));
  mass_turn(c, c->lack);
  for (PetscInt i = 0; i < m->grid->n_owned * c->width; ++i)
    if (m->nodes->fixed[i / c->width * dim + i % dim]) c->lack[i] = c->inverse[i] = 0;
  PetscFunctionReturn(0);
}

/* The mass matrix of the balance; where points carry accelerations to other nodes somewhat lumped, since
 * single forces would be accelerations of both signs of nodes that are hardly reached. */
static PetscErrorCode MassOfExcess(const Model *m, Discretisation *space, PetscReal **lumping)
{
  const PetscInt n = m->space->support->n_groups;

  PetscFunctionBeginUser;
  *space = *m->space;
  *lumping = NULL;
  if (!m->method->restores_grid || !space->lumping) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, lumping));
  for (PetscInt g = 0; g < n; ++g) (*lumping)[g] = space->lumping[g] + LUMPED_SHARE * (1 - space->lumping[g]);
  space->lumping = *lumping;
  PetscFunctionReturn(0);
}

/* What is remembered as acceleration is of walls' forces what stays: of what rests all that there is. The rest is
 * taken out at the nodes that felt it. */
static PetscErrorCode Release(Model *m, PetscReal dt)
{
  const PetscReal lag = m->scheme->weights(&m->c->analysis, dt).lag;
  PetscReal enough[MOTIONS], *lumping;
  Discretisation space;
  PetscBool any;
  MassSolve c;

  PetscFunctionBeginUser;
  if (!holds(m)) PetscFunctionReturn(0);
  PetscCall(Touches(m->contact, m->comm, &any));
  if (!any) PetscFunctionReturn(0);
  PetscCall(MassOfExcess(m, &space, &lumping));
  PetscCall(MassSolveCreate(&space, &c));
  c.framed = PETSC_TRUE;
  PetscCall(SumExcess(m, &c));
  PetscCall(MassLack(&c, enough));
  enough[ACCELERATION] *= PetscSqr(RELEASED);
  PetscCall(MassSolveRun(&c, enough, MOST_SWEEPS));
  PetscCall(MassSolveClose(&c));
  mass_turn(&c, c.x);
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) {
    const PetscReal excess = c.x[i / m->dim * c.width + ACCELERATION * m->dim + i % m->dim];
    m->nodes->a1[i] -= excess;
    m->nodes->echo[i] -= lag * excess;
  }
  PetscCall(MassSolveDestroy(&c));
  PetscCall(PetscFree(lumping));
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
  PetscCall(PetscCalloc1(3 * n, &now)); /* forces at the end, impulses, what is taken out of the first */
  for (PetscInt k = 0; k < s->n; ++k) {
    ContactPoint *c = s->point + k;
    PetscReal f[3];
    contact_balance(s, c, f);
    contact_add(c, m->dim, f, now + c->wall);
    contact_excess(s, c, f);
    contact_add(c, m->dim, f, now + 2 * n + c->wall);
  }
  PetscCall(PetscArraycpy(now + n, s->impulse, n));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, now, (PetscMPIInt)(3 * n * SUM_NUMBERS), MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt k = 0; k < n; ++k) {
    WallState *wall = s->wall + k;
    const ContactSum before = wall->rate;
    wall->mean = wall->rate = (ContactSum){0};
    add(&wall->rate, 1 / (1 - w.lag), now + k);
    add(&wall->rate, -w.lag / (1 - w.lag), &before);
    wall->friction += now[n + k].sliding;
    if (m->scheme->inertia) {
      add(&wall->mean, 1 - w.mean, &before);
      add(&wall->mean, w.mean, &wall->rate);
      add(&wall->mean, 1 / dt, now + n + k);
    } else add(&wall->mean, 1, now + k);
    add(&wall->rate, -1, now + 2 * n + k);
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
  PetscCall(ContactTractions(m->contact, m->grid, wall, m->nodes->du, share_of_force(m).mean, n, tractions));
  PetscFunctionReturn(0);
}

void contact_force_on(const Model *m, PetscInt p, PetscReal force[3])
{
  const PetscReal *kept = point_real(m->points, POINT_CONTACT, p);
  force[0] = force[1] = force[2] = 0;
  for (PetscInt k = 0; k < m->c->n_walls + m->c->n_interfaces; ++k, kept += CONTACT_KEPT(m->dim))
    for (PetscInt d = 0; d < m->dim && (int)(kept[0] + 0.5) != CONTACT_OPEN; ++d) force[d] += kept[2 + d];
}
