/* How a material point stands against another body.
 *
 * Each point is a disk on the surface of its body, as wide as its reach. The normal of contact is the
 * way along which the convex hulls of the parts of both bodies around the place are farthest apart:
 * across the flatter of both surfaces, exactly where one is plane, whatever lattice its points stand in. */
#include "solve/contact/contact.h"
#include "solve/contact/surface/surface.h"

#define MOST_POINTS 512
#define MOST_SWEEPS 50
#define FLAT 1e-12
#define WAYS 32          /* in which hulls that overlap are asked how far they are from being apart */
#define OUTSTANDING 0.05 /* of a point's size: how much farther out makes up for standing that far aside */
#define BESIDE \
  1.175 /* of a point's size: neighbours are within it (1.15 of Gauss points), those across a corner not (1.2) */
#define DEEPER 0.05   /* of a point's size: by more than that a side is none, as of points that stand in steps */
#define IN_FRONT 0.25 /* of a point's size: what stands so far before a surface belongs to another side */

/* Points around a place; disks are so much wider than the smallest. */
typedef struct {
  PetscInt n;
  const SurfacePoint *point[MOST_POINTS];
  PetscReal least;
} Part;

PetscInt surface_first_at(const Surface *s, PetscReal x)
{
  PetscInt lo = 0, hi = s->n;
  while (lo < hi) {
    const PetscInt middle = lo + (hi - lo) / 2;
    if (s->point[middle].x[0] < x) lo = middle + 1;
    else hi = middle;
  }
  return lo;
}

/* Of the distance: asked for of every pair, without its root. */
static PetscReal square(const PetscReal *a, const PetscReal *b)
{
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]);
}

static void part_around(const Surface *s, const PetscReal *x, PetscReal radius, Part *part)
{
  part->n = 0;
  part->least = PETSC_MAX_REAL;
  for (PetscInt k = surface_first_at(s, x[0] - radius); k < s->n && s->point[k].x[0] <= x[0] + radius; ++k) {
    if (square(s->point[k].x, x) > radius * radius || part->n == MOST_POINTS) continue;
    part->point[part->n++] = s->point + k;
    part->least = PetscMin(part->least, s->point[k].reach);
  }
}

/* The point of the hull that is farthest along the unit vector d; the part holds some. */
static void farthest(const Part *part, const PetscReal d[2], PetscReal out[2])
{
  const SurfacePoint *best = part->point[0];
  PetscReal most = -PETSC_MAX_REAL;
  for (PetscInt k = 0; k < part->n; ++k) {
    const SurfacePoint *s = part->point[k];
    const PetscReal height = s->x[0] * d[0] + s->x[1] * d[1] + s->reach - part->least;
    if (height > most) most = height, best = s;
  }
  const PetscReal wider = best->reach - part->least;
  for (int i = 0; i < 2; ++i) out[i] = best->x[i] + wider * d[i];
}

/* The place nearest to the origin on the way from a to b; what of its ends is needed for it stays in s. */
static PetscInt nearest_on(const PetscReal a[2], const PetscReal b[2], PetscReal s[2][2], PetscReal v[2])
{
  const PetscReal way[2] = {b[0] - a[0], b[1] - a[1]}, square = way[0] * way[0] + way[1] * way[1];
  const PetscReal t = square > 0 ? -(a[0] * way[0] + a[1] * way[1]) / square : 0;
  const PetscReal *end = t <= 0 ? a : b;
  for (int i = 0; i < 2; ++i) {
    s[0][i] = t > 0 && t < 1 ? a[i] : end[i];
    s[1][i] = b[i];
    v[i] = t > 0 && t < 1 ? a[i] + t * way[i] : end[i];
  }
  return t > 0 && t < 1 ? 2 : 1;
}

static PetscBool holds_origin(PetscReal s[2][2], const PetscReal w[2])
{
  const PetscReal *corner[3] = {s[0], s[1], w};
  int left = 0;
  for (int i = 0; i < 3; ++i) {
    const PetscReal *a = corner[i], *b = corner[(i + 1) % 3];
    left += a[0] * (b[1] - a[1]) - a[1] * (b[0] - a[0]) > 0 ? 1 : -1;
  }
  return left == 3 || left == -3;
}

/* The way from b to a, unit, by the algorithm of Gilbert, Johnson and Keerthi; PETSC_FALSE where they overlap.
 * n comes with a first guess. */
