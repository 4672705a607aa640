/* Eigenvalues and eigenvectors of a symmetric 3 x 3 tensor by Jacobi rotations.
 *
 * Chosen over a closed form for its accuracy: vectors are orthonormal to rounding however close the
 * eigenvalues are, and small eigenvalues of positive definite tensors keep their relative accuracy.
 * A tensor with one known direction (plane strain: yz = zx = 0) takes a single rotation and keeps
 * that direction exactly. */
#pragma once
#include "base/math/tensor.h"
#include <math.h>

/* quadratic convergence: four are enough, tensors of 32 orders of magnitude take a few more */
#define EIGEN_SWEEPS 24
#define EIGEN_INLINE static inline __attribute__((always_inline))

/* Off-diagonals below 1e-18 of the geometric mean of the diagonal change no eigenvalue's last
 * digit. */
EIGEN_INLINE int eigen_negligible(PetscReal pp, PetscReal qq, PetscReal pq)
{
  return pq * pq <= 1e-36 * fabs(pp * qq) || pq == 0.0;
}

/* Rotate rows and columns p, q of a (Voigt) so that a_pq vanishes; columns p, q of v turn along, if there is one. */
EIGEN_INLINE int eigen_rotate(int p, int q, PetscReal a[6], PetscReal *v)
{
  const int r = 3 - p - q, pq = voigt_of[p][q], pr = voigt_of[p][r], qr = voigt_of[q][r];
  if (eigen_negligible(a[p], a[q], a[pq])) return 0;
  const PetscReal h = 0.5 * (a[q] - a[p]);
  const PetscReal t = copysign(1.0, h) * a[pq] / (fabs(h) + sqrt(h * h + a[pq] * a[pq]));
  const PetscReal c = 1.0 / sqrt(1.0 + t * t), s = t * c, apr = a[pr], aqr = a[qr];
  a[p] -= t * a[pq];
  a[q] += t * a[pq];
  a[pq] = 0.0;
  a[pr] = c * apr - s * aqr;
  a[qr] = s * apr + c * aqr;
  for (int i = 0; v && i < 9; i += 3) {
    const PetscReal vp = v[i + p], vq = v[i + q];
    v[i + p] = c * vp - s * vq;
    v[i + q] = s * vp + c * vq;
  }
  return 1;
}

EIGEN_INLINE void eigen_swap(int p, int q, PetscReal value[3], PetscReal *v)
{
  if (!(value[p] < value[q])) return;
  const PetscReal kept = value[p];
  value[p] = value[q], value[q] = kept;
  for (int i = 0; v && i < 9; i += 3) {
    const PetscReal vp = v[i + p];
    v[i + p] = v[i + q], v[i + q] = vp;
  }
}

EIGEN_INLINE void eigen_solve(const PetscReal s[6], PetscReal value[3], PetscReal *v)
{
  PetscReal a[6];
  for (int k = 0; k < 6; ++k) a[k] = s[k];
  for (int k = 0; v && k < 9; ++k) v[k] = k % 4 == 0;
  for (int sweep = 0, turned = 1; turned && sweep < EIGEN_SWEEPS; ++sweep) {
    turned = eigen_rotate(0, 1, a, v);
    turned += eigen_rotate(0, 2, a, v);
    turned += eigen_rotate(1, 2, a, v);
  }
  for (int k = 0; k < 3; ++k) value[k] = a[k];
  eigen_swap(0, 1, value, v);
  eigen_swap(1, 2, value, v);
  eigen_swap(0, 1, value, v);
}

/* s = sum value[A] n_A n_A, value falling, n_A = column A of v. */
static inline void sym_eigen(const PetscReal s[6], PetscReal value[3], PetscReal v[9]) { eigen_solve(s, value, v); }

/* The same values alone. */
static inline void sym_eigenvalues(const PetscReal s[6], PetscReal value[3]) { eigen_solve(s, value, NULL); }
