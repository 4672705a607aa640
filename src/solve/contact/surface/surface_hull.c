/* The way between the convex hulls of two parts: where they are apart the shortest, by the algorithm of Gilbert,
 * Johnson and Keerthi; where they overlap the shortest that takes them apart. */
#include "solve/contact/surface/surface_hull.h"

#define MOST_SWEEPS 100
#define FLAT 1e-12
#define SAME 1e-14  /* of a length: round-off */
#define TOUCH 1e-14 /* of where a corner is: hulls so near each other overlap */
#define THIN 1e-10  /* square of the sine between sides of a triangle that is none */
#define WAYS 32     /* in which hulls that overlap are asked how far they are from being apart; */
#define WAYS_SPACE 128
#define MARGIN 0.1 /* of that distance: so much farther apart they are looked at again */

/* Corners of the difference of two hulls that the place nearest to the origin lies between. */
typedef struct {
  PetscInt n;
  PetscReal corner[3][3];
} Simplex;

/* The point of the hull that is farthest along the unit vector d; the part holds some. */
static void farthest(const Part *part, const PetscReal d[3], PetscReal out[3])
{
  const SurfacePoint *best = part->point[0];
  PetscReal most = -PETSC_MAX_REAL;
  for (PetscInt k = 0; k < part->n; ++k) {
    const SurfacePoint *s = part->point[k];
    const PetscReal height = vector_dot(s->x, d) + vector_dot(s->shift, d) + s->reach - part->least;
    if (height > most) most = height, best = s;
  }
  const PetscReal wider = best->reach - part->least;
  for (int i = 0; i < 3; ++i) out[i] = best->x[i] + best->shift[i] + wider * d[i];
}

/* Corner of a - b that is farthest against n. */
static void corner_against(const Part *a, const Part *b, const PetscReal n[3], PetscReal w[3])
{
  const PetscReal back[3] = {-n[0], -n[1], -n[2]};
  PetscReal here[3], there[3];
  farthest(a, back, here);
  farthest(b, n, there);
  for (int i = 0; i < 3; ++i) w[i] = here[i] - there[i];
}

/* The unit vector along v away from the origin, as seen from w, and how far w is along it. */
static PetscReal look_along(const PetscReal v[3], const PetscReal w[3], PetscReal n[3])
{
  const PetscReal length = PetscSqrtReal(vector_dot(v, v)), scale = (vector_dot(v, w) < 0 ? -1 : 1) / length;
  if (length == 0) return 0;
  for (int i = 0; i < 3; ++i) n[i] = scale * v[i];
  return vector_dot(n, w);
}

/* Nearest place to the origin on the way from w to another corner; PETSC_FALSE: it is an end. */
static PetscBool on_way(PetscInt dim, const PetscReal w[3], const PetscReal *a, PetscReal v[3])
{
  const PetscReal e[3] = {a[0] - w[0], a[1] - w[1], a[2] - w[2]}, square = vector_dot(e, e), t = -vector_dot(w, e);
  if (t <= 0 || t >= square) return PETSC_FALSE;
  for (int i = 0; i < 3; ++i) v[i] = w[i] + t / square * e[i];
  if (dim == 2) v[0] = -e[1], v[1] = e[0]; /* whatever the distance is, that is exact */
  return PETSC_TRUE;
}

/* Likewise on a triangle: v is across it. PETSC_FALSE: it is on a side. */
static PetscBool on_triangle(const PetscReal w[3], const PetscReal *const other[2], PetscReal v[3])
{
  PetscReal e[2][3];
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 3; ++i) e[k][i] = other[k][i] - w[i];
  vector_cross(e[0], e[1], v);
  const PetscReal a = vector_dot(e[0], e[0]), b = vector_dot(e[0], e[1]), c = vector_dot(e[1], e[1]),
                  square = vector_dot(v, v);
  const PetscReal p = -vector_dot(w, e[0]), q = -vector_dot(w, e[1]), s = c * p - b * q, t = a * q - b * p;
  return (PetscBool)(square > THIN * a * c && s > 0 && t > 0 && s + t < square);
}

/* The place nearest to the origin between w and some of the corners, in its direction n; what it lies between is kept.
 * Of those as near it is the one between most corners: its direction is exact. Returns its distance. */
static PetscReal nearest_between(PetscInt dim, const PetscReal w[3], Simplex *s, PetscReal n[3])
{
  PetscReal least = PETSC_MAX_REAL;
  Simplex best = {.n = 0};
  for (int mask = 0; mask < 1 << s->n; ++mask) {
    const PetscReal *other[3];
    PetscReal v[3] = {w[0], w[1], w[2]}, u[3] = {0, 0, 0};
    PetscInt m = 0;
    for (PetscInt k = 0; k < s->n; ++k)
      if (mask >> k & 1) other[m++] = s->corner[k];
    if (m >= dim || (m == 1 && !on_way(dim, w, other[0], v)) || (m == 2 && !on_triangle(w, other, v))) continue;
    const PetscReal length = look_along(v, w, u);
    if (mask && length >= (m >= best.n ? 1 + SAME : 1 - SAME) * least) continue;
    least = length;
    best.n = m + 1;
    for (int i = 0; i < 3; ++i) n[i] = u[i], best.corner[m][i] = w[i];
    for (PetscInt k = 0; k < m; ++k)
      for (int i = 0; i < 3; ++i) best.corner[k][i] = other[k][i];
  }
  *s = best;
  return least;
}

