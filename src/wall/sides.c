/* The sides of one wall that meet a position at once, in its corners: places where the distance is least among those
 * around them, whose normals differ. The nearest of them is what wall_near finds. */
#include "base/math/vector.h"
#include <math.h>
#include "wall/wall_private.h"

#define ALIKE 0.9   /* cosine: normals that differ by less are those of one side, flat or curved */
#define BEHIND 1e-9 /* of the gaps: a side that is hidden by another one begins beyond its plane */

static PetscReal bend_of(const PetscReal *a, const PetscReal *b, const PetscReal *c)
{
  const PetscReal u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - b[0], c[1] - b[1]};
  return atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
}

/* Does a polygon or a line bend enough, and seen from where the material is towards it? */
static PetscBool bends(const Shape *s, PetscBool inside)
{
  const PetscInt n = s->n_vertices, closed = s->kind == SHAPE_POLYGON;
  PetscReal turned = 0, most = 0, least = 0;
  for (PetscInt i = closed ? 0 : 1; i < (closed ? n : n - 1); ++i) {
    const PetscReal bend =
      bend_of(s->vertices + 2 * ((i + n - 1) % n), s->vertices + 2 * i, s->vertices + 2 * ((i + 1) % n));
    turned += bend;
    most = PetscMax(most, bend), least = PetscMin(least, bend);
  }
  const PetscReal limit = acos(ALIKE);
  if (!closed) return (PetscBool)(most > limit || least < -limit);
  return (PetscBool)((turned > 0) == inside ? most > limit : least < -limit);
}

PetscBool wall_has_corners(const WallSpec *w)
{
  const Shape *s = &w->shape;
  switch (s->kind) {
  case SHAPE_HALF_SPACE:
  case SHAPE_BALL:
  case SHAPE_ARC:
  case SHAPE_DISK: return PETSC_FALSE;
  case SHAPE_BOX:
  case SHAPE_CYLINDER:
  case SHAPE_CONE: return w->inside;
  case SHAPE_POLYGON:
  case SHAPE_LINE: return bends(s, w->inside);
  default: return PETSC_TRUE;
  }
}

PetscBool wall_turns(const WallSpec *w)
{
  const Shape *s = &w->shape;
  for (PetscInt i = 0; i < w->n_motions; ++i)
    if (w->motions[i].kind == MOTION_ROTATION) return PETSC_TRUE;
  if (w->has_mass && w->mass.free[3]) return PETSC_TRUE;
  switch (s->kind) {
  case SHAPE_HALF_SPACE:
  case SHAPE_BOX:
  case SHAPE_DISK: return PETSC_FALSE;
  case SHAPE_LINE: return (PetscBool)(s->n_vertices > 2);
  default: return PETSC_TRUE;
  }
}

PetscBool sides_have(const WallSides *sides, const WallPlace *place)
{
  for (PetscInt i = 0; i < sides->n; ++i)
    if (sides->place[i].gap <= place->gap && vector_dot(sides->place[i].normal, place->normal) > ALIKE)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

void sides_add(WallSides *sides, const WallPlace *place)
{
  PetscInt worst = 0;
  if (sides_have(sides, place)) return;
  for (PetscInt i = 0; i < sides->n; ++i) {
    if (vector_dot(sides->place[i].normal, place->normal) > ALIKE) {
      sides->place[i] = *place;
      return;
    }
    if (sides->place[i].gap > sides->place[worst].gap) worst = i;
  }
  if (sides->n < WALL_SIDES_FOUND) sides->place[sides->n++] = *place;
  else if (place->gap < sides->place[worst].gap) sides->place[worst] = *place;
}

/* Faces of a box around x: flat, and none hides another. */
static void box_sides(const Form *f, const PetscReal x[3], PetscReal high, WallSides *sides)
{
  for (PetscInt d = 0; d < f->dim; ++d)
    for (int end = 0; end < 2; ++end) {
      WallPlace place = {.gap = end ? f->bounds[d + 3] - x[d] : x[d] - f->bounds[d]};
      place.normal[d] = end ? -1 : 1;
      if (place.gap <= high) sides_add(sides, &place);
    }
}

/* Of a union the sides of all its children count, of an intersection those of the farthest; see combined_near. */
static void combined_sides(const Form *f, const PetscReal x[3], int flip, PetscReal high, WallSides *sides)
{
  const PetscBool least = (f->shape->kind == SHAPE_UNION) == (flip > 0);
  PetscInt farthest = -1;
  PetscReal far = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < f->n; ++i) {
    const int way = f->shape->kind == SHAPE_DIFFERENCE && i > 0 ? -flip : flip;
    WallPlace found;
    if (least) form_sides(f->child + i, x, way, high, sides);
    else if (form_near(f->child + i, x, way, high, &found) != NEAR_NOT && found.gap > far)
      farthest = i, far = found.gap;
  }
  if (farthest < 0) return;
  form_sides(f->child + farthest, x, f->shape->kind == SHAPE_DIFFERENCE && farthest > 0 ? -flip : flip, high, sides);
}

