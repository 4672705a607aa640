/* Which part of a facet bounds the body and is selected. It is cut at all planes that bound the shape and at the ends
 * of ranges, so that its pieces have no straight edges any more; where a curved surface may be near they are halved. */
#include "boundary/surface/surface.h"

/* Parts of a facet that are looked at, at least: 2^n; and how small those are at most that an edge of the shape
 * crosses in another way than straight. */
static const PetscInt least[4] = {0, 0, 5, 6}, most[4] = {0, 0, 5, 24};
#define CROSSINGS 45
#define STRAIGHT 1e-3 /* of a part */

/* Is it there, and does it look the same way? */
static PetscBool is_on(const Surface *s, PetscInt dim, const PetscReal *x, const PetscReal *normal, PetscReal near)
{
  PetscReal gradient[3], along = 0;
  for (PetscInt d = 0; d < dim; ++d)
    if (x[d] < s->min[d] - near || x[d] > s->max[d] + near) return PETSC_FALSE;
  if (PetscAbsReal(surface_distance(s, dim, x, gradient)) > near) return PETSC_FALSE;
  for (PetscInt d = 0; d < dim; ++d) along += gradient[d] * normal[d];
  return (PetscBool)(along > 1 - 1e-6);
}

/* Does surface k bound the shape next to x? Of surfaces that lie upon each other the first one does. */
static PetscBool bounds(const Trim *t, const PetscReal *x)
{
  const BodySurface *b = t->body;
  const PetscInt dim = b->grid->dim;
  PetscReal normal[3], at[3] = {0, 0, 0}, in[3] = {0, 0, 0}, out[3] = {0, 0, 0};
  const PetscReal f = surface_distance(b->surfaces + t->k, dim, x, normal);
  for (PetscInt d = 0; d < dim; ++d) {
    at[d] = x[d] - f * normal[d];
    in[d] = at[d] - b->step * normal[d];
    out[d] = at[d] + b->step * normal[d];
  }
  if (!grid_takes(b->grid, b->on, at) || !is_on(b->surfaces + t->k, dim, at, normal, b->step)) return PETSC_FALSE;
  if (!shape_contains(b->shape, dim, in, 0) || shape_contains(b->shape, dim, out, 0)) return PETSC_FALSE;
  for (PetscInt j = 0; j < t->k; ++j)
    if (is_on(b->surfaces + j, dim, at, normal, b->step)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Does the shape go on beyond a side of the last cell? Without one the side is the surface. */
static PetscBool goes_on(const Trim *t, const PetscReal *x)
{
  const BodySurface *b = t->body;
  PetscReal in[3] = {0, 0, 0}, out[3] = {0, 0, 0};
  if (!b->shape) return grid_takes(b->grid, b->on, x);
  for (PetscInt d = 0; d < b->grid->dim; ++d) {
    in[d] = x[d] - b->slack * t->outward[d];
    out[d] = x[d] + b->slack * t->outward[d];
  }
  return (PetscBool)(grid_takes(b->grid, b->on, x) && shape_contains(b->shape, b->grid->dim, in, 0) &&
                     shape_contains(b->shape, b->grid->dim, out, 0));
}

static PetscBool takes(const Trim *t, const PetscReal *x) { return t->k < 0 ? goes_on(t, x) : bounds(t, x); }

static void add_point(const Trim *t, const PetscReal *x, const PetscReal *vector, PieceSum *sum)
{
  const PetscReal weight = kinematics_weight(t->body->kinematics, x[0]);
  PetscReal square = 0, r[3];
  for (int d = 0; d < 3; ++d) square += vector[d] * vector[d], r[d] = x[d] - sum->origin[d];
  const PetscReal area = weight * PetscSqrtReal(square);
  sum->area += area;
  for (int i = 0; i < 3; ++i) {
    sum->vector[i] += weight * vector[i];
    sum->first[i] += area * r[i];
    for (int j = 0; j < 3; ++j) {
      sum->second[i][j] += area * r[i] * r[j];
      sum->turn[i][j] += r[i] * weight * vector[j];
    }
  }
}

/* Area times normal of a facet. */
static void normal_of(PetscInt dim, Facet x, const PetscReal *outward, PetscReal *n)
{
  PetscReal u[3], v[3] = {0, 0, 1}, along = 0;
  for (int d = 0; d < 3; ++d) u[d] = x[1][d] - x[0][d];
  for (int d = 0; d < 3 && dim == 3; ++d) v[d] = 0.5 * (x[2][d] - x[0][d]);
  for (int d = 0; d < 3; ++d) n[d] = u[(d + 1) % 3] * v[(d + 2) % 3] - u[(d + 2) % 3] * v[(d + 1) % 3];
  for (int d = 0; d < 3; ++d) along += n[d] * outward[d];
  for (int d = 0; d < 3 && along < 0; ++d) n[d] = -n[d];
}

/* Moments up to the second ones, of a ring's radius times them too, are exact. */
static void add_facet(const Trim *t, Facet x, const PetscReal *outward, PieceSum *sum)
{
  const PetscInt dim = t->body->grid->dim;
  const PetscReal g = 0.5 - 0.5 / PetscSqrtReal(3);
  PetscReal n[3], at[3];
  normal_of(dim, x, outward, n);
  for (int d = 0; d < 3; ++d) n[d] /= (PetscReal)dim;
  for (PetscInt k = 0; k < dim; ++k) {
    for (int d = 0; d < 3; ++d)
      at[d] = dim == 2 ? (k ? g : 1 - g) * x[0][d] + (k ? 1 - g : g) * x[1][d]
                       : (x[0][d] + x[1][d] + x[2][d]) / 6 + 0.5 * x[k][d];
    add_point(t, at, n, sum);
  }
}

/* Where it ends between a, which is taken, and b. */
static void end_of(const Trim *t, const PetscReal *a, const PetscReal *b, PetscReal *at)
{
  PetscReal low = 0, high = 1;
  for (int k = 0; k < CROSSINGS; ++k) {
    const PetscReal middle = 0.5 * (low + high);
    for (int d = 0; d < 3; ++d) at[d] = (1 - middle) * a[d] + middle * b[d];
    if (takes(t, at)) low = middle;
    else high = middle;
  }
}

/* Of a triangle with one corner `at` taken, or all but that: does a straight line cut it? cut: where its ends are. */
static PetscBool cuts_straight(const Trim *t, Facet x, const PetscBool *in, PetscInt at, PetscReal cut[2][3])
{
  const PetscReal *a = x[(at + 1) % 3], *b = x[(at + 2) % 3];
  PetscReal here[3], there[3];
  end_of(t, in[at] ? x[at] : a, in[at] ? a : x[at], cut[0]);
  end_of(t, in[at] ? x[at] : b, in[at] ? b : x[at], cut[1]);
  for (int d = 0; d < 3; ++d) {
    const PetscReal middle = 0.5 * (cut[0][d] + cut[1][d]), far = 0.5 * (a[d] + b[d]);
    here[d] = middle + STRAIGHT * (x[at][d] - middle);
    there[d] = middle + STRAIGHT * (far - middle);
  }
  return (PetscBool)(takes(t, here) == in[at] && takes(t, there) != in[at]);
}

static void trim_segment(const Trim *t, Facet x, const PetscBool *in, const PetscReal *outward, PieceSum *sum)
{
  Facet part = {{0}};
  const PetscInt from = in[0] ? 0 : 1;
  for (int d = 0; d < 3; ++d) part[0][d] = x[from][d];
  end_of(t, x[from], x[1 - from], part[1]);
  add_facet(t, part, outward, sum);
}

/* What is taken of a triangle that a line cuts: the corner, or the rest, a quadrilateral. */
static void add_part(const Trim *t, Facet x, PetscBool corner, PetscInt at, PetscReal cut[2][3],
                     const PetscReal *outward, PieceSum *sum)
{
  Facet part;
  const PetscReal *a = x[(at + 1) % 3], *b = x[(at + 2) % 3];
  for (int d = 0; d < 3; ++d) {
    part[0][d] = corner ? x[at][d] : a[d];
    part[1][d] = cut[0][d];
    part[2][d] = cut[1][d];
  }
  add_facet(t, part, outward, sum);
  if (corner) return;
  for (int d = 0; d < 3; ++d) part[1][d] = b[d];
  add_facet(t, part, outward, sum);
}

static void trim(const Trim *t, Facet x, const PetscBool *in, const PetscReal *outward, PetscInt depth, PieceSum *sum);

/* Both halves, cut at the longest edge. */
static void halve(const Trim *t, Facet x, const PetscBool *in, const PetscReal *outward, PetscInt depth, PieceSum *sum)
{
  const PetscInt dim = t->body->grid->dim;
  PetscReal longest = 0, middle[3];
  PetscInt edge[2] = {0, 1};
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt j = i + 1; j < dim; ++j) {
      PetscReal square = 0;
      for (int d = 0; d < 3; ++d) square += PetscSqr(x[i][d] - x[j][d]);
      if (square > longest * (1 + 1e-9)) longest = square, edge[0] = i, edge[1] = j;
    }
  if (!(longest > 0)) return;
  for (int d = 0; d < 3; ++d) middle[d] = 0.5 * (x[edge[0]][d] + x[edge[1]][d]);
  const PetscBool taken = takes(t, middle);
  for (int k = 0; k < 2; ++k) {
    Facet part;
    PetscBool inside[3] = {in[0], in[1], dim == 3 ? in[2] : PETSC_FALSE};
    PetscCallVoid(PetscArraycpy(&part[0][0], &x[0][0], 9));
    for (int d = 0; d < 3; ++d) part[edge[k]][d] = middle[d];
    inside[edge[k]] = taken;
    trim(t, part, inside, outward, depth + 1, sum);
  }
}

/* in: which corners are taken. */
static void trim(const Trim *t, Facet x, const PetscBool *in, const PetscReal *outward, PetscInt depth, PieceSum *sum)
{
  const PetscInt dim = t->body->grid->dim;
  PetscInt n = 0, odd = 0;
  PetscReal cut[2][3];
  for (PetscInt i = 0; i < dim; ++i) n += in[i] ? 1 : 0;
  if (depth < least[dim]) {
    halve(t, x, in, outward, depth, sum);
    return;
  }
  if (n == 0) return;
  if (n == dim) add_facet(t, x, outward, sum);
  else if (dim == 2) trim_segment(t, x, in, outward, sum);
  else {
    while (in[odd] != (n == 1)) ++odd;
    if (cuts_straight(t, x, in, odd, cut) || depth == most[dim])
      add_part(t, x, (PetscBool)(n == 1), odd, cut, outward, sum);
    else halve(t, x, in, outward, depth, sum);
  }
}

/* Can a facet meet a surface? f: of its corners. */
static PetscBool meets(const Trim *t, const Surface *s, Facet x, PetscReal f[3])
{
  const PetscInt dim = t->body->grid->dim;
  PetscReal gradient[3], size = 0, nearest = PETSC_MAX_REAL;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal low = x[0][d], high = x[0][d];
    for (PetscInt i = 1; i < dim; ++i) low = PetscMin(low, x[i][d]), high = PetscMax(high, x[i][d]);
    if (low > s->max[d] + t->body->step || high < s->min[d] - t->body->step) return PETSC_FALSE;
    size += high - low;
  }
  for (PetscInt i = 0; i < dim; ++i) {
    f[i] = surface_distance(s, dim, x[i], gradient);
    nearest = PetscMin(nearest, PetscAbsReal(f[i]));
  }
  return (PetscBool)(nearest <= size * s->steepness);
}

