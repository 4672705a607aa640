/* How much of its surface a material point turns to another body that stands before it: not that beyond where the other
 * one ends, so that an area of contact is that of both, whichever body comes first. */
#include "solve/contact/surface/surface_hull.h"

#define ROW 0.5     /* of a point's size: no farther behind, others stand in its row */
#define BESIDE 0.25 /* at least so far aside, and */
#define ASIDE 0.1   /* likewise, beside an edge */
#define NEXT 1.75   /* at most: a row that goes on. In a lattice that stands askew the next is 1.4 away */
#define LAYERS 1    /* of a point's size: so far behind a point of the other body still tells where that ends */
#define LOOKS 0.7   /* cosine between a surface and what it looks at */
#define MOST_CORNERS 24
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

/* Half of its part along a surface across n, as it knows it by the surface that it was given, or by its volume. */
static PetscReal half_of(const Surface *s, const SurfacePoint *p, const PetscReal n[3])
{
  const PetscReal face = PetscAbsReal(vector_dot(p->face, n)), all = PetscSqrtReal(vector_dot(p->face, p->face));
  if (face <= LOOKS * all) return 0.5 * p->own;
  return 0.5 * (s->dim == 2 ? face : PetscSqrtReal(face));
}

/* From a point to the side, edge or corner of its body that it was seeded beside, as that has gone since. */
static void to_corner(const SurfacePoint *p, PetscReal gone[3])
{
  for (int i = 0; i < 3; ++i) gone[i] = vector_dot(p->F + 3 * i, p->corner);
}

/* How far such an end along the surface is at least, m: of a part that a surface cuts only edges are known. */
static PetscReal aside_of(const SurfacePoint *p)
{
  return (vector_dot(p->face, p->face) > 0 ? ASIDE : BESIDE) * p->own;
}

/* From a point to the end of its body along u or against it (side 1 or -1): to the side of it that it was seeded
 * beside, as that has gone since; else half of its part. */
static PetscReal end_of(const Surface *s, const SurfacePoint *p, const PetscReal n[3], const PetscReal u[3], int side)
{
  const PetscReal all = PetscSqrtReal(vector_dot(p->face, p->face));
  PetscReal gone[3];
  to_corner(p, gone);
  const PetscReal aside = side * vector_dot(gone, u);
  if (aside > aside_of(p)) return aside;
  if (all > 0 && side * vector_dot(p->face, u) > LOOKS * all) return p->reach;
  return half_of(s, p, n);
}

/* In the plane the surface that a point was given says how long its stretch is; its end, if it stands beside one. */
static Stretch given_of(const Surface *s, const SurfacePoint *p, const PetscReal n[3], const PetscReal u[3])
{
  const PetscReal half = half_of(s, p, n), low = end_of(s, p, n, u, -1), high = end_of(s, p, n, u, 1);
  if (low != half) return (Stretch){.low = -low, .high = high == half ? 2 * half - low : high};
  return (Stretch){.low = high == half ? -half : high - 2 * half, .high = high};
}

/* Of a point among those of its body: half the way to the next ones of its row, or to the body's end. */
static Stretch own_of(const Surface *s, const SurfacePoint *p, const PetscReal n[3], const Tangents *t, PetscInt k)
{
  const PetscReal *u = t->along[k];
  PetscReal way[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL};
  if (s->dim == 2 && PetscAbsReal(vector_dot(p->face, n)) > 0) return given_of(s, p, n, u);
  SurfaceWalk walk = surface_walk(s, p->x, 2 * NEXT * p->size);
  for (const SurfacePoint *q; (q = surface_next(&walk));) {
    const PetscReal mean = 0.5 * (p->size + q->size), aside = offset(p, q, u), far = PetscAbsReal(aside);
    if (far < BESIDE * p->size || far > NEXT * mean || PetscAbsReal(offset(p, q, n)) > ROW * p->size) continue;
    if (in_row(p, q, t, k, ROW * p->size)) way[aside > 0] = PetscMin(way[aside > 0], far * 0.5 * p->size / mean);
  }
  return (Stretch){.low = -(way[0] < PETSC_MAX_REAL ? way[0] : end_of(s, p, n, u, -1)),
                   .high = way[1] < PETSC_MAX_REAL ? way[1] : end_of(s, p, n, u, 1)};
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
    all.low = PetscMin(all.low, aside - end_of(s, q, pair->normal, u, -1));
    all.high = PetscMax(all.high, aside + end_of(s, q, pair->normal, u, 1));
  }
  return all;
}

/* A polygon along a surface, around the place of a point. */
typedef struct {
  PetscInt n;
  PetscReal x[MOST_CORNERS][2];
} Polygon;

