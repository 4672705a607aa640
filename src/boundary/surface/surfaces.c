/* The simple surfaces that bound a shape. */
#include "boundary/surface/surface.h"

typedef struct {
  PetscInt dim, n, capacity;
  Surface *list;
} Surfaces;

static PetscErrorCode Add(Surfaces *s, Surface surface)
{
  PetscFunctionBeginUser;
  if (s->n == s->capacity) {
    s->capacity = PetscMax(16, 2 * s->capacity);
    PetscCall(PetscRealloc((size_t)s->capacity * sizeof *s->list, &s->list));
  }
  if (surface.steepness == 0) surface.steepness = 1;
  s->list[s->n++] = surface;
  PetscFunctionReturn(0);
}

/* Nowhere else than anywhere. */
static Surface unbounded(SurfaceKind kind, PetscReal sign)
{
  Surface s = {.kind = kind, .sign = sign};
  for (int d = 0; d < 3; ++d) s.min[d] = -PETSC_MAX_REAL, s.max[d] = PETSC_MAX_REAL;
  return s;
}

static Surface plane(const PetscReal *point, const PetscReal *normal, PetscInt dim, PetscReal sign)
{
  Surface s = unbounded(SURFACE_PLANE, sign);
  PetscReal length = 0;
  for (PetscInt d = 0; d < dim; ++d) length += normal[d] * normal[d];
  length = PetscSqrtReal(length);
  for (PetscInt d = 0; d < dim; ++d) {
    s.point[d] = point[d];
    s.normal[d] = normal[d] / length;
  }
  return s;
}

static PetscErrorCode AddBox(Surfaces *s, const Shape *box, PetscReal sign)
{
  PetscFunctionBeginUser;
  for (PetscInt d = 0; d < s->dim; ++d)
    for (int high = 0; high < 2; ++high) {
      PetscReal normal[3] = {0, 0, 0};
      normal[d] = high ? 1 : -1;
      Surface side = plane(high ? box->max : box->min, normal, s->dim, sign);
      for (PetscInt e = 0; e < s->dim; ++e) {
        side.min[e] = e == d ? side.point[d] : box->min[e];
        side.max[e] = e == d ? side.point[d] : box->max[e];
      }
      PetscCall(Add(s, side));
    }
  PetscFunctionReturn(0);
}

/* Twice the area, positive if the corners go round counter-clockwise. */
static PetscReal turning(const Shape *polygon)
{
  PetscReal sum = 0;
  for (PetscInt i = 0, j = polygon->n_vertices - 1; i < polygon->n_vertices; j = i++) {
    const PetscReal *a = polygon->vertices + 2 * j, *b = polygon->vertices + 2 * i;
    sum += a[0] * b[1] - a[1] * b[0];
  }
  return sum;
}

static PetscErrorCode AddPolygon(Surfaces *s, const Shape *polygon, PetscReal sign)
{
  const PetscReal side = turning(polygon) > 0 ? 1 : -1;

  PetscFunctionBeginUser;
  for (PetscInt i = 0, j = polygon->n_vertices - 1; i < polygon->n_vertices; j = i++) {
    const PetscReal *a = polygon->vertices + 2 * j, *b = polygon->vertices + 2 * i;
    const PetscReal normal[2] = {side * (b[1] - a[1]), side * (a[0] - b[0])};
    if (normal[0] == 0 && normal[1] == 0) continue;
    Surface edge = plane(a, normal, 2, sign);
    for (int d = 0; d < 2; ++d) edge.min[d] = PetscMin(a[d], b[d]), edge.max[d] = PetscMax(a[d], b[d]);
    PetscCall(Add(s, edge));
  }
  PetscFunctionReturn(0);
}

