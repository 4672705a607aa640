#include "wall/form.h"
#include <math.h>

/* --- asking --- */
static Nearness with_formula(const Form *f, const PetscReal x[3], WallPlace *place)
{
  switch (f->shape->kind) {
  case SHAPE_BOX: box_place(f, x, place); return NEAR;
  case SHAPE_BALL: ball_place(f, x, place); return NEAR;
  case SHAPE_ARC: return arc_place(f, x, place);
  default: half_space_place(f, x, place); return NEAR;
  }
}

static void turn_over(WallPlace *place)
{
  place->gap = -place->gap;
  for (int d = 0; d < 3; ++d) place->normal[d] = -place->normal[d];
  for (int k = 0; k < 9; ++k) place->curvature[k] = -place->curvature[k];
}

/* A union has the least gap of its children, an intersection the largest; a difference is the
 * intersection of the first with what the others leave; and turned over each is the other. */
static Nearness combined_near(const Form *f, const PetscReal x[3], int flip, PetscReal high, WallPlace *place)
{
  const PetscBool least = (f->shape->kind == SHAPE_UNION) == (flip > 0);
  Nearness result = NEAR_NOT;
  for (PetscInt i = 0; i < f->n; ++i) {
    const int way = f->shape->kind == SHAPE_DIFFERENCE && i > 0 ? -flip : flip;
    const PetscReal limit = least && result != NEAR_NOT ? place->gap : high;
    WallPlace found;
    const Nearness near = form_near(f->child + i, x, way, limit, &found);
    if (near == NEAR_NOT && !least) return NEAR_NOT;
    if (near == NEAR_NOT || (result != NEAR_NOT && (least ? found.gap >= place->gap : found.gap <= place->gap)))
      continue;
    *place = found;
    result = near;
  }
  return result;
}

Nearness form_near(const Form *f, const PetscReal x[3], int flip, PetscReal high, WallPlace *place)
{
  WallPlace found;
  if (f->n) return combined_near(f, x, flip, high, place);
  if (f->facets && !form_is_flat(f)) return revolved_near(f, x, flip, high, place);
  if (f->facets) return facets_near(f->facets, x, flip, f->thin, high, place);
  const Nearness near = with_formula(f, x, &found);
  if (flip < 0) turn_over(&found);
  if ((f->thin ? fabs(found.gap) : found.gap) > high) return NEAR_NOT;
  *place = found;
  return near;
}

/* --- making --- */
static void set_axis(Form *f, const PetscReal *base, const PetscReal *direction)
{
  PetscReal norm = 0;
  for (PetscInt d = 0; d < f->dim; ++d) norm += direction[d] * direction[d];
  for (PetscInt d = 0; d < f->dim; ++d) {
    f->base[d] = base[d];
    f->direction[d] = direction[d] / PetscSqrtReal(norm);
  }
}

/* The box around the section at its largest radius, everywhere along the axis. */
static void revolved_bounds(Form *f)
{
  const PetscReal *section = f->facets->bounds; /* radius, height */
  for (int d = 0; d < 3; ++d) {
    const PetscReal a = f->direction[d], reach = section[3] * PetscSqrtReal(PetscMax(0, 1 - a * a));
    f->bounds[d] = f->base[d] + PetscMin(a * section[1], a * section[4]) - reach;
    f->bounds[d + 3] = f->base[d] + PetscMax(a * section[1], a * section[4]) + reach;
  }
}

/* Disks, cylinders and cones are sections of two or four corners, too. */
static PetscErrorCode Revolve(Form *f)
{
  const Shape *s = f->shape;
  const PetscReal disk[4] = {s->radii[1], 0, s->radii[0], 0}; /* its right side is along the normal */
  const PetscReal cone[8] = {0, 0, s->radii[0], 0, s->radii[1], s->length, 0, s->length};

  PetscFunctionBeginUser;
  set_axis(f, s->kind == SHAPE_DISK ? s->centre : s->point, s->normal);
  if (s->kind == SHAPE_DISK) PetscCall(FacetsOfLine(2, disk, PETSC_FALSE, PETSC_TRUE, &f->facets));
  else if (s->kind == SHAPE_REVOLVED)
    PetscCall(FacetsOfLine(s->n_vertices, s->vertices, !s->open, PETSC_TRUE, &f->facets));
  else PetscCall(FacetsOfLine(4, cone, PETSC_TRUE, PETSC_TRUE, &f->facets));
  revolved_bounds(f);
  PetscFunctionReturn(0);
}

