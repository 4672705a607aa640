/* Nonlinear elimination (Lanzkron, Rose, Wilkes 1996): where what is left of a residual stands at few
 * nodes, these are settled by themselves at every place that the line search tries, before the
 * residual of all is taken there.
 *
 * At the edge of a jet single grains come into contact and apart, many times within a step's
 * iteration, while the body behind them has converged. Equations and tolerance stay as they are. */
#pragma once
#include "solve/newton/patches/patch.h"

typedef struct {
  PetscInt dim;
  unsigned char *own;          /* n_nodes: are all its groups on this rank? */
  unsigned char *live;         /* n_nodes: may something act there besides stress that follows the increments? */
  PetscInt *place;             /* n_nodes: -1 but while something is at work */
  PetscReal *force;            /* n_nodes x dim, scratch */
  PetscInt n_patches;          /* of this rank */
  PetscBool any;               /* does some rank have one? */
  PetscInt *node, *node_start; /* nodes, patch by patch */
  PetscInt *group, *group_start;
} Elimination;

/* Collective. Arrays for the system's pattern as it is now; nothing is chosen yet. */
PetscErrorCode EliminationSetUp(Elimination *elimination, const StepProblem *problem);
/* Before a solve: forces that act on nodes in this step. */
PetscErrorCode EliminationBegin(Elimination *elimination, const StepProblem *problem);
PetscErrorCode EliminationReset(Elimination *elimination);
/* Collective. Choose the nodes at which the residual f (of active nodes, dim each; its norm over all
 * ranks) stands out, with their neighbours; none if they are not few. */
PetscErrorCode EliminationChoose(Elimination *elimination, const StepProblem *problem, const PetscReal *f,
                                 PetscReal norm);
/* From problem->du, until the residual of each patch is at most `enough`, N. */
PetscErrorCode EliminationApply(Elimination *elimination, const StepProblem *problem, PetscReal enough);