/* What curved surfaces or shapes may bound is looked at part by part, all else has no edge in the facet any more. */
static void decide(const Trim *t, Facet x, const PetscReal *outward, PieceSum *sum)
{
  const BodySurface *b = t->body;
  const PetscInt dim = b->grid->dim;
  PetscBool in[3] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE}, open = b->on->has_shape;
  PetscReal middle[3] = {0, 0, 0}, f[3];
  for (PetscInt k = 0; k < b->n_surfaces && !open; ++k)
    open = (PetscBool)(k != t->k && b->surfaces[k].kind != SURFACE_PLANE && meets(t, b->surfaces + k, x, f));
  if (open) {
    const PetscBool small = (PetscBool)(t->k >= 0 && b->surfaces[t->k].kind != SURFACE_PLANE);
    for (PetscInt i = 0; i < dim; ++i) in[i] = takes(t, x[i]);
    trim(t, x, in, outward, small ? least[dim] : 0, sum);
    return;
  }
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt d = 0; d < dim; ++d) middle[d] += x[i][d] / (PetscReal)dim;
  if (takes(t, middle)) add_facet(t, x, outward, sum);
}

static void split(const Trim *t, Facet x, const PetscReal *outward, PetscInt k, PieceSum *sum);

/* Both sides of the plane at which f is 0 at the corners' values, one of which, `odd`, has its sign for itself. */
static void split_at(const Trim *t, Facet x, const PetscReal f[3], PetscInt odd, const PetscReal *outward, PetscInt k,
                     PieceSum *sum)
{
  const PetscInt dim = t->body->grid->dim, a = (odd + 1) % dim, b = (odd + dim - 1) % dim;
  Facet part[3];
  PetscReal cut[2][3] = {{0, 0, 0}, {0, 0, 0}};
  for (int d = 0; d < 3; ++d) {
    cut[0][d] = x[odd][d] + f[odd] / (f[odd] - f[a]) * (x[a][d] - x[odd][d]);
    cut[1][d] = x[odd][d] + f[odd] / (f[odd] - f[b]) * (x[b][d] - x[odd][d]);
    part[0][0][d] = x[odd][d], part[0][1][d] = cut[0][d], part[0][2][d] = cut[1][d];
    part[1][0][d] = x[a][d], part[1][1][d] = cut[0][d], part[1][2][d] = cut[1][d];
    part[2][0][d] = x[a][d], part[2][1][d] = x[b][d], part[2][2][d] = cut[1][d];
  }
  for (PetscInt i = 0; i < dim; ++i) split(t, part[i], outward, k, sum);
}