static PetscBool separate(const Part *a, const Part *b, PetscReal n[2])
{
  PetscReal s[2][2] = {{0}}, v[2] = {0, 0}, length = PETSC_MAX_REAL;
  PetscInt corners = 0;
  for (int sweep = 0; sweep < MOST_SWEEPS; ++sweep) {
    const PetscReal back[2] = {-n[0], -n[1]};
    PetscReal here[2], there[2], w[2], first[2][2], second[2][2], u[2], best[2];
    farthest(a, back, here);
    farthest(b, n, there);
    for (int i = 0; i < 2; ++i) w[i] = here[i] - there[i];
    if (corners && length - (w[0] * n[0] + w[1] * n[1]) <= FLAT * length) break;
    if (corners == 2 && holds_origin(s, w)) return PETSC_FALSE;
    const PetscInt kept = corners ? nearest_on(s[0], w, first, best) : nearest_on(w, w, first, best);
    const PetscInt other = corners == 2 ? nearest_on(s[1], w, second, u) : 0;
    const PetscBool take = other && u[0] * u[0] + u[1] * u[1] < best[0] * best[0] + best[1] * best[1];
    const PetscReal *to = take ? u : best;
    const PetscReal now = PetscSqrtReal(to[0] * to[0] + to[1] * to[1]);
    if (now >= length) break;
    if (now == 0) return PETSC_FALSE;
    corners = take ? other : kept;
    length = now;
    for (int i = 0; i < 2; ++i) {
      s[0][i] = take ? second[0][i] : first[0][i];
      s[1][i] = take ? second[1][i] : first[1][i];
      v[i] = to[i], n[i] = v[i] / length;
    }
  }
  return PETSC_TRUE;
}

/* How far a has to go along n to be out of b, m. */
static PetscReal overlap(const Part *a, const Part *b, const PetscReal n[2])
{
  const PetscReal back[2] = {-n[0], -n[1]};
  PetscReal here[2], there[2];
  farthest(a, back, here);
  farthest(b, n, there);
  return (there[0] - here[0]) * n[0] + (there[1] - here[1]) * n[1];
}

static PetscReal overlap_at(const Part *a, const Part *b, PetscReal angle)
{
  const PetscReal n[2] = {PetscCosReal(angle), PetscSinReal(angle)};
  return overlap(a, b, n);
}

/* The shortest way out for hulls that overlap, and how long it is: across a side of one of them, of which some are
 * looked at all round, and the best is followed to its end. */
static PetscReal escape(const Part *a, const Part *b, PetscReal n[2])
{
  const PetscReal turn = 2 * PETSC_PI / WAYS, golden = 0.5 * (PetscSqrtReal(5) - 1);
  PetscReal best = 0, least = PETSC_MAX_REAL;
  for (int k = 0; k < WAYS; ++k) {
    const PetscReal far = overlap_at(a, b, k * turn);
    if (far < least) least = far, best = k * turn;
  }
  PetscReal low = best - turn, high = best + turn;
  while (high - low > FLAT) {
    const PetscReal wide = golden * (high - low);
    if (overlap_at(a, b, high - wide) < overlap_at(a, b, low + wide)) high = low + wide;
    else low = high - wide;
  }
  n[0] = PetscCosReal(0.5 * (low + high));
  n[1] = PetscSinReal(0.5 * (low + high));
  return overlap(a, b, n);
}

/* The way from b to a, unit: of bodies that have sunk into each other the shortest way out. Hulls of grains that stand
 * round another body overlap without touching it: there it is the one from the nearest point. */
static void face_each_other(const Part *a, const Part *b, PetscReal deepest, PetscReal n[2])
{
  const PetscReal first[2] = {n[0], n[1]};
  if (separate(a, b, n) || escape(a, b, n) <= deepest) return;
  for (int i = 0; i < 2; ++i) n[i] = first[i];
}

static const SurfacePoint *nearest_of(const Surface *b, const PetscReal *x, PetscReal within, PetscReal *least)
{
  const SurfacePoint *best = NULL;
  PetscReal nearest = within * within;
  *least = within;
  for (PetscInt k = surface_first_at(b, x[0] - within); k < b->n && b->point[k].x[0] <= x[0] + *least; ++k) {
    const PetscReal now = square(b->point[k].x, x);
    if (now >= nearest) continue;
    nearest = now, best = b->point + k;
    *least = PetscSqrtReal(now);
  }
  return best;
}

/* Offset of q from p, along n and across it. */
static void offset(const SurfacePoint *p, const SurfacePoint *q, const PetscReal n[2], PetscReal *along,
                   PetscReal *across)
{
  const PetscReal r[2] = {p->x[0] - q->x[0], p->x[1] - q->x[1]};
  *along = r[0] * n[0] + r[1] * n[1];
  *across = PetscAbsReal(r[0] * n[1] - r[1] * n[0]);
}

