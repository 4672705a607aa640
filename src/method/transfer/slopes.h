/* Gradients of their motion that points carry (POINT_SLOPE): what lumped mass does not see of a
 * rotation (docs/theory.md, "What points and nodes hand each other"). */
#pragma once
#include "method/discretisation.h"

/* sum += what the lumped share of the mass and the ties of cells that are not full have of the
 * points' linear motions, n_nodes x (2 dim), velocity and acceleration of a node behind each other:
 *
 *   sum_p l_g m N_I G_p (x_I - x_p) + t_g G_g (x_I - mean_g x) */
void slopes_gather(const Discretisation *space, PetscReal *sum);
/* Those of the nodes' motion v1, a1 at the end of the step, where its du has brought the points:
 *
 *   G_p := l_g (G_p - grad v~) + grad v1 dF^-1, of the acceleration grad a1 dF^-1
 *
 * v~: as the nodes gathered it. */
void slopes_give(Discretisation *space);
/* Collective. G of points that had none, of their velocities. linear: did a transfer keep these linear over cells? */
PetscErrorCode SlopesStart(Discretisation *space, PetscBool linear);
