#include "wall/check.h"
#include <math.h>

/* --- lines that cross themselves --- */
static PetscReal turn_of(const PetscReal *a, const PetscReal *b, const PetscReal *c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static PetscBool cross(const PetscReal *a, const PetscReal *b, const PetscReal *c, const PetscReal *d)
{
  return turn_of(a, b, c) * turn_of(a, b, d) < 0 && turn_of(c, d, a) * turn_of(c, d, b) < 0;
}

static void check_crossing(const Shape *s, PetscBool closed, const char *path, Diag *diag)
{
  const PetscInt n = s->n_vertices, edges = closed ? n : n - 1;
  for (PetscInt i = 0; i < edges; ++i)
    for (PetscInt j = i + 2; j < edges; ++j) {
      const PetscReal *v = s->vertices;
      if (!cross(v + 2 * i, v + 2 * ((i + 1) % n), v + 2 * j, v + 2 * ((j + 1) % n))) continue;
      diag_error(diag, path,
                 "%s crosses itself: its edges from corner %" PetscInt_FMT " and from corner %" PetscInt_FMT
                 " (counted from 1) meet",
                 closed ? "the polygon" : "the line", i + 1, j + 1);
      return;
    }
}

static void check_length(const Shape *s, const char *path, Diag *diag)
{
  for (PetscInt i = 1; i < s->n_vertices; ++i)
    for (int d = 0; d < 2; ++d)
      if (s->vertices[2 * i + d] != s->vertices[d]) return;
  diag_error(diag, path, "all corners of the line are one place: it has no length");
}

/* --- axisymmetry --- */
/* What of a shape is beyond the axis, or NULL. What is cut by the axis must be symmetric. */
static const char *beyond_axis(const Shape *s)
{
  const PetscReal tolerance = 1e-12 * s->radius;
  switch (s->kind) {
  case SHAPE_BOX: return s->min[0] < 0 ? "the box begins" : NULL;
  case SHAPE_BALL:
    return fabs(s->centre[0]) > tolerance && s->centre[0] - s->radius < -tolerance ? "part of the circle lies" : NULL;
  case SHAPE_ARC: /* its ends, and its leftmost position where it has it */
    for (int k = 0; k < 2; ++k)
      if (s->centre[0] + s->radius * cos(s->angle[k] * PETSC_PI / 180) < -tolerance) return "the arc ends";
    return s->angle[0] < 180 && s->angle[1] > 180 && s->centre[0] - s->radius < -tolerance ? "the arc goes" : NULL;
  case SHAPE_HALF_SPACE: return s->normal[1] == 0 && s->point[0] <= 0 ? "its surface lies" : NULL;
  case SHAPE_POLYGON:
  case SHAPE_LINE:
    for (PetscInt i = 0; i < s->n_vertices; ++i)
      if (s->vertices[2 * i] < 0) return "a corner lies";
    return NULL;
  default: return NULL;
  }
}

static void check_shape(const Shape *s, PetscBool axis, const char *path, Diag *diag)
{
  const char *what = axis || s->kind == SHAPE_REVOLVED ? beyond_axis(s) : NULL;
  for (PetscInt i = 0; i < s->n_vertices && s->kind == SHAPE_REVOLVED; ++i)
    if (s->vertices[2 * i] < 0) what = "a corner lies";
  if (what) {
    diag_error(diag, path, "%s beyond the axis, where the radius is negative", what);
    diag_hint(diag, "give the half on the right of the axis; it is the whole wall");
  }
  if (s->kind == SHAPE_LINE || (s->kind == SHAPE_REVOLVED && s->open)) check_length(s, path, diag);
  if (s->n_vertices) check_crossing(s, s->kind == SHAPE_POLYGON || (s->kind == SHAPE_REVOLVED && !s->open), path, diag);
  for (PetscInt i = 0; i < s->n_children; ++i) check_shape(s->children + i, axis, path, diag);
}

/* --- against the grid --- */
static void check_size(const Case *c, const Form *form, const char *path, Diag *diag)
{
  const PetscReal *b = form->bounds;
  PetscReal size = 0, grid = 0;
  for (PetscInt d = 0; d < form->dim; ++d) {
    size = PetscMax(size, b[d + 3] - b[d]);
    grid = PetscMax(grid, c->grid.max[d] - c->grid.min[d]);
  }
  if (size <= 50 * grid) return;
  diag_warning(diag, path, "the surface is %.4g m large, and the grid %.4g m", (double)size, (double)grid);
  diag_hint(diag, "if the file is in mm: scale: 0.001");
}

void wall_check(const Case *c, const WallSpec *wall, const Form *form, const char *path, Diag *diag)
{
  check_shape(&wall->shape, form->axis, path, diag);
  if (c->grid.kind == GRID_BOX && wall->shape.kind == SHAPE_SURFACE) check_size(c, form, path, diag);
}
