/* A static run that gives up while a body slides on all that it touches: friction may be overcome, and then there is no
 * equilibrium to be found. */
#include "model/model_private.h"

/* Of the contact points of a body, so many. */
#define ALL 0.9

/* counts (bodies x 2): what rubs, and what of it slides, over all ranks. */
static PetscErrorCode Count(const Model *m, PetscInt *counts)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->contact->n; ++k) {
    const ContactPoint *c = m->contact->point + k;
    PetscInt *count = counts + 2 * m->points->body[c->owner];
    if (c->state == CONTACT_OPEN || c->law.kind != CONTACT_FRICTION) continue;
    ++count[0];
    count[1] += c->state == CONTACT_SLIDES;
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, counts, (PetscMPIInt)(2 * m->c->n_bodies), MPIU_INT, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactDescribe(const Model *m, StepReport *report)
{
  const size_t used = strlen(report->reason);
  PetscInt *counts;

  PetscFunctionBeginUser;
  if (!m->contact || m->scheme->inertia) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(2 * m->c->n_bodies, &counts));
  PetscCall(Count(m, counts));
  for (PetscInt b = 0; b < m->c->n_bodies && !report->reason[used]; ++b) {
    if (!counts[2 * b] || counts[2 * b + 1] < ALL * counts[2 * b]) continue;
    snprintf(report->reason + used, sizeof report->reason - used,
             ". Friction may be overcome: '%s' slides at %d of the %d places where it rubs", m->c->bodies[b].name,
             (int)counts[2 * b + 1], (int)counts[2 * b]);
  }
  PetscCall(PetscFree(counts));
  PetscFunctionReturn(0);
}
