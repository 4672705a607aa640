/* Contact of material with rigid walls and of bodies with each other, inside Newton's method.
 *
 * What meets a wall are contact points: of each material point near it the place on the surface of
 * its part of the body that is nearest to the wall (mpm, gmm), or nodes (fem). Each moves with the
 * field at that place, sum_I N_I du_I, and has its own multipliers, so that as many may act in a
 * cell as there are: their forces need not be unique for those of the nodes to be.
 *
 * Of two bodies that meet at an interface the second is to the first what a wall is, a plane about the
 * part of it that is nearest (surfaces.h). The place moves against it with sum_I N_I du_I over the nodes
 * of both fields, those of the second with -N: so forces come in pairs, and all that follows is the same
 * for walls and interfaces. */
#pragma once
#include "boundary/frames.h"
#include "solve/contact/contact_kept.h"
#include "solve/contact/contact_law.h"
#include "solve/contact/rigid.h"
#include "solve/forces/nodal_force.h"

/* Of the functions of a contact point the share of nodes that are held along the normal, and that of nodes held in all
 * directions; and what these are moved by along the normal, and at all, times their functions, m. */
typedef struct {
  PetscReal along, all, led, towed[3];
} ContactHeld;

typedef struct {
  PetscInt owner; /* the material point, or the node */
  PetscInt wall;  /* or the number of walls + the interface */
  int side;
  PetscBool edge;     /* is it an edge or a corner of the wall that its owner sees at the start? */
  PetscInt slot_kept; /* which of the sides that its owner remembers of the partner this is */
  PetscInt anchor;    /* in a corner of the wall: this side of it, of Contact; else -1: what is nearest */
  PetscInt first, n;  /* nodes that carry it: node[first] .. of Contact; the first of them, */
  PetscInt own;       /* so many, are of its own body, others of the other one, */
  PetscInt slot;      /* and the first of their n x n pairs */
  PetscReal spread;   /* sum of their |N|: it moves by no more than that times what the nodes do */
  PetscReal reach;    /* from the material point to its surface, at the start of the step, m; */
  PetscReal ahead;    /* and of that what counts along the normal at the last assembly */
  PetscReal leapt;    /* and what has come of leaps of its gap, m: contact_bodies.c */
  PetscReal x[3];     /* at the start of the step, m */
  PetscReal swept[3]; /* what the wall's matter there moves by in the step, m */
  PetscReal section;  /* of the surface that it stands for, m2; */
  PetscReal cover;    /* the share of it that the other body stands before; 1: a wall */
  /* of its material, and of that of the other body (0: a wall), Pa, kg/m3 */
  PetscReal modulus[2], density[2];
  PetscReal stiffer; /* by so much does it oppose a change of volume more than `modulus` says, */
  PetscReal softer;  /* and so much of it a change of shape */
  PetscReal open;    /* gap at the start of the step, m */
  ContactHeld held;
  PetscBool let_in;         /* does it stand where a spring of explicit dynamics has left it? */
  PetscReal behind, passed; /* by how much the wall has passed it before the step and at the last assembly, m, */
  PetscReal let[3];         /* and what of `swept` held nodes let pass */
  PetscReal own_bond;       /* that the wall bears along itself without pressure, N, */
  PetscReal bond;           /* with what others lend it: ContactLend */
  ContactLaw law;
  PetscReal cell;     /* what a cell opposes to it at the surface, N/m */
  PetscReal stiffest; /* penalty, N/m */
  PetscReal borne;    /* explicit dynamics: the share of its spring that the substep bears */
  PetscReal left;     /* gap or slip when multipliers were last changed, m; 0: not yet in contact */
  ContactForce multiplier, now;
  ContactState state;  /* at the last assembly */
  ContactState before; /* at the end of the last step */
  PetscBool gone;      /* has the wall vanished when the step begins? Its last force is to be forgotten */
  PetscBool touches;   /* is there no gap at the start of the step? */
  PetscBool begins;    /* does the motion of its body begin with the step, and with it a stage? */
  PetscBool inner;     /* has its point none of the body's surface that looks at the partner? */
  PetscBool covered;   /* does its surface touch after the step? See ContactCover */
  PetscReal gap;       /* at the last assembly, m */
  PetscReal normal[3]; /* at the last assembly, */
  PetscReal push[3];   /* and that of the force, which may be the one of the middle of the way: */
  PetscBool halfway;
  PetscReal facing[3]; /* at the start of the step, as the owner sees it */
  PetscReal slip[3];   /* likewise: motion against the wall, m */
  PetscReal last[3];   /* force of the last step, its mean if matter has inertia, N */
  PetscReal least;     /* the run is over: with less it holds nothing, N */
  PetscReal stays;     /* share of it that nodes remember as acceleration */
  /* of the impulse at the start of the step: what an impact gives for good, N s; and what the motion along the wall is
   * lent on account of the step's friction, as the force that the balance takes back for it, N */
  PetscReal struck[3], lent[3];
} ContactPoint;

