/* The law of an interface at one contact point: what a rigid wall does to the material there.
 *
 * With the gap g along the normal n and the slip s, the motion against the wall since the start of
 * the step, forces are those of an augmented Lagrangian (Alart and Curnier 1991):
 *
 *   p = max(0, p_k - r g),    t = t_k - r_t s, but no longer than friction p + min(bond, 20 p),    f = p n + t.
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
  PetscReal pressure; /* along the normal: pushes if positive */
  PetscReal shear[3]; /* across it */
} ContactForce;

/* The largest tangential force beside a pressure, N. */
PetscReal contact_most(const ContactLaw *law, PetscReal pressure);

/* `now`, from the multipliers and where the point is against the wall. stiffness: 3 x 3, minus the
 * derivative of p n + t by the position, N/m; NULL: not wanted. */
ContactState contact_law(const ContactLaw *law, const WallPlace *place, const PetscReal slip[3],
                         const ContactForce *multiplier, ContactForce *now, PetscReal *stiffness);
