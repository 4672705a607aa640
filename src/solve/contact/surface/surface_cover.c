/* How much of its surface a material point turns to another body that stands before it: not that beyond where the other
 * one ends, so that an area of contact is that of both, whichever body comes first. In space a surface is a rectangle
 * along two ways, and counts with the product of what it has along each. */
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

/* The normal and the ways along the surface: one in the plane. */
typedef struct {
  PetscInt ways;
  PetscReal normal[3], along[2][3];
} Axes;

/* Where q is from p. */
typedef struct {
  PetscReal normal, along[2];
} Offset;

static Offset offset(const SurfacePoint *p, const SurfacePoint *q, const Axes *axes)
{
  PetscReal r[3];
  surface_offset(p, q, r);
  return (Offset){.normal = surface_dot(r, axes->normal),
                  .along = {surface_dot(r, axes->along[0]), surface_dot(r, axes->along[1])}};
}

/* In space the first way is the material axis of p that leans least out of the surface: points stand in rows along
 * that. */
static void rows_of(const SurfacePoint *p, Axes *axes)
{
  PetscReal least = PETSC_MAX_REAL, size = 0, *t = axes->along[0];
  for (int k = 0; k < 3; ++k) {
    const PetscReal e[3] = {p->F[k], p->F[3 + k], p->F[6 + k]}, out = surface_dot(e, axes->normal);
    const PetscReal leans = PetscAbsReal(out) / PetscSqrtReal(surface_dot(e, e));
    if (leans >= least) continue;
    least = leans;
    for (int d = 0; d < 3; ++d) t[d] = e[d] - out * axes->normal[d];
  }
  size = PetscSqrtReal(surface_dot(t, t));
  for (int d = 0; d < 3; ++d) t[d] /= size;
  surface_cross(axes->normal, t, axes->along[1]);
}

static Axes axes_of(PetscInt dim, const SurfacePoint *p, const PetscReal n[3])
{
  Axes axes = {.ways = dim - 1, .normal = {n[0], n[1], n[2]}, .along = {{-n[1], n[0], 0}}};
  if (dim == 3) rows_of(p, &axes);
  return axes;
}

/* From a point to the end of its body on one side (1 or -1): to the side of it that it was seeded beside, as that has
 * gone since; else half of its part. */
static PetscReal end_of(const SurfacePoint *p, const PetscReal along[3], int side)
{
  PetscReal corner[3];
  for (int d = 0; d < 3; ++d) corner[d] = surface_dot(p->F + 3 * d, p->corner);
  const PetscReal aside = side * surface_dot(corner, along);
  return aside > BESIDE * p->size ? aside : 0.5 * p->size;
}

/* Of a point among those of its body: half the way to the next ones of its row, or to the body's end. */
static Stretch own_of(const Surface *s, const SurfacePoint *p, const Axes *axes, PetscInt way)
{
  PetscReal next[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL};
  SurfaceWalk walk;
  for (const SurfacePoint *q = surface_first(s, p->x, 2 * NEXT * p->size, &walk); q; q = surface_next(&walk)) {
    const Offset o = offset(p, q, axes);
    const PetscReal mean = 0.5 * (p->size + q->size), far = PetscAbsReal(o.along[way]);
    if (PetscAbsReal(o.normal) > ROW * p->size || far < BESIDE * p->size || far > NEXT * mean) continue;
    if (axes->ways == 2 && PetscAbsReal(o.along[1 - way]) > ROW * p->size) continue;
    next[o.along[way] > 0] = PetscMin(next[o.along[way] > 0], far * 0.5 * p->size / mean);
  }
  return (Stretch){.low = -(next[0] < PETSC_MAX_REAL ? next[0] : end_of(p, axes->along[way], -1)),
                   .high = next[1] < PETSC_MAX_REAL ? next[1] : end_of(p, axes->along[way], 1)};
}

/* Of the other body, as far as it is needed. */
static Stretch other_of(const Surface *s, const SurfacePoint *p, const SurfacePair *pair, const Axes *axes,
                        PetscInt way)
{
  const SurfacePoint *front = pair->other;
  const PetscReal within = 2 * (p->size + front->size);
  const PetscReal *along = axes->along[way];
  Stretch all = {PETSC_MAX_REAL, -PETSC_MAX_REAL};
  SurfaceWalk walk;
  for (const SurfacePoint *q = surface_first(s, p->x, within, &walk); q; q = surface_next(&walk)) {
    const Offset o = offset(p, q, axes), behind = offset(front, q, axes);
    if (PetscAbsReal(behind.normal) > LAYERS * front->size || PetscAbsReal(o.along[way]) > within) continue;
    if (axes->ways == 2 && PetscAbsReal(o.along[1 - way]) > 0.5 * (p->size + q->size)) continue;
    all.low = PetscMin(all.low, o.along[way] - end_of(q, along, -1));
    all.high = PetscMax(all.high, o.along[way] + end_of(q, along, 1));
  }
  return all;
}

PetscReal surface_cover(const Surface *a, const SurfacePoint *p, const Surface *b, const SurfacePair *pair)
{
  const Axes axes = axes_of(a->dim, p, pair->normal);
  PetscReal whole = 1;
  for (PetscInt way = 0; way < axes.ways; ++way) {
    const Stretch mine = own_of(a, p, &axes, way), theirs = other_of(b, p, pair, &axes, way);
    const PetscReal both = PetscMin(mine.high, theirs.high) - PetscMax(mine.low, theirs.low);
    const PetscReal share = both / (mine.high - mine.low);
    if (share < NOTHING) return 0;
    whole *= share > ALL ? 1 : share;
  }
  return whole;
}
