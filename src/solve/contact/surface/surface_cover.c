/* How much of its surface a material point turns to another body that stands before it: not that beyond where the other
 * one ends, so that an area of contact is that of both, whichever body comes first. */
#include "solve/contact/surface/surface.h"

#define ROW 0.5     /* of a point's size: no farther behind, others stand in its row */
#define BESIDE 0.25 /* at least so far aside, and */
#define NEXT 1.75   /* at most: a row that goes on. In a lattice that stands askew the next is 1.4 away */
#define LAYERS 1    /* of a point's size: so far behind a point of the other body still tells where that ends */
#define NOTHING 0.02
#define ALL (1 - 1e-9)

/* A stretch of a surface, from the place of the point that it is asked for, m. */
typedef struct {
  PetscReal low, high;
} Stretch;

/* Offset of q from p along the normal and along the surface. */
static void offset(const SurfacePoint *p, const SurfacePoint *q, const PetscReal n[3], PetscReal *along,
                   PetscReal *aside)
{
  const PetscReal r[2] = {q->x[0] - p->x[0], q->x[1] - p->x[1]};
  *along = r[0] * n[0] + r[1] * n[1];
  *aside = r[1] * n[0] - r[0] * n[1];
}

/* From a point to the end of its body on one side (1 or -1): to the side of it that it was seeded beside, as that has
 * gone since; else half of its part. */
static PetscReal end_of(const SurfacePoint *p, const PetscReal n[3], int side)
{
  const PetscReal *F = p->F, *c = p->corner;
  const PetscReal x = F[0] * c[0] + F[1] * c[1], y = F[3] * c[0] + F[4] * c[1], aside = side * (y * n[0] - x * n[1]);
  return aside > BESIDE * p->size ? aside : 0.5 * p->size;
}

/* Of a point among those of its body: half the way to the next ones of its row, or to the body's end. */
static Stretch own_of(const Surface *s, const SurfacePoint *p, const PetscReal n[3])
{
  PetscReal way[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, along, aside;
  const PetscReal within = 2 * NEXT * p->size;
  for (PetscInt k = surface_first_at(s, p->x[0] - within); k < s->n && s->point[k].x[0] <= p->x[0] + within; ++k) {
    const SurfacePoint *q = s->point + k;
    offset(p, q, n, &along, &aside);
    const PetscReal mean = 0.5 * (p->size + q->size), far = PetscAbsReal(aside);
    if (PetscAbsReal(along) > ROW * p->size || far < BESIDE * p->size || far > NEXT * mean) continue;
    way[aside > 0] = PetscMin(way[aside > 0], far * 0.5 * p->size / mean);
  }
  return (Stretch){.low = -(way[0] < PETSC_MAX_REAL ? way[0] : end_of(p, n, -1)),
                   .high = way[1] < PETSC_MAX_REAL ? way[1] : end_of(p, n, 1)};
}

/* Of the other body, as far as it is needed. */
static Stretch other_of(const Surface *s, const SurfacePoint *p, const SurfacePair *pair)
{
  const SurfacePoint *front = pair->other;
  const PetscReal within = 2 * (p->size + front->size);
  Stretch all = {PETSC_MAX_REAL, -PETSC_MAX_REAL};
  PetscReal along, aside, behind, away;
  for (PetscInt k = surface_first_at(s, p->x[0] - within); k < s->n && s->point[k].x[0] <= p->x[0] + within; ++k) {
    const SurfacePoint *q = s->point + k;
    offset(p, q, pair->normal, &along, &aside);
    offset(front, q, pair->normal, &behind, &away);
    if (PetscAbsReal(behind) > LAYERS * front->size || PetscAbsReal(aside) > within) continue;
    all.low = PetscMin(all.low, aside - end_of(q, pair->normal, -1));
    all.high = PetscMax(all.high, aside + end_of(q, pair->normal, 1));
  }
  return all;
}

PetscReal surface_cover(const Surface *a, const SurfacePoint *p, const Surface *b, const SurfacePair *pair)
{
  const Stretch mine = own_of(a, p, pair->normal), theirs = other_of(b, p, pair);
  const PetscReal both = PetscMin(mine.high, theirs.high) - PetscMax(mine.low, theirs.low);
  const PetscReal share = both / (mine.high - mine.low);
  return share > ALL ? 1 : share < NOTHING ? 0 : share;
}
