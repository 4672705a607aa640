/* Eigenvalues and eigenvectors of eight symmetric 3 x 3 tensors side by side: base/math/eigen.h,
 * number for number. A lane that needs no more turns is left as it is, so that its result does not
 * depend on its neighbours. */
#pragma once
#include "base/math/eigen.h"
#include "base/math/lanes.h"

LANES_INLINE int lanes_eigen_rotate(int p, int q, Lanes a[6], Lanes v[9])
{
  const int r = 3 - p - q, pq = voigt_of[p][q], pr = voigt_of[p][r], qr = voigt_of[q][r];
  const Lanes product = a[p] * a[q], none = {0};
  Lanes size, root, t;
  lanes_abs(&product, &size);
  const LaneBits turns = (a[pq] * a[pq] > 1e-36 * size) & (a[pq] != none);
  if (!lanes_any(&turns)) return 0;
  const Lanes h = 0.5 * (a[q] - a[p]), square = h * h + a[pq] * a[pq];
  lanes_sqrt(&square, &root);
  lanes_abs(&h, &size);
  const LaneBits sign = (LaneBits)h & INT64_MIN;
  t = (Lanes)((LaneBits)(a[pq] / (size + root)) ^ sign);
  lanes_select(&turns, &t, &none, &t);
  const Lanes norm2 = 1.0 + t * t;
  lanes_sqrt(&norm2, &root);
  const Lanes c = 1.0 / root, s = t * c, apr = a[pr], aqr = a[qr];
  a[p] -= t * a[pq];
  a[q] += t * a[pq];
  lanes_select(&turns, &none, &a[pq], &a[pq]);
  a[pr] = c * apr - s * aqr;
  a[qr] = s * apr + c * aqr;
  for (int i = 0; i < 9; i += 3) {
    const Lanes vp = v[i + p], vq = v[i + q];
    v[i + p] = c * vp - s * vq;
    v[i + q] = s * vp + c * vq;
  }
  return 1;
}

LANES_INLINE void lanes_eigen_swap(int p, int q, Lanes value[3], Lanes v[9])
{
  const LaneBits wrong = value[p] < value[q];
  if (!lanes_any(&wrong)) return;
  Lanes kept = value[p];
  lanes_select(&wrong, &value[q], &value[p], &value[p]);
  lanes_select(&wrong, &kept, &value[q], &value[q]);
  for (int i = 0; i < 9; i += 3) {
    kept = v[i + p];
    lanes_select(&wrong, &v[i + q], &v[i + p], &v[i + p]);
    lanes_select(&wrong, &kept, &v[i + q], &v[i + q]);
  }
}

/* s = sum value[A] n_A n_A, value falling, n_A = column A of v. */
LANES_INLINE void lanes_sym_eigen(const Lanes s[6], Lanes value[3], Lanes v[9])
{
  const Lanes zero = {0};
  Lanes a[6];
  for (int k = 0; k < 6; ++k) a[k] = s[k];
  for (int k = 0; k < 9; ++k) v[k] = zero + (k % 4 == 0 ? 1.0 : 0.0);
  for (int sweep = 0, turned = 1; turned && sweep < EIGEN_SWEEPS; ++sweep) {
    turned = lanes_eigen_rotate(0, 1, a, v);
    turned += lanes_eigen_rotate(0, 2, a, v);
    turned += lanes_eigen_rotate(1, 2, a, v);
  }
  for (int k = 0; k < 3; ++k) value[k] = a[k];
  lanes_eigen_swap(0, 1, value, v);
  lanes_eigen_swap(1, 2, value, v);
  lanes_eigen_swap(0, 1, value, v);
}
