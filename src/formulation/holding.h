/* What holds nodes that points hardly reach, apart from all other forces. */
#pragma once
#include "formulation/formulation.h"

/* Adds the forces (n_nodes x dim) that grow with the increments du; in needs support, soft, du, x and lattice. */
PetscErrorCode HoldingForces(const WeakFormInput *in, PetscInt dim, PetscReal *force);
