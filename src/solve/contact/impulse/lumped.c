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
  for (PetscInt i = 0; i < w->n_moved * dim; ++i) w->nodes[w->moved[i / dim] * dim + i % dim] = 0;
  for (PetscInt k = 0; k < s->n; ++k) {
    if (!w->held[k]) continue;
    for (PetscInt e = s->point[k].first; e < s->point[k].first + s->point[k].n; ++e)
      for (PetscInt d = 0; d < dim; ++d) w->nodes[s->node[e] * dim + d] += s->N[e] * p[3 * k + d];
  }
  PetscCall(GridSumToOwners(grid, dim, w->nodes));
  frames_turn(w->m->frames, dim, w->nodes);
  for (PetscInt i = 0; i < w->n_moved * dim; ++i) {
    const PetscInt node = w->moved[i / dim];
    if (node < grid->n_owned) w->nodes[node * dim + i % dim] *= inverse_mass(w->m, dim, node, i % dim);
  }
  frames_turn(w->m->frames, dim, w->nodes);
  PetscCall(GridToGhosts(grid, dim, w->nodes));
  PetscCall(ImpulsesToWalls(w, p));
  PetscFunctionReturn(0);
}

/* q = (A M^-1 A^T + softening) z */
static PetscErrorCode Apply(Projection *w, const PetscReal *z, PetscReal *q)
{
  PetscFunctionBeginUser;
  PetscCall(ImpulsesLumpedSpread(w, z));
  for (PetscInt k = 0; k < w->s->n; ++k) {
    PetscReal answer[3];
    impulse_gather(w, w->nodes, k, q + 3 * k);
    impulse_answer(w, w->answer, k, answer);
    for (int d = 0; d < 3; ++d) q[3 * k + d] -= answer[d];
    for (int d = 0; d < 3; ++d) q[3 * k + d] += SOFTENED * w->own[k] * z[3 * k + d];
  }
  PetscFunctionReturn(0);
}

/* Over what an impulse moves itself: of nodes that are hardly reached that is a hundred times that of others. */
static void precondition(const Projection *w, const PetscReal *r, PetscReal *s)
{
  for (PetscInt k = 0; k < w->s->n; ++k)
    for (int d = 0; d < 3; ++d) s[3 * k + d] = w->own[k] > 0 ? r[3 * k + d] / w->own[k] : 0;
}

/* Collective. r s, and r r. */
static PetscErrorCode Norms(const Projection *w, const PetscReal *r, const PetscReal *s, PetscReal norms[2])
{
  const PetscReal local[2] = {impulse_dot(3 * w->s->n, r, s), impulse_dot(3 * w->s->n, r, r)};

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(local, norms, 2, MPIU_REAL, MPI_SUM, w->m->grid->comm));
  PetscFunctionReturn(0);
}

/* p, q, r, s, z: impulses, their product, what is lacking, the same preconditioned, the direction. */
static PetscErrorCode Sweeps(Projection *w, PetscReal *q, PetscReal *r, PetscReal *s, PetscReal *z)
{
  const PetscInt n = 3 * w->s->n;
  PetscReal local, zq, rs[2], before, enough;

  PetscFunctionBeginUser;
  PetscCall(Norms(w, r, s, rs));
  enough = ENOUGH * ENOUGH * rs[1];
  for (int sweep = 0; sweep < MOST_SWEEPS && rs[1] > enough; ++sweep) {
    PetscCall(Apply(w, z, q));
    local = impulse_dot(n, z, q);
    PetscCall(MPIU_Allreduce(&local, &zq, 1, MPIU_REAL, MPI_SUM, w->m->grid->comm));
    if (zq <= 0) break;
    for (PetscInt i = 0; i < n; ++i) {
      w->p[i] += rs[0] / zq * z[i];
      r[i] -= rs[0] / zq * q[i];
    }
    precondition(w, r, s);
    before = rs[0];
    PetscCall(Norms(w, r, s, rs));
    for (PetscInt i = 0; i < n; ++i) z[i] = s[i] + rs[0] / before * z[i];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ImpulsesLumped(Projection *w)
{
  const PetscInt n = 3 * w->s->n;
  PetscReal *q, *r, *s, *z;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n, &q, n, &r, n, &s, n, &z));
  PetscCall(PetscArrayzero(w->p, n));
  PetscCall(PetscArraycpy(r, w->lack, n));
  for (PetscInt k = 0; k < w->s->n; ++k) impulse_hold(w, k, r + 3 * k);
  precondition(w, r, s);
  PetscCall(PetscArraycpy(z, s, n));
  PetscCall(Sweeps(w, q, r, s, z));
  PetscCall(PetscFree4(q, r, s, z));
  PetscFunctionReturn(0);
}
