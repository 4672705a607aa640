/* Local maximum entropy (Arroyo and Ortiz 2006): N_I = w_I exp(-beta r_I^2 + lambda.d_I) / Z,
 * lambda such that sum N_I d_I = 0, found as the minimum of the convex function ln Z(lambda). */
#pragma once
#include "basis/cloud/cloud.h"
#include "basis/cloud/cloud_kernels.h"

/* dual: lambda times h, or NULL. */
CloudStatus lme_evaluate(const CloudBasis *basis, int dim, PetscReal h, Cloud *cloud, PetscReal *N, PetscReal *dN,
                         PetscReal *condition, PetscReal *dual);
