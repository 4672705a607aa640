#include "case/case.h"
#include "case/terrain/relief.h"
#include "case/shape_corners.h"

static PetscBool box_contains(const Shape *s, PetscInt dim, const PetscReal *x, PetscReal tolerance)
{
  for (PetscInt d = 0; d < dim; ++d)
    if (x[d] < s->min[d] - tolerance || x[d] > s->max[d] + tolerance) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscBool ball_contains(const Shape *s, PetscInt dim, const PetscReal *x, PetscReal tolerance)
{
  PetscReal square = 0;
  for (PetscInt d = 0; d < dim; ++d) square += (x[d] - s->centre[d]) * (x[d] - s->centre[d]);
  return PetscSqrtReal(square) <= s->radius + tolerance;
}

static PetscBool half_space_contains(const Shape *s, PetscInt dim, const PetscReal *x, PetscReal tolerance)
{
  PetscReal along = 0, length = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    along += (x[d] - s->point[d]) * s->normal[d];
    length += s->normal[d] * s->normal[d];
  }
  return along <= tolerance * PetscSqrtReal(length);
}

static PetscReal distance_to_segment(const PetscReal *a, const PetscReal *b, const PetscReal *x)
{
  const PetscReal e[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {x[0] - a[0], x[1] - a[1]};
  const PetscReal square = e[0] * e[0] + e[1] * e[1];
  const PetscReal raw = square > 0 ? (v[0] * e[0] + v[1] * e[1]) / square : 0;
  const PetscReal s = PetscMax(0, PetscMin(1, raw));
  return PetscSqrtReal(PetscSqr(v[0] - s * e[0]) + PetscSqr(v[1] - s * e[1]));
}

/* Even-odd rule; a position on an edge belongs to the polygon, or not if the tolerance is
 * negative. */
static PetscBool polygon_contains(const Shape *s, const PetscReal *x, PetscReal tolerance)
{
  PetscBool inside = PETSC_FALSE;
  for (PetscInt i = 0, j = s->n_vertices - 1; i < s->n_vertices; j = i++) {
    const PetscReal *a = s->vertices + 2 * i, *b = s->vertices + 2 * j;
    if (distance_to_segment(a, b, x) <= PetscAbsReal(tolerance)) return tolerance >= 0;
    if ((a[1] > x[1]) != (b[1] > x[1]) && x[0] < (b[0] - a[0]) * (x[1] - a[1]) / (b[1] - a[1]) + a[0]) inside = !inside;
  }
  return inside;
}

/* Height along the axis and distance from it. */
static void about_axis(const Shape *s, const PetscReal *x, PetscReal *height, PetscReal *radius)
{
  PetscReal along = 0, square = 0, norm = 0;
  for (PetscInt d = 0; d < 3; ++d) norm += s->normal[d] * s->normal[d];
  norm = PetscSqrtReal(norm);
  for (PetscInt d = 0; d < 3; ++d) along += (x[d] - s->point[d]) * s->normal[d] / norm;
  for (PetscInt d = 0; d < 3; ++d) square += PetscSqr(x[d] - s->point[d] - along * s->normal[d] / norm);
  *height = along;
  *radius = PetscSqrtReal(square);
}

static PetscBool cone_contains(const Shape *s, const PetscReal *x, PetscReal tolerance)
{
  const PetscReal slope = (s->radii[1] - s->radii[0]) / s->length;
  PetscReal height, radius;
  about_axis(s, x, &height, &radius);
  return height >= -tolerance && height <= s->length + tolerance &&
         radius - s->radii[0] - slope * height <= tolerance * PetscSqrtReal(1 + slope * slope);
}

static PetscBool children_contain(const Shape *s, PetscInt dim, const PetscReal *x, PetscReal tolerance)
{
  PetscInt hits = 0;
  if (s->kind == SHAPE_DIFFERENCE) {
    if (!shape_contains(&s->children[0], dim, x, tolerance)) return PETSC_FALSE;
    /* What is cut away gives its surface back to the rest. */
    for (PetscInt i = 1; i < s->n_children; ++i)
      if (shape_contains(&s->children[i], dim, x, -tolerance)) return PETSC_FALSE;
    return PETSC_TRUE;
  }
  for (PetscInt i = 0; i < s->n_children; ++i) hits += shape_contains(&s->children[i], dim, x, tolerance) ? 1 : 0;
  return s->kind == SHAPE_UNION ? (hits > 0) : (hits == s->n_children);
}

PetscBool shape_contains(const Shape *s, PetscInt dim, const PetscReal *x, PetscReal tolerance)
{
  switch (s->kind) {
  case SHAPE_BOX: return box_contains(s, dim, x, tolerance);
  case SHAPE_BALL: return ball_contains(s, dim, x, tolerance);
  case SHAPE_POLYGON: return polygon_contains(s, x, tolerance);
  case SHAPE_HALF_SPACE: return half_space_contains(s, dim, x, tolerance);
  case SHAPE_CYLINDER:
  case SHAPE_CONE: return cone_contains(s, x, tolerance);
  case SHAPE_TERRAIN: return relief_contains(s->relief, x, tolerance);
  case SHAPE_UNION:
  case SHAPE_DIFFERENCE:
  case SHAPE_INTERSECTION: return children_contain(s, dim, x, tolerance);
  default: return PETSC_FALSE;
  }
}

PetscBool shape_is_solid(const Shape *s)
{
  return s->kind != SHAPE_LINE && s->kind != SHAPE_ARC && s->kind != SHAPE_DISK && !s->open;
}

PetscReal shape_depth(const Shape *s, PetscInt dim, const PetscReal *x, PetscReal most)
{
  PetscReal low = 0, high = most;
  if (!shape_contains(s, dim, x, 0)) return 0;
  if (shape_contains(s, dim, x, -most)) return most;
  for (int k = 0; k < 40; ++k) {
    const PetscReal middle = 0.5 * (low + high);
    if (shape_contains(s, dim, x, -middle)) low = middle;
    else high = middle;
  }
  return low;
}

static void half_space_bounds(const Shape *s, PetscInt dim, PetscReal min[3], PetscReal max[3])
{
  for (PetscInt d = 0; d < dim; ++d) {
    PetscBool aligned = s->normal[d] != 0;
    for (PetscInt e = 0; e < dim; ++e)
      if (e != d && s->normal[e] != 0) aligned = PETSC_FALSE;
    if (aligned && s->normal[d] > 0) max[d] = s->point[d];
    if (aligned && s->normal[d] < 0) min[d] = s->point[d];
  }
}

static void children_bounds(const Shape *s, PetscInt dim, PetscReal min[3], PetscReal max[3])
{
  const PetscInt n = s->kind == SHAPE_DIFFERENCE ? 1 : s->n_children;
  for (PetscInt i = 0; i < n; ++i) {
    PetscReal low[3], high[3];
    shape_bounds(&s->children[i], dim, low, high);
    for (PetscInt d = 0; d < dim; ++d) {
      const PetscBool narrow = s->kind == SHAPE_INTERSECTION;
      min[d] = i == 0 ? low[d] : narrow ? PetscMax(min[d], low[d]) : PetscMin(min[d], low[d]);
      max[d] = i == 0 ? high[d] : narrow ? PetscMin(max[d], high[d]) : PetscMax(max[d], high[d]);
    }
  }
}

/* What lies on terrain lies no lower than that does there; below its bottom terrain takes nothing away, but other
 * terrain ends as far below, where there is nothing meant. */
static void raise_to_terrain(const Shape *s, PetscReal min[3], const PetscReal max[3])
{
  for (PetscInt i = 1; i < s->n_children; ++i) {
    const Shape *ground = s->children + i;
    if (ground->kind != SHAPE_TERRAIN) continue;
    if (s->children[0].kind == SHAPE_TERRAIN || min[2] >= ground->relief->bottom)
      min[2] = PetscMax(min[2], relief_lowest(ground->relief, min, max));
  }
}

/* How high a shape is in the ground plan of a box, where terrain bounds it; a mountain elsewhere does not count. */
static PetscReal top_within(const Shape *s, const PetscReal min[3], const PetscReal max[3])
{
  const PetscBool least = s->kind == SHAPE_INTERSECTION;
  const PetscInt n = s->kind == SHAPE_DIFFERENCE ? 1 : s->n_children;
  PetscReal top = least ? PETSC_MAX_REAL : -PETSC_MAX_REAL;
  if (s->kind == SHAPE_TERRAIN) return relief_highest(s->relief, min, max);
  if (!n) return PETSC_MAX_REAL;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal child = top_within(s->children + i, min, max);
    top = least ? PetscMin(top, child) : PetscMax(top, child);
  }
  return top;
}