/* Resultants of one wall on the material: force, N, and torque about the origin, N m. */
typedef struct {
  PetscReal force[3], torque[3];
  PetscReal sliding; /* of impulses: work lost in sliding, J */
} ContactSum;

/* Of one wall, or interface: then of what the second body does to the first. */
typedef struct {
  ContactSum rate;    /* what its forces at the end of the last step are in the rate of momentum */
  ContactSum mean;    /* over the last step: times dt it is all momentum that came from the wall */
  PetscReal friction; /* work of sliding along it since the start, J */
  PetscReal area;     /* of the surface in contact after the last step, m2 */
  PetscReal deepest;  /* largest penetration after the last step, m */
} WallState;

/* How the force of a step stands in the balance at its end (docs/theory.md, "Impact"): its mean over the step is
 * `mean` of it; what nodes remember as acceleration of that of the last step is taken back by `back`, and counts there
 * by `lag`. */
typedef struct {
  PetscBool inertia;
  PetscBool flows;  /* may matter with inertia yield? Then gaps are measured by what it moves */
  PetscBool moves;  /* has matter inertia, whatever the scheme remembers? */
  PetscBool yields; /* may it at all? What it strains by is no millionth then */
  PetscBool fades;  /* does it move through its nodes, in statics that have not failed lately and whose time passes? */
  PetscReal asked;  /* share of the usual that may stay of gaps */
  PetscReal leaves; /* share of what is too deep at the start of a very short step that the next one closes */
  PetscReal mean, back, lag;
} ContactShare;

typedef struct Contact {
  Walls *walls;
  PetscInt n_rigid;
  RigidWall *rigid; /* walls with mass */
  PetscInt dim, n_walls;
  PetscBool hoop;      /* do all turn about x = 0? */
  PetscBool *turns;    /* n_walls: may its normals turn within a step? See wall_turns */
  PetscInt n_partners; /* walls and interfaces */
  PetscInt sides;      /* of each that may meet one carrier: contact_sides */
  PetscInt n, capacity;
  ContactPoint *point;
  PetscInt n_nodes, capacity_nodes, *node;
  PetscInt n_anchors, capacity_anchors;
  WallAnchor *anchor;
  PetscReal *N;
  PetscReal *lead; /* what N is at the surface beyond what it is at the material point */
  PetscReal *turn; /* of bodies, dim of each: how N changes along the surface, 1/m */
  PetscInt n_slots, capacity_slots, *slot;
  PetscReal worst;  /* gap or slip when multipliers were last looked at, m */
  PetscBool begins; /* then: was nothing in contact before the step, on any rank? */
  PetscReal near;   /* m: what is farther away cannot be reached in a step */
  PetscReal length; /* of a cell, m: scale of gaps */
  ContactShare share;
  PetscBool adheres; /* does anything, in implicit steps and statics? */
  PetscBool grips;   /* for a first guess: what was in contact goes along with its wall */
  PetscReal *least;  /* n_bodies: of the contact points of each when the run is over; NULL: it is not */
  PetscBool slips;   /* is it asked what friction does not hold? */
  /* n_partners x n_bodies: of friction and adhesion where that body meets this partner; 0: it does not slide */
  PetscReal *divisor;
  WallState *wall;
  /* of this rank and step, of each wall: momentum that setting what is in contact to its velocity took */
  ContactSum *impulse;
  /* of each wall, kg: material that was pressed against one side of an open one and has gone to the other; of this rank
   * and step, and of all so far */
  PetscReal *crosses, *crossed;
  PetscReal *sunk;  /* of each partner: how deep material was in it in explicit steps before any others, m */
  PetscReal driven; /* work of these where walls move as they are told, J */
} Contact;

