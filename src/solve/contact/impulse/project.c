/* The motion of nodes that lets points in contact go with their walls: the change of least kinetic
 * energy, by impulses at these points,
 *
 *   v := v + M^-1 A^T p,    A v = wall,
 *
 * with the mass M and A v, the motion of the contact points in the directions that are held.
 * Where more points are in contact than nodes can follow, p is not unique: some of it counts as
 * motion, so that it stays small. What slides is rubbed by the impulses, too: friction p against the
 * way that it goes. */
#include "solve/contact/impulse/impulse.h"

#define MOST_LET_GO 8 /* times that points are let go that would pull */

/* Of a wall that goes as it is told at this instant, at the place x of contact point k. Nodes that are held let pass of
 * its way what they do in all of the step. */
static void take_told(const Projection *w, PetscInt k, const PetscReal x[3], PetscReal v[3])
{
  const ContactPoint *c = w->s->point + k;
  PetscReal let[3];
  if (c->wall >= w->s->n_walls) return; /* of bodies the nodes tell it */
  wall_velocity(w->s->walls, c->wall, w->m->time, w->m->glance, x, v);
  (void)contact_let_pass(c, c->swept, let);
  for (int d = 0; d < 3; ++d) v[d] -= w->m->rate * let[d];
}

/* Velocity of the wall there, now, as far as it does not pass nodes that are held. */
static void velocity_of_wall(const Projection *w, PetscInt k, PetscReal v[3])
{
  const ContactPoint *c = w->s->point + k;
  const RigidWall *b = contact_rigid(w->s, c);
  PetscReal way[3], let[3];
  for (int d = 0; d < 3; ++d) v[d] = w->told[3 * k + d];
  if (!b) return;
  rigid_velocity(b, w->arm + 3 * k, v);
  for (int d = 0; d < 3; ++d) way[d] = v[d] / w->m->rate;
  (void)contact_let_pass(c, way, let);
  for (int d = 0; d < 3; ++d) v[d] -= w->m->rate * let[d];
}

/* Walls that do not pull let go what would have to be held back. */
static PetscErrorCode LetGo(Projection *w, PetscBool *any)
{
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < w->s->n && !w->m->pulls; ++k) {
    const ContactPoint *c = w->s->point + k;
    if (!w->held[k] || c->law.kind == CONTACT_BONDED || impulse_dot(3, c->normal, w->p + 3 * k) >= 0) continue;
    w->held[k] = 0;
    for (int d = 0; d < 3; ++d) w->p[3 * k + d] = 0;
    here = PETSC_TRUE;
  }
  if (here) impulse_list(w);
  PetscCallMPI(MPI_Allreduce(&here, any, 1, MPIU_BOOL, MPI_LOR, w->m->grid->comm));
  PetscFunctionReturn(0);
}

/* Of the larger speed: by more a wall's velocity jumps, and not by what rounding and its two differences are off. */
#define JUMP 1e-2

/* Is the wall of contact point k, now at x, a new one, or does it go on with another velocity than it came with? To a
 * body whose motion begins each wall is new. */
static PetscBool jumps(const Projection *w, PetscInt k, const PetscReal x[3])
{
  const ContactPoint *c = w->s->point + k;
  PetscReal before[3], after[3], jump = 0, fastest = 0;
  if (c->wall >= w->s->n_walls || contact_rigid(w->s, c)) return PETSC_FALSE;
  if (c->begins || wall_is_new(w->s->walls, c->wall, w->m->time)) return PETSC_TRUE;
  wall_velocity(w->s->walls, c->wall, w->m->time, -w->m->glance, x, before);
  wall_velocity(w->s->walls, c->wall, w->m->time, w->m->glance, x, after);
  for (int d = 0; d < 3; ++d) {
    jump += PetscSqr(after[d] - before[d]);
    /* where a wall turns back it is its way in the step that tells what is slow */
    fastest += PetscSqr(after[d]) + PetscSqr(before[d]) + PetscSqr(w->m->rate * c->swept[d]);
  }
  return (PetscBool)(jump > PetscSqr(JUMP) * fastest);
}

