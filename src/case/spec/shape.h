/* Where bodies and walls are. */
#pragma once
#include "case/kinematics/kinematics.h"

typedef enum {
  SHAPE_BOX,
  SHAPE_BALL,
  SHAPE_POLYGON,
  SHAPE_HALF_SPACE,
  SHAPE_UNION,
  SHAPE_DIFFERENCE,
  SHAPE_INTERSECTION,
  SHAPE_CYLINDER,
  SHAPE_CONE,
  SHAPE_TERRAIN,
  /* of walls alone: */
  SHAPE_LINE,
  SHAPE_ARC,
  SHAPE_DISK,
  SHAPE_REVOLVED,
  SHAPE_SURFACE
} ShapeKind;

/* A set of positions. A difference is its first child without all the others. */
typedef struct Shape {
  ShapeKind kind;
  PetscReal min[3], max[3];      /* box */
  PetscReal centre[3], radius;   /* ball: a circle in 2D */
  PetscReal point[3], normal[3]; /* half-space: all x with (x - point) . normal <= 0 */
  PetscInt n_vertices;           /* polygon, 2D, closed by itself; line */
  PetscReal *vertices;           /* n_vertices x 2; revolved: radius and height */
  /* cylinder, cone, revolved: the axis begins at `point` and goes `length` along `normal` */
  PetscReal radii[2], length; /* of both ends; disk: of its hole and its rim */
  PetscReal angle[2];         /* arc: from, to, counter-clockwise from x, in degrees (as in files) */
  PetscBool open;             /* revolved, surface: thin, without an inside */
  char *file, *group;         /* surface: STL or .msh, and a physical group of it or NULL; terrain: .asc */
  PetscReal scale, offset[3]; /* of what the file gives: x = scale X + offset, m */
  struct Relief *relief;      /* terrain: what the file gives */
  PetscInt n_children;
  struct Shape *children;
} Shape;

/* Has the shape an inside? (Lines, arcs, disks and open surfaces have none.) */
PetscBool shape_is_solid(const Shape *shape);
/* Is x (2 or 3 coordinates) in the shape? Its surface belongs to it, within `tolerance` m. Not for
 * shapes of walls alone. */
PetscBool shape_contains(const Shape *shape, PetscInt dim, const PetscReal *x, PetscReal tolerance);
/* How deep below the surface x lies, m, `most` at most; 0: it lies outside. */
PetscReal shape_depth(const Shape *shape, PetscInt dim, const PetscReal *x, PetscReal most);
/* Smallest box around the shape; unbounded sides are +-PETSC_MAX_REAL. */
void shape_bounds(const Shape *shape, PetscInt dim, PetscReal min[3], PetscReal max[3]);