/* Does the simplex of dim corners and w hold the origin? It does where that lies on the same side of all faces. */
static PetscBool holds_origin(PetscInt dim, const Simplex *s, const PetscReal w[3])
{
  int left = 0;
  for (PetscInt k = 0; k <= dim; ++k) {
    const PetscReal *face[3] = {w, w, w};
    PetscReal across[3];
    PetscInt m = 0;
    for (PetscInt j = 0; j <= dim; ++j)
      if (j != k) face[m++] = j < dim ? s->corner[j] : w;
    vector_cross(face[0], face[1], across);
    const PetscReal turn = dim == 2 ? across[2] : vector_dot(across, face[2]);
    left += (k % 2 ? -turn : turn) > 0 ? 1 : -1;
  }
  return (PetscBool)(left == dim + 1 || left == -dim - 1);
}

/* The way from b to a, which is moved, unit, by the algorithm of Gilbert, Johnson and Keerthi; PETSC_FALSE where they
 * overlap. n comes with a first guess. */
static PetscBool separate(const Part *a, const PetscReal moved[3], const Part *b, PetscReal n[3])
{
  Simplex s = {.n = 0};
  PetscReal length = PETSC_MAX_REAL, height = 0;
  for (int sweep = 0; sweep < MOST_SWEEPS; ++sweep) {
    PetscReal w[3], way[3] = {0, 0, 0};
    corner_against(a, b, n, w);
    for (int i = 0; i < 3; ++i) w[i] += moved[i];
    height = vector_dot(w, n);
    if (s.n && length - height <= FLAT * length) break;
    if (s.n == a->dim && height <= 0 && holds_origin(a->dim, &s, w)) return PETSC_FALSE;
    const PetscInt corners = s.n;
    const PetscReal now = nearest_between(a->dim, w, &s, way);
    if (now <= TOUCH * PetscSqrtReal(vector_dot(w, w))) return PETSC_FALSE;
    if (now >= (s.n > corners ? 1 + SAME : 1 - SAME) * length) break;
    length = now;
    for (int i = 0; i < 3; ++i) n[i] = way[i];
  }
  return (PetscBool)(height > 0);
}

/* How far a has to go along n to be out of b, m. */
static PetscReal overlap(const Part *a, const Part *b, const PetscReal n[3])
{
  PetscReal w[3];
  corner_against(a, b, n, w);
  return -vector_dot(w, n);
}

/* Way k of so many, well spread: in space a spiral over the ball, by the golden angle. */
static void way_of(PetscInt dim, int k, int ways, PetscReal n[3])
{
  const PetscReal golden = PETSC_PI * (3 - PetscSqrtReal(5)), turn = dim == 2 ? 2 * PETSC_PI / ways : golden;
  const PetscReal z = dim == 2 ? 0 : 1 - (2 * k + 1) / (PetscReal)ways, r = PetscSqrtReal(1 - z * z);
  n[0] = r * PetscCosReal(k * turn);
  n[1] = r * PetscSinReal(k * turn);
  n[2] = z;
}

/* The shortest way out for hulls that overlap, and how long it is: across a side of their difference. Some ways are
 * looked at all round, and from the best it goes down: taken apart along n, and a margin, the hulls are nearest along
 * a way that takes them apart sooner, unless n is across a side. */
static PetscReal escape(const Part *a, const Part *b, PetscReal n[3])
{
  const int ways = a->dim == 2 ? WAYS : WAYS_SPACE;
  PetscReal least = PETSC_MAX_REAL, way[3], moved[3], far;
  for (int k = 0; k < ways; ++k) {
    way_of(a->dim, k, ways, way);
    far = overlap(a, b, way);
    if (far >= least) continue;
    least = far;
    for (int i = 0; i < 3; ++i) n[i] = way[i];
  }
  for (int sweep = 0; sweep < MOST_SWEEPS; ++sweep) {
    const PetscReal before = least;
    for (int i = 0; i < 3; ++i) way[i] = n[i], moved[i] = (least + MARGIN * PetscMax(least, a->least)) * n[i];
    if (!separate(a, moved, b, way)) break;
    far = overlap(a, b, way);
    if (far > (1 + SAME) * least) break;
    least = far;
    for (int i = 0; i < 3; ++i) n[i] = way[i];
    if (far > (1 - FLAT) * before) break;
  }
  return least;
}

void hull_face(const Part *a, const Part *b, PetscReal deepest, PetscReal n[3])
{
  const PetscReal first[3] = {n[0], n[1], n[2]}, still[3] = {0, 0, 0};
  if (separate(a, still, b, n) || escape(a, b, n) <= deepest) return;
  for (int i = 0; i < 3; ++i) n[i] = first[i];
}
