#include "case/shape_volume.h"
#include <math.h>

enum { LINES = 4096, STEPS = 512, HALVINGS = 40 };

/* Area and first moment about x = 0 of a polygon. */
static PetscReal polygon_area(const Shape *shape, PetscReal *moment)
{
  PetscReal area = 0;
  *moment = 0;
  for (PetscInt i = 0; i < shape->n_vertices; ++i) {
    const PetscReal *a = shape->vertices + 2 * i, *b = shape->vertices + 2 * ((i + 1) % shape->n_vertices);
    const PetscReal cross = a[0] * b[1] - b[0] * a[1];
    area += 0.5 * cross;
    *moment += cross * (a[0] + b[0]) / 6;
  }
  *moment = area < 0 ? -*moment : *moment;
  return PetscAbsReal(area);
}

static PetscReal box_volume(const Shape *shape, PetscInt dim)
{
  PetscReal volume = 1;
  for (PetscInt d = 0; d < dim; ++d) volume *= shape->max[d] - shape->min[d];
  return volume;
}

/* Volume of a shape where it is easily known, else -1. */
static PetscReal plain_volume(const Shape *shape, PetscInt dim)
{
  PetscReal moment;
  switch (shape->kind) {
  case SHAPE_BOX: return box_volume(shape, dim);
  case SHAPE_BALL: return PETSC_PI * PetscSqr(shape->radius) * (dim == 3 ? 4.0 / 3.0 * shape->radius : 1);
  case SHAPE_POLYGON: return polygon_area(shape, &moment);
  default: return -1;
  }
}

/* The same of what turns about x = 0: by Pappus's rule 2 pi times the first moment. A shape that
 * crosses the axis counts for its part with x > 0. */
static PetscReal ring_volume(const Shape *shape)
{
  const PetscReal in = PetscMax(0, shape->min[0]), out = shape->max[0];
  const PetscReal centre = shape->centre[0], radius = shape->radius;
  PetscReal moment, min[3], max[3];
  shape_bounds(shape, 2, min, max);
  switch (shape->kind) {
  case SHAPE_BOX: return PETSC_PI * (out * out - in * in) * (max[1] - min[1]);
  case SHAPE_BALL:
    if (centre == 0) return 4.0 / 3.0 * PETSC_PI * radius * radius * radius;
    return centre >= radius ? 2 * PETSC_PI * centre * PETSC_PI * radius * radius : -1;
  case SHAPE_POLYGON: (void)polygon_area(shape, &moment); return min[0] >= 0 ? 2 * PETSC_PI * moment : -1;
  default: return -1;
  }
}

/* Where the surface is between a position inside and one outside, along axis d. */
static PetscReal crossing(const Shape *shape, PetscInt dim, const PetscReal *x, PetscReal inside, PetscReal outside)
{
  PetscReal at[3] = {x[0], x[1], x[2]};
  for (int k = 0; k < HALVINGS; ++k) {
    at[dim - 1] = 0.5 * (inside + outside);
    if (shape_contains(shape, dim, at, 0)) inside = at[dim - 1];
    else outside = at[dim - 1];
  }
  return 0.5 * (inside + outside);
}

/* How much of a line along the last axis lies in the shape, m. */
static PetscReal length_inside(const Shape *shape, PetscInt dim, PetscReal *x, PetscReal low, PetscReal high)
{
  PetscReal length = 0, last = low;
  x[dim - 1] = low;
  PetscBool inside = shape_contains(shape, dim, x, 0);
  for (int k = 1; k <= STEPS; ++k) {
    const PetscReal next = low + (high - low) * (PetscReal)k / STEPS;
    x[dim - 1] = next;
    const PetscBool now = shape_contains(shape, dim, x, 0);
    if (now && inside) length += next - last;
    else if (now) length += next - crossing(shape, dim, x, next, last);
    else if (inside) length += crossing(shape, dim, x, last, next) - last;
    inside = now;
    last = next;
  }
  return length;
}

/* Lines stand where no plane meets them in rows (points/seed/parts.c). */
static PetscReal volume_by_lines(const Shape *shape, const Kinematics *kinematics, const PetscReal *min,
                                 const PetscReal *max)
{
  const PetscInt dim = kinematics->dim;
  const PetscReal golden = dim == 2 ? 1.61803398874989484820 : 1.32471795724474602596;
  PetscReal low[3], high[3], sum = 0, across = 1;
  shape_bounds(shape, dim, low, high);
  for (PetscInt d = 0; d < dim; ++d) {
    low[d] = PetscMax(low[d], min[d]);
    high[d] = PetscMin(high[d], max[d]);
    if (high[d] <= low[d]) return 0;
    if (d < dim - 1) across *= high[d] - low[d];
  }
  for (int k = 0; k < LINES; ++k) {
    PetscReal x[3] = {0, 0, 0}, weight = across / LINES;
    for (PetscInt d = 0; d < dim - 1; ++d) {
      const PetscReal u = 0.5 + (PetscReal)k * PetscPowReal(golden, -(PetscReal)(d + 1));
      x[d] = low[d] + (high[d] - low[d]) * (u - floor(u));
    }
    if (kinematics->hoop) weight *= 2 * PETSC_PI * x[0];
    sum += weight * length_inside(shape, dim, x, low[dim - 1], high[dim - 1]);
  }
  return sum;
}

PetscReal shape_volume(const Shape *shape, const Kinematics *kinematics, const PetscReal *min, const PetscReal *max)
{
  const PetscReal known = kinematics->hoop ? ring_volume(shape) : plain_volume(shape, kinematics->dim);
  return known >= 0 ? known : volume_by_lines(shape, kinematics, min, max);
}
