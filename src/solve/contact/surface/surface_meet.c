/* How a material point stands against another body.
 *
 * Each point is a disk (in space a ball) on the surface of its body, as wide as its reach. The normal of contact is the
 * way along which the convex hulls of the parts of both bodies around the place are farthest apart:
 * across the flatter of both surfaces, exactly where one is plane, whatever lattice its points stand in. */
#include "solve/contact/contact.h"
#include "solve/contact/surface/surface_hull.h"

#define OUTSTANDING 0.05 /* of a point's size: how much farther out makes up for standing that far aside */
#define BESIDE \
  1.175 /* of a point's size: neighbours are within it (1.15 of Gauss points), those across a corner not (1.2) */
#define DEEPER 0.05   /* of a point's size: by more than that a side is none, as of points that stand in steps */
#define IN_FRONT 0.25 /* of a point's size: what stands so far before a surface belongs to another side */

/* Of the distance: asked for of every pair, without its root. */
static PetscReal square(const PetscReal *a, const PetscReal *b)
{
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]);
}

static void part_around(const Surface *s, const PetscReal *x, PetscReal radius, SurfacePart *part)
{
  SurfaceWalk walk;
  surface_part_begin(part, s->dim);
  for (const SurfacePoint *q = surface_first(s, x, radius, &walk); q; q = surface_next(&walk))
    if (square(q->x, x) <= radius * radius) surface_part_add(part, q);
}

static const SurfacePoint *nearest_within(const Surface *b, const PetscReal *x, PetscReal within, PetscReal *least)
{
  const SurfacePoint *best = NULL;
  PetscReal nearest = within * within;
  SurfaceWalk walk;
  for (const SurfacePoint *q = surface_first(b, x, within, &walk); q; q = surface_next(&walk)) {
    const PetscReal now = square(q->x, x);
    if (now < nearest) nearest = now, best = q;
  }
  *least = PetscSqrtReal(nearest);
  return best;
}

/* Most that meet are next to each other. */
static const SurfacePoint *nearest_of(const Surface *b, const SurfacePoint *p, PetscReal within, PetscReal *least)
{
  const SurfacePoint *best = nearest_within(b, p->x, PetscMin(within, 2 * p->size), least);
  return best ? best : nearest_within(b, p->x, within, least);
}

/* How far p is from q along n, and across it. */
static void offset(const SurfacePoint *p, const SurfacePoint *q, const PetscReal n[3], PetscReal *along,
                   PetscReal *across)
{
  PetscReal r[3], aside[3];
  surface_offset(q, p, r);
  surface_cross(r, n, aside);
  *along = surface_dot(r, n);
  *across = PetscSqrtReal(surface_dot(aside, aside));
}