static PetscErrorCode Combine(Form *f, const char *path, Diag *diag)
{
  static const char *const keys[] = {
    [SHAPE_UNION] = "union", [SHAPE_DIFFERENCE] = "difference", [SHAPE_INTERSECTION] = "intersection"};
  char below[512];

  PetscFunctionBeginUser;
  f->n = f->shape->n_children;
  PetscCall(PetscCalloc1(f->n, &f->child));
  for (PetscInt i = 0; i < f->n; ++i) {
    Form *child;
    snprintf(below, sizeof below, "%s.%s[%" PetscInt_FMT "]", path, keys[f->shape->kind], i);
    PetscCall(FormCreate(f->shape->children + i, f->dim, f->axis, below, diag, &child));
    if (child) f->child[i] = *child;
    PetscCall(PetscFree(child));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FacetsOfShape(Form *f, const char *path, Diag *diag)
{
  const Shape *s = f->shape;

  PetscFunctionBeginUser;
  if (s->kind == SHAPE_SURFACE || s->kind == SHAPE_TERRAIN) PetscCall(SurfaceRead(s, path, diag, &f->facets));
  else PetscCall(FacetsOfLine(s->n_vertices, s->vertices, s->kind == SHAPE_POLYGON, f->axis, &f->facets));
  for (int d = 0; d < 6 && f->facets; ++d) f->bounds[d] = f->facets->bounds[d];
  PetscFunctionReturn(0);
}

static void plain_bounds(Form *f)
{
  const Shape *s = f->shape;
  shape_bounds(s, f->dim, f->bounds, f->bounds + 3);
  if (s->kind == SHAPE_HALF_SPACE) set_axis(f, s->point, s->normal);
  for (PetscInt d = 0; d < f->dim && s->kind == SHAPE_ARC; ++d) {
    f->bounds[d] = s->centre[d] - s->radius;
    f->bounds[d + 3] = s->centre[d] + s->radius;
  }
  /* a box that reaches the axis has no face on it: it is mirrored */
  if (f->axis && s->kind == SHAPE_BOX && s->min[0] <= 0) f->bounds[0] = -f->bounds[3];
}

PetscErrorCode FormCreate(const Shape *shape, PetscInt dim, PetscBool axis, const char *path, Diag *diag, Form **form)
{
  const PetscInt before = diag_errors(diag);
  Form *f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  *f = (Form){.shape = shape, .dim = dim, .axis = axis, .thin = shape_is_solid(shape) ? PETSC_FALSE : PETSC_TRUE};
  switch (shape->kind) {
  case SHAPE_UNION:
  case SHAPE_DIFFERENCE:
  case SHAPE_INTERSECTION:
    PetscCall(Combine(f, path, diag));
    shape_bounds(shape, dim, f->bounds, f->bounds + 3);
    break;
  case SHAPE_POLYGON:
  case SHAPE_LINE:
  case SHAPE_SURFACE:
  case SHAPE_TERRAIN: PetscCall(FacetsOfShape(f, path, diag)); break;
  case SHAPE_CYLINDER:
  case SHAPE_CONE:
  case SHAPE_DISK:
  case SHAPE_REVOLVED: PetscCall(Revolve(f)); break;
  default: plain_bounds(f);
  }
  *form = f;
  if (diag_errors(diag) > before) PetscCall(FormDestroy(form));
  PetscFunctionReturn(0);
}

static PetscErrorCode FormClear(Form *f)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < f->n; ++i) PetscCall(FormClear(f->child + i));
  PetscCall(PetscFree(f->child));
  PetscCall(FacetsDestroy(&f->facets));
  PetscFunctionReturn(0);
}

PetscErrorCode FormDestroy(Form **form)
{
  PetscFunctionBeginUser;
  if (*form) PetscCall(FormClear(*form));
  PetscCall(PetscFree(*form));
  PetscFunctionReturn(0);
}