/* Shortest and longest that a point's part of the surface layer counts as, over its reach at the start:
 * laws of flow stretch without bound. */
#define THINNEST 0.25
#define THICKEST 2

/* Layers of nodes that a rank knows beyond those of its basis where bodies meet others: of the other
 * body's points in reach. */
#define CONTACT_HALO 2

/* Walls with mass whose mass is not known are mistakes. */
PetscErrorCode ContactCreate(const Case *c, Walls *walls, Diag *diag, Contact **contact);
PetscErrorCode ContactDestroy(Contact **contact);
/* Forget the contact points and find those of this step. The scene stands at its start. */
PetscErrorCode ContactFind(Contact *contact, const NodalScene *scene);
/* Those that were found bear what they begin the step with, as if an assembly had left them so. share: the walls'
 * forces over those of the balance. */
void contact_stand(Contact *contact, PetscReal share);
/* Before the solve of a step of dt: penalties, and how walls move. inertia: see WeakFormInput. */
void contact_prepare(Contact *contact, PetscReal t, PetscReal dt, PetscReal inertia, ContactShare share);
/* Collective. The same for another try, with less along walls and bodies, where anything rubs so much that a push along
 * one may wedge it (softer): what friction bears goes with the gap by friction times the penalty, and the gap with what
 * it bears (docs/theory.md, section 98). */
PetscErrorCode ContactSoften(Contact *contact, MPI_Comm comm, PetscBool *softer);
/* contact_alone.c. Collective. Then: how far penalties of what is bonded may rise (ContactPoint.stiffest). wide: do
 * functions reach farther than to the nodes of a cell? */
PetscErrorCode ContactFindAlone(Contact *contact, const Grid *grid, PetscBool wide);
/* contact_held.c. Then: what cannot follow a wall. Flags in the frames of nodes, increments of the step, m. */
void contact_find_held(Contact *contact, const unsigned char *fixed, const PetscReal *prescribed, const Frames *frames);
/* Where the wall's matter goes by `way`, by how much it has passed the point at the end of the step, m; let: what of
 * that way held nodes let pass. */
PetscReal contact_let_pass(const ContactPoint *c, const PetscReal way[3], PetscReal let[3]);
/* By what `let` changes with a motion more of the wall's matter. */
void contact_lets(const ContactPoint *c, const PetscReal motion[3], PetscReal let[3]);
/* Forget what impulses have done in a step, or in a try of it that has failed: a try begins. */
void contact_again(Contact *contact);
/* How far the surface is from point p at a distance `gap` from the wall, as the last step has left it, m. A corner that
 * turns with its body is as far ahead as it has come to be. Of what nothing is known, as strain has it. */
PetscReal contact_reach_left(const NodalScene *scene, PetscInt p, const PetscReal *kept, const PetscReal n[3],
                             PetscReal gap);
/* By how much the wall has passed a surface that is `gap` from it, as the last step has left it, m: a spring of
 * explicit dynamics that let it in, in whichever layer of points, is gone, and it stands where it stood; what pulled
 * it, too, where it is bonded. */
PetscReal contact_behind_left(const NodalScene *scene, ContactKind kind, const PetscReal *kept, PetscReal gap);
/* Was it such a spring that the wall passed it by? */
PetscBool contact_let_in(const NodalScene *scene, const PetscReal *kept, PetscReal behind);
/* What else the room finds: contact points with nodes, and the surface of a part of a body. */
PetscErrorCode ContactAdd(Contact *contact, ContactPoint **c);
PetscErrorCode ContactAddNodes(Contact *contact, ContactPoint *c, PetscInt n);
PetscReal contact_reach(const PetscReal F[9], const PetscReal n[3], PetscReal first, const PetscReal *corner,
                        PetscInt dim);
