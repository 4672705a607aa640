/* What is held cannot follow a wall: a contact point asks its free nodes alone to go along.
 *
 * Beside nodes H that a boundary holds, or moves by u_I, a contact point goes by sum_F N_I u_I + sum_H N_I u_I, and
 * behind a wall that goes by w no gap would be left only if free nodes went farther than the wall: five times as far
 * next to a foot that stands. So held nodes let pass sum_H N_I (w - u_I) of it, and the wall passes the point by
 *
 *   e := max(0, e + sum_H N_I (w - u_I) . n),
 *
 * which counts in its gap: what is left of that is the gap of its free nodes. As the wall goes back e falls to 0
 * (docs/theory.md, section 76). */
#include "base/math/vector.h"
#include "solve/contact/contact.h"

#define ASIDE 1e-6 /* a normal with no more of a free axis does not lean along it */

/* Of a node, n in its frame: is it held in all directions along which n leans, and in all others? */
static PetscBool is_held(PetscInt dim, const unsigned char *fixed, const PetscReal *n, PetscBool *all)
{
  PetscBool along = PETSC_TRUE;
  *all = PETSC_TRUE;
  for (PetscInt d = 0; d < 3 && d < dim; ++d) {
    if (fixed[d]) continue;
    *all = PETSC_FALSE;
    if (PetscAbsReal(n[d]) > ASIDE) along = PETSC_FALSE;
  }
  return along;
}

static void find_held(const Contact *s, ContactPoint *c, const unsigned char *fixed, const PetscReal *prescribed,
                      const Frames *frames)
{
  const PetscInt dim = s->dim;
  for (PetscInt e = c->first; e < c->first + c->n; ++e) {
    const PetscReal *frame = frame_of(frames, s->node[e]);
    PetscReal n[3] = {c->facing[0], c->facing[1], c->facing[2]}, u[3] = {0, 0, 0};
    PetscBool all;
    if (frame) frame_turn(dim, frame, n);
    if (!is_held(dim, fixed + s->node[e] * dim, n, &all)) continue;
    for (PetscInt d = 0; d < dim; ++d) u[d] = s->N[e] * prescribed[s->node[e] * dim + d];
    c->held.along += s->N[e];
    c->held.led += vector_dot(u, n);
    if (!all) continue;
    if (frame) frame_turn(dim, frame, u);
    c->held.all += s->N[e];
    for (PetscInt d = 0; d < dim; ++d) c->held.towed[d] += u[d];
  }
}

void contact_find_held(Contact *s, const unsigned char *fixed, const PetscReal *prescribed, const Frames *frames)
{
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    c->held = (ContactHeld){0};
    if (c->wall < s->n_walls) find_held(s, c, fixed, prescribed, frames);
    c->passed = contact_let_pass(c, c->swept, c->let);
  }
}

/* A wall that has not passed yet closes the gap first; what is bonded goes with it both ways. */
static PetscReal passed(const ContactPoint *c, PetscReal more)
{
  if (c->law.kind == CONTACT_BONDED) return c->behind + more;
  if (c->behind > 0) return PetscMax(0, c->behind + more);
  return PetscMax(0, more - c->held.along * PetscMax(0, c->open));
}

PetscReal contact_let_pass(const ContactPoint *c, const PetscReal way[3], PetscReal let[3])
{
  const PetscReal along = vector_dot(way, c->facing), towed = vector_dot(c->held.towed, c->facing);
  const PetscReal end = passed(c, c->held.along * along - c->held.led);
  for (int d = 0; d < 3; ++d)
    let[d] = (end - c->behind) * c->facing[d] + c->held.all * (way[d] - along * c->facing[d]) -
             (c->held.towed[d] - towed * c->facing[d]);
  return end;
}

void contact_lets(const ContactPoint *c, const PetscReal motion[3], PetscReal let[3])
{
  const PetscReal along = vector_dot(motion, c->facing), passes = c->passed != 0 ? c->held.along * along : 0;
  for (int d = 0; d < 3; ++d) let[d] = passes * c->facing[d] + c->held.all * (motion[d] - along * c->facing[d]);
}