void form_sides(const Form *f, const PetscReal x[3], int flip, PetscReal high, WallSides *sides)
{
  WallPlace place;
  if (f->n) combined_sides(f, x, flip, high, sides);
  else if (f->facets && !form_is_flat(f)) revolved_sides(f, x, flip, high, sides);
  else if (f->facets) facets_sides(f->facets, x, flip, high, sides);
  else if (f->shape->kind == SHAPE_BOX && flip < 0) box_sides(f, x, high, sides);
  else if (form_near(f, x, flip, high, &place) == NEAR) sides_add(sides, &place);
}

/* Is a new side another one than those, seen from x, and nothing before it? */
static PetscBool is_seen(const WallPlace *place, PetscInt n, const WallPlace *others)
{
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal turn = vector_dot(place->normal, others[i].normal), off = BEHIND * (place->gap + others[i].gap);
    if (turn > ALIKE || others[i].gap - place->gap * turn < -off || place->gap - others[i].gap * turn < -off)
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The nearest that is seen after n others; -1: none. */
static PetscInt choose(const WallSides *sides, PetscInt n, const WallPlace *others)
{
  PetscInt best = -1;
  for (PetscInt i = 0; i < sides->n; ++i)
    if ((best < 0 || sides->place[i].gap < sides->place[best].gap) && is_seen(&sides->place[i], n, others)) best = i;
  return best;
}

PetscInt wall_sides(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, PetscReal within, int side,
                    WallPlace place[WALL_SIDES])
{
  Wall *wall = walls->wall + k;
  WallSides sides = {.n = 1};
  PetscInt n = 1, next;
  PetscReal X[3];
  if (!wall_near(walls, k, t, x, within, side, place)) return 0;
  if (!wall->corners || place->gap <= 0 || (wall->form->thin && !side)) return 1;
  const PetscReal half = wall->form->thin ? wall->spec->thickness / 2 : 0;
  const int flip = wall->form->thin ? side : wall->spec->inside ? -1 : 1;
  wall_origin(walls, k, t, x, X);
  sides.place[0] = *place;
  sides.place[0].gap += half;
  wall_turn_back(wall, &sides.place[0]);
  form_sides(wall->form, X, flip, within + half, &sides);
  for (PetscInt i = 0; i < sides.n; ++i) {
    sides.place[i].gap -= half;
    wall_turn(wall, &sides.place[i]);
  }
  for (; n < walls->dim && (next = choose(&sides, n, place)) >= 0; ++n) place[n] = sides.place[next];
  return n;
}

void wall_anchor(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, const WallPlace *place,
                 WallAnchor *anchor)
{
  wall_origin(walls, k, t, x, anchor->X);
  anchor->place = *place;
  wall_turn_back(walls->wall + k, &anchor->place);
}

void wall_from_anchor(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, const WallAnchor *anchor,
                      WallPlace *place)
{
  PetscReal X[3], bent[3], length = 0;
  wall_origin(walls, k, t, x, X);
  *place = anchor->place;
  for (int i = 0; i < 3; ++i) X[i] -= anchor->X[i];
  for (int i = 0; i < 3; ++i) {
    bent[i] = vector_dot(anchor->place.curvature + 3 * i, X);
    place->gap += X[i] * (anchor->place.normal[i] + bent[i] / 2);
    place->normal[i] += bent[i];
  }
  for (int i = 0; i < 3; ++i) length += PetscSqr(place->normal[i]);
  for (int i = 0; i < 3; ++i) place->normal[i] /= PetscSqrtReal(length);
  wall_turn(walls->wall + k, place);
}
