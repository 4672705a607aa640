/* The shape of a wall in its own frame, ready to be asked. */
#pragma once
#include "wall/facets/facets.h"

typedef struct Form Form;
struct Form {
  const Shape *shape;
  PetscInt dim;
  PetscBool thin;                  /* without an inside */
  PetscBool axis;                  /* x = 0 is an axis of symmetry */
  PetscReal bounds[6];             /* m */
  PetscReal base[3], direction[3]; /* of an axis of revolution; half-space: normal, disk likewise; unit */
  Facets *facets;                  /* polygons, surfaces; the section of what is revolved */
  PetscInt n;
  Form *child;
};

/* Are its facets the surface itself, not a section that is turned about an axis? */
static inline PetscBool form_is_flat(const Form *f)
{
  const ShapeKind kind = f->shape->kind;
  return kind == SHAPE_POLYGON || kind == SHAPE_LINE || kind == SHAPE_SURFACE || kind == SHAPE_TERRAIN;
}

/* Mistakes go to diag at `path`; *form is NULL then. axis: of axisymmetric kinematics. */
PetscErrorCode FormCreate(const Shape *shape, PetscInt dim, PetscBool axis, const char *path, Diag *diag, Form **form);
PetscErrorCode FormDestroy(Form **form);
/* facets_near for any shape. */
Nearness form_near(const Form *form, const PetscReal x[3], int flip, PetscReal high, WallPlace *place);

/* All places of the shape that x may see within `high`, for wall_sides: hidden ones among them (sides.c). */
void form_sides(const Form *form, const PetscReal x[3], int flip, PetscReal high, WallSides *sides);

/* --- solids.c: gap, normal and curvature of shapes with a formula --- */
void box_place(const Form *form, const PetscReal x[3], WallPlace *place);
void ball_place(const Form *form, const PetscReal x[3], WallPlace *place);
void half_space_place(const Form *form, const PetscReal x[3], WallPlace *place);
Nearness arc_place(const Form *form, const PetscReal x[3], WallPlace *place);
/* A section (radius, height) turned about an axis. */
Nearness revolved_near(const Form *form, const PetscReal x[3], int flip, PetscReal high, WallPlace *place);
void revolved_sides(const Form *form, const PetscReal x[3], int flip, PetscReal high, WallSides *sides);

/* --- surface/surface.c --- */
PetscErrorCode SurfaceRead(const Shape *shape, const char *path, Diag *diag, Facets **facets);
