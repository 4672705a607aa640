#include "solve/contact/surface/surface_hull.h"

#define MOST_SWEEPS 50
#define FLAT 1e-12
#define NO_TRIANGLE 1e-14 /* square of the sine between two edges of one that is none */
/* In which hulls that overlap are asked how far they are from being apart. */
#define WAYS_PLANE 32
#define WAYS_SPACE 128
#define APART 0.1 /* of a point's size: hulls that overlap are moved apart by so much more */

/* Corners of the difference of two hulls, of which the nearest place to the origin is made. */
typedef struct {
  PetscInt n;
  PetscReal at[4][3];
} Corners;

/* The point of the hull that is farthest along the unit vector d. */
static void farthest(const SurfacePart *part, const PetscReal d[3], PetscReal out[3])
{
  const SurfacePoint *best = part->point[0];
  PetscReal most = -PETSC_MAX_REAL;
  for (PetscInt k = 0; k < part->n; ++k) {
    const SurfacePoint *s = part->point[k];
    const PetscReal height = surface_dot(s->x, d) + s->reach - part->least;
    if (height > most) most = height, best = s;
  }
  const PetscReal wider = best->reach - part->least;
  for (int i = 0; i < 3; ++i) out[i] = best->x[i] + wider * d[i];
}

/* Of a, moved by `away`, less b: what is farthest back along n. */
static void corner_of(const SurfacePart *a, const SurfacePart *b, const PetscReal away[3], const PetscReal n[3],
                      PetscReal w[3])
{
  const PetscReal back[3] = {-n[0], -n[1], -n[2]};
  PetscReal here[3], there[3];
  farthest(a, back, here);
  farthest(b, n, there);
  for (int i = 0; i < 3; ++i) w[i] = here[i] + away[i] - there[i];
}

/* The place v nearest to the origin on what w and m other corners span; PETSC_FALSE: it is not between them. */
static PetscBool nearest_among(const PetscReal *w, PetscInt m, const PetscReal *const other[2], PetscReal v[3])
{
  PetscReal e[2][3], share[2] = {0, 0}, r[2] = {0, 0};
  for (PetscInt k = 0; k < m; ++k) {
    for (int i = 0; i < 3; ++i) e[k][i] = other[k][i] - w[i];
    r[k] = -surface_dot(w, e[k]);
  }
  if (m == 1) share[0] = r[0] / surface_dot(e[0], e[0]);
  if (m == 2) {
    const PetscReal a = surface_dot(e[0], e[0]), b = surface_dot(e[0], e[1]), c = surface_dot(e[1], e[1]);
    const PetscReal det = a * c - b * b;
    if (det <= NO_TRIANGLE * a * c) return PETSC_FALSE;
    share[0] = (c * r[0] - b * r[1]) / det;
    share[1] = (a * r[1] - b * r[0]) / det;
  }
  for (int i = 0; i < 3; ++i) v[i] = w[i];
  for (PetscInt k = 0; k < m; ++k) {
    if (!(share[k] > 0)) return PETSC_FALSE;
    for (int i = 0; i < 3; ++i) v[i] += share[k] * e[k][i];
  }
  return (PetscBool)(share[0] + share[1] < 1);
}

/* Of all that w, the last corner, and some of the others span the place v nearest to the origin; only the corners that
 * it takes stay. dim corners at most come, and go. Returns how far it is. */
static PetscReal keep_nearest(PetscInt dim, Corners *c, PetscReal v[3])
{
  const PetscInt n = c->n - 1;
  const PetscReal *w = c->at[n];
  PetscReal least = PETSC_MAX_REAL, best[3] = {0};
  PetscInt kept[2] = {0, 0}, n_kept = 0;
  for (PetscInt i = -1; i < n; ++i)
    for (PetscInt j = -1; j < i || j < 0; ++j) {
      const PetscReal *const other[2] = {i < 0 ? w : c->at[i], j < 0 ? w : c->at[j]};
      const PetscInt m = (i >= 0) + (j >= 0);
      PetscReal now[3];
      if (m < dim && nearest_among(w, m, other, now) && surface_dot(now, now) < least) {
        least = surface_dot(now, now), n_kept = m, kept[0] = i, kept[1] = j;
        for (int d = 0; d < 3; ++d) best[d] = now[d];
      }
    }
  Corners left = {.n = n_kept + 1};
  for (int d = 0; d < 3; ++d) {
    for (PetscInt k = 0; k < n_kept; ++k) left.at[k][d] = c->at[kept[k]][d];
    left.at[n_kept][d] = w[d];
    v[d] = best[d];
  }
  *c = left;
  return PetscSqrtReal(least);
}

