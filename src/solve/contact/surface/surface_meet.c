/* How a material point stands against another body.
 *
 * Each point is a disk, in space a ball, on the surface of its body, as wide as its reach. The normal of contact is the
 * way along which the convex hulls of the parts of both bodies around the place are farthest apart:
 * across the flatter of both surfaces, exactly where one is plane, whatever lattice its points stand in. */
#include "solve/contact/contact.h"
#include "solve/contact/surface/surface_hull.h"

#define OUTSTANDING 0.05 /* of a point's size: how much farther out makes up for standing that far aside */
#define BESIDE \
  1.175 /* of a point's size: neighbours are within it (1.15 of Gauss points), those across a corner not (1.2) */
#define FITS 0.01         /* of a point's size: what is so near touches */
#define ALIKE 0.8         /* cosine: a curved side leans by less from one point to the next, another side by more */
#define DEEPER 0.05       /* of a point's size: by more than that a side is none, as of points that stand in steps */
#define IN_FRONT 0.25     /* of a point's size: what stands so far before a surface belongs to another side */
#define BEHIND 0.375      /* of two points' size: so far aside one still stands before the other: 0.71 at an edge, */
#define BEHIND_SPACE 0.42 /* and 0.82 at a corner of space */
#define SQUARE 1e-4       /* 1 - cosine: a surface looks along n */
#define STRAIGHT 1.4      /* of half of what a point was given: its middle is at most a sixth off that of its part */
#define A_LITTLE (1 + 1e-9)
#define PASSES_SPACE 2 /* towards a side: of neighbours alone few see one of space whole */

/* Of the distance: asked for of every pair, without its root. */
static PetscReal square(const PetscReal *a, const PetscReal *b)
{
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]);
}

static void part_around(const Surface *s, const PetscReal *x, PetscReal radius, Part *part)
{
  part_begin(part, s->dim);
  SurfaceWalk walk = surface_walk(s, x, radius);
  for (const SurfacePoint *p; (p = surface_next(&walk));)
    if (square(p->x, x) <= radius * radius) part_add(part, p);
}

static const SurfacePoint *nearest_within(const Surface *b, const PetscReal *x, PetscReal within, PetscReal *least)
{
  const SurfacePoint *best = NULL;
  PetscReal nearest = within * within;
  SurfaceWalk walk = surface_walk(b, x, within);
  *least = within;
  for (const SurfacePoint *p; (p = surface_next(&walk));) {
    const PetscReal now = square(p->x, x);
    if (now >= nearest) continue;
    nearest = now, best = p;
    *least = PetscSqrtReal(now);
    walk.high = x[0] + *least;
  }
  return best;
}

/* Of what p may meet; most that do are near. */
static const SurfacePoint *nearest_of(const Surface *b, const SurfacePoint *p, PetscReal h, PetscReal *least)
{
  const PetscReal within = PetscMin(3 * h, A_LITTLE * (h + p->reach + b->reach + p->own));
  const SurfacePoint *q = nearest_within(b, p->x, 0.5 * within, least);
  if (!q) q = nearest_within(b, p->x, within, least);
  return q && *least <= h + p->reach + q->reach + p->own ? q : NULL;
}

/* Offset of q from p, along n and across it. */
static void offset(const SurfacePoint *p, const SurfacePoint *q, const PetscReal n[3], PetscReal *along,
                   PetscReal *across)
{
  const PetscReal r[3] = {p->x[0] - q->x[0], p->x[1] - q->x[1], p->x[2] - q->x[2]};
  *along = vector_dot(r, n);
  const PetscReal aside[3] = {r[0] - *along * n[0], r[1] - *along * n[1], r[2] - *along * n[2]};
  *across = PetscSqrtReal(vector_dot(aside, aside));
}

/* From a point to the surface of its body along n. (A corner counts towards a wall, against its normal.) */
static PetscReal reach_along(PetscInt dim, const SurfacePoint *p, const PetscReal n[3])
{
  const PetscReal back[3] = {-n[0], -n[1], -n[2]};
  return contact_reach(p->F, back, p->first, p->corner, dim);
}

/* How wide the surface is that a point was given, if it looks along n as a plane side does; else 0: of a bent one
 * nobody knows how far it is plane. */
static PetscReal plane_width(PetscInt dim, const SurfacePoint *p, const PetscReal n[3])
{
  const PetscReal square = vector_dot(p->face, p->face), along = vector_dot(p->face, n);
  if (along <= 0 || PetscSqr(along) < (1 - 2 * SQUARE) * square) return 0;
  return dim == 2 ? along : PetscSqrtReal(along);
}