/* The k-th plane that may be an edge: of the shape, or of the ranges of the selector. PETSC_FALSE: it is far. */
static PetscBool edge_at(const Trim *t, PetscInt k, Facet x, PetscReal f[3])
{
  const BodySurface *b = t->body;
  const PetscInt range = k - b->n_surfaces, d = range / 2;
  if (range < 0)
    return (PetscBool)(k != t->k && b->surfaces[k].kind == SURFACE_PLANE && meets(t, b->surfaces + k, x, f));
  if (!b->on->has[d]) return PETSC_FALSE;
  for (PetscInt i = 0; i < b->grid->dim; ++i) f[i] = x[i][d] - (range % 2 ? b->on->max[d] : b->on->min[d]);
  return PETSC_TRUE;
}

/* Cuts a facet at the planes from the k-th on. */
static void split(const Trim *t, Facet x, const PetscReal *outward, PetscInt k, PieceSum *sum)
{
  const PetscInt dim = t->body->grid->dim, n = t->body->n_surfaces + 2 * dim;
  const PetscReal nothing = 1e-3 * t->body->step;
  PetscReal f[3] = {0, 0, 0};
  for (; k < n; ++k) {
    PetscInt above = 0, below = 0, odd = 0;
    if (!edge_at(t, k, x, f)) continue;
    for (PetscInt i = 0; i < dim; ++i) above += f[i] > nothing, below += f[i] < -nothing;
    if (!above || !below) continue;
    while (odd + 1 < dim && (above <= below ? !(f[odd] > nothing) : !(f[odd] < -nothing))) ++odd;
    split_at(t, x, f, odd, outward, k + 1, sum);
    return;
  }
  decide(t, x, outward, sum);
}

void surface_trim(const Trim *t, Facet facet, const PetscReal *outward, PieceSum *sum)
{
  split(t, facet, outward, 0, sum);
}
