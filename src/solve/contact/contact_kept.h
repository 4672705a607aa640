/* What a carrier keeps of its contacts from step to step (POINT_CONTACT): for each partner, a wall or an interface, so
 * many sides as may meet it at once; of each the state, its reach, m, the force of the last step, N, how much of that
 * stays, what of the reach has come by leaps of the gap, m, the share of this that the last step's sliding takes back,
 * and by how much held nodes have let the wall pass it, m. Where there may be more than one side, each is known by its
 * normal. Gaps of walls do not leap: of open ones explicit dynamics keeps there the side that the point came from, 1 or
 * -1 (0: not known), and at what distance on that side the substep leaves it, m, below 0 beyond the wall. */
#pragma once
#include "points/points.h"
#include "wall/wall.h"

#define KEPT_STATE 0
#define KEPT_REACH 1
#define KEPT_FORCE 2 /* dim numbers */
#define KEPT_STAYS(dim) (2 + (dim))
#define KEPT_LEAPT(dim) (3 + (dim))
#define KEPT_TAKES(dim) (4 + (dim))
#define KEPT_SIDE(dim) KEPT_LEAPT(dim)
#define KEPT_DISTANCE(dim) KEPT_TAKES(dim)
#define KEPT_PASSED(dim) (5 + (dim))
#define KEPT_NORMAL(dim) (6 + (dim)) /* dim numbers, where partners may have several sides */

/* How many sides of any partner may meet one carrier. */
static inline PetscInt contact_sides(const Case *c)
{
  for (PetscInt k = 0; k < c->n_walls; ++k)
    if (wall_has_corners(c->walls + k)) return kinematics_dim(c->kinematics);
  return 1;
}

/* Numbers of one side, and of a partner with so many. */
static inline PetscInt contact_kept_side(PetscInt dim, PetscInt sides) { return 6 + dim + (sides > 1 ? dim : 0); }
static inline PetscInt contact_kept_partner(PetscInt dim, PetscInt sides)
{
  return sides * contact_kept_side(dim, sides);
}

/* Of a side (0 .. sides - 1) of a partner. */
static inline PetscReal *contact_kept(const Points *points, PetscInt p, PetscInt partner, PetscInt sides, PetscInt side)
{
  const PetscInt one = contact_kept_side(points->dim, sides);
  return point_real(points, POINT_CONTACT, p) + (partner * sides + side) * one;
}

static inline void contact_keep_normal(PetscReal *kept, PetscInt dim, PetscInt sides, const PetscReal n[3])
{
  for (PetscInt d = 0; d < dim && sides > 1; ++d) kept[KEPT_NORMAL(dim) + d] = n[d];
}

/* Is added to the state where a spring held it (explicit dynamics): what is pressed stands deeper than the surface. */
#define CONTACT_SPRING 0.25

static inline PetscBool contact_is_sprung(PetscReal state)
{
  return state - PetscFloorReal(state) > CONTACT_SPRING / 2;
}

/* Where another scheme goes on from there. */
#define CONTACT_LET_IN 0.0625

static inline PetscBool contact_is_let_in(PetscReal state) { return state - PetscFloorReal(state) == CONTACT_LET_IN; }
