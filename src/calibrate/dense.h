/* Small dense symmetric systems, row by row: A = L L^T. */
#pragma once
#include <petscsys.h>

/* L replaces the lower triangle of a; PETSC_FALSE if a is not positive definite. */
static inline PetscBool dense_factor(PetscInt n, PetscReal *a)
{
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j <= i; ++j) {
      PetscReal sum = a[i * n + j];
      for (PetscInt k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i > j) a[i * n + j] = sum / a[j * n + j];
      else if (sum > 0) a[i * n + i] = PetscSqrtReal(sum);
      else return PETSC_FALSE;
    }
  return PETSC_TRUE;
}

/* x <- L^-1 x */
static inline void dense_forward(PetscInt n, const PetscReal *l, PetscReal *x)
{
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
}

/* x <- L^-T x */
static inline void dense_backward(PetscInt n, const PetscReal *l, PetscReal *x)
{
  for (PetscInt i = n - 1; i >= 0; --i) {
    x[i] /= l[i * n + i];
    for (PetscInt k = 0; k < i; ++k) x[k] -= l[i * n + k] * x[i];
  }
}

static inline PetscReal dense_dot(PetscInt n, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0;
  for (PetscInt i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}