/* What has just met a wall that lets nothing slide does not slide there either. */
static unsigned char held_of(const ContactPoint *c, const ContactMotion *m)
{
  const ContactState state = m->start ? c->before : c->state;
  const PetscBool meets = state != CONTACT_OPEN || (m->start && c->touches);
  if (m->start && c->gone) return 0;
  return state == CONTACT_STICKS || (meets && c->law.kind == CONTACT_STICK) ? 3 : meets;
}

/* Motion of a contact point along its wall, 3 numbers. */
static void slip_of(const Projection *w, PetscInt k, PetscReal v[3])
{
  const ContactPoint *c = w->s->point + k;
  PetscReal along = 0, own[3];
  velocity_of_wall(w, k, own);
  v[0] = v[1] = v[2] = 0;
  for (PetscInt e = c->first; e < c->first + c->n; ++e)
    for (PetscInt d = 0; d < w->s->dim; ++d) v[d] += w->s->N[e] * w->m->motion[w->s->node[e] * w->s->dim + d];
  for (int d = 0; d < 3; ++d) v[d] -= own[d], along += v[d] * c->normal[d];
  for (int d = 0; d < 3; ++d) v[d] -= along * c->normal[d];
}

/* Of a wall that rubs: what slides is rubbed against its way by the impulse along the normal, or gets back what the
 * solve has taken too much, but by no more than what stops it: of what goes with its wall the way is nothing but
 * round-off. */
static void rub_sliding(const Projection *w, PetscInt k, PetscReal normal, PetscReal shear[3])
{
  PetscReal v[3];
  slip_of(w, k, v);
  const PetscReal speed = PetscSqrtReal(impulse_dot(3, v, v));
  const PetscReal stops = w->own[k] > 0 ? speed / w->own[k] : 0;
  const PetscReal rubs = PetscMax(-stops, PetscMin(stops, w->s->point[k].law.friction * normal));
  for (int d = 0; d < 3; ++d) shear[d] = speed > 0 ? -rubs * v[d] / speed : 0;
}

/* Largest impulse that friction beside a pressure of the solve gives over the step, N s. */
static PetscReal most_of_step(const Projection *w, const ContactPoint *c, PetscReal pressure)
{
  return w->s->share.mean / w->m->rate * contact_most(&c->law, pressure);
}

/* What sticks starts with its wall's motion along it. Beyond what the impulse along the normal bears that is lent, on
 * account of the friction of the step, whose force takes it back: or the step would have both. What even that
 * cannot bear has begun to slide. */
static void lend(const Projection *w, ContactPoint *c, PetscReal normal, PetscReal shear[3])
{
  const PetscReal size = PetscSqrtReal(impulse_dot(3, shear, shear)), pressed = impulse_dot(3, c->last, c->normal);
  const PetscReal struck = PetscMax(0, c->law.friction * normal);
  const PetscReal most = struck + most_of_step(w, c, pressed / w->s->share.mean);
  if (size <= struck) return;
  for (int d = 0; d < 3 && size <= most; ++d)
    c->lent[d] = (1 - struck / size) * shear[d] * w->m->rate / w->s->share.mean;
  for (int d = 0; d < 3 && size > most; ++d) shear[d] *= struck / size;
}

/* shear without what is too much of it. The cone of a wall that lets nothing slide is no law of its own, but ties the
 * force along it to a pressure: there less is given, but nothing turned back, which by 20 times what the wall has
 * pressed too much would set off what sticks. */
static void take_back(const ContactPoint *c, const PetscReal too_much[3], PetscReal shear[3])
{
  const PetscReal square = impulse_dot(3, shear, shear), along = impulse_dot(3, too_much, shear);
  const PetscReal left = square > 0 ? 1 - PetscMax(0, PetscMin(1, along / square)) : 1;
  for (int d = 0; d < 3; ++d) shear[d] = c->law.kind == CONTACT_STICK ? left * shear[d] : shear[d] - too_much[d];
}

/* The wall has given no more along itself, in all of the step, than friction bears of what it has given along the
 * normal. */
