/* Walls that move by what acts on them: rigid bodies whose increments in a step are unknowns of Newton's method,
 * beside those of the nodes (newton_rigid.c).
 *
 * With impulses dt F of all forces, where contact counts with its mean over the step,
 *
 *   M (v1 - v) = dt F,  d = dt (v + v1) / 2;   R1 J W1 - R J W = dt T,  R1 = R exp(dt (W + W1) / 2),
 *
 * the torque T about the centre where forces act, in the middle of the step: momentum, its moment and energy are exact
 * for any dt (Simo and Wong 1991). In statics forces and torques balance at the end. All ranks have the same
 * numbers. */
#pragma once
#include "wall/wall.h"

#define RIGID 6 /* unknowns: translation, rotation */

/* What outlives a step: numbers alone, a row of a checkpoint. */
typedef struct {
  PetscReal moved[3];    /* of the centre since the start, m */
  PetscReal R[9];        /* x = centre + moved + R (X - centre) */
  PetscReal v[3];        /* m/s */
  PetscReal L[3];        /* moment of momentum about the centre, kg m2/s */
  PetscReal turned[3];   /* sum of its rotations, rad */
  PetscReal last[RIGID]; /* its increments in the last step, */
  PetscReal step;        /* which was so long, s */
  PetscReal work;        /* of weight and load since the start, J */
} RigidState;

typedef struct {
  PetscInt wall;
  WallInertia body;
  PetscBool free[RIGID];
  RigidState now, start;    /* in the step, and as it began */
  PetscBool stands;         /* in this step */
  PetscReal dt, share;      /* dt 0: statics; share: the mean of contact over what the balance asks for */
  PetscReal part;           /* of the step at which forces have their levers: 1/2, in statics 1 */
  PetscReal load[2][RIGID]; /* weight, force and torque at the step's start and end */
  PetscReal held[RIGID];    /* what more contact bore when the stage began: it fades (forces/release.h) */
  PetscReal q[RIGID];       /* increments: translation d, and theta of exp(theta), m, rad */
  /* of contact on the material at the last assembly, over all ranks: forces and torques, and the sums of their
   * sizes; penalties of what is near, N/m, and times the squares of their levers, N m */
  PetscReal contact[RIGID], size[2], stiff, twist;
  PetscReal adrift[RIGID]; /* statics: what acted along motions that nothing resisted at the last tangent, N, N m */
  PetscReal borne[RIGID * RIGID]; /* and the share of forces and torques that holds bear there, as it tilts */
  PetscReal given[3];             /* momentum that contact took from it in this step, kg m/s */
  PetscReal lost;                 /* energy of motion that impulses took, J */
} RigidWall;

/* The rigid wall of a wall of the case, or NULL. */
static inline RigidWall *rigid_of(RigidWall *rigid, PetscInt n, PetscInt wall)
{
  for (PetscInt k = 0; k < n; ++k)
    if (rigid[k].wall == wall) return rigid + k;
  return NULL;
}

/* Of those walls that have mass, at the start; what is missing is a mistake. */
PetscErrorCode RigidCreate(const Case *c, Walls *walls, Diag *diag, PetscInt *n, RigidWall **rigid);
/* A step, or a try of it, begins at t. middle: forces balance there. */
void rigid_begin(RigidWall *b, Walls *walls, const Case *c, PetscReal t, PetscReal dt, PetscReal share,
                 PetscBool middle);
/* A stage begins at t, and contact on the material bears so much: what loads at that time lack of it. */
void rigid_hold(RigidWall *b, const Case *c, PetscReal t, const PetscReal bears[RIGID]);
/* First guess: by inertia, or (statics) as in the last step. */
void rigid_guess(RigidWall *b, Walls *walls, PetscBool previous);
/* The wall where its increments put it. */
void rigid_place(const RigidWall *b, Walls *walls);
/* Unknowns that it has: those free, while it stands. */
static inline PetscBool rigid_has(const RigidWall *b, int i) { return b->stands && b->free[i]; }

/* Of a contact point that goes from x0 to x1: lever about the centre where forces act, and what the wall's matter
 * moves by there: in dynamics by theta across the lever, so that the work of contact is that of forces on d and of
 * torques on theta; in statics by the turn itself, or what is bonded would be pinched by theta^2 / 2 in each step. */
void rigid_lever(const RigidWall *b, const PetscReal x0[3], const PetscReal x1[3], PetscReal lever[3]);
void rigid_sweep(const RigidWall *b, const PetscReal x0[3], const PetscReal x1[3], PetscReal swept[3]);
/* About which axis, and how far, it turns at the end of the step for a unit of theta. */
void rigid_turns(const RigidWall *b, int axis, PetscReal a[3]);
/* Position against the centre at the start, or at the end of the step, and velocity there. */
void rigid_arm(const RigidWall *b, PetscBool start, const PetscReal x[3], PetscReal arm[3]);
void rigid_velocity(const RigidWall *b, const PetscReal arm[3], PetscReal v[3]);
/* A vector of the wall as it stands at the end of the step, turned back to where it was drawn. */
void rigid_as_drawn(const RigidWall *b, const PetscReal v[3], PetscReal drawn[3]);
/* Change of velocity and spin by momentum p and its moment (6 numbers). */
void rigid_respond(const RigidWall *b, const PetscReal p[RIGID], PetscReal change[RIGID]);
void rigid_push(RigidWall *b, const PetscReal p[RIGID]);

/* What the balance of the wall lacks, N and N m, and the derivative of its inertia, 6 x 6. */
void rigid_residual(const RigidWall *b, PetscReal r[RIGID]);
void rigid_inertia(const RigidWall *b, PetscReal D[RIGID * RIGID]);
/* In statics: does something act on it while it touched nothing at the last assembly, be something near or not? */
PetscBool rigid_floats(const RigidWall *b);
/* Does it balance, up to `tolerance` of what acts on it, or what a length `digit` makes of contact? */
PetscBool rigid_balances(const RigidWall *b, PetscReal tolerance, PetscReal digit);
/* The step is accepted: momentum at its end. */
void rigid_end(RigidWall *b);
PetscReal rigid_kinetic(const RigidWall *b);
/* Without equations (explicit dynamics): its spin; how fast a unit of momentum at the end of a lever (m) makes its
 * matter there at most, 1/kg. */
void rigid_spin(const RigidWall *b, PetscReal omega[3]);
PetscReal rigid_softness(const RigidWall *b, PetscReal lever);
/* What acts at t, `contact` too, acts so long; then it moves on by inertia; and is where that has brought it. */
void rigid_kick(RigidWall *b, const Case *c, PetscReal t, PetscReal kick);
void rigid_drift(RigidWall *b, PetscReal dt);
void rigid_go(RigidWall *b, Walls *walls);
/* When a stage begins: it is where it is drawn, with the motion that it is told, or with the velocity and spin that it
 * had (was); or it goes on with these from where the stage before has left it. Whatever its mass is now, and what loads
 * have worked stays in the account. */
void rigid_start(RigidWall *b, const Case *c);
void rigid_redraw(RigidWall *b, const RigidWall *was);
void rigid_go_on(RigidWall *b, const RigidWall *was);
/* After that: it moves so, as far as it may; and stands still. */
void rigid_move(RigidWall *b, const PetscReal v[3], const PetscReal omega[3]);
void rigid_stop(RigidWall *b);
/* As the step began. */
void rigid_restore(RigidWall *b, Walls *walls);
