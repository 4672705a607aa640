/* What gmm remembers between steps, for this room only. */
#pragma once
#include "grid/cloud/cloud.h"
#include "method/method.h"

typedef struct {
  PetscBool constraints;       /* prescribed motion by multipliers? else on the nodes themselves */
  Support *tracers, *carriers; /* clouds of points without mass */
  /* clouds of owned nodes that are no twins, in their order; empty where no prescribed node is
   * near and no constraint needs them */
  Support *nodes;
  PetscInt layouts; /* state of the cloud that the arrays of this room fit */
  PetscInt *twin;   /* n_owned: local number of the node's twin, -1 if it has none */
} Gmm;

static inline Gmm *gmm_of(const Discretisation *space) { return space->own; }

/* Places of this rank where bodies may meet others in the step, with the velocity field of the other one. */
typedef struct {
  PetscInt n, *field;
  PetscReal *x; /* n x dim */
} MeetingPlaces;

/* gmm_meet.c. Collective. On one rank, which knows all nodes, there are none. */
PetscErrorCode MeetingPlacesFind(const Discretisation *space, MeetingPlaces *places);
PetscErrorCode MeetingPlacesDestroy(MeetingPlaces *places);
/* How far from there nodes are that may carry the other body's surface, m. */
PetscReal meeting_reach(const Discretisation *space);
/* use[k] for those remote nodes that are within reach of them in the other one's field. */
PetscErrorCode MeetingPlacesUse(const MeetingPlaces *places, const Discretisation *space, PetscReal reach,
                                const RemoteNodes *remote, PetscBool *use);

/* Collective. Ghosts, clouds and constraints for where nodes and points are now; touched nodes
 * too. */
PetscErrorCode GmmGather(Discretisation *space);
/* Collective. Clouds are new: nodes take what their points carried, and prescribed nodes the rest
 * as an impulse. */
PetscErrorCode GmmCarry(Discretisation *space);
/* Collective. If clouds have grown too ragged, cut space anew and send nodes and points to their
 * new ranks. */
PetscErrorCode GmmBalance(Discretisation *space);
/* Collective. Do that now. */
PetscErrorCode GmmRedistribute(Discretisation *space);
/* Collective. Groups of nodes that the next steps may couple: near points and constraints. */
PetscErrorCode GmmCouplings(const Discretisation *space, NodeGroups *groups);
