/* The motion of nodes that lets points in contact go with their walls: the change of least kinetic
 * energy, by impulses at these points,
 *
 *   v := v + M^-1 A^T p,    A v = wall,
 *
 * with the lumped mass M and A v, the motion of the contact points in the directions that are held.
 * Where more points are in contact than nodes can follow, p is not unique: some of it counts as
 * motion, so that it stays small. What slides is rubbed by the impulses, too: friction p against the
 * way that it goes. */
#include "solve/contact/contact.h"

#define MOST_SWEEPS 60
#define ENOUGH 1e-7   /* of what is lacking */
#define SOFTENED 0.1  /* of what an impulse moves itself: counts as motion */
#define MOST_LET_GO 8 /* times that points are let go that would pull */

/* Conjugate gradients over impulses, three numbers a contact point. */
typedef struct {
  const Contact *s;
  const ContactMotion *m;
  PetscReal *p, *r, *q, *z; /* 3 per contact point */
  PetscReal *own;           /* 1 per contact point: what a unit impulse moves itself */
  unsigned char *held;      /* 0: not at all, 1: along the normal, 3: in all directions */
  PetscReal *arm;           /* 3 per contact point: against the centre of a wall with mass */
  PetscReal *push, *answer; /* RIGID per wall with mass: momentum, and what it changes */
  PetscReal *nodes;         /* n_nodes x dim, zero but for these: */
  PetscInt n_moved, *moved; /* local nodes that impulses move, on any rank */
} Projection;

static void hold(const Projection *w, PetscInt k, PetscReal *a)
{
  const PetscReal *n = w->s->point[k].normal;
  if (w->held[k] == 3) return;
  const PetscReal along = w->held[k] ? a[0] * n[0] + a[1] * n[1] + a[2] * n[2] : 0;
  for (int d = 0; d < 3; ++d) a[d] = along * n[d];
}

static PetscReal inverse_mass(const ContactMotion *m, PetscInt dim, PetscInt node, PetscInt d)
{
  return m->fixed[node * dim + d] || m->mass[node] < 1e-300 ? 0 : 1 / m->mass[node];
}

/* Walls with mass get what nodes do not: push = -B^T p, answer = M^-1 push. */
static PetscErrorCode SpreadToWalls(Projection *w, const PetscReal *p)
{
  const Contact *s = w->s;

  PetscFunctionBeginUser;
  if (!s->n_rigid) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(w->push, RIGID * s->n_rigid));
  for (PetscInt k = 0; k < s->n; ++k) {
    const RigidWall *b = contact_rigid(s, s->point + k);
    const PetscReal *r = w->arm + 3 * k, *f = p + 3 * k;
    if (!b || !w->held[k]) continue;
    PetscReal *push = w->push + RIGID * (b - s->rigid);
    for (int d = 0; d < 3; ++d) {
      push[d] -= f[d];
      push[3 + d] -= r[(d + 1) % 3] * f[(d + 2) % 3] - r[(d + 2) % 3] * f[(d + 1) % 3];
    }
  }
  PetscCall(
    MPIU_Allreduce(MPI_IN_PLACE, w->push, (PetscMPIInt)(RIGID * s->n_rigid), MPIU_REAL, MPI_SUM, w->m->grid->comm));
  for (PetscInt k = 0; k < s->n_rigid; ++k) rigid_respond(s->rigid + k, w->push + RIGID * k, w->answer + RIGID * k);
  PetscFunctionReturn(0);
}

/* Of a wall that changes its motion so, at contact point k. */
static void answer_at(const Projection *w, PetscInt k, PetscReal v[3])
{
  const RigidWall *b = contact_rigid(w->s, w->s->point + k);
  const PetscReal *r = w->arm + 3 * k;
  v[0] = v[1] = v[2] = 0;
  if (!b) return;
  const PetscReal *a = w->answer + RIGID * (b - w->s->rigid), *o = a + 3;
  for (int d = 0; d < 3; ++d) v[d] = a[d] + o[(d + 1) % 3] * r[(d + 2) % 3] - o[(d + 2) % 3] * r[(d + 1) % 3];
}

/* Velocity of the wall there, now. */
static void wall_velocity(const Projection *w, PetscInt k, PetscReal v[3])
{
  const ContactPoint *c = w->s->point + k;
  const RigidWall *b = contact_rigid(w->s, c);
  if (b) rigid_velocity(b, w->arm + 3 * k, v);
  else
    for (int d = 0; d < 3; ++d) v[d] = w->m->rate * c->swept[d];
}

/* nodes = M^-1 A^T p, on all copies. */
static PetscErrorCode Spread(Projection *w, const PetscReal *p)
{
  const Contact *s = w->s;
  const PetscInt dim = s->dim;
  const Grid *grid = w->m->grid;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < w->n_moved * dim; ++i) w->nodes[w->moved[i / dim] * dim + i % dim] = 0;
  for (PetscInt k = 0; k < s->n; ++k) {
    if (!w->held[k]) continue;
    for (PetscInt e = s->point[k].first; e < s->point[k].first + s->point[k].n; ++e)
      for (PetscInt d = 0; d < dim; ++d) w->nodes[s->node[e] * dim + d] += s->N[e] * p[3 * k + d];
  }
  PetscCall(GridSumToOwners(grid, dim, w->nodes));
  for (PetscInt i = 0; i < w->n_moved * dim; ++i) {
    const PetscInt node = w->moved[i / dim];
    if (node < grid->n_owned) w->nodes[node * dim + i % dim] *= inverse_mass(w->m, dim, node, i % dim);
  }
  PetscCall(GridToGhosts(grid, dim, w->nodes));
  PetscCall(SpreadToWalls(w, p));
  PetscFunctionReturn(0);
}

