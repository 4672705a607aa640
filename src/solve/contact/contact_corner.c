/* Points in corners of one wall: each side of it is a contact of its own, which goes on from step to step. */
#include "solve/contact/contact.h"

#define SAME_SIDE 0.7 /* cosine: a side of a wall, or what it has turned to in a step */

/* How alike the normal of a remembered side is; 0: none is remembered. */
static PetscReal likeness(const PetscReal *kept, PetscInt dim, const PetscReal n[3])
{
  PetscReal along = 0;
  for (PetscInt d = 0; d < dim; ++d) along += kept[KEPT_NORMAL(dim) + d] * n[d];
  return along;
}

/* The slot, not taken, of what p remembers of wall k by which a side goes on, known by its normal; -1: none. */
static PetscInt slot_like(const Contact *s, const Points *points, PetscInt p, PetscInt k, const PetscReal n[3],
                          const PetscBool *taken)
{
  PetscReal best = SAME_SIDE;
  PetscInt slot = -1;
  for (PetscInt j = 0; j < s->sides; ++j) {
    const PetscReal like = likeness(contact_kept(points, p, k, s->sides, j), s->dim, n);
    if (!taken[j] && like > best) best = like, slot = j;
  }
  return slot;
}

/* A single side goes on as the single one that there was, however it has turned; -1: there were more. */
static PetscInt only_slot(const Contact *s, const Points *points, PetscInt p, PetscInt k)
{
  PetscInt slot = 0, n = 0;
  for (PetscInt j = 0; j < s->sides; ++j) {
    const PetscReal *kept = contact_kept(points, p, k, s->sides, j);
    if (likeness(kept, s->dim, kept + KEPT_NORMAL(s->dim)) > 0) slot = j, ++n;
  }
  return n > 1 ? -1 : slot;
}

void contact_find_slots(const Contact *s, const Points *points, PetscInt p, PetscInt k, PetscInt n,
                        const WallPlace *place, PetscInt slot[WALL_SIDES], const PetscReal *kept[WALL_SIDES])
{
  static const PetscReal nothing[KEPT_NORMAL(3) + 3] = {0};
  PetscBool taken[WALL_SIDES] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  for (PetscInt i = 0; i < n; ++i) {
    slot[i] = s->sides == 1 ? 0 : slot_like(s, points, p, k, place[i].normal, taken);
    if (slot[i] < 0 && n == 1) slot[i] = only_slot(s, points, p, k);
    kept[i] = slot[i] < 0 ? nothing : contact_kept(points, p, k, s->sides, slot[i]);
    if (slot[i] >= 0) taken[slot[i]] = PETSC_TRUE;
  }
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt j = 0; j < s->sides && slot[i] < 0; ++j)
      if (!taken[j]) slot[i] = j;
    taken[slot[i]] = PETSC_TRUE;
  }
}

PetscErrorCode ContactAnchor(Contact *s, const NodalScene *scene, const WallPlace *place, ContactPoint *c)
{
  PetscFunctionBeginUser;
  if (s->n_anchors == s->capacity_anchors) {
    s->capacity_anchors += s->capacity_anchors / 2 + 16;
    PetscCall(PetscRealloc((size_t)s->capacity_anchors * sizeof *s->anchor, &s->anchor));
  }
  c->anchor = s->n_anchors++;
  wall_anchor(s->walls, c->wall, scene->t, c->x, place, s->anchor + c->anchor);
  PetscFunctionReturn(0);
}
