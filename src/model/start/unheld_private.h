/* Rigid motions that nothing holds, for start/unheld.c, start/turning.c and start/advice/held.c. */
#pragma once
#include "model/model_private.h"

#define RIGID 6

/* Which of those that touch at interfaces, or both touch a wall with mass, move as one? None, those that rub or are
 * bonded, all. */
typedef enum { MEET_NONE, MEET_ROUGH, MEET_ALL } MeetKind;
/* Collective. of (n_nodes, 0 on entry): of the bodies that share nodes, directly or through others, or that move as one
 * at what they touch, the first one's number from 1 on, where they touch the node. */
PetscErrorCode JoinedBodies(const Model *model, MeetKind meet, PetscReal *of);
/* Does the contact point make both sides one? */
static inline PetscBool meet_as_one(MeetKind meet, const ContactPoint *c)
{
  return (PetscBool)(meet == MEET_ALL || (meet == MEET_ROUGH && c->law.kind != CONTACT_FRICTIONLESS));
}

/* Bodies that move as one, since they touch the same nodes, and the rigid motions that are left to them. */
typedef struct {
  PetscInt body;                   /* the first of them */
  const PetscReal *of;             /* n_nodes: body + 1 where they touch the node */
  MeetKind meet;                   /* which of those that touch move as one, too? */
  PetscReal centre[3], size, mass; /* m; half of their diagonal; the largest of a node, kg */
  PetscReal plane[3];              /* nodes held along axis d stand at x_d = plane, if they can, m */
  PetscBool has_plane[3];
  PetscInt n, n_free;           /* rigid motions of these kinematics, and how many are free: */
  PetscReal free[RIGID][RIGID]; /* orthonormal, as many along the axes and about the centre times 1 / size */
} UnheldGroup;

static inline PetscBool unheld_is_of(const UnheldGroup *g, PetscInt node)
{
  return (PetscBool)(g->of[node] == (PetscReal)(g->body + 1));
}

/* What each rigid motion moves the node by along an axis: of the frame w, NULL: of space. */
void unheld_row(const Model *model, const UnheldGroup *g, PetscInt node, PetscInt axis, const PetscReal *w,
                PetscReal row[RIGID]);
/* Adds to sum (n x n) squares of what motions move a place of a wall by where that holds it: against the wall, and
 * along it if it rubs. */
void unheld_add_place(const Model *model, const UnheldGroup *g, const PetscReal *x, const PetscReal normal[3],
                      PetscBool rubs, PetscReal *sum);
/* Collective. What such a sum, of this rank, holds is not free. */
PetscErrorCode UnheldTake(const Model *model, UnheldGroup *g, PetscReal *sum);
/* Collective. Calls back for each group that has a motion free, in the order of their bodies. meet: which of those that
 * touch move as one, too; each is to others what a wall is. */
PetscErrorCode UnheldEach(Model *model, MeetKind meet, Diag *diag,
                          PetscErrorCode (*visit)(Model *model, UnheldGroup *g, Diag *diag));
/* Of its free motions those are left that do not turn it. */
void unheld_keep_from_turning(const Model *model, UnheldGroup *g);
/* "in x and y, and from turning" */
void unheld_name_free(const Model *model, const UnheldGroup *g, char text[64]);
/* What loads and gravity push component i of the nodes with, N: m->nodes->external is known. */
static inline PetscReal unheld_load(const Model *m, const PetscReal gravity[3], PetscInt i)
{
  return m->nodes->external[i] + m->nodes->mass[i / m->dim] * gravity[i % m->dim];
}
