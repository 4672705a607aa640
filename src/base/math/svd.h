/* Small dense systems that may be singular: singular values by Jacobi rotations of columns
 * (Hestenes), accurate also where they are small. */
#pragma once
#include <math.h>
#include <petscsys.h>

#define SVD_MOST 12
#define SVD_SWEEPS 60

/* Turn columns p and q of A and V until those of A are orthogonal; were they not? */
static inline PetscBool svd_rotate(PetscInt n, PetscInt p, PetscInt q, PetscReal *A, PetscReal *V)
{
  PetscReal pp = 0, qq = 0, pq = 0;
  for (PetscInt i = 0; i < n; ++i) {
    pp += A[i * n + p] * A[i * n + p];
    qq += A[i * n + q] * A[i * n + q];
    pq += A[i * n + p] * A[i * n + q];
  }
  if (!(fabs(pq) > PETSC_MACHINE_EPSILON * sqrt(pp * qq))) return PETSC_FALSE;
  const PetscReal h = 0.5 * (qq - pp), t = copysign(1.0, h) * pq / (fabs(h) + hypot(h, pq));
  const PetscReal c = 1 / sqrt(1 + t * t), s = c * t;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal a = A[i * n + p], v = V[i * n + p];
    A[i * n + p] = c * a - s * A[i * n + q];
    A[i * n + q] = s * a + c * A[i * n + q];
    V[i * n + p] = c * v - s * V[i * n + q];
    V[i * n + q] = s * v + c * V[i * n + q];
  }
  return PETSC_TRUE;
}

/* A becomes A V, whose columns are orthogonal: their lengths are the singular values, in no order. */
static inline void svd_turn(PetscInt n, PetscReal *A, PetscReal *V)
{
  PetscBool turned = PETSC_TRUE;
  for (PetscInt k = 0; k < n * n; ++k) V[k] = k % (n + 1) == 0;
  for (int sweep = 0; sweep < SVD_SWEEPS && turned; ++sweep) {
    turned = PETSC_FALSE;
    for (PetscInt p = 0; p < n; ++p)
      for (PetscInt q = p + 1; q < n; ++q) turned |= svd_rotate(n, p, q, A, V);
  }
}

/* The shortest x that solves A x = b (n x n, row by row, n <= SVD_MOST; A is lost) as well as can be:
 * what singular values below `tolerance` of the largest would bring is left out. */
static inline void svd_solve(PetscInt n, PetscReal tolerance, PetscReal *A, const PetscReal *b, PetscReal *x)
{
  PetscReal V[SVD_MOST * SVD_MOST], size2[SVD_MOST], largest = 0;
  svd_turn(n, A, V);
  for (PetscInt j = 0; j < n; ++j) {
    x[j] = size2[j] = 0;
    for (PetscInt i = 0; i < n; ++i) size2[j] += A[i * n + j] * A[i * n + j];
    largest = PetscMax(largest, size2[j]);
  }
  for (PetscInt j = 0; j < n; ++j) {
    PetscReal share = 0;
    if (!(size2[j] > tolerance * tolerance * largest)) continue;
    for (PetscInt i = 0; i < n; ++i) share += A[i * n + j] * b[i];
    for (PetscInt i = 0; i < n; ++i) x[i] += V[i * n + j] * share / size2[j];
  }
}