/* Does another point of its body stand before p? */
static PetscBool is_behind(const SurfacePart *a, const SurfacePoint *p, const PetscReal n[3])
{
  PetscReal along, across;
  for (PetscInt k = 0; k < a->n; ++k) {
    offset(p, a->point[k], n, &along, &across);
    if (along > 0.5 * p->size && across < 0.375 * (p->size + a->point[k]->size)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The outermost point of b whose part lies before that of p; of those as far out the nearest. */
static PetscBool choose(const SurfacePart *b, const SurfacePoint *p, SurfacePair *pair)
{
  PetscReal along, across, least = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < b->n; ++k) {
    const SurfacePoint *q = b->point[k];
    offset(p, q, pair->normal, &along, &across);
    if (across > 0.5 * (p->size + q->size)) continue;
    const PetscReal gap = along - contact_reach(q->F, pair->normal, q->first, q->corner, b->dim);
    const PetscReal key = gap + OUTSTANDING * across * across / q->size;
    if (key >= least) continue;
    least = key;
    pair->gap = gap;
    pair->other = q;
  }
  return least < PETSC_MAX_REAL;
}

/* Of a part a point and its neighbours. */
static void beside(const SurfacePart *part, const SurfacePoint *p, SurfacePart *beside)
{
  surface_part_begin(beside, part->dim);
  for (PetscInt k = 0; k < part->n; ++k)
    if (square(part->point[k]->x, p->x) <= PetscSqr(BESIDE * p->size)) surface_part_add(beside, part->point[k]);
}

/* Of a part what does not stand before the surface of q. */
static PetscBool clear_front(const SurfacePart *part, const SurfacePoint *q, const PetscReal n[3], SurfacePart *clear)
{
  surface_part_begin(clear, part->dim);
  for (PetscInt k = 0; k < part->n; ++k) {
    PetscReal r[3];
    surface_offset(q, part->point[k], r);
    if (surface_dot(r, n) <= IN_FRONT * q->size) surface_part_add(clear, part->point[k]);
  }
  return (PetscBool)(clear->n < part->n);
}

/* A way to the other body, and what of that counts. */
typedef struct {
  PetscReal n[3];
  SurfacePart theirs;
} Way;

/* A body that stands round a corner of the other one has two sides there, and its hull has neither. Where something is
 * before the surface across `whole`, the way is across what is behind the side that p meets, as it and its neighbours
 * and those of q see it; way->n comes with that between the two points. PETSC_FALSE: nothing is before it. */
static PetscBool take_side(const SurfacePoint *p, const SurfacePart *mine, const SurfacePoint *q,
                           const SurfacePart *theirs, const PetscReal whole[3], Way *way)
{
  const PetscReal deepest = 0.5 * (p->size + q->size);
  PetscReal back[3] = {-whole[0], -whole[1], -whole[2]};
  SurfacePart near, far;
  const PetscBool turns = clear_front(theirs, q, whole, &way->theirs);
  if (!clear_front(mine, p, back, &near) && !turns) return PETSC_FALSE;
  beside(mine, p, &near);
  beside(theirs, q, &far);
  if (!near.n || !far.n) return PETSC_FALSE; /* so many points that some were left out */
  surface_face(&near, &far, deepest, way->n);
  for (int i = 0; i < 3; ++i) back[i] = -way->n[i];
  (void)clear_front(theirs, q, way->n, &way->theirs);
  (void)clear_front(mine, p, back, &near);
  if (!near.n || !way->theirs.n) return PETSC_FALSE;
  surface_face(&near, &way->theirs, deepest, way->n);
  return PETSC_TRUE;
}

/* What p meets that way, and how far its own surface is from there. */
static PetscBool meet_way(const SurfacePoint *p, const SurfacePart *mine, const SurfacePart *theirs,
                          const PetscReal n[3], SurfacePair *pair, PetscReal *gap)
{
  *pair = (SurfacePair){.normal = {n[0], n[1], n[2]}};
  if (is_behind(mine, p, n) || !choose(theirs, p, pair)) return PETSC_FALSE;
  *gap = pair->gap - contact_reach(p->F, pair->normal, p->first, p->corner, mine->dim);
  return PETSC_TRUE;
}

PetscBool surface_meet(const Surface *a, const SurfacePoint *p, const Surface *b, PetscReal h, SurfacePair *pair)
{
  SurfacePart mine, theirs;
  Way way;
  SurfacePair other;
  PetscReal least, gap, farther, n[3] = {1, 0, 0};
  const SurfacePoint *q = nearest_of(b, p, 3 * h, &least);
  if (!q || least > h + p->reach + q->reach + p->size) return PETSC_FALSE;
  part_around(a, q->x, least + h, &mine);
  part_around(b, p->x, least + h, &theirs);
  for (int i = 0; i < 3 && least > 0; ++i) n[i] = (p->x[i] - q->x[i]) / least; /* else any way will do */
  for (int i = 0; i < 3; ++i) way.n[i] = n[i];
  surface_face(&mine, &theirs, 0.5 * (p->size + q->size), n);
  PetscBool meets = meet_way(p, &mine, &theirs, n, pair, &gap);
  if (take_side(p, &mine, q, &theirs, n, &way) && meet_way(p, &mine, &way.theirs, way.n, &other, &farther))
    if (!meets || farther > PetscMin(gap, 0) - DEEPER * p->size) *pair = other, meets = PETSC_TRUE;
  if (!meets) return PETSC_FALSE;
  pair->cover = surface_cover(a, p, b, pair);
  return pair->cover > 0;
}
