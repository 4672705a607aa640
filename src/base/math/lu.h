/* Small dense systems without symmetry. */
#pragma once
#include <petscsys.h>

static inline void lu_swap_rows(PetscInt n, PetscInt a, PetscInt b, PetscReal *A)
{
  for (PetscInt j = 0; a != b && j < n; ++j) {
    const PetscReal kept = A[a * n + j];
    A[a * n + j] = A[b * n + j];
    A[b * n + j] = kept;
  }
}

/* b = A^-1 b by elimination with the largest pivot of each column; A (n x n, row by row) is lost.
 * PETSC_FALSE if it is singular or holds something that is no number. */
static inline PetscBool lu_solve(PetscInt n, PetscReal *restrict A, PetscReal *restrict b)
{
  for (PetscInt k = 0; k < n; ++k) {
    PetscInt pivot = k;
    for (PetscInt i = k + 1; i < n; ++i)
      if (PetscAbsReal(A[i * n + k]) > PetscAbsReal(A[pivot * n + k])) pivot = i;
    if (!(PetscAbsReal(A[pivot * n + k]) > 0)) return PETSC_FALSE;
    lu_swap_rows(n, k, pivot, A);
    const PetscReal first = b[pivot];
    b[pivot] = b[k];
    b[k] = first;
    for (PetscInt i = k + 1; i < n; ++i) {
      const PetscReal factor = A[i * n + k] / A[k * n + k];
      if (factor == 0) continue; /* most of a sparse matrix's */
      for (PetscInt j = k + 1; j < n; ++j) A[i * n + j] -= factor * A[k * n + j];
      b[i] -= factor * first;
    }
  }
  for (PetscInt i = n; i-- > 0;) {
    for (PetscInt j = i + 1; j < n; ++j) b[i] -= A[i * n + j] * b[j];
    b[i] /= A[i * n + i];
  }
  return PETSC_TRUE;
}