static void bound_all(const Projection *w, const ContactPoint *c, PetscReal normal, PetscReal shear[3])
{
  PetscReal all[3], struck = impulse_dot(3, c->struck, c->normal);
  const PetscReal step = w->s->share.mean / w->m->rate;
  for (int d = 0; d < 3; ++d) all[d] = step * c->now.shear[d] + c->struck[d] - struck * c->normal[d] + shear[d];
  const PetscReal size = PetscSqrtReal(impulse_dot(3, all, all));
  const PetscReal most = PetscMax(0, most_of_step(w, c, c->now.pressure) + c->law.friction * (struck + normal));
  if (size <= most) return;
  for (int d = 0; d < 3; ++d) all[d] *= 1 - most / size;
  take_back(c, all, shear);
}

/* The impulse p at contact point k is one that friction bears. */
static void rub(const Projection *w, PetscInt k, PetscReal *p)
{
  ContactPoint *c = w->s->point + k;
  const PetscReal normal = impulse_dot(3, p, c->normal);
  PetscReal shear[3];
  if (c->law.kind != CONTACT_FRICTION && c->law.kind != CONTACT_STICK) return;
  for (int d = 0; d < 3; ++d) shear[d] = p[d] - normal * c->normal[d];
  if (w->held[k] != 3) rub_sliding(w, k, normal, shear);
  else if (w->m->start) lend(w, c, normal, shear);
  if (!w->m->start) bound_all(w, c, normal, shear);
  for (int d = 0; d < 3; ++d) p[d] = normal * c->normal[d] + shear[d];
  for (int d = 0; d < 3 && w->m->start; ++d) c->struck[d] = p[d] - w->s->share.mean / w->m->rate * c->lent[d];
}

/* Half of the work that impulses take from sliding: by the motion before them, or after. */
static void lose(const Projection *w, ContactSum *sum)
{
  PetscReal v[3];
  for (PetscInt j = 0; j < w->n_held; ++j) {
    const PetscInt k = w->list[j];
    if (w->s->point[k].law.kind == CONTACT_BONDED) continue; /* it does not slide: lost in the transfer */
    slip_of(w, k, v);
    sum[w->s->point[k].wall].sliding -= 0.5 * impulse_dot(3, v, w->p + 3 * k);
  }
}

/* Work of walls that move as they are told: impulses times their velocity, as of prescribed nodes. */
static PetscReal driven(const Projection *w)
{
  PetscReal sum = 0;
  for (PetscInt j = 0; j < w->n_held; ++j) {
    const PetscInt k = w->list[j];
    sum += impulse_dot(3, w->told + 3 * k, w->p + 3 * k);
  }
  return sum;
}

void contact_add(const PetscReal x[3], PetscInt dim, const PetscReal f[3], ContactSum *sum)
{
  for (PetscInt d = 0; d < dim; ++d) sum->force[d] += f[d];
  for (int d = 0; d < 3; ++d) sum->torque[d] += x[(d + 1) % 3] * f[(d + 2) % 3] - x[(d + 2) % 3] * f[(d + 1) % 3];
}

/* What contact point k lacks of the motion of its wall. */
static void lack_of(const Projection *w, PetscInt k, PetscReal lack[3])
{
  PetscReal v[3];
  impulse_gather(w, w->m->motion, k, v);
  velocity_of_wall(w, k, lack);
  impulse_hold(w, k, lack);
  for (int d = 0; d < 3; ++d) lack[d] -= v[d];
}