static void lower_to_terrain(const Shape *s, PetscReal min[3], PetscReal max[3])
{
  const PetscReal top = top_within(s, min, max);
  if (top > min[2]) max[2] = PetscMin(max[2], top); /* else there is nothing, and its place tells more */
}

static void polygon_bounds(const Shape *s, PetscReal min[3], PetscReal max[3])
{
  for (PetscInt d = 0; d < 2; ++d) {
    min[d] = PETSC_MAX_REAL;
    max[d] = -PETSC_MAX_REAL;
    for (PetscInt i = 0; i < s->n_vertices; ++i) {
      min[d] = PetscMin(min[d], s->vertices[2 * i + d]);
      max[d] = PetscMax(max[d], s->vertices[2 * i + d]);
    }
  }
}

/* A disk of radius r reaches r sqrt(1 - n_d^2) along axis d. */
static void cone_bounds(const Shape *s, PetscReal min[3], PetscReal max[3])
{
  PetscReal norm = 0;
  for (PetscInt d = 0; d < 3; ++d) norm += s->normal[d] * s->normal[d];
  for (PetscInt d = 0; d < 3; ++d) {
    const PetscReal n = s->normal[d] / PetscSqrtReal(norm), reach = PetscSqrtReal(PetscMax(0, 1 - n * n));
    const PetscReal end = s->point[d] + n * s->length;
    min[d] = PetscMin(s->point[d] - s->radii[0] * reach, end - s->radii[1] * reach);
    max[d] = PetscMax(s->point[d] + s->radii[0] * reach, end + s->radii[1] * reach);
  }
}

