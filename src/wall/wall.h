/* Rigid walls as geometry, independent of the grid: how far a position is from a wall, which way
 * leads away from it, and how the wall's matter moves. In axisymmetry all is meant in the plane of
 * radius and height. Not collective; each rank has all walls. */
#pragma once
#include "base/diag/diag.h"
#include "case/case.h"

/* The walls of a case; each by its index in Case.walls. */
typedef struct Walls Walls;

/* What a wall is to a position near it. */
typedef struct {
  PetscReal gap;          /* signed distance to its surface, m: negative inside the wall */
  PetscReal normal[3];    /* unit, out of the wall: the gradient of gap */
  PetscReal curvature[9]; /* 3 x 3, the Hessian of gap, 1/m: 0 along flat faces */
} WallPlace;

/* The largest of its principal curvatures, 1/m: times the gap 1 before an edge or a corner, also before one whose line
 * bends towards x, as the rim of a hole, and less before what is round. */
PetscReal wall_bend(const WallPlace *place);

/* Mistakes of the geometry (files that cannot be read, surfaces that are not closed) go to diag. */
PetscErrorCode WallsCreate(const Case *c, Diag *diag, Walls **walls);
PetscErrorCode WallsDestroy(Walls **walls);
/* Does wall k stand in a step that ends at time t? Up to `until`, and after `from` (from the start, if
 * that is 0). While something is sought what stands as that begins. */
PetscBool wall_stands(const Walls *walls, PetscInt k, PetscReal t);
/* And in one that begins at t? From `from` on, and before `until`. */
PetscBool wall_comes(const Walls *walls, PetscInt k, PetscReal t);
/* Is it new at t: by its `from`, or as what brought it begins, the run or a stage? */
PetscBool wall_is_new(const Walls *walls, PetscInt k, PetscReal t);
/* How long from t until a wall appears or vanishes, s; PETSC_MAX_REAL: none does. Differences that
 * wall_stands overlooks are none here either. */
PetscReal walls_until_change(const Walls *walls, PetscReal t);
/* The wall of index k as x (dim coordinates) sees it at time t. PETSC_FALSE if x is farther than
 * `within` (m) away, or the wall stands in no step that begins or ends then: *place is left alone then. What lies
 * in a wall that has an inside is never far. side: of a wall without an inside, the one on which x
 * was before (what wall_side gave), then gap is negative on the other one; 0: gap is the distance
 * (less half the thickness), as it is from any side where a rim is nearest. */
PetscBool wall_near(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, PetscReal within, int side,
                    WallPlace *place);
/* At most so many sides of a wall meet one position: in the plane two. */
#define WALL_SIDES 3
/* May it have more than one before material somewhere: corners as seen from there? */
PetscBool wall_has_corners(const WallSpec *wall);
/* May its normal before what goes along it turn: is it round, or of several faces, or does it turn itself? Boxes are no
 * such: their faces are straight, and material that goes round an edge of one leaves it. */
PetscBool wall_turns(const WallSpec *wall);
/* wall_near for all sides of the wall that a position in a corner of it meets: the nearest first, as wall_near has it,
 * then others that are seen from x within reach, where the distance is least among places around (sides.c). Returns how
 * many. */
PetscInt wall_sides(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, PetscReal within, int side,
                    WallPlace place[WALL_SIDES]);
/* One side of a wall before x, known by its place there and its bend: it goes with the wall. */
typedef struct {
  PetscReal X[3];
  WallPlace place; /* both in the frame of the wall */
} WallAnchor;
void wall_anchor(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, const WallPlace *place,
                 WallAnchor *anchor);
/* That side as x sees it at time t, to second order in the way from where it was anchored; beyond its ends, too. */
void wall_from_anchor(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, const WallAnchor *anchor,
                      WallPlace *place);
/* On which side of wall k is x at time t, 1 or -1? 0 for walls that have an inside, and beyond the
 * rim of others, where neither side is behind the other: ask anew in every step. */
int wall_side(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x);
/* Is no place of it ever behind another one: a half-space, and what surrounds a hollow that bulges everywhere? */
PetscBool wall_has_one_side(const Walls *walls, PetscInt k);
/* What the wall's matter that is at x at t0 moves by until t1, m. */
void wall_motion(const Walls *walls, PetscInt k, PetscReal t0, PetscReal t1, const PetscReal *x,
                 PetscReal increment[3]);
/* Velocity at t of its matter that is at x then, by the way of the next `glance` s, or, < 0, of the last ones: exact
 * where its acceleration is constant in these. */
void wall_velocity(const Walls *walls, PetscInt k, PetscReal t, PetscReal glance, const PetscReal *x, PetscReal v[3]);
/* Wall k, which has mass, is where x = R X + T of what stood at X at the start, whatever time is asked for. */
void wall_put(Walls *walls, PetscInt k, const PetscReal R[9], const PetscReal T[3]);

/* Where all walls are that have mass, as wall_put has it: R and T, 12 numbers each, in their order. */
PetscInt walls_with_mass(const Case *c);
void walls_get_frames(const Walls *walls, PetscReal *frames);
void walls_put_frames(Walls *walls, const PetscReal *frames);

/* What a rigid body is to its motion. */
typedef struct {
  PetscReal mass;       /* kg */
  PetscReal centre[3];  /* of mass, at the start, m */
  PetscReal inertia[9]; /* about it, kg m2, 3 x 3; in the plane [8] counts */
} WallInertia;

/* Of the shape of wall k filled with matter of density 1 (inertia.c). PETSC_FALSE: it has no such volume, or one
 * that is not known here. */
PetscBool wall_volume(const Walls *walls, PetscInt k, WallInertia *inertia);
/* Of wall k as its case asks for it; what is missing is a mistake. */
void wall_inertia(const Walls *walls, PetscInt k, Diag *diag, WallInertia *inertia);
/* The box around wall k at time t; PETSC_MAX_REAL, with a sign, where it has no end. */
void wall_bounds(const Walls *walls, PetscInt k, PetscReal t, PetscReal min[3], PetscReal max[3]);