/* a = A nodes. */
static void gather(const Projection *w, const PetscReal *nodes, PetscInt k, PetscReal a[3])
{
  const Contact *s = w->s;
  const ContactPoint *c = s->point + k;
  a[0] = a[1] = a[2] = 0;
  for (PetscInt e = c->first; e < c->first + c->n; ++e)
    for (PetscInt d = 0; d < s->dim; ++d) a[d] += s->N[e] * nodes[s->node[e] * s->dim + d];
  hold(w, k, a);
}

static PetscReal dot(PetscInt n, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0;
  for (PetscInt i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

/* q = (A M^-1 A^T + softening) z */
static PetscErrorCode Apply(Projection *w, const PetscReal *z, PetscReal *q)
{
  PetscFunctionBeginUser;
  PetscCall(Spread(w, z));
  for (PetscInt k = 0; k < w->s->n; ++k) {
    PetscReal answer[3];
    gather(w, w->nodes, k, q + 3 * k);
    answer_at(w, k, answer);
    hold(w, k, answer);
    for (int d = 0; d < 3; ++d) q[3 * k + d] -= answer[d];
    for (int d = 0; d < 3; ++d) q[3 * k + d] += SOFTENED * w->own[k] * z[3 * k + d];
  }
  PetscFunctionReturn(0);
}

/* p, for what the points in contact lack of the motion of their walls. */
static PetscErrorCode Solve(Projection *w)
{
  const Contact *s = w->s;
  const PetscInt n = 3 * s->n;
  MPI_Comm comm = w->m->grid->comm;
  PetscReal local, rr, start, zq;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(w->p, n));
  for (PetscInt k = 0; k < s->n; ++k) {
    PetscReal *r = w->r + 3 * k;
    gather(w, w->m->motion, k, r);
    PetscReal target[3];
    wall_velocity(w, k, target);
    hold(w, k, target);
    for (int d = 0; d < 3; ++d) r[d] = target[d] - r[d];
  }
  PetscCall(PetscArraycpy(w->z, w->r, n));
  local = dot(n, w->r, w->r);
  PetscCall(MPIU_Allreduce(&local, &rr, 1, MPIU_REAL, MPI_SUM, comm));
  start = rr;
  for (int sweep = 0; sweep < MOST_SWEEPS && rr > ENOUGH * ENOUGH * start; ++sweep) {
    PetscCall(Apply(w, w->z, w->q));
    local = dot(n, w->z, w->q);
    PetscCall(MPIU_Allreduce(&local, &zq, 1, MPIU_REAL, MPI_SUM, comm));
    if (zq <= 0) break;
    for (PetscInt i = 0; i < n; ++i) {
      w->p[i] += rr / zq * w->z[i];
      w->r[i] -= rr / zq * w->q[i];
    }
    const PetscReal before = rr;
    local = dot(n, w->r, w->r);
    PetscCall(MPIU_Allreduce(&local, &rr, 1, MPIU_REAL, MPI_SUM, comm));
    for (PetscInt i = 0; i < n; ++i) w->z[i] = w->r[i] + rr / before * w->z[i];
  }
  PetscFunctionReturn(0);
}

/* Walls that do not pull let go what would have to be held back. */
static PetscErrorCode LetGo(Projection *w, PetscBool *any)
{
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < w->s->n && !w->m->pulls; ++k) {
    const ContactPoint *c = w->s->point + k;
    if (!w->held[k] || c->law.kind == CONTACT_BONDED || dot(3, c->normal, w->p + 3 * k) >= 0) continue;
    w->held[k] = 0;
    here = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(&here, any, 1, MPIU_BOOL, MPI_LOR, w->m->grid->comm));
  PetscFunctionReturn(0);
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
  wall_velocity(w, k, own);
  v[0] = v[1] = v[2] = 0;
  for (PetscInt e = c->first; e < c->first + c->n; ++e)
    for (PetscInt d = 0; d < w->s->dim; ++d) v[d] += w->s->N[e] * w->m->motion[w->s->node[e] * w->s->dim + d];
  for (int d = 0; d < 3; ++d) v[d] -= own[d], along += v[d] * c->normal[d];
  for (int d = 0; d < 3; ++d) v[d] -= along * c->normal[d];
}

/* Of a wall that rubs: what slides is rubbed against its way by the impulse along the normal, or gets
 * back what the solve has taken too much; what sticks is held by no more than friction can. */
