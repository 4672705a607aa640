/* What gmm remembers between steps, for this room only. */
#pragma once
#include "method/method.h"

typedef struct Gmm {
  PetscBool constraints;       /* prescribed motion by multipliers? else on the nodes themselves */
  Support *tracers, *carriers; /* clouds of points without mass */
  Support
    *nodes; /* clouds of owned nodes that are no twins, in their order; empty where no prescribed node is near and no
                               * constraint needs them */
  PetscInt layouts; /* state of the cloud that the arrays of this room fit */
  PetscInt *twin;   /* n_owned: local number of the node's twin, -1 if it has none */
} Gmm;

/* Collective. Ghosts, clouds and constraints for where nodes and points are now; touched nodes too. */
PetscErrorCode GmmGather(Stage *stage);
/* Collective. Clouds are new: nodes take what their points carried, and prescribed nodes the rest as an impulse. */
PetscErrorCode GmmCarry(Stage *stage);
/* Collective. If clouds have grown too ragged, cut space anew and send nodes and points to their new ranks. */
PetscErrorCode GmmBalance(Stage *stage);
/* Collective. Do that now. */
PetscErrorCode GmmRedistribute(Stage *stage);
/* Collective. Groups of nodes that the next steps may couple: near points and constraints. */
PetscErrorCode GmmCouplings(const Stage *stage, NodeGroups *groups);
