/* Eigenvalues of symmetric 3 x 3 tensors and what projects on their axes, n_A n_A, in closed form, without turns: for
 * functions of such tensors that need no axes, in a third of the time of base/math/eigen_lanes.h.
 *
 * The eigenvalue that is farthest from the mean is found first, from J2 and J3 of the deviator d: it is well apart
 * from the others, so that it and its axis have all digits (Scherzinger and Dohrmann, 2008, begin with it, too):
 *
 *   eta = +- 2 q c,  q = sqrt(J2 / 3),  4 c^3 - 3 c = |J3| / 2 q^3,  n n = adj(d - eta) / tr adj(d - eta)
 *
 * What is left, D = d + eta/2 - 3/2 eta n n = delta (n_B n_B - n_C n_C), may be as small as rounding where two
 * eigenvalues are alike; then n_B and n_C mean nothing, but no function feels which they are. */
#pragma once
#include "base/math/lanes.h"

#define ALIKE_BELOW 1e-15 /* a deviator of this share of the mean is none */

/* Largest root c of 4 c^3 - 3 c = x, 0 <= x <= 1: to 1e-8 by a polynomial, to rounding by a step of Newton's. */
LANES_INLINE void lanes_third_of_angle(const Lanes *x, Lanes *c)
{
  static const PetscReal fit[8] = {0.8660254148,   0.1666651913,   -0.04807964781,  0.02440584058,
                                   -0.01432729707, 0.007718813557, -0.002961986951, 0.0005536798055};
  const Lanes v = *x, v2 = v * v, v4 = v2 * v2;
  const Lanes low = (fit[0] + v * fit[1]) + v2 * (fit[2] + v * fit[3]),
              high = (fit[4] + v * fit[5]) + v2 * (fit[6] + v * fit[7]);
  const Lanes guess = low + v4 * high, square = guess * guess;
  *c = guess - (guess * (4.0 * square - 3.0) - v) / (12.0 * square - 3.0);
}

/* The deviator's second and third invariants. */
LANES_INLINE void lanes_invariants(const Lanes d[6], Lanes *J2, Lanes *J3)
{
  const Lanes xy = d[3] * d[3], yz = d[4] * d[4], zx = d[5] * d[5];
  *J2 = 0.5 * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) + (xy + yz + zx);
  *J3 = d[0] * (d[1] * d[2] - yz) - d[3] * (d[3] * d[2] - d[4] * d[5]) + d[5] * (d[3] * d[4] - d[1] * d[5]);
}

/* n n of the eigenvalue eta of d, which is apart from the others; who is `alike` along all axes has x. */
LANES_INLINE void lanes_projection(const Lanes d[6], const Lanes *eta, const LaneBits *alike, Lanes nn[6])
{
  const Lanes one = (Lanes){0} + 1.0, none = {0}, x = d[0] - *eta, y = d[1] - *eta, z = d[2] - *eta;
  const Lanes adj[6] = {y * z - d[4] * d[4],    x * z - d[5] * d[5],    x * y - d[3] * d[3],
                        d[4] * d[5] - d[3] * z, d[3] * d[5] - d[4] * x, d[3] * d[4] - d[5] * y};
  const Lanes per_trace = 1.0 / (adj[0] + adj[1] + adj[2]);
  for (int k = 0; k < 6; ++k) {
    const Lanes one_of = adj[k] * per_trace;
    lanes_select(alike, k == 0 ? &one : &none, &one_of, &nn[k]);
  }
}

/* s: 11 22 33 12 23 13; value falling; first, last: n_A n_A of the largest and of the smallest. */
LANES_INLINE void lanes_sym_projections(const Lanes s[6], Lanes value[3], Lanes first[6], Lanes last[6])
{
  const Lanes none = {0}, mean = (s[0] + s[1] + s[2]) * (1.0 / 3.0), most = none + 1.0;
  const Lanes d[6] = {s[0] - mean, s[1] - mean, s[2] - mean, s[3], s[4], s[5]};
  Lanes J2, J3, q, size, c, eta, nn[6], D[6], delta, delta2 = none;
  lanes_invariants(d, &J2, &J3);
  const LaneBits alike = J2 <= ALIKE_BELOW * ALIKE_BELOW * (mean * mean), high = J3 >= 0.0;
  const Lanes third = J2 * (1.0 / 3.0);
  lanes_sqrt(&third, &q);
  lanes_abs(&J3, &size);
  Lanes x = size / (2.0 * q * third);
  const LaneBits within = x < most;
  lanes_select(&within, &x, &most, &x);
  lanes_third_of_angle(&x, &c);
  eta = 2.0 * q * c;
  eta = (Lanes)((LaneBits)eta ^ (~high & INT64_MIN));
  lanes_select(&alike, &none, &eta, &eta);
  lanes_projection(d, &eta, &alike, nn);
  for (int k = 0; k < 6; ++k) {
    D[k] = d[k] - 1.5 * eta * nn[k];
    if (k < 3) D[k] += 0.5 * eta;
    delta2 += (k < 3 ? 0.5 : 1.0) * D[k] * D[k];
  }
  lanes_sqrt(&delta2, &delta);
  const LaneBits pair = alike | (delta2 <= 1e-36 * (mean * mean));
  Lanes half = 0.5 / delta;
  lanes_select(&pair, &none, &delta, &delta);
  lanes_select(&pair, &none, &half, &half);
  half = (Lanes)((LaneBits)half ^ (high & INT64_MIN)); /* of the one that is not beside eta */
  for (int k = 0; k < 6; ++k) {
    const Lanes other = (k < 3 ? 0.5 : 0.0) - 0.5 * nn[k] + half * D[k];
    lanes_select(&high, &nn[k], &other, &first[k]);
    lanes_select(&high, &other, &nn[k], &last[k]);
  }
  const Lanes alone = mean + eta, upper = mean - 0.5 * eta + delta, lower = mean - 0.5 * eta - delta;
  lanes_select(&high, &alone, &upper, &value[0]);
  lanes_select(&high, &upper, &lower, &value[1]);
  lanes_select(&high, &lower, &alone, &value[2]);
}