/* Both ends of a cylinder or cone, and what is between them. */
static PetscErrorCode AddCone(Surfaces *s, const Shape *cone, PetscReal sign)
{
  Surface low = plane(cone->point, cone->normal, 3, -sign), high = low, round = low;

  PetscFunctionBeginUser;
  /* the lower end looks along -normal */
  for (int d = 0; d < 3; ++d) low.normal[d] = -low.normal[d], high.point[d] += cone->length * high.normal[d];
  low.sign = high.sign = round.sign = sign;
  round.kind = SURFACE_CONE;
  round.radius = cone->radii[0];
  round.slope = (cone->radii[1] - cone->radii[0]) / cone->length;
  PetscCall(Add(s, low));
  PetscCall(Add(s, high));
  PetscCall(Add(s, round));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddRelief(Surfaces *s, const Shape *shape, PetscReal sign)
{
  Surface surface = unbounded(SURFACE_RELIEF, sign);

  PetscFunctionBeginUser;
  surface.relief = shape->relief;
  surface.steepness = relief_steepness(shape->relief);
  PetscCall(Add(s, surface));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddShape(Surfaces *s, const Shape *shape, PetscReal sign)
{
  Surface ball;

  PetscFunctionBeginUser;
  switch (shape->kind) {
  case SHAPE_BOX: PetscCall(AddBox(s, shape, sign)); break;
  case SHAPE_BALL:
    ball = unbounded(SURFACE_BALL, sign);
    for (PetscInt d = 0; d < s->dim; ++d) ball.point[d] = shape->centre[d];
    ball.radius = shape->radius;
    PetscCall(Add(s, ball));
    break;
  case SHAPE_POLYGON: PetscCall(AddPolygon(s, shape, sign)); break;
  case SHAPE_HALF_SPACE: PetscCall(Add(s, plane(shape->point, shape->normal, s->dim, sign))); break;
  case SHAPE_CYLINDER:
  case SHAPE_CONE: PetscCall(AddCone(s, shape, sign)); break;
  case SHAPE_TERRAIN: PetscCall(AddRelief(s, shape, sign)); break;
  default:
    for (PetscInt i = 0; i < shape->n_children; ++i)
      PetscCall(AddShape(s, shape->children + i, shape->kind == SHAPE_DIFFERENCE && i ? -sign : sign));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SurfacesCreate(const Shape *shape, PetscInt dim, PetscInt *n, Surface **surfaces)
{
  Surfaces s = {.dim = dim};

  PetscFunctionBeginUser;
  PetscCall(AddShape(&s, shape, 1));
  *n = s.n;
  *surfaces = s.list;
  PetscFunctionReturn(0);
}

static PetscReal cone_distance(const Surface *s, const PetscReal *x, PetscReal *gradient)
{
  const PetscReal scale = 1 / PetscSqrtReal(1 + s->slope * s->slope);
  PetscReal along = 0, across[3], radius = 0;
  for (int d = 0; d < 3; ++d) along += (x[d] - s->point[d]) * s->normal[d];
  for (int d = 0; d < 3; ++d) {
    across[d] = x[d] - s->point[d] - along * s->normal[d];
    radius += across[d] * across[d];
  }
  radius = PetscSqrtReal(radius);
  for (int d = 0; d < 3; ++d) gradient[d] = scale * ((radius > 0 ? across[d] / radius : 0) - s->slope * s->normal[d]);
  return scale * (radius - s->radius - s->slope * along);
}

static PetscReal ball_distance(const Surface *s, PetscInt dim, const PetscReal *x, PetscReal *gradient)
{
  PetscReal radius = 0;
  for (PetscInt d = 0; d < dim; ++d) radius += PetscSqr(x[d] - s->point[d]);
  radius = PetscSqrtReal(radius);
  for (PetscInt d = 0; d < dim; ++d) gradient[d] = radius > 0 ? (x[d] - s->point[d]) / radius : 0;
  return radius - s->radius;
}

PetscReal surface_distance(const Surface *s, PetscInt dim, const PetscReal *x, PetscReal *gradient)
{
  PetscReal f = 0;
  for (int d = 0; d < 3; ++d) gradient[d] = 0;
  if (s->kind == SURFACE_BALL) f = ball_distance(s, dim, x, gradient);
  else if (s->kind == SURFACE_CONE) f = cone_distance(s, x, gradient);
  else if (s->kind == SURFACE_RELIEF) f = relief_distance(s->relief, x, gradient);
  else
    for (PetscInt d = 0; d < dim; ++d) {
      f += (x[d] - s->point[d]) * s->normal[d];
      gradient[d] = s->normal[d];
    }
  for (int d = 0; d < 3; ++d) gradient[d] *= s->sign;
  return s->sign * f;
}
