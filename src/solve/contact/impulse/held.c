/* What prescribed nodes get of impulses of contact, they do not move by: the boundary gives as much against it. */
#include "solve/contact/impulse/impulse.h"

/* rows = A^T p - M nodes, on owners; the lumped mass has no rows of prescribed nodes that others move. */
static PetscErrorCode Lacking(const Projection *w, PetscReal *rows)
{
  const Contact *s = w->s;
  const ContactMass *whole = w->m->whole;
  PetscReal *product;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < w->n_held; ++j) {
    const ContactPoint *c = s->point + w->list[j];
    for (PetscInt e = c->first; e < c->first + c->n; ++e)
      for (PetscInt d = 0; d < s->dim; ++d) rows[s->node[e] * s->dim + d] += s->N[e] * w->p[3 * w->list[j] + d];
  }
  PetscCall(GridSumToOwners(w->m->grid, s->dim, rows));
  if (!whole) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(w->m->grid->n_nodes * s->dim, &product));
  PetscCall(whole->multiply(whole->context, w->nodes, product));
  for (PetscInt i = 0; i < w->m->grid->n_owned * s->dim; ++i) rows[i] -= product[i];
  PetscCall(PetscFree(product));
  PetscFunctionReturn(0);
}

PetscErrorCode ImpulsesHeld(const Projection *w)
{
  const PetscInt dim = w->s->dim;
  PetscReal *rows;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(w->m->grid->n_nodes * dim, &rows));
  PetscCall(Lacking(w, rows));
  frames_turn(w->m->frames, dim, rows);
  for (PetscInt k = 0; k < w->n_moved; ++k)
    for (PetscInt i = w->moved[k] * dim; i < (w->moved[k] + 1) * dim; ++i)
      if (!w->m->fixed[i]) rows[i] = 0;
  frames_turn(w->m->frames, dim, rows);
  for (PetscInt k = 0; k < w->n_moved; ++k)
    for (PetscInt i = w->moved[k] * dim; i < (w->moved[k] + 1) * dim && w->moved[k] < w->m->grid->n_owned; ++i)
      w->m->given[i] -= rows[i];
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(0);
}