/* Of material point p, as it is now, and at most, m. */
PetscReal contact_reach_of(const Points *points, PetscInt p, const PetscReal n[3]);
PetscReal contact_farthest(const Points *points, PetscInt p);
/* At the start: it is made to fit, and reaches no farther towards n. */
void contact_take_back(Points *points, PetscInt p, const PetscReal n[3], PetscReal reach);
/* At the start: it stands on what is ahead of it, beside a nearer side, and reaches as far towards n. */
void contact_let_reach(Points *points, PetscInt p, const PetscReal n[3], PetscReal reach);
/* What the carrier kept of its contact with a partner. */
void contact_remember(ContactPoint *c, PetscInt dim, const PetscReal *kept, const PetscReal normal[3]);
/* contact_side.c. The side of wall k on which point p is, 1 or -1: where it came from, as long as it is where the last
 * substep sent it; 0: see wall_side. Then, of what had sunk in: it sees n places of the wall from `side`; has it left
 * the side that it came from, through the wall? */
int contact_side(const Contact *contact, const NodalScene *scene, PetscInt p, PetscInt k);
void contact_note_crossing(Contact *contact, const NodalScene *scene, PetscInt p, PetscInt k, int side, PetscInt n);
/* contact_corner.c. Which slots the sides of wall k before point p have of what p remembers, and what these remember of
 * them: of new ones nothing. */
void contact_find_slots(const Contact *contact, const Points *points, PetscInt p, PetscInt k, PetscInt n,
                        const WallPlace *place, PetscInt slot[WALL_SIDES], const PetscReal *kept[WALL_SIDES]);
/* In a corner each side goes on as it is at the start of the step: what is nearest may change from one to another. */
PetscErrorCode ContactAnchor(Contact *contact, const NodalScene *scene, const WallPlace *place, ContactPoint *c);
/* Its law; then its section, m2, and what adheres on that. */
void contact_take_law(const Contact *contact, const NodalScene *scene, ContactPoint *c);
void contact_take_section(const Contact *contact, const NodalScene *scene, PetscReal section, ContactPoint *c);
/* It begins with the force, N, or what of it its law bears; open where that is nothing. */
void contact_press(ContactPoint *c, const PetscReal force[3]);
/* What touches at the start is pressed by the stress that the material was given; of carriers that kept nothing. */
void contact_start(const NodalScene *scene, ContactPoint *c);
/* Is a contact point with this gap at the start of the step none? Says whether it touches. */
PetscBool contact_passes(const Contact *contact, ContactPoint *c, PetscReal gap, PetscBool first);
/* Collective. Those between bodies. */
PetscErrorCode ContactFindBodies(Contact *contact, const NodalScene *scene);
/* touch/section.c. Surface that material point p stands for before a wall with the normal n, as the point is now, m2.
 * radius: of the point and of that surface, m. */
PetscReal contact_section(const NodalScene *scene, PetscInt p, const PetscReal n[3], const PetscReal radius[2]);
/* Of the surface of its body that material point p was given (POINT_FACE) what looks at a wall with the normal n now,
 * as large as it was at the start, m2 (in rings m); 0: none. */
PetscReal contact_face(const Points *points, PetscInt p, const PetscReal n[3]);
/* Does material point p stand at the surface of its body that looks at n, for all that it knows? What has flowed
 * may. */
PetscBool contact_is_surface(const NodalScene *scene, PetscInt p, const PetscReal n[3]);
/* Is it there, or behind it, as what stands beside a side that looks elsewhere is, however its body tilts? Of what has
 * flowed nobody knows. */
typedef enum { CONTACT_ANYWHERE, CONTACT_OUTSIDE, CONTACT_INSIDE } ContactDepth;
ContactDepth contact_depth(const NodalScene *scene, PetscInt p, const PetscReal n[3]);
/* Has the square of an edge's length, or the cosine of an angle, at point p changed by `limit` since the start? */
PetscBool contact_is_strained(const Points *points, PetscInt p, PetscReal limit);
/* How far the increments take it against its wall, or the other body, m. */
PetscReal contact_went(const Contact *contact, const ContactPoint *c, const PetscReal *du);
/* Position of a contact point with the field's increments, times `whole`. */
void contact_place(const Contact *contact, const ContactPoint *c, const PetscReal *du, PetscReal whole, PetscReal x[3]);

