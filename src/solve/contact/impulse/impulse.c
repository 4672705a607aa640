#include "solve/contact/impulse/impulse.h"

void impulse_list(Projection *w)
{
  w->n_held = 0;
  for (PetscInt k = 0; k < w->s->n; ++k)
    if (w->held[k]) w->list[w->n_held++] = k;
}

void impulse_hold(const Projection *w, PetscInt k, PetscReal *a)
{
  const PetscReal *n = w->s->point[k].normal;
  if (w->held[k] == 3) return;
  const PetscReal along = w->held[k] ? a[0] * n[0] + a[1] * n[1] + a[2] * n[2] : 0;
  for (int d = 0; d < 3; ++d) a[d] = along * n[d];
}

void impulse_gather(const Projection *w, const PetscReal *nodes, PetscInt k, PetscReal a[3])
{
  const Contact *s = w->s;
  const ContactPoint *c = s->point + k;
  a[0] = a[1] = a[2] = 0;
  if (!w->held[k]) return;
  for (PetscInt e = c->first; e < c->first + c->n; ++e)
    for (PetscInt d = 0; d < s->dim; ++d) a[d] += s->N[e] * nodes[s->node[e] * s->dim + d];
  impulse_hold(w, k, a);
}

PetscErrorCode ImpulsesToWalls(Projection *w, const PetscReal *p)
{
  const Contact *s = w->s;

  PetscFunctionBeginUser;
  if (!s->n_rigid) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(w->push, RIGID * s->n_rigid));
  for (PetscInt j = 0; j < w->n_held; ++j) {
    const PetscInt k = w->list[j];
    const RigidWall *b = contact_rigid(s, s->point + k);
    const PetscReal *r = w->arm + 3 * k, *f = p + 3 * k;
    if (!b) continue;
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

void impulse_answer(const Projection *w, const PetscReal *change, PetscInt k, PetscReal v[3])
{
  const RigidWall *b = contact_rigid(w->s, w->s->point + k);
  const PetscReal *r = w->arm + 3 * k;
  v[0] = v[1] = v[2] = 0;
  if (!b) return;
  const PetscReal *a = change + RIGID * (b - w->s->rigid), *o = a + 3;
  for (int d = 0; d < 3; ++d) v[d] = a[d] + o[(d + 1) % 3] * r[(d + 2) % 3] - o[(d + 2) % 3] * r[(d + 1) % 3];
  impulse_hold(w, k, v);
}

void impulse_free(const ContactMotion *m, PetscInt dim, PetscReal *nodes)
{
  frames_turn(m->frames, dim, nodes);
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i)
    if (m->fixed[i]) nodes[i] = 0;
  frames_turn(m->frames, dim, nodes);
}
