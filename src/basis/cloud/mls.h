/* Moving least squares: N_I = p(0)^T M^-1 p_I w_I with M = sum w p p^T, polynomials p relative to
 * the point. */
#pragma once
#include "basis/cloud/cloud.h"
#include "basis/cloud/cloud_kernels.h"

CloudStatus mls_evaluate(const CloudBasis *basis, int dim, PetscReal h, Cloud *cloud, PetscReal *N, PetscReal *dN,
                         PetscReal *condition);
/* Number of polynomials. */
int mls_functions(CloudOrder order, int dim);
