/* A transfer: what motion the nodes of a restored grid take from the points before a step, and what
 * motion the points take back after it. To add one: a file with a struct transfer_<name>, and a line
 * in transfers.inc (docs/theory.md, "What points and nodes hand each other"). */
#pragma once
#include "method/discretisation.h"

typedef struct Transfer {
  const char *name, *help;
  /* The floor of (2.16) as printed, which takes nothing from points (analysis.keep_velocity): can it? */
  PetscBool keeps_velocity;
  PetscBool slopes; /* do points carry gradients of their motion (POINT_SLOPE)? */
  /* Collective, phase a: v_points and a_points on all copies, from v and a of the points. Mass,
   * lumping and tie are known. */
  PetscErrorCode (*gather)(Discretisation *space);
  /* Collective: v and a of prescribed dofs have been set, the others are still v_points and
   * a_points. What the others make of that, and which impulse and force it takes. */
  PetscErrorCode (*hold)(Discretisation *space);
  /* Phase c: v and a of the points, from v1 and a1 of the nodes; they stand where they stood. */
  PetscErrorCode (*give)(Discretisation *space);
} Transfer;

extern const Transfer *const transfers[]; /* ended by NULL */
/* NULL stands for the first, the thesis's; NULL if there is none of that name. */
const Transfer *transfer_find(const char *name);

/* What transfers share. */
/* Collective. Sums of N m v and N m a of the points, on owners, in v_points and a_points. */
PetscErrorCode TransferSum(Discretisation *space);
/* The same over the mass of the nodes, on all copies. A node so far from all points that its mass
 * vanishes is at rest: its velocity counts for nothing. */
PetscErrorCode TransferMean(Discretisation *space);
/* Points take the change of the nodes' velocity, and their acceleration. */
PetscErrorCode TransferGiveChange(Discretisation *space);