/* Does wall k meet this body? */
PetscBool contact_meets_body(const Case *c, PetscInt k, PetscInt body);
/* Collective. Which contact points touch after the step (ContactPoint.covered), with or without a force. */
PetscErrorCode ContactCover(Contact *contact, const Grid *grid);
/* Collective. What these may bear by adhesion, those bear that have the force beside them: at the start of the step, or
 * at the last assembly. changed: by how much bonds are others now, over the largest. */
PetscErrorCode ContactLend(Contact *contact, const Grid *grid, PetscBool starts, PetscReal *changed);

/* What a wall does to the surface of the material at one place. */
typedef struct {
  PetscReal x[3], normal[3];    /* at the end of the step, m; that of its force */
  PetscReal pressure, shear[3]; /* Pa: along the normal, across it */
  PetscReal section, force[3];  /* of the contact point alone, m2, N */
} ContactTraction;

/* Collective. Tractions of one wall at this rank's points in contact, freed with PetscFree. du: increments of
 * the last step; share: the walls' forces over those of the balance (touch/traction.c). */
PetscErrorCode ContactTractions(const Contact *contact, const Grid *grid, PetscInt wall, const PetscReal *du,
                                PetscReal share, PetscInt *n, ContactTraction **tractions);

/* A mass matrix that is not diagonal. */
typedef struct {
  /* Collective. product = M x, n_nodes x dim, on owners; x is right on all copies. */
  PetscErrorCode (*multiply)(void *context, const PetscReal *x, PetscReal *product);
  void *context;
  const PetscReal *diagonal; /* n_nodes, on owners, kg */
} ContactMass;

/* What a projection works with; arrays go over local nodes. */
typedef struct {
  const Grid *grid;
  const PetscReal *mass;      /* n_nodes, kg */
  const ContactMass *whole;   /* of which that is the lumped one; NULL: that is all */
  const unsigned char *fixed; /* n_nodes x dim: dofs that do not take part, in the frames of nodes that slide */
  const Frames *frames;
  PetscReal *motion;   /* n_nodes x dim: velocity or acceleration, changed */
  PetscReal *given;    /* n_nodes x dim: what that takes from the boundary at prescribed dofs is added, on owners */
  const PetscReal *du; /* increments of the step */
  PetscReal time;      /* now, s: walls that go as they are told have their velocity of this instant, */
  PetscReal glance;    /* as the next so many s, or, < 0, the last ones, show it */
  PetscReal rate;      /* times an increment of the step it is a mean velocity */
  PetscBool pulls;     /* may the wall pull? Else only what moves into it is stopped */
  PetscBool start;     /* of those in contact before the step, or of those in contact after it? */
  PetscBool jumps;     /* of walls alone that go as they are told, are new, or have another velocity than before? */
} ContactMotion;

/* Collective. The least change, by mass, of nodal motion that lets points in contact go with their
 * wall: in the direction of the normal, and across it where they stick. sum: momentum (or force) that
 * it takes from each wall (n_walls of them, on this rank). */
PetscErrorCode ContactProject(Contact *contact, const ContactMotion *motion, ContactSum *sum);
/* contact_rigid.c. Collective. What contact does to walls with mass, in the terms of `rigid`. */
PetscErrorCode RigidSums(Contact *contact, const NodalScene *scene);
/* Collective. A stage begins: what the contact points, found there, bore in the last step holds them, and fades. */
PetscErrorCode RigidHold(Contact *contact, const NodalScene *scene);
/* Collective. At the increments of the last assembly, for n = RIGID n_rigid unknowns of walls: of this rank the
 * derivatives of the nodes' residual by them, B, and of theirs by du, C (n x n_nodes x dim each, zero on entry); D:
 * of theirs by themselves, n x n, of all ranks. Those that a wall does not have are 1 on the diagonal. */
