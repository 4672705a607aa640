/* Small systems without symmetry whose entries stand in a band. */
#pragma once
#include <petscsys.h>

/* Numbers of a row: columns i - band .. i + 2 band of row i, the last `band` for rows that change places. */
static inline PetscInt lu_width(PetscInt band) { return 3 * band + 1; }

/* Where column j of row i stands. */
static inline PetscInt lu_at(PetscInt band, PetscInt i, PetscInt j) { return i * lu_width(band) + j - i + band; }

/* Rows k and `pivot` change places, from column k to `end`. */
static inline void lu_swap(PetscInt band, PetscInt k, PetscInt pivot, PetscInt end, PetscReal *A, PetscReal *b)
{
  for (PetscInt j = k; pivot != k && j < end; ++j) {
    const PetscReal kept = A[lu_at(band, k, j)];
    A[lu_at(band, k, j)] = A[lu_at(band, pivot, j)];
    A[lu_at(band, pivot, j)] = kept;
  }
  const PetscReal first = b[pivot];
  b[pivot] = b[k];
  b[k] = first;
}

/* sum_j a_j b_j in four parts, none of which waits for another. */
static inline PetscReal lu_sum(PetscInt n, const PetscReal *a, const PetscReal *b)
{
  PetscReal part[4] = {0, 0, 0, 0};
  PetscInt j = 0;
  for (; j + 4 <= n; j += 4)
    for (int l = 0; l < 4; ++l) part[l] += a[j + l] * b[j + l];
  for (; j < n; ++j) part[0] += a[j] * b[j];
  return (part[0] + part[1]) + (part[2] + part[3]);
}

/* b = A^-1 b by elimination with the largest pivot of each column. A (n rows of lu_width, zero beyond the band and
 * n; band < n for a full matrix) is lost. PETSC_FALSE if it is singular or holds something that is no number. */
static inline PetscBool lu_solve(PetscInt n, PetscInt band, PetscReal *restrict A, PetscReal *restrict b)
{
  PetscInt end = 0; /* of the rows above, at the most */
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt rows = PetscMin(n, k + band + 1);
    PetscInt pivot = k;
    for (PetscInt i = k + 1; i < rows; ++i)
      if (PetscAbsReal(A[lu_at(band, i, k)]) > PetscAbsReal(A[lu_at(band, pivot, k)])) pivot = i;
    if (!(PetscAbsReal(A[lu_at(band, pivot, k)]) > 0)) return PETSC_FALSE;
    end = PetscMax(end, PetscMin(n, pivot + band + 1));
    lu_swap(band, k, pivot, end, A, b);
    const PetscReal *top = A + lu_at(band, k, k);
    for (PetscInt i = k + 1; i < rows; ++i) {
      PetscReal *row = A + lu_at(band, i, k);
      const PetscReal factor = row[0] / top[0];
      if (factor == 0) continue; /* most of a sparse matrix's */
      for (PetscInt j = 1; j < end - k; ++j) row[j] -= factor * top[j];
      b[i] -= factor * b[k];
    }
  }
  for (PetscInt i = n; i-- > 0;) {
    const PetscReal *row = A + lu_at(band, i, i);
    b[i] = (b[i] - lu_sum(PetscMin(n, i + 2 * band + 1) - i - 1, row + 1, b + i + 1)) / row[0];
  }
  return PETSC_TRUE;
}
