/* Impulses by the lumped mass: preconditioned conjugate gradients over them, since all nodes that they move are those
 * of the contact points. */
#include "solve/contact/impulse/impulse.h"

#define MOST_SWEEPS 60
#define ENOUGH 1e-7 /* of what is lacking */

static PetscReal inverse_mass(const ContactMotion *m, PetscInt dim, PetscInt node, PetscInt d)
{
  return m->fixed[node * dim + d] || m->mass[node] < 1e-300 ? 0 : 1 / m->mass[node];
}

PetscErrorCode ImpulsesLumpedSpread(Projection *w, const PetscReal *p)
{
  const Contact *s = w->s;
  const PetscInt dim = s->dim;
  const Grid *grid = w->m->grid;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < w->n_moved; ++i) {
    PetscReal *node = w->nodes + w->moved[i] * dim;
    node[0] = node[1] = 0;
    if (dim == 3) node[2] = 0;
  }
  for (PetscInt j = 0; j < w->n_held; ++j) {
    const ContactPoint *c = s->point + w->list[j];
    for (PetscInt e = c->first; e < c->first + c->n; ++e)
      for (PetscInt d = 0; d < dim; ++d) w->nodes[s->node[e] * dim + d] += s->N[e] * p[3 * w->list[j] + d];
  }
  PetscCall(GridSumToOwners(grid, dim, w->nodes));
  frames_turn(w->m->frames, dim, w->nodes);
  for (PetscInt i = 0; i < w->n_moved; ++i)
    for (PetscInt d = 0; d < dim && w->moved[i] < grid->n_owned; ++d)
      w->nodes[w->moved[i] * dim + d] *= inverse_mass(w->m, dim, w->moved[i], d);
  frames_turn(w->m->frames, dim, w->nodes);
  PetscCall(GridToGhosts(grid, dim, w->nodes));
  PetscCall(ImpulsesToWalls(w, p));
  PetscFunctionReturn(0);
}

/* What is held of contact points behind each other, in their order, and among all that are near. */
static void pack(const Projection *w, const PetscReal *all, PetscReal *held)
{
  for (PetscInt i = 0; i < 3 * w->n_held; ++i) held[i] = all[3 * w->list[i / 3] + i % 3];
}

static void unpack(const Projection *w, const PetscReal *held, PetscReal *all)
{
  for (PetscInt i = 0; i < 3 * w->n_held; ++i) all[3 * w->list[i / 3] + i % 3] = held[i];
}

/* q = (A M^-1 A^T + softening) z; `all` is room for every contact point. */
static PetscErrorCode Apply(Projection *w, const PetscReal *z, PetscReal *all, PetscReal *q)
{
  PetscFunctionBeginUser;
  unpack(w, z, all);
  PetscCall(ImpulsesLumpedSpread(w, all));
  for (PetscInt j = 0; j < w->n_held; ++j) {
    const PetscInt k = w->list[j];
    PetscReal answer[3];
    impulse_gather(w, w->nodes, k, q + 3 * j);
    impulse_answer(w, w->answer, k, answer);
    for (int d = 0; d < 3; ++d) q[3 * j + d] -= answer[d];
    for (int d = 0; d < 3; ++d) q[3 * j + d] += w->softened * w->own[k] * z[3 * j + d];
  }
  PetscFunctionReturn(0);
}

/* Over what an impulse moves itself: of nodes that are hardly reached that is a hundred times that of others. */
static void precondition(const Projection *w, const PetscReal *r, PetscReal *s)
{
  for (PetscInt j = 0; j < w->n_held; ++j)
    for (int d = 0; d < 3; ++d) s[3 * j + d] = w->own[w->list[j]] > 0 ? r[3 * j + d] / w->own[w->list[j]] : 0;
}

/* Collective. r s, and r r. */
static PetscErrorCode Norms(const Projection *w, const PetscReal *r, const PetscReal *s, PetscReal norms[2])
{
  const PetscReal local[2] = {impulse_dot(3 * w->n_held, r, s), impulse_dot(3 * w->n_held, r, r)};

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(local, norms, 2, MPIU_REAL, MPI_SUM, w->m->grid->comm));
  PetscFunctionReturn(0);
}

/* Of what is held: impulses, their product, what is lacking, the same preconditioned, the direction; and room for
 * all. */
typedef struct {
  PetscReal *p, *q, *r, *s, *z, *all;
} Work;

/* From the impulses of an earlier round, after some have been let go. */
static PetscErrorCode GoOn(Projection *w, Work *x)
{
  const PetscInt n = 3 * w->n_held;

  PetscFunctionBeginUser;
  if (w->rounds++ > 0) {
    pack(w, w->p, x->p);
    PetscCall(Apply(w, x->p, x->all, x->q));
    for (PetscInt i = 0; i < n; ++i) x->r[i] -= x->q[i];
    precondition(w, x->r, x->s);
  }
  PetscCall(PetscArraycpy(x->z, x->s, n));
  PetscFunctionReturn(0);
}

static PetscErrorCode Sweeps(Projection *w, Work *x)
{
  const PetscInt n = 3 * w->n_held;
  PetscReal local, zq, rs[2], before, enough;

  PetscFunctionBeginUser;
  PetscCall(Norms(w, x->r, x->s, rs));
  enough = ENOUGH * ENOUGH * rs[1];
  PetscCall(GoOn(w, x));
  PetscCall(Norms(w, x->r, x->s, rs));
  for (int sweep = 0; sweep < MOST_SWEEPS && rs[1] > enough; ++sweep) {
    PetscCall(Apply(w, x->z, x->all, x->q));
    local = impulse_dot(n, x->z, x->q);
    PetscCall(MPIU_Allreduce(&local, &zq, 1, MPIU_REAL, MPI_SUM, w->m->grid->comm));
    if (zq <= 0) break;
    for (PetscInt i = 0; i < n; ++i) {
      x->p[i] += rs[0] / zq * x->z[i];
      x->r[i] -= rs[0] / zq * x->q[i];
    }
    precondition(w, x->r, x->s);
    before = rs[0];
    PetscCall(Norms(w, x->r, x->s, rs));
    for (PetscInt i = 0; i < n; ++i) x->z[i] = x->s[i] + rs[0] / before * x->z[i];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ImpulsesLumped(Projection *w)
{
  const PetscInt n = 3 * w->n_held;
  Work x;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc6(n, &x.p, n, &x.q, n, &x.r, n, &x.s, n, &x.z, 3 * w->s->n, &x.all));
  PetscCall(PetscArrayzero(x.p, n));
  pack(w, w->lack, x.r);
  for (PetscInt j = 0; j < w->n_held; ++j) impulse_hold(w, w->list[j], x.r + 3 * j);
  precondition(w, x.r, x.s);
  PetscCall(Sweeps(w, &x));
  PetscCall(PetscArrayzero(w->p, 3 * w->s->n));
  unpack(w, x.p, w->p);
  PetscCall(PetscFree6(x.p, x.q, x.r, x.s, x.z, x.all));
  PetscFunctionReturn(0);
}
