/* What holds nodes that points hardly reach, apart from all other forces. `in` needs support, soft, du, x and
 * lattice. */
#pragma once
#include "formulation/formulation.h"

/* Adds the forces (n_nodes x dim, N) that grow with the increments du. */
void holding_forces(const WeakFormInput *in, PetscInt dim, PetscReal *force);

/* Half of these forces times du, over this rank's points, J. */
PetscReal holding_work(const WeakFormInput *in, PetscInt dim);