/* Of dim + 1 corners: twice an area, six times a volume. */
static PetscReal content(PetscInt dim, PetscReal at[4][3])
{
  PetscReal e[3][3], across[3];
  for (PetscInt k = 0; k < dim; ++k)
    for (int d = 0; d < 3; ++d) e[k][d] = at[k + 1][d] - at[0][d];
  surface_cross(e[0], e[1], across);
  return dim == 2 ? across[2] : surface_dot(across, e[2]);
}

/* Is the origin on the same side of each face as the corner that is not on it? */
static PetscBool holds_origin(PetscInt dim, const Corners *c)
{
  Corners part = *c;
  const PetscBool left = (PetscBool)(content(dim, part.at) > 0);
  for (PetscInt k = 0; k <= dim; ++k) {
    part = *c;
    for (int d = 0; d < 3; ++d) part.at[k][d] = 0;
    const PetscReal now = content(dim, part.at);
    if (now == 0 || (now > 0) != left) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The way from b to a, moved by `away`, unit, by the algorithm of Gilbert, Johnson and Keerthi; PETSC_FALSE where they
 * overlap. n comes with a first guess. */
static PetscBool separate(const SurfacePart *a, const SurfacePart *b, const PetscReal away[3], PetscReal n[3])
{
  const PetscInt dim = a->dim;
  PetscReal length = PETSC_MAX_REAL;
  Corners c = {0};
  for (int sweep = 0; sweep < MOST_SWEEPS; ++sweep) {
    PetscReal *w = c.at[c.n], v[3];
    corner_of(a, b, away, n, w);
    if (c.n && length - surface_dot(w, n) <= FLAT * length) break;
    ++c.n;
    if (c.n == dim + 1 && holds_origin(dim, &c)) return PETSC_FALSE;
    const PetscReal now = keep_nearest(dim, &c, v);
    if (now >= length) break;
    if (now == 0) return PETSC_FALSE;
    length = now;
    for (int i = 0; i < 3; ++i) n[i] = v[i] / length;
  }
  return PETSC_TRUE;
}

/* How far a has to go along n to be out of b, m. */
static PetscReal overlap(const SurfacePart *a, const SurfacePart *b, const PetscReal n[3])
{
  static const PetscReal stays[3] = {0, 0, 0};
  PetscReal w[3];
  corner_of(a, b, stays, n, w);
  return -surface_dot(w, n);
}

/* The k-th of so many ways all round. */
static void way_round(PetscInt dim, PetscInt k, PetscInt many, PetscReal n[3])
{
  const PetscReal height = dim == 2 ? 0 : 1 - (2 * (PetscReal)k + 1) / (PetscReal)many;
  const PetscReal wide = PetscSqrtReal(1 - height * height);
  const PetscReal turn = dim == 2 ? 2 * PETSC_PI / (PetscReal)many : PETSC_PI * (3 - PetscSqrtReal(5));
  n[0] = wide * PetscCosReal((PetscReal)k * turn);
  n[1] = wide * PetscSinReal((PetscReal)k * turn);
  n[2] = height;
}

/* The shortest way out for hulls that overlap, and how long it is. Some ways are looked at all round; from the best one
 * it goes down: moved along n until they are apart, hulls are that far apart along a way on which no more is needed. */
static PetscReal escape(const SurfacePart *a, const SurfacePart *b, PetscReal n[3])
{
  const PetscInt many = a->dim == 2 ? WAYS_PLANE : WAYS_SPACE;
  PetscReal least = PETSC_MAX_REAL, way[3];
  for (PetscInt k = 0; k < many; ++k) {
    way_round(a->dim, k, many, way);
    const PetscReal far = overlap(a, b, way);
    if (far >= least) continue;
    least = far;
    for (int i = 0; i < 3; ++i) n[i] = way[i];
  }
  for (int sweep = 0; sweep < MOST_SWEEPS; ++sweep) {
    const PetscReal far = least + APART * a->point[0]->size, away[3] = {far * n[0], far * n[1], far * n[2]};
    for (int i = 0; i < 3; ++i) way[i] = n[i];
    if (!separate(a, b, away, way)) break;
    const PetscReal now = overlap(a, b, way);
    if (now >= least) break;
    least = now;
    for (int i = 0; i < 3; ++i) n[i] = way[i];
  }
  return least;
}

void surface_face(const SurfacePart *a, const SurfacePart *b, PetscReal deepest, PetscReal n[3])
{
  static const PetscReal stays[3] = {0, 0, 0};
  const PetscReal first[3] = {n[0], n[1], n[2]};
  if (separate(a, b, stays, n) || escape(a, b, n) <= deepest) return;
  for (int i = 0; i < 3; ++i) n[i] = first[i];
}