/* Does another point of its body stand before p? */
static PetscBool is_behind(const Part *a, const SurfacePoint *p, const PetscReal n[3])
{
  const PetscReal within = a->dim == 2 ? BEHIND : BEHIND_SPACE;
  PetscReal along, across;
  for (PetscInt k = 0; k < a->n; ++k) {
    offset(p, a->point[k], n, &along, &across);
    if (along > 0.5 * p->own && across < within * (p->own + a->point[k]->own)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Of what was given plane surface that looks at p, the one that p is most nearly straight before, if it is: that
 * surface is the body's there, wherever the middle of its part is, and whatever stands behind it. */
static const SurfacePoint *straight_before(const Part *b, const SurfacePoint *p, const PetscReal n[3])
{
  const SurfacePoint *best = NULL;
  PetscReal along, across, least = STRAIGHT;
  for (PetscInt k = 0; k < b->n; ++k) {
    const PetscReal width = plane_width(b->dim, b->point[k], n);
    if (width == 0) continue;
    offset(p, b->point[k], n, &along, &across);
    if (across < least * 0.5 * width) least = 2 * across / width, best = b->point[k];
  }
  return best;
}

/* The outermost point of b whose part lies before that of p; of those as far out the nearest. */
static PetscBool choose(const Part *b, const SurfacePoint *p, SurfacePair *pair)
{
  PetscReal along, across, least = PETSC_MAX_REAL;
  pair->other = straight_before(b, p, pair->normal);
  if (pair->other) {
    offset(p, pair->other, pair->normal, &along, &across);
    pair->gap = along - reach_along(b->dim, pair->other, pair->normal);
    return PETSC_TRUE;
  }
  for (PetscInt k = 0; k < b->n; ++k) {
    const SurfacePoint *q = b->point[k];
    offset(p, q, pair->normal, &along, &across);
    if (across > 0.5 * (p->own + q->own)) continue;
    const PetscReal gap = along - reach_along(b->dim, q, pair->normal);
    const PetscReal key = gap + OUTSTANDING * across * across / q->own;
    if (key >= least) continue;
    least = key;
    pair->gap = gap;
    pair->other = q;
  }
  return least < PETSC_MAX_REAL;
}

/* Of a part a point and its neighbours: by the size of the larger of both, as what a surface leaves of a cell is small
 * beside a whole one, and would have none. */
static void beside(const Part *part, const SurfacePoint *p, Part *beside)
{
  part_begin(beside, part->dim);
  for (PetscInt k = 0; k < part->n; ++k) {
    const SurfacePoint *q = part->point[k];
    if (square(q->x, p->x) <= PetscSqr(BESIDE * PetscMax(p->own, q->own))) part_add(beside, q);
  }
}

/* How far out the surface that p stands for is along n, out of its body. */
static PetscReal surface_along(const SurfacePoint *p, const PetscReal n[3], PetscInt dim)
{
  return vector_dot(p->x, n) + reach_along(dim, p, n);
}

/* Of a part what does not stand before the surface of q. Places of points tell nothing of that where the surface cuts
 * cells: they are at any depth below it. */
static PetscBool clear_front(const Part *part, const SurfacePoint *q, const PetscReal n[3], Part *clear)
{
  const PetscReal front = surface_along(q, n, part->dim) + IN_FRONT * q->own;
  part_begin(clear, part->dim);
  for (PetscInt k = 0; k < part->n; ++k)
    if (surface_along(part->point[k], n, part->dim) <= front) part_add(clear, part->point[k]);
  return (PetscBool)(clear->n < part->n);
}

/* A way to the other body, and what of that counts. */
typedef struct {
  PetscReal n[3];
  Part theirs;
} Way;

/* A body that stands round a corner of the other one has two sides there, and its hull has neither. Where something is
 * before the surface across `whole`, the way is across what is behind the side that p meets, as it and its neighbours
 * and those of q see it; way->n comes with that between the two points. PETSC_FALSE: nothing is before it. */
static PetscBool take_side(const SurfacePoint *p, const Part *mine, const SurfacePoint *q, const Part *theirs,
                           const PetscReal whole[3], Way *way)
{
  const PetscReal deepest = 0.5 * (p->own + q->own);
  PetscReal back[3] = {-whole[0], -whole[1], -whole[2]};
  Part near, far;
  const PetscBool turns = clear_front(theirs, q, whole, &way->theirs);
  if (!clear_front(mine, p, back, &near) && !turns) return PETSC_FALSE;
  beside(mine, p, &near);
  beside(theirs, q, &far);
  if (!near.n || !far.n) return PETSC_FALSE; /* so many points that some were left out */
  hull_face(&near, &far, deepest, way->n);
  for (int pass = 0; pass < (theirs->dim == 2 ? 1 : PASSES_SPACE); ++pass) {
    for (int i = 0; i < 3; ++i) back[i] = -way->n[i];
    (void)clear_front(theirs, q, way->n, &way->theirs);
    (void)clear_front(mine, p, back, &near);
    if (!near.n || !way->theirs.n) return PETSC_FALSE;
    hull_face(&near, &way->theirs, deepest, way->n);
  }
  return PETSC_TRUE;
}

/* What p meets that way, and how far its own surface is from there. */
static PetscBool meet_way(const SurfacePoint *p, const Part *mine, const Part *theirs, const PetscReal n[3],
                          SurfacePair *pair, PetscReal *gap)
{
  *pair = (SurfacePair){.normal = {n[0], n[1], n[2]}};
  if (is_behind(mine, p, n) || !choose(theirs, p, pair)) return PETSC_FALSE;
  *gap = pair->gap - contact_reach(p->F, pair->normal, p->first, p->corner, mine->dim);
  return PETSC_TRUE;
}

/* Does all surface that is known of a part look along n, as that of a round body does at a single point alone? */
static PetscBool is_plane(const Part *part, const PetscReal n[3])
{
  for (PetscInt k = 0; k < part->n; ++k) {
    const SurfacePoint *q = part->point[k];
    if (!q->bent && vector_dot(q->face, q->face) > 0 && plane_width(part->dim, q, n) == 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Does a way lean from the plane surface that it meets, across which that between hulls is? Then it is across no side:
 * it is that from points beside a corner of the first body, which look elsewhere. */
static PetscBool leans(const Part *theirs, const PetscReal whole[3], const SurfacePair *side)
{
  if (side->other->bent || !(vector_dot(whole, side->normal) < 1 - SQUARE)) return PETSC_FALSE;
  return (PetscBool)(plane_width(theirs->dim, side->other, whole) > 0 && is_plane(theirs, whole));
}

/* Is the way that was found anew, with its gap, better than that between hulls? Not if a block would be deeper in it by
 * that; and in the plane, where ways out are exact, not if what touches across a curved side would stand off. */
static PetscBool is_side(PetscInt dim, const SurfacePoint *p, const SurfacePair *whole, PetscReal gap,
                         const SurfacePair *side, PetscReal farther)
{
  const PetscBool touches = (PetscBool)(dim == 2 && PetscAbsReal(gap) <= FITS * p->own && farther > gap);
  if (touches && vector_dot(whole->normal, side->normal) > ALIKE) return PETSC_FALSE;
  return (PetscBool)(farther > PetscMin(gap, 0) - DEEPER * p->own);
}

PetscBool surface_meet(const Surface *a, const SurfacePoint *p, const Surface *b, PetscReal h, SurfacePair *pair)
{
  Part mine, theirs;
  Way way = {.n = {1, 0, 0}}; /* where one lies on the other: any will do */
  SurfacePair other;
  PetscReal least, gap = 0, farther;
  const SurfacePoint *q = nearest_of(b, p, h, &least);
  if (!q) return PETSC_FALSE;
  const PetscReal far = h * PetscMax(1, PetscMax(p->flat, q->flat));
  part_around(a, q->x, least + far, &mine);
  part_around(b, p->x, least + far, &theirs);
  for (int i = 0; i < 3 && least > 0; ++i) way.n[i] = (p->x[i] - q->x[i]) / least;
  PetscReal n[3] = {way.n[0], way.n[1], way.n[2]};
  hull_face(&mine, &theirs, 0.5 * (p->own + q->own), n);
  PetscBool meets = meet_way(p, &mine, &theirs, n, pair, &gap);
  if (take_side(p, &mine, q, &theirs, n, &way) && meet_way(p, &mine, &way.theirs, way.n, &other, &farther))
    if (!leans(&theirs, n, &other) && (!meets || is_side(a->dim, p, pair, gap, &other, farther)))
      *pair = other, meets = PETSC_TRUE;
  if (!meets) return PETSC_FALSE;
  pair->cover = surface_cover(a, p, b, pair);
  return pair->cover > 0;
}
