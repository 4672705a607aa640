/* What Krylov methods do with whole vectors: single precision, sums in double. Eight numbers at a
 * time, since the compiler may not reorder a sum by itself. */
#pragma once
#include "solve/blocks/block_kernels.h"

typedef float Eight __attribute__((vector_size(32), aligned(4), may_alias));
typedef double EightDoubles __attribute__((vector_size(64)));

/* by pointer: machines without such registers have no settled way to hand them over */
KERNEL double eight_sum(const EightDoubles *sum)
{
  const EightDoubles v = *sum;
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

KERNEL Eight eight(const float *x) { return *(const Eight *)x; }
KERNEL void eight_store(Eight v, float *x) { *(Eight *)x = v; }
KERNEL void eight_add(Eight v, EightDoubles *sum) { *sum += __builtin_convertvector(v, EightDoubles); }

/* x += alpha p, r -= alpha (t + y); r . r */
static inline double vectors_step(PetscInt n, float alpha, const float *p, const float *t, const float *y, float *x,
                                  float *r)
{
  EightDoubles sum = {0};
  double rest = 0;
  PetscInt i = 0;
  for (; i + 8 <= n; i += 8) {
    const Eight left = eight(r + i) - alpha * (eight(t + i) + eight(y + i));
    eight_store(eight(x + i) + alpha * eight(p + i), x + i);
    eight_store(left, r + i);
    eight_add(left * left, &sum);
  }
  for (; i < n; ++i) {
    x[i] += alpha * p[i];
    r[i] -= alpha * (t[i] + y[i]);
    rest += (double)(r[i] * r[i]);
  }
  return eight_sum(&sum) + rest;
}

/* v = t + y, r -= alpha v */
static inline void vectors_half_step(PetscInt n, float alpha, const float *t, const float *y, float *v, float *r)
{
  PetscInt i = 0;
  for (; i + 8 <= n; i += 8) {
    const Eight product = eight(t + i) + eight(y + i);
    eight_store(product, v + i);
    eight_store(eight(r + i) - alpha * product, r + i);
  }
  for (; i < n; ++i) {
    v[i] = t[i] + y[i];
    r[i] -= alpha * v[i];
  }
}

/* |t + y|^2 */
static inline double vectors_norm2(PetscInt n, const float *t, const float *y)
{
  EightDoubles sum = {0};
  double rest = 0;
  PetscInt i = 0;
  for (; i + 8 <= n; i += 8) {
    const Eight v = eight(t + i) + eight(y + i);
    eight_add(v * v, &sum);
  }
  for (; i < n; ++i) rest += (double)((t[i] + y[i]) * (t[i] + y[i]));
  return eight_sum(&sum) + rest;
}

/* x += alpha p + omega r, r -= omega (t + y), p -= omega v; sums = r . r, shadow . r */
static inline void vectors_full_step(PetscInt n, float alpha, float omega, const float *t, const float *y,
                                     const float *v, const float *shadow, float *x, float *r, float *p, double sums[2])
{
  EightDoubles norm2 = {0}, dot = {0};
  PetscInt i = 0;
  for (; i + 8 <= n; i += 8) {
    const Eight old = eight(r + i), left = old - omega * (eight(t + i) + eight(y + i));
    eight_store(eight(x + i) + alpha * eight(p + i) + omega * old, x + i);
    eight_store(eight(p + i) - omega * eight(v + i), p + i);
    eight_store(left, r + i);
    eight_add(left * left, &norm2);
    eight_add(left * eight(shadow + i), &dot);
  }
  sums[0] = eight_sum(&norm2);
  sums[1] = eight_sum(&dot);
  for (; i < n; ++i) {
    x[i] += alpha * p[i] + omega * r[i];
    r[i] -= omega * (t[i] + y[i]);
    p[i] -= omega * v[i];
    sums[0] += (double)(r[i] * r[i]);
    sums[1] += (double)(shadow[i] * r[i]);
  }
}