static PetscErrorCode ListMoved(Projection *w)
{
  const Contact *s = w->s;
  const Grid *grid = w->m->grid;
  PetscReal *used;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_nodes * s->dim, &w->nodes));
  used = w->nodes; /* until they are known */
  for (PetscInt k = 0; k < s->n; ++k)
    for (PetscInt e = s->point[k].first; e < s->point[k].first + s->point[k].n && w->held[k]; ++e) used[s->node[e]] = 1;
  PetscCall(GridSumToOwners(grid, 1, used));
  PetscCall(GridToGhosts(grid, 1, used));
  PetscCall(PetscMalloc1(grid->n_nodes, &w->moved));
  for (PetscInt i = 0; i < grid->n_nodes; ++i)
    if (used[i] > 0 || w->m->whole) w->moved[w->n_moved++] = i;
  PetscCall(PetscArrayzero(used, grid->n_nodes));
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(const Contact *s, const ContactMotion *m, Projection *w, PetscBool *any)
{
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  *w = (Projection){.s = s, .m = m, .softened = m->jumps ? SOFTENED_ONCE : SOFTENED};
  PetscCall(PetscCalloc6(3 * s->n, &w->p, 3 * s->n, &w->lack, 3 * s->n, &w->told, s->n, &w->own, s->n, &w->held, s->n,
                         &w->list));
  PetscCall(
    PetscCalloc3(s->n_rigid ? 3 * s->n : 0, &w->arm, RIGID * s->n_rigid, &w->push, RIGID * s->n_rigid, &w->answer));
  for (PetscInt k = 0; k < s->n; ++k) {
    const ContactPoint *c = s->point + k;
    const RigidWall *b = contact_rigid(s, c);
    PetscReal x[3];
    contact_place(s, c, m->du, m->start ? 0 : 1, x);
    if (b) rigid_arm(b, m->start, x, w->arm + 3 * k);
    else take_told(w, k, x, w->told + 3 * k);
    if (b) w->own[k] += 1 / b->body.mass;
    w->held[k] = !m->jumps || jumps(w, k, x) ? held_of(c, m) : 0;
    lack_of(w, k, w->lack + 3 * k);
    here = here || w->held[k];
    for (PetscInt e = c->first; e < c->first + c->n; ++e)
      w->own[k] += m->mass[s->node[e]] > 1e-300 ? s->N[e] * s->N[e] / m->mass[s->node[e]] : 0;
  }
  impulse_list(w);
  PetscCallMPI(MPI_Allreduce(&here, any, 1, MPIU_BOOL, MPI_LOR, m->grid->comm));
  if (*any) PetscCall(ListMoved(w));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Projection *w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(w->p, w->lack, w->told, w->own, w->held, w->list));
  PetscCall(PetscFree3(w->arm, w->push, w->answer));
  PetscCall(PetscFree(w->nodes));
  PetscCall(PetscFree(w->moved));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactProject(Contact *s, const ContactMotion *m, ContactSum *sum)
{
  Projection w;
  PetscBool any;

  PetscFunctionBeginUser;
  PetscCall(Create(s, m, &w, &any));
  if (!any) {
    PetscCall(Destroy(&w));
    PetscFunctionReturn(0);
  }
  for (int k = 0; k < MOST_LET_GO && any; ++k) {
    PetscCall(m->whole ? ImpulsesWhole(&w) : ImpulsesLumped(&w));
    PetscCall(LetGo(&w, &any));
  }
  for (PetscInt j = 0; j < w.n_held; ++j) rub(&w, w.list[j], w.p + 3 * w.list[j]);
  lose(&w, sum);
  PetscCall(m->whole ? ImpulsesWholeSpread(&w, w.p) : ImpulsesLumpedSpread(&w, w.p));
  PetscCall(ImpulsesHeld(&w));
  for (PetscInt i = 0; i < w.n_moved; ++i)
    for (PetscInt dof = w.moved[i] * s->dim; dof < (w.moved[i] + 1) * s->dim; ++dof) m->motion[dof] += w.nodes[dof];
  for (PetscInt k = 0; k < s->n_rigid; ++k) rigid_push(s->rigid + k, w.push + RIGID * k);
  lose(&w, sum);
  s->driven += driven(&w);
  for (PetscInt j = 0; j < w.n_held; ++j) {
    const ContactPoint *c = s->point + w.list[j];
    PetscReal x[3];
    contact_place(s, c, m->du, m->start ? 0 : 1, x);
    contact_add(x, s->dim, w.p + 3 * w.list[j], sum + c->wall);
  }
  PetscCall(Destroy(&w));
  PetscFunctionReturn(0);
}