/* Does another point of its body stand before p? */
static PetscBool is_behind(const Part *a, const SurfacePoint *p, const PetscReal n[2])
{
  PetscReal along, across;
  for (PetscInt k = 0; k < a->n; ++k) {
    offset(p, a->point[k], n, &along, &across);
    if (along > 0.5 * p->size && across < 0.375 * (p->size + a->point[k]->size)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The outermost point of b whose part lies before that of p; of those as far out the nearest. */
static PetscBool choose(const Part *b, const SurfacePoint *p, SurfacePair *pair)
{
  PetscReal along, across, least = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < b->n; ++k) {
    const SurfacePoint *q = b->point[k];
    offset(p, q, pair->normal, &along, &across);
    if (across > 0.5 * (p->size + q->size)) continue;
    const PetscReal gap = along - contact_reach(q->F, pair->normal, q->first, q->corner, 2);
    const PetscReal key = gap + OUTSTANDING * across * across / q->size;
    if (key >= least) continue;
    least = key;
    pair->gap = gap;
    pair->other = q;
  }
  return least < PETSC_MAX_REAL;
}

/* Of a part a point and its neighbours. */
static void beside(const Part *part, const SurfacePoint *p, Part *beside)
{
  beside->n = 0;
  beside->least = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < part->n; ++k) {
    if (square(part->point[k]->x, p->x) > PetscSqr(BESIDE * p->size)) continue;
    beside->point[beside->n++] = part->point[k];
    beside->least = PetscMin(beside->least, part->point[k]->reach);
  }
}

/* Of a part what does not stand before the surface of q. */
static PetscBool clear_front(const Part *part, const SurfacePoint *q, const PetscReal n[2], Part *clear)
{
  clear->n = 0;
  clear->least = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < part->n; ++k) {
    const SurfacePoint *s = part->point[k];
    if ((s->x[0] - q->x[0]) * n[0] + (s->x[1] - q->x[1]) * n[1] > IN_FRONT * q->size) continue;
    clear->point[clear->n++] = s;
    clear->least = PetscMin(clear->least, s->reach);
  }
  return (PetscBool)(clear->n < part->n);
}

/* A way to the other body, and what of that counts. */
typedef struct {
  PetscReal n[2];
  Part theirs;
} Way;

/* A body that stands round a corner of the other one has two sides there, and its hull has neither. Where something is
 * before the surface across `whole`, the way is across what is behind the side that p meets, as it and its neighbours
 * and those of q see it; way->n comes with that between the two points. PETSC_FALSE: nothing is before it. */
static PetscBool take_side(const SurfacePoint *p, const Part *mine, const SurfacePoint *q, const Part *theirs,
                           const PetscReal whole[2], Way *way)
{
  const PetscReal deepest = 0.5 * (p->size + q->size);
  PetscReal back[2] = {-whole[0], -whole[1]};
  Part near, far;
  const PetscBool turns = clear_front(theirs, q, whole, &way->theirs);
  if (!clear_front(mine, p, back, &near) && !turns) return PETSC_FALSE;
  beside(mine, p, &near);
  beside(theirs, q, &far);
  if (!near.n || !far.n) return PETSC_FALSE; /* so many points that some were left out */
  face_each_other(&near, &far, deepest, way->n);
  for (int i = 0; i < 2; ++i) back[i] = -way->n[i];
  (void)clear_front(theirs, q, way->n, &way->theirs);
  (void)clear_front(mine, p, back, &near);
  if (!near.n || !way->theirs.n) return PETSC_FALSE;
  face_each_other(&near, &way->theirs, deepest, way->n);
  return PETSC_TRUE;
}

/* What p meets that way, and how far its own surface is from there. */
static PetscBool meet_way(const SurfacePoint *p, const Part *mine, const Part *theirs, const PetscReal n[2],
                          SurfacePair *pair, PetscReal *gap)
{
  *pair = (SurfacePair){.normal = {n[0], n[1]}};
  if (is_behind(mine, p, n) || !choose(theirs, p, pair)) return PETSC_FALSE;
  *gap = pair->gap - contact_reach(p->F, pair->normal, p->first, p->corner, 2);
  return PETSC_TRUE;
}

PetscBool surface_meet(const Surface *a, const SurfacePoint *p, const Surface *b, PetscReal h, SurfacePair *pair)
{
  Part mine, theirs;
  Way way;
  SurfacePair other;
  PetscReal least, gap, farther;
  const SurfacePoint *q = nearest_of(b, p->x, 3 * h, &least);
  if (!q || least > h + p->reach + q->reach + p->size) return PETSC_FALSE;
  part_around(a, q->x, least + h, &mine);
  part_around(b, p->x, least + h, &theirs);
  const PetscReal scale = least > 0 ? 1 / least : 0; /* 0: one lies on the other, and any way will do */
  PetscReal n[2] = {scale > 0 ? scale * (p->x[0] - q->x[0]) : 1, scale * (p->x[1] - q->x[1])};
  for (int i = 0; i < 2; ++i) way.n[i] = n[i];
  face_each_other(&mine, &theirs, 0.5 * (p->size + q->size), n);
  PetscBool meets = meet_way(p, &mine, &theirs, n, pair, &gap);
  if (take_side(p, &mine, q, &theirs, n, &way) && meet_way(p, &mine, &way.theirs, way.n, &other, &farther))
    if (!meets || farther > PetscMin(gap, 0) - DEEPER * p->size) *pair = other, meets = PETSC_TRUE;
  if (!meets) return PETSC_FALSE;
  pair->cover = surface_cover(a, p, b, pair);
  return pair->cover > 0;
}