PetscErrorCode RigidTangent(Contact *contact, const NodalScene *scene, PetscReal *B, PetscReal *C, PetscReal *D);
/* In statics that holds motions which nothing resists where they are: along which unknown of the wall does most act of
 * such? -1: nothing does. */
int rigid_adrift(const RigidWall *wall);
/* The law at the present increments; tangent: by the motion of the contact point, or NULL.
 * PETSC_FALSE where there is no contact. */
PetscBool contact_meets(const Contact *contact, ContactPoint *c, const NodalScene *scene, ContactTangent *tangent);
/* contact_force.c, contact_multiplier.c: what the nodal force does. */
PetscErrorCode ContactAssemble(void *contact, const NodalScene *scene, const NodalOutput *out);
PetscErrorCode ContactAugment(void *contact, const NodalScene *scene, PetscInt change, PetscBool *again);
/* Is it in contact, or touches what it may press, when the step begins? */
static inline PetscBool contact_touched(const ContactPoint *c)
{
  return (PetscBool)(c->touches || c->before != CONTACT_OPEN);
}
static inline PetscReal contact_last(const ContactPoint *c)
{
  return PetscSqrtReal(PetscSqr(c->last[0]) + PetscSqr(c->last[1]) + PetscSqr(c->last[2]));
}
/* Does it hold? A wall that only pushes may turn out to hold one way alone: whoever asks looks again after the run
 * (ModelWarnLoose), when what touches and bears next to nothing has been left behind, but for round-off, if it is
 * not bonded; before, what touches may still come to bear. */
static inline PetscBool contact_bears(const ContactPoint *c)
{
  return (PetscBool)(contact_touched(c) && (c->law.kind == CONTACT_BONDED || contact_last(c) >= c->least));
}
/* Collective. The run is over, until `least` is freed, and the contact points are those that it ends with. force
 * (n_bodies): the largest that stress asks of a point of each body on this rank, N. */
PetscErrorCode ContactIsOver(Contact *contact, const NodalScene *scene, const PetscReal *force);
/* What its owner keeps of it. */
static inline PetscReal *contact_kept_of(const Contact *contact, const Points *points, const ContactPoint *c)
{
  return contact_kept(points, c->owner, c->wall, contact->sides, c->slot_kept);
}
/* The wall with mass that it meets, or NULL. */
static inline RigidWall *contact_rigid(const Contact *contact, const ContactPoint *c)
{
  return rigid_of(contact->rigid, contact->n_rigid, c->wall);
}
void contact_force(const ContactPoint *c, PetscReal f[3]); /* of the last assembly */
/* Likewise, without what the start of the step was lent of it. */
void contact_acts(const ContactPoint *c, PetscReal f[3]);
/* Likewise, what of it stands in the balance at the end of the step. */
void contact_balance(const Contact *contact, const ContactPoint *c, PetscReal f[3]);
/* Share of the force that nodes are to remember: what of it pressed in the last step, too. */
PetscReal contact_stays(const Contact *contact, const ContactPoint *c);
/* What the acceleration at the end of the step has of it more than that, as rate of momentum, N. */
void contact_excess(const Contact *contact, const ContactPoint *c, PetscReal f[3]);
/* Collective. In statics: does a wall go away from what it touches, or a rough one along itself, so that this would
 * fall, or slide, if it stayed? */
PetscErrorCode ContactCarries(const Contact *contact, MPI_Comm comm, PetscBool *carries);
/* Collective. Does anything in contact move along its wall by more than what rests may, at the last assembly? */
PetscErrorCode ContactMoves(const Contact *contact, MPI_Comm comm, PetscBool *moves);
/* Work of the last step's forces over the gaps and slips that may stay, J; contact may be NULL. size: of a cell, m. */
PetscReal contact_unresolved(const Contact *contact, PetscReal size);
/* Of all forces of this rank at the last assembly, N2; contact may be NULL. */
PetscReal contact_square(const Contact *contact);
/* x: where it acts, m. */
void contact_add(const PetscReal x[3], PetscInt dim, const PetscReal force[3], ContactSum *sum);
