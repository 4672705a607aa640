/* Rigid motions of the nodes: what multigrid must be told of, or it coarsens a body as if each of its
 * directions were a membrane. */
#pragma once
#include "solve/system/system.h"

/* Collective. Of the active nodes, dim unknowns each, orthonormal, in the frames of the nodes. */
PetscErrorCode RigidMotions(const System *system, const Grid *grid, MatNullSpace *rigid);
