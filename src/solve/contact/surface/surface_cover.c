/* How much of its surface a material point turns to another body that stands before it: not that beyond where the other
 * one ends, so that an area of contact is that of both, whichever body comes first. */
#include "solve/contact/surface/surface_hull.h"

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

/* Unit vectors along a surface: one in the plane, two in space. */
typedef struct {
  PetscInt n;
  PetscReal along[2][3];
} Tangents;

/* In space they go with the axis of the point's matter that lies most nearly in the surface: where the body was seeded
 * along it, so do rows of its points. */
static Tangents tangents_of(PetscInt dim, const SurfacePoint *p, const PetscReal n[3])
{
  Tangents t = {.n = dim - 1, .along = {{-n[1], n[0], 0}}};
  PetscReal *u = t.along[0], *v = t.along[1], flattest = PETSC_MAX_REAL;
  if (dim == 2) return t;
  for (int k = 0; k < 3; ++k) {
    const PetscReal axis[3] = {p->F[k], p->F[3 + k], p->F[6 + k]}, length = PetscSqrtReal(vector_dot(axis, axis));
    const PetscReal off = vector_dot(axis, n), square = PetscSqr(off / length);
    if (square >= flattest) continue;
    flattest = square;
    for (int i = 0; i < 3; ++i) u[i] = (axis[i] - off * n[i]) / (length * PetscSqrtReal(1 - square));
  }
  vector_cross(n, u, v);
  return t;
}

/* Offset of q from p along a unit vector. */
static PetscReal offset(const SurfacePoint *p, const SurfacePoint *q, const PetscReal u[3])
{
  const PetscReal r[3] = {q->x[0] - p->x[0], q->x[1] - p->x[1], q->x[2] - p->x[2]};
  return vector_dot(r, u);
}

/* Do the two stand in one row along tangent k, but for so much? */
static PetscBool in_row(const SurfacePoint *p, const SurfacePoint *q, const Tangents *t, PetscInt k, PetscReal aside)
{
  return (PetscBool)(t->n == 1 || PetscAbsReal(offset(p, q, t->along[1 - k])) <= aside);
}

/* From a point to the end of its body along u or against it (side 1 or -1): to the side of it that it was seeded
 * beside, as that has gone since; else half of its part. */
static PetscReal end_of(const SurfacePoint *p, const PetscReal u[3], int side)
{
  const PetscReal *F = p->F, *c = p->corner, gone[3] = {vector_dot(F, c), vector_dot(F + 3, c), vector_dot(F + 6, c)};
  const PetscReal aside = side * vector_dot(gone, u);
  return aside > BESIDE * p->size ? aside : 0.5 * p->size;
}

/* Of a point among those of its body: half the way to the next ones of its row, or to the body's end. */
static Stretch own_of(const Surface *s, const SurfacePoint *p, const PetscReal n[3], const Tangents *t, PetscInt k)
{
  const PetscReal *u = t->along[k];
  PetscReal way[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL};
  SurfaceWalk walk = surface_walk(s, p->x, 2 * NEXT * p->size);
  for (const SurfacePoint *q; (q = surface_next(&walk));) {
    const PetscReal mean = 0.5 * (p->size + q->size), aside = offset(p, q, u), far = PetscAbsReal(aside);
    if (far < BESIDE * p->size || far > NEXT * mean || PetscAbsReal(offset(p, q, n)) > ROW * p->size) continue;
    if (in_row(p, q, t, k, ROW * p->size)) way[aside > 0] = PetscMin(way[aside > 0], far * 0.5 * p->size / mean);
  }
  return (Stretch){.low = -(way[0] < PETSC_MAX_REAL ? way[0] : end_of(p, u, -1)),
                   .high = way[1] < PETSC_MAX_REAL ? way[1] : end_of(p, u, 1)};
}

/* Of the other body, as far as it is needed. */
static Stretch other_of(const Surface *s, const SurfacePoint *p, const SurfacePair *pair, const Tangents *t, PetscInt k)
{
  const SurfacePoint *front = pair->other;
  const PetscReal within = 2 * (p->size + front->size), *u = t->along[k];
  Stretch all = {PETSC_MAX_REAL, -PETSC_MAX_REAL};
  SurfaceWalk walk = surface_walk(s, p->x, within);
  for (const SurfacePoint *q; (q = surface_next(&walk));) {
    const PetscReal aside = offset(p, q, u);
    if (PetscAbsReal(aside) > within || PetscAbsReal(offset(front, q, pair->normal)) > LAYERS * front->size) continue;
    if (!in_row(p, q, t, k, 0.5 * (p->size + q->size))) continue;
    all.low = PetscMin(all.low, aside - end_of(q, u, -1));
    all.high = PetscMax(all.high, aside + end_of(q, u, 1));
  }
  return all;
}

PetscReal surface_cover(const Surface *a, const SurfacePoint *p, const Surface *b, const SurfacePair *pair)
{
  const Tangents t = tangents_of(a->dim, p, pair->normal);
  PetscReal share = 1;
  for (PetscInt k = 0; k < t.n; ++k) {
    const Stretch mine = own_of(a, p, pair->normal, &t, k), theirs = other_of(b, p, pair, &t, k);
    const PetscReal both = PetscMin(mine.high, theirs.high) - PetscMax(mine.low, theirs.low);
    share *= PetscMax(0, both / (mine.high - mine.low));
  }
  return share > ALL ? 1 : share < NOTHING ? 0 : share;
}
