/* The law at contact points, and what it puts into forces and tangent of nodes. */
#include "solve/contact/contact.h"

#define ROUND_CORNER 0.9 /* cosine: a normal that has turned by more in a step belongs to another face */

static void take_way(const Contact *s, const ContactPoint *c, const PetscReal *du, PetscReal whole, PetscReal way[3])
{
  for (int d = 0; d < 3; ++d) way[d] = 0;
  for (PetscInt I = 0; I < c->n; ++I)
    for (PetscInt d = 0; d < s->dim; ++d) way[d] += whole * s->N[c->first + I] * du[s->node[c->first + I] * s->dim + d];
}

void contact_place(const Contact *s, const ContactPoint *c, const PetscReal *du, PetscReal whole, PetscReal x[3])
{
  PetscReal way[3];
  take_way(s, c, du, whole, way);
  for (int d = 0; d < 3; ++d) x[d] = c->x[d] + way[d];
}

PetscReal contact_went(const Contact *s, const ContactPoint *c, const PetscReal *du)
{
  PetscReal way[3], square = 0;
  take_way(s, c, du, 1, way);
  for (int d = 0; d < 3; ++d) square += PetscSqr(way[d] - c->swept[d] + c->let[d]);
  return PetscSqrtReal(square);
}

/* A place in the wall, beside a corner, may be nearer to another face than that which the material came to: it would be
 * pushed out there, in every step anew. Then the owner, which stands outside, sees the wall for it. So it does before
 * an edge: for the place, which is all but there, the normal turns by a right angle within the gap, and Newton's method
 * goes in circles; to the owner the edge is as round as it is far. */
static PetscBool see_wall(const Contact *s, ContactPoint *c, PetscReal t, const PetscReal x[3], WallPlace *place)
{
  PetscReal along = 0, owner[3];
  if (c->anchor >= 0) {
    wall_from_anchor(s->walls, c->wall, t, x, s->anchor + c->anchor, place);
    c->ahead = 0;
    for (int d = 0; d < 3; ++d) c->ahead += c->reach * place->normal[d] * c->facing[d];
    return PETSC_TRUE;
  }
  if (!wall_near(s->walls, c->wall, t, x, 2 * s->near, c->side, place)) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) along += place->normal[d] * c->facing[d];
  if (!c->edge && along > ROUND_CORNER) return c->ahead = along * c->reach, PETSC_TRUE;
  for (int d = 0; d < 3; ++d) owner[d] = x[d] + c->reach * c->facing[d];
  if (!wall_near(s->walls, c->wall, t, owner, 2 * s->near + c->reach, c->side, place)) return PETSC_FALSE;
  along = 0;
  for (int d = 0; d < 3; ++d) along += ((owner[d] - x[d]) - c->reach * c->facing[d]) * place->normal[d];
  place->gap -= c->reach + along; /* what rounding has added to the way there, as in place_of */
  return PETSC_TRUE;
}

/* The wall as the contact point sees it at x, on its way there, or the other body: a plane that goes with it. Far from
 * the origin (maps have 5e6 m) x is rounded to 1e-9 m, for which a stiff body has more force than Newton's method may
 * leave: what rounding has lost of the way counts in the gap. */
static PetscBool place_of(const Contact *s, ContactPoint *c, PetscReal t, const PetscReal x[3], const PetscReal way[3],
                          WallPlace *place)
{
  if (c->wall < s->n_walls) {
    if (!see_wall(s, c, t, x, place)) return PETSC_FALSE;
    for (int d = 0; d < 3; ++d) place->gap += (way[d] - (x[d] - c->x[d])) * place->normal[d];
    return PETSC_TRUE;
  }
  *place = (WallPlace){.gap = c->open - c->behind}; /* what has passed it counts after that, as before walls */
  for (int d = 0; d < 3; ++d) {
    place->normal[d] = c->normal[d];
    place->gap += way[d] * c->normal[d];
  }
  return PETSC_TRUE;
}

static void stay_open(ContactPoint *c)
{
  c->state = CONTACT_OPEN;
  c->now = (ContactForce){0};
  c->gap = PETSC_MAX_REAL;
}

/* Most that is near a wall has not met it, before the step or in it: nothing asks which way it would push. */
static PetscBool stays_away(const ContactPoint *c)
{
  if (c->before != CONTACT_OPEN || !contact_opens(&c->law, c->gap, &c->multiplier)) return PETSC_FALSE;
  return (PetscBool)(c->lent[0] == 0 && c->lent[1] == 0 && c->lent[2] == 0);
}

PetscBool contact_meets(const Contact *s, ContactPoint *c, const NodalScene *scene, ContactTangent *tangent)
{
  const RigidWall *rigid = contact_rigid(s, c);
  PetscReal way[3], x[3];
  WallPlace place;
  ContactPlace pushes;
  take_way(s, c, scene->du, scene->whole, way);
  for (int d = 0; d < 3; ++d) x[d] = c->x[d] + way[d];
  if (rigid) rigid_sweep(rigid, c->x, x, c->swept);
  stay_open(c);
  c->ahead = c->reach;
  if (rigid) c->passed = contact_let_pass(c, c->swept, c->let); /* of others it is known */
  if (!place_of(s, c, scene->end, x, way, &place)) return PETSC_FALSE;
  c->gap = place.gap + c->passed + s->share.leaves * PetscMax(0, -(c->open + c->passed));
  for (int d = 0; d < 3; ++d) {
    c->slip[d] = way[d] - c->swept[d] + c->let[d];
    c->normal[d] = c->push[d] = place.normal[d];
  }
  c->law.grips = (PetscBool)(s->grips && contact_touched(c));
  if (stays_away(c)) return PETSC_FALSE;
  pushes = c->halfway ? contact_halfway(&place, c->facing, c->open - c->behind) : contact_straight(&place);
  pushes.at.gap = c->gap;
  for (int d = 0; d < 3; ++d) c->push[d] = pushes.push[d];
  c->state = contact_law(&c->law, &pushes, c->slip, &c->multiplier, &c->now, tangent);
  return c->state != CONTACT_OPEN;
}

