/* What every basis must do, whatever it is made of: cells, moving least squares, local maximum
 * entropy...
 *
 * Fill a BasisUnderTest and call basis_suite_run() inside a cmocka test. A failure names the
 * basis. */
#pragma once
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <petscsys.h>

#define BASIS_SUITE_MAX_NODES 256

typedef struct {
  const char *name;
  PetscInt dim, nodes;
  const PetscReal *x; /* node positions, nodes x dim */
  PetscInt n_samples;
  const PetscReal *sample; /* positions inside, n_samples x dim */
  PetscReal size;          /* a length typical of the node spacing, m */
  PetscReal tolerance;     /* of sums of N; gradients: over size */
  PetscReal difference;    /* relative, of gradients against differences */
  PetscBool interpolates;  /* N_a(x_b) = 1 if a = b, else 0 */
  /* N (nodes) and dN/dx (nodes x dim) at `point`; PETSC_FALSE if that failed. */
  PetscBool (*evaluate)(const void *context, const PetscReal *point, PetscReal *N, PetscReal *dN);
  const void *context;
} BasisUnderTest;

static inline void basis_suite_near(const BasisUnderTest *basis, const char *what, PetscReal value, PetscReal expected,
                                    PetscReal tolerance)
{
  if (fabs(value - expected) <= tolerance) return;
  fail_msg("%s: %s is %.17g, expected %.17g within %.2g", basis->name, what, value, expected, tolerance);
}

static inline void basis_suite_evaluate(const BasisUnderTest *basis, const PetscReal *point, PetscReal *N,
                                        PetscReal *dN)
{
  if (!basis->evaluate(basis->context, point, N, dN))
    fail_msg("%s: no shape functions at a position inside", basis->name);
}

/* sum N = 1, sum dN = 0. */
static inline void basis_suite_partition_of_unity(const BasisUnderTest *basis, const PetscReal *N, const PetscReal *dN)
{
  PetscReal sum = 0.0, gradient[3] = {0};
  for (PetscInt a = 0; a < basis->nodes; ++a) {
    sum += N[a];
    for (PetscInt d = 0; d < basis->dim; ++d) gradient[d] += dN[a * basis->dim + d];
  }
  basis_suite_near(basis, "sum of N", sum, 1.0, basis->tolerance);
  for (PetscInt d = 0; d < basis->dim; ++d)
    basis_suite_near(basis, "sum of dN", gradient[d], 0.0, basis->tolerance / basis->size);
}

/* sum N x = x, sum x dN = 1; x counted from the position itself, so that no digits go to its
 * distance from the origin. */
static inline void basis_suite_linear_reproduction(const BasisUnderTest *basis, const PetscReal *point,
                                                   const PetscReal *N, const PetscReal *dN)
{
  const PetscInt dim = basis->dim;
  for (PetscInt i = 0; i < dim; ++i) {
    PetscReal position = 0.0, gradient[3] = {0};
    for (PetscInt a = 0; a < basis->nodes; ++a) {
      const PetscReal offset = basis->x[a * dim + i] - point[i];
      position += N[a] * offset;
      for (PetscInt j = 0; j < dim; ++j) gradient[j] += offset * dN[a * dim + j];
    }
    basis_suite_near(basis, "sum of N x", position, 0.0, basis->tolerance * basis->size);
    for (PetscInt j = 0; j < dim; ++j)
      basis_suite_near(basis, "sum of x dN", gradient[j], i == j ? 1.0 : 0.0, basis->tolerance);
  }
}

/* dN against fourth-order central differences of N. */
static inline void basis_suite_gradients(const BasisUnderTest *basis, const PetscReal *point, const PetscReal *dN)
{
  static const PetscReal offset[4] = {-2, -1, 1, 2}, factor[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
  const PetscReal h = 1e-3 * basis->size;
  for (PetscInt d = 0; d < basis->dim; ++d) {
    PetscReal difference[BASIS_SUITE_MAX_NODES] = {0};
    for (int k = 0; k < 4; ++k) {
      PetscReal at[3] = {0}, N[BASIS_SUITE_MAX_NODES], unused[3 * BASIS_SUITE_MAX_NODES];
      for (PetscInt i = 0; i < basis->dim; ++i) at[i] = point[i];
      at[d] += offset[k] * h;
      basis_suite_evaluate(basis, at, N, unused);
      for (PetscInt a = 0; a < basis->nodes; ++a) difference[a] += factor[k] * N[a] / h;
    }
    for (PetscInt a = 0; a < basis->nodes; ++a)
      basis_suite_near(basis, "dN", dN[a * basis->dim + d], difference[a], basis->difference / basis->size);
  }
}

static inline void basis_suite_kronecker(const BasisUnderTest *basis)
{
  PetscReal N[BASIS_SUITE_MAX_NODES], dN[3 * BASIS_SUITE_MAX_NODES];
  for (PetscInt b = 0; b < basis->nodes; ++b) {
    basis_suite_evaluate(basis, basis->x + b * basis->dim, N, dN);
    for (PetscInt a = 0; a < basis->nodes; ++a)
      basis_suite_near(basis, "N at a node", N[a], a == b ? 1.0 : 0.0, basis->tolerance);
  }
}

static inline void basis_suite_run(const BasisUnderTest *basis)
{
  PetscReal N[BASIS_SUITE_MAX_NODES], dN[3 * BASIS_SUITE_MAX_NODES];
  assert_true(basis->nodes <= BASIS_SUITE_MAX_NODES);
  for (PetscInt s = 0; s < basis->n_samples; ++s) {
    const PetscReal *point = basis->sample + s * basis->dim;
    basis_suite_evaluate(basis, point, N, dN);
    basis_suite_partition_of_unity(basis, N, dN);
    basis_suite_linear_reproduction(basis, point, N, dN);
    basis_suite_gradients(basis, point, dN);
  }
  if (basis->interpolates) basis_suite_kronecker(basis);
}