void shape_bounds(const Shape *s, PetscInt dim, PetscReal min[3], PetscReal max[3])
{
  for (PetscInt d = 0; d < 3; ++d) {
    min[d] = d < dim ? -PETSC_MAX_REAL : 0;
    max[d] = d < dim ? PETSC_MAX_REAL : 0;
  }
  switch (s->kind) {
  case SHAPE_BOX:
    for (PetscInt d = 0; d < dim; ++d) {
      min[d] = s->min[d];
      max[d] = s->max[d];
    }
    break;
  case SHAPE_BALL:
    for (PetscInt d = 0; d < dim; ++d) {
      min[d] = s->centre[d] - s->radius;
      max[d] = s->centre[d] + s->radius;
    }
    break;
  case SHAPE_POLYGON: polygon_bounds(s, min, max); break;
  case SHAPE_HALF_SPACE: half_space_bounds(s, dim, min, max); break;
  case SHAPE_CYLINDER:
  case SHAPE_CONE: cone_bounds(s, min, max); break;
  case SHAPE_TERRAIN: relief_bounds(s->relief, min, max); break;
  case SHAPE_UNION:
  case SHAPE_DIFFERENCE:
  case SHAPE_INTERSECTION:
    children_bounds(s, dim, min, max);
    if (s->kind == SHAPE_DIFFERENCE) raise_to_terrain(s, min, max);
    if (s->kind == SHAPE_INTERSECTION) corner_bounds(s, dim, min, max);
    if (s->kind == SHAPE_INTERSECTION && dim == 3) lower_to_terrain(s, min, max);
    break;
  default: break; /* of walls alone */
  }
}
