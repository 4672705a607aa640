/* One entry for both meshfree bases, and what they share at their edges: bad input, results of a
 * failure. */
#include "basis/cloud/cloud.h"
#include "basis/cloud/cloud_kernels.h"
#include "basis/cloud/lme.h"
#include "basis/cloud/mls.h"

const char *const cloud_status_names[] = {"ok", "too few nodes", "degenerate", "outside", "no convergence"};

int cloud_minimum(const CloudBasis *basis, int dim)
{
  return basis->kind == CLOUD_LME ? dim + 1 : mls_functions(basis->order, dim);
}

static void cloud_nothing(int dim, int n, PetscReal *N, PetscReal *dN, PetscReal *condition, PetscReal *dual)
{
  *condition = PETSC_MAX_REAL;
  for (int a = 0; a < n; ++a) N[a] = 0.0;
  for (int k = 0; k < n * dim; ++k) dN[k] = 0.0;
  for (int k = 0; dual && k < dim; ++k) dual[k] = 0.0;
}

/* A NaN or an infinite distance anywhere shows in the sum of all. */
static PetscBool cloud_finite(const Cloud *cloud)
{
  Pack sum = {0};
  for (int i = 0; i < cloud->packs; ++i) sum += cloud->r2[i];
  return pack_sum(&sum) < 1e200;
}

CloudStatus cloud_basis(const CloudBasis *basis, int dim, int n, const PetscReal *X, PetscReal h, const PetscReal *x,
                        PetscReal *N, PetscReal *dN, PetscReal *condition, PetscReal *dual)
{
  Cloud cloud;
  CloudStatus status = CLOUD_TOO_FEW;
  if (n >= cloud_minimum(basis, dim) && n <= CLOUD_MAX_NODES) {
    cloud_gather(dim, n, X, h, x, &cloud);
    if (!cloud_finite(&cloud)) status = CLOUD_NO_CONVERGENCE;
    else if (basis->kind == CLOUD_LME) status = lme_evaluate(basis, dim, h, &cloud, N, dN, condition, dual);
    else status = mls_evaluate(basis, dim, h, &cloud, N, dN, condition);
  }
  if (status != CLOUD_OK) cloud_nothing(dim, n, N, dN, condition, dual);
  return status;
}