static void rub(const Projection *w, PetscInt k, PetscReal *p)
{
  const ContactPoint *c = w->s->point + k;
  PetscReal v[3], shear[3];
  if (!w->held[k] || c->law.friction == 0 || c->law.kind == CONTACT_BONDED) return;
  const PetscReal normal = dot(3, p, c->normal), friction = c->law.friction;
  const PetscReal pressing =
    (1 / w->m->rate) * (w->m->start ? dot(3, c->last, c->normal) / w->s->share.mean : c->now.pressure);
  for (int d = 0; d < 3; ++d) shear[d] = p[d] - normal * c->normal[d];
  if (w->held[k] == 3) {
    const PetscReal size = PetscSqrtReal(dot(3, shear, shear)), most = friction * (PetscAbsReal(normal) + pressing);
    for (int d = 0; d < 3 && size > most; ++d) p[d] -= (1 - most / size) * shear[d];
    return;
  }
  slip_of(w, k, v);
  const PetscReal speed = PetscSqrtReal(dot(3, v, v));
  for (int d = 0; d < 3 && speed > 0; ++d) p[d] -= friction * normal * v[d] / speed;
}

/* Half of the work that impulses take from sliding: by the motion before them, or after. */
static void lose(const Projection *w, ContactSum *sum)
{
  PetscReal v[3];
  for (PetscInt k = 0; k < w->s->n; ++k) {
    slip_of(w, k, v);
    sum[w->s->point[k].wall].sliding -= 0.5 * dot(3, v, w->p + 3 * k);
  }
}

void contact_add(const ContactPoint *c, PetscInt dim, const PetscReal f[3], ContactSum *sum)
{
  for (PetscInt d = 0; d < dim; ++d) sum->force[d] += f[d];
  for (int d = 0; d < 3; ++d) sum->torque[d] += c->x[(d + 1) % 3] * f[(d + 2) % 3] - c->x[(d + 2) % 3] * f[(d + 1) % 3];
}

static PetscErrorCode ListMoved(Projection *w)
{
  const Contact *s = w->s;
  const Grid *grid = w->m->grid;
  PetscReal *used;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_nodes, &used));
  for (PetscInt k = 0; k < s->n; ++k)
    for (PetscInt e = s->point[k].first; e < s->point[k].first + s->point[k].n && w->held[k]; ++e) used[s->node[e]] = 1;
  PetscCall(GridSumToOwners(grid, 1, used));
  PetscCall(GridToGhosts(grid, 1, used));
  PetscCall(PetscMalloc1(grid->n_nodes, &w->moved));
  for (PetscInt i = 0; i < grid->n_nodes; ++i)
    if (used[i] > 0) w->moved[w->n_moved++] = i;
  PetscCall(PetscFree(used));
  PetscCall(PetscCalloc1(grid->n_nodes * s->dim, &w->nodes));
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(const Contact *s, const ContactMotion *m, Projection *w, PetscBool *any)
{
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  *w = (Projection){.s = s, .m = m};
  PetscCall(
    PetscCalloc6(3 * s->n, &w->p, 3 * s->n, &w->r, 3 * s->n, &w->q, 3 * s->n, &w->z, s->n, &w->own, s->n, &w->held));
  PetscCall(
    PetscCalloc3(s->n_rigid ? 3 * s->n : 0, &w->arm, RIGID * s->n_rigid, &w->push, RIGID * s->n_rigid, &w->answer));
  for (PetscInt k = 0; k < s->n; ++k) {
    const ContactPoint *c = s->point + k;
    const RigidWall *b = contact_rigid(s, c);
    PetscReal x[3];
    contact_place(s, c, m->du, m->start ? 0 : 1, x);
    if (b) rigid_arm(b, m->start, x, w->arm + 3 * k);
    if (b) w->own[k] += 1 / b->body.mass;
    w->held[k] = held_of(c, m);
    here = here || w->held[k];
    for (PetscInt e = c->first; e < c->first + c->n; ++e)
      w->own[k] += m->mass[s->node[e]] > 1e-300 ? s->N[e] * s->N[e] / m->mass[s->node[e]] : 0;
  }
  PetscCallMPI(MPI_Allreduce(&here, any, 1, MPIU_BOOL, MPI_LOR, m->grid->comm));
  if (*any) PetscCall(ListMoved(w));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Projection *w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(w->p, w->r, w->q, w->z, w->own, w->held));
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
    PetscCall(Solve(&w));
    PetscCall(LetGo(&w, &any));
  }
  for (PetscInt k = 0; k < s->n; ++k) rub(&w, k, w.p + 3 * k);
  lose(&w, sum);
  PetscCall(Spread(&w, w.p));
  for (PetscInt i = 0; i < w.n_moved * s->dim; ++i) {
    const PetscInt dof = w.moved[i / s->dim] * s->dim + i % s->dim;
    m->motion[dof] += w.nodes[dof];
  }
  for (PetscInt k = 0; k < s->n_rigid; ++k) rigid_push(s->rigid + k, w.push + RIGID * k);
  lose(&w, sum);
  for (PetscInt k = 0; k < s->n; ++k) contact_add(s->point + k, s->dim, w.p + 3 * k, sum + s->point[k].wall);
  PetscCall(Destroy(&w));
  PetscFunctionReturn(0);
}
