/* The law of an interface at one contact point: what a rigid wall does to the material there.
 *
 * With the gap g along the normal n and the slip s, the motion against the wall since the start of
 * the step, forces are those of an augmented Lagrangian (Alart and Curnier 1991):
 *
 *   p = max(0, p_k - r g),    t = t_k - r_t s, but no longer than friction p + min(bond, 20 p),    f = p n + t,
 *
 * n and t those of the end of the step, or of the middle of its way (ContactPlace).
 *
 * p_k, t_k are multipliers that Newton's method keeps while it iterates, and which become p, t when
 * it is about to converge (contact.c): with them g and s of what is in contact and does not slide go to
 * zero, whatever r and r_t are. */
#pragma once
#include "wall/wall.h"

/* Tangential force over the pressure of what does not slide, or adheres: one that did not vanish with the
 * pressure would leave no solution where contact opens. */
#define CONTACT_STICKING 20

typedef enum { CONTACT_OPEN, CONTACT_SLIDES, CONTACT_STICKS } ContactState;

typedef struct {
  ContactKind kind;
  PetscReal friction; /* tangent of the angle */
  PetscReal bond;     /* tangential force beside friction, N */
  PetscReal penalty;  /* r, N/m */
  PetscReal along;    /* r_t, N/m */
  PetscBool grips;    /* for a first guess: it neither slides nor opens, whatever friction bears */
} ContactLaw;

/* What the wall does to the material, N. */
typedef struct {
  PetscReal pressure; /* along `push`, the normal of the force: pushes if positive */
  PetscReal shear[3]; /* across it */
} ContactForce;

/* The wall as the law sees it: where it is at the end of the step, and which way it pushes. */
typedef struct {
  WallPlace at;
  PetscReal push[3];    /* unit */
  PetscReal follows[9]; /* 3 x 3, how that turns with the normal, */
  PetscReal bends[9];   /* and with the position, 1/m */
} ContactPlace;

/* Minus derivatives of p n + t, 3 x 3: by the position, N/m, and by the normal of a wall that turns, N. */
typedef struct {
  PetscReal K[9], turn[9];
} ContactTangent;

/* The largest tangential force beside a pressure, N. */
PetscReal contact_most(const ContactLaw *law, PetscReal pressure);

/* It pushes along its normal. */
ContactPlace contact_straight(const WallPlace *place);
/* It has pushed throughout a step that began with the normal `start` and a gap of `open`, m: along the normal of the
 * middle of the way. Force and motion of a step belong to its middle, and by a normal of its end what slides along a
 * round wall would be braked (docs/theory.md, section 84). */
ContactPlace contact_halfway(const WallPlace *place, const PetscReal start[3], PetscReal open);

/* Has it nothing to push with at that gap, m, and does not pull? */
PetscBool contact_opens(const ContactLaw *law, PetscReal gap, const ContactForce *multiplier);
/* `now`, from the multipliers and where the point is against the wall. tangent: NULL: not wanted. */
ContactState contact_law(const ContactLaw *law, const ContactPlace *place, const PetscReal slip[3],
                         const ContactForce *multiplier, ContactForce *now, ContactTangent *tangent);