static PetscReal area_of(const Polygon *p)
{
  PetscReal sum = 0;
  for (PetscInt i = 0; i < p->n; ++i) {
    const PetscReal *a = p->x[i], *b = p->x[(i + 1) % p->n];
    sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return sum;
}

/* What of it is not beyond the line e . x = end. */
static void cut_off(Polygon *p, const PetscReal e[2], PetscReal end)
{
  Polygon left = {0};
  for (PetscInt i = 0; i < p->n; ++i) {
    const PetscReal *a = p->x[i], *b = p->x[(i + 1) % p->n];
    const PetscReal from = e[0] * a[0] + e[1] * a[1] - end, to = e[0] * b[0] + e[1] * b[1] - end;
    if (left.n + 2 > MOST_CORNERS) return;
    if (from <= 0) left.x[left.n][0] = a[0], left.x[left.n++][1] = a[1];
    if ((from <= 0) == (to <= 0)) continue;
    for (int k = 0; k < 2; ++k) left.x[left.n][k] = a[k] + from / (from - to) * (b[k] - a[k]);
    ++left.n;
  }
  *p = left;
}

/* The line at which the body of q ends beside it, as p sees it; PETSC_FALSE: it stands beside no end, or one elsewhere.
 */
static PetscBool end_beside(const SurfacePoint *p, const SurfacePoint *q, const Tangents *t, PetscReal e[2],
                            PetscReal *end)
{
  PetscReal gone[3], length = 0, at[2];
  to_corner(q, gone);
  for (int k = 0; k < 2; ++k) {
    e[k] = vector_dot(gone, t->along[k]);
    at[k] = offset(p, q, t->along[k]);
    length += PetscSqr(e[k]);
  }
  length = PetscSqrtReal(length);
  if (length <= aside_of(q)) return PETSC_FALSE;
  for (int k = 0; k < 2; ++k) e[k] /= length;
  *end = at[0] * e[0] + at[1] * e[1] + length;
  return (PetscBool)(PetscAbsReal(at[0] * e[1] - at[1] * e[0]) <= 0.5 * (p->size + q->size));
}

/* Does the other body go on beyond that line, before p? */
static PetscBool goes_on(const Surface *s, const SurfacePoint *p, const SurfacePair *pair, const Tangents *t,
                         const PetscReal e[2], PetscReal end)
{
  const SurfacePoint *front = pair->other;
  const PetscReal within = 2 * (p->size + front->size);
  SurfaceWalk walk = surface_walk(s, p->x, within);
  for (const SurfacePoint *q; (q = surface_next(&walk));) {
    const PetscReal at[2] = {offset(p, q, t->along[0]), offset(p, q, t->along[1])};
    if (PetscAbsReal(offset(front, q, pair->normal)) > LAYERS * front->size) continue;
    if (PetscAbsReal(at[0] * e[1] - at[1] * e[0]) > 0.5 * (p->size + q->size)) continue;
    if (at[0] * e[0] + at[1] * e[1] > end && at[0] * e[0] + at[1] * e[1] < within) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Edges of the other body run across its points as they like. */
static void cut_at_edges(const Surface *s, const SurfacePoint *p, const SurfacePair *pair, const Tangents *t,
                         Polygon *polygon)
{
  const SurfacePoint *front = pair->other;
  PetscReal e[2], end;
  SurfaceWalk walk = surface_walk(s, p->x, 2 * (p->size + front->size));
  for (const SurfacePoint *q; (q = surface_next(&walk));) {
    if (PetscAbsReal(offset(front, q, pair->normal)) > LAYERS * front->size) continue;
    if (end_beside(p, q, t, e, &end) && end < p->size && !goes_on(s, p, pair, t, e, end)) cut_off(polygon, e, end);
  }
}

/* In space: the share of a rectangle, as far as the own body goes on, that the other one is before. */
static PetscReal share_of(const SurfacePoint *p, const Surface *b, const SurfacePair *pair, const Tangents *t,
                          const Stretch mine[2], const Stretch theirs[2])
{
  Polygon own = {.n = 4}, both;
  PetscReal e[2], end;
  for (int k = 0; k < 4; ++k) {
    own.x[k][0] = k == 0 || k == 3 ? mine[0].low : mine[0].high;
    own.x[k][1] = k < 2 ? mine[1].low : mine[1].high;
  }
  if (end_beside(p, p, t, e, &end)) cut_off(&own, e, end);
  both = own;
  for (int k = 0; k < 2; ++k) {
    cut_off(&both, (PetscReal[]){k == 0, k == 1}, theirs[k].high);
    cut_off(&both, (PetscReal[]){-(k == 0), -(k == 1)}, -theirs[k].low);
  }
  cut_at_edges(b, p, pair, t, &both);
  return area_of(&own) > 0 ? area_of(&both) / area_of(&own) : 0;
}

PetscReal surface_cover(const Surface *a, const SurfacePoint *p, const Surface *b, const SurfacePair *pair)
{
  const Tangents t = tangents_of(a->dim, p, pair->normal);
  Stretch mine[2], theirs[2];
  for (PetscInt k = 0; k < t.n; ++k)
    mine[k] = own_of(a, p, pair->normal, &t, k), theirs[k] = other_of(b, p, pair, &t, k);
  const PetscReal both = PetscMin(mine[0].high, theirs[0].high) - PetscMax(mine[0].low, theirs[0].low);
  const PetscReal share =
    t.n == 1 ? PetscMax(0, both / (mine[0].high - mine[0].low)) : share_of(p, b, pair, &t, mine, theirs);
  return share > ALL ? 1 : share < NOTHING ? 0 : share;
}
