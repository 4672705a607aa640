/* What is out of balance when a stage begins, held by forces on nodes that fade (docs/theory.md, "Stages"). */
#pragma once
#include "solve/forces/nodal_force.h"

/* Forces that hold every node in balance at the start, N: n_nodes x dim, those of owned nodes count; NULL
 * where the case releases nothing over time. The caller fills them in. */
PetscReal *release_forces(const NodalForces *forces);
/* The share of them that acts at time t. */
PetscReal release_share(const Case *c, PetscReal t);
