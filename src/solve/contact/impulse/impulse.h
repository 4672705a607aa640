/* Impulses at contact points that change the motion of nodes and of walls with mass (project.c): what both ways
 * to find them, by the lumped mass (lumped.c) and by a whole mass matrix (whole.c), share. */
#pragma once
#include "solve/contact/contact.h"

/* Of what an impulse moves itself: counts as motion. What jumps once has no later step that takes the rest. */
#define SOFTENED 0.1
#define SOFTENED_ONCE 0.01

typedef struct {
  const Contact *s;
  const ContactMotion *m;
  PetscReal *p;             /* impulses, 3 per contact point */
  PetscReal *lack;          /* likewise: what the points lacked of their walls' motion at the beginning, m/s */
  PetscReal *own;           /* 1 per contact point: what a unit impulse moves itself */
  unsigned char *held;      /* 0: not at all, 1: along the normal, 3: in all directions */
  PetscInt n_held, *list;   /* contact points that are held: often a third of those that are near */
  PetscReal softened;       /* which of both */
  PetscInt rounds;          /* how often p has been sought */
  PetscReal *told;          /* 3 per contact point: velocity of a wall that goes as it is told, but for what nodes that
                             * are held let pass, m/s */
  PetscReal *arm;           /* 3 per contact point: against the centre of a wall with mass */
  PetscReal *push, *answer; /* RIGID per wall with mass: momentum, and what it changes */
  PetscReal *nodes;         /* n_nodes x dim: changes of motion; zero but for these: */
  PetscInt n_moved, *moved; /* local nodes that impulses move, on any rank */
} Projection;

static inline PetscReal impulse_dot(PetscInt n, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0;
  for (PetscInt i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

/* List what is held, after that has changed. */
void impulse_list(Projection *w);
/* Of a vector at contact point k what is held there. */
void impulse_hold(const Projection *w, PetscInt k, PetscReal *a);
/* a = A nodes at contact point k: what is held of the motion of nodes there. */
void impulse_gather(const Projection *w, const PetscReal *nodes, PetscInt k, PetscReal a[3]);
/* Collective. Walls with mass get what nodes do not: push = -B^T p, answer = M^-1 push. */
PetscErrorCode ImpulsesToWalls(Projection *w, const PetscReal *p);
/* What such changes of the walls' motion (RIGID each) are at contact point k. */
void impulse_answer(const Projection *w, const PetscReal *change, PetscInt k, PetscReal v[3]);
/* Nodal vectors without what does not take part, on owners. */
void impulse_free(const ContactMotion *m, PetscInt dim, PetscReal *nodes);
/* Collective. p, for w->lack, and once more after `held` has changed. */
PetscErrorCode ImpulsesLumped(Projection *w);
/* Collective. nodes = M^-1 A^T p, and the answers of the walls. */
PetscErrorCode ImpulsesLumpedSpread(Projection *w, const PetscReal *p);
/* Likewise by the whole matrix; nodes and answer go on from what they are. */
PetscErrorCode ImpulsesWhole(Projection *w);
PetscErrorCode ImpulsesWholeSpread(Projection *w, const PetscReal *p);
/* Collective. After it: what the boundary gives prescribed nodes against them, to w->m->given. */
PetscErrorCode ImpulsesHeld(const Projection *w);