void contact_force(const ContactPoint *c, PetscReal f[3])
{
  for (int d = 0; d < 3; ++d) f[d] = c->now.pressure * c->push[d] + c->now.shear[d];
}

void contact_acts(const ContactPoint *c, PetscReal f[3])
{
  contact_force(c, f);
  for (int d = 0; d < 3; ++d) f[d] -= c->lent[d];
}

void contact_balance(const Contact *s, const ContactPoint *c, PetscReal f[3])
{
  contact_acts(c, f);
  for (int d = 0; d < 3; ++d) f[d] -= s->share.back * c->stays * c->last[d];
}

/* A force that rises by more than that in a step has begun in it. */
#define AT_ONCE 1.2

/* The mean of a step is the force half a step before its end, where accelerations stand: half of what it has risen by
 * since the last mean is added. What remembered the mean alone drove whatever swings on a wall (docs/theory.md,
 * section 93). */
PetscReal contact_stays(const Contact *s, const ContactPoint *c)
{
  const PetscReal now = s->share.mean * c->now.pressure;
  PetscReal before = 0;
  for (int d = 0; d < 3; ++d) before += c->last[d] * c->push[d];
  if (!s->share.inertia) return 1;
  return now == 0 ? 0 : PetscMax(0, PetscMin(1.5 - 0.5 * before / now, AT_ONCE * before / now));
}

void contact_excess(const Contact *s, const ContactPoint *c, PetscReal f[3])
{
  const PetscReal stays = s->share.mean * contact_stays(s, c), lag = s->share.lag;
  PetscReal balance[3];
  contact_force(c, f);
  contact_balance(s, c, balance);
  for (int d = 0; d < 3; ++d) f[d] = (balance[d] - lag * c->stays * c->last[d]) / (1 - lag) - stays * f[d];
}

PetscReal contact_square(const Contact *s)
{
  PetscReal sum = 0;
  for (PetscInt k = 0; s && k < s->n; ++k) {
    PetscReal f[3];
    contact_force(s->point + k, f);
    for (PetscInt d = 0; d < s->dim; ++d) sum += f[d] * f[d];
  }
  return sum;
}

static void add_tangent(const Contact *s, const ContactPoint *c, const NodalScene *scene, const PetscReal *K,
                        const NodalOutput *out)
{
  const PetscReal *N = s->N + c->first;
  for (PetscInt I = 0; I < c->n; ++I)
    for (PetscInt J = 0; J < c->n; ++J) {
      const PetscReal weight = scene->whole * N[I] * N[J];
      const PetscInt slot = s->slot[c->slot + I * c->n + J];
      if (s->dim == 2) nodal_add_tangents(out, 2, slot, weight, K); /* a number that the compiler knows */
      else nodal_add_tangents(out, 3, slot, weight, K);
    }
}

static void add_force(const Contact *s, const ContactPoint *c, PetscReal sign, PetscReal *force)
{
  PetscReal f[3];
  contact_balance(s, c, f);
  if (f[0] == 0 && f[1] == 0 && f[2] == 0) return; /* most that is near a wall has not met it */
  for (PetscInt e = c->first; e < c->first + c->n; ++e)
    for (PetscInt d = 0; d < s->dim; ++d) force[s->node[e] * s->dim + d] -= sign * s->N[e] * f[d];
}

/* Largest motion of a node that carries contact, m. */
static PetscReal largest_motion(const Contact *s, const NodalScene *scene)
{
  PetscReal largest = 0;
  for (PetscInt e = 0; e < s->n_nodes; ++e) {
    const PetscReal *du = scene->du + s->node[e] * s->dim;
    const PetscReal square = PetscSqr(du[0]) + PetscSqr(du[1]) + (s->dim == 3 ? PetscSqr(du[2]) : 0);
    largest = PetscMax(largest, square);
  }
  return scene->whole * PetscSqrtReal(largest);
}

/* Is it too far from a wall that rests to have come there? Most points near one are: a gap changes by no more than what
 * the place moves. */
static PetscBool is_out_of_reach(const Contact *s, const ContactPoint *c, PetscReal motion)
{
  if (c->touches || c->open <= c->spread * motion || c->before != CONTACT_OPEN || contact_rigid(s, c))
    return PETSC_FALSE;
  return c->swept[0] == 0 && c->swept[1] == 0 && c->swept[2] == 0;
}

PetscErrorCode ContactAssemble(void *data, const NodalScene *scene, const NodalOutput *out)
{
  const Contact *s = data;
  const PetscReal motion = largest_motion(s, scene);
  ContactTangent tangent;

  PetscFunctionBeginUser;
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (is_out_of_reach(s, c, motion)) {
      stay_open(c);
      c->gap = c->open; /* within what it moves */
      continue;
    }
    const PetscBool meets = contact_meets(s, c, scene, out->system ? &tangent : NULL);
    add_force(s, c, out->away ? -1 : 1, out->force);
    if (out->system && meets) add_tangent(s, c, scene, tangent.K, out);
  }
  PetscCall(RigidSums(data, scene));
  PetscFunctionReturn(0);
}
