/* What moving least squares and local maximum entropy share: the nodes of a cloud side by side,
 * eight at a time.
 *
 * A cloud is padded to whole packs by nodes of weight 0 at the point itself, so no loop has a
 * tail. */
#pragma once
#include "base/math/lanes.h"
#include "basis/cloud/cloud.h"

#define PACK LANES
#define CLOUD_MAX_PACKS (CLOUD_MAX_NODES / PACK)
#define CLOUD_INLINE static inline __attribute__((always_inline))
#define CLOUD_PAD -1e30 /* the exponent of a node that only pads */

typedef Lanes Pack;
typedef LaneBits PackBits;

/* Lengths in units of h. The weight of a node is exp(exponent) * window before the basis does
 * anything to it. */
typedef struct {
  int n, packs;
  Pack d[3][CLOUD_MAX_PACKS];      /* node - point */
  Pack r2[CLOUD_MAX_PACKS];        /* its square */
  Pack window[CLOUD_MAX_PACKS];    /* 1 inside, 0 at the reach; written only if there is a reach */
  Pack steepness[CLOUD_MAX_PACKS]; /* gradient of the window = steepness * d; likewise */
} Cloud;

CLOUD_INLINE PetscReal pack_sum(const Pack *v)
{
  return (((*v)[0] + (*v)[4]) + ((*v)[2] + (*v)[6])) + (((*v)[1] + (*v)[5]) + ((*v)[3] + (*v)[7]));
}

/* NaN comes through only if the caller looks at what it did with the numbers: comparisons drop
 * it. */
CLOUD_INLINE void pack_max(const Pack *v, Pack *largest)
{
  const PackBits mask = *v > *largest;
  *largest = (Pack)(((PackBits)*v & mask) | ((PackBits)*largest & ~mask));
}

CLOUD_INLINE PetscReal pack_largest(const Pack *v)
{
  Pack other = __builtin_shufflevector(*v, *v, 4, 5, 6, 7, 0, 1, 2, 3), largest = *v;
  pack_max(&other, &largest);
  other = __builtin_shufflevector(largest, largest, 2, 3, 0, 1, 6, 7, 4, 5);
  pack_max(&other, &largest);
  return largest[0] > largest[1] ? largest[0] : largest[1];
}

CLOUD_INLINE void cloud_gather(int dim, int n, const PetscReal *X, PetscReal h, const PetscReal *x, Cloud *cloud)
{
  const PetscReal scale = 1.0 / h;
  cloud->n = n;
  cloud->packs = (n + PACK - 1) / PACK;
  const Pack zero = {0};
  for (int k = 0; k < dim; ++k) cloud->d[k][cloud->packs - 1] = zero;
  for (int a = 0; a < n; ++a)
    for (int k = 0; k < dim; ++k) cloud->d[k][a / PACK][a % PACK] = (X[a * dim + k] - x[k]) * scale;
  for (int i = 0; i < cloud->packs; ++i) {
    Pack r2 = cloud->d[0][i] * cloud->d[0][i];
    for (int k = 1; k < dim; ++k) r2 += cloud->d[k][i] * cloud->d[k][i];
    cloud->r2[i] = r2;
  }
}

#define CLOUD_WINDOW_START 0.7 /* of the reach: inside of this weights are untouched */

/* 1 - s^3 (10 - 15 s + 6 s^2), s from 0 at the start to 1 at the reach: two continuous
 * derivatives. */
CLOUD_INLINE void cloud_window(PetscReal reach, Cloud *cloud)
{
  const PetscReal start = CLOUD_WINDOW_START * reach, slope = 1.0 / (reach - start);
  for (int a = 0; a < cloud->packs * PACK; ++a) {
    const PetscReal r = sqrt(cloud->r2[a / PACK][a % PACK]), t = (r - start) * slope;
    const PetscReal s = t < 0.0 ? 0.0 : (t > 1.0 ? 1.0 : t), u = s * (1.0 - s);
    cloud->window[a / PACK][a % PACK] = 1.0 - s * s * s * (10.0 - s * (15.0 - 6.0 * s));
    cloud->steepness[a / PACK][a % PACK] = 30.0 * u * u * slope / (r > start ? r : start);
  }
}

/* Upper triangle of a symmetric matrix, row by row. */
CLOUD_INLINE int cloud_upper(int m, int i, int j) { return i * m - i * (i - 1) / 2 + j - i; }

/* a (upper triangle) = L L^T, in place (column i of L in row i); returns the ratio of the extreme
 * squared pivots, or -1. */
CLOUD_INLINE PetscReal cloud_cholesky(int m, PetscReal singular, PetscReal *a)
{
  PetscReal least = PETSC_MAX_REAL, largest = 0.0;
  for (int i = 0; i < m; ++i) {
    const PetscReal pivot = a[cloud_upper(m, i, i)];
    least = PetscMin(least, pivot), largest = PetscMax(largest, pivot);
    if (!(pivot > singular * largest)) return -1.0;
    const PetscReal s = 1.0 / sqrt(pivot);
    for (int j = i; j < m; ++j) a[cloud_upper(m, i, j)] *= s;
    for (int j = i + 1; j < m; ++j)
      for (int k = j; k < m; ++k) a[cloud_upper(m, j, k)] -= a[cloud_upper(m, i, j)] * a[cloud_upper(m, i, k)];
  }
  return largest / least;
}

CLOUD_INLINE void cloud_cholesky_solve(int m, const PetscReal *l, PetscReal *b)
{
  for (int i = 0; i < m; ++i) {
    b[i] /= l[cloud_upper(m, i, i)];
    for (int j = i + 1; j < m; ++j) b[j] -= l[cloud_upper(m, i, j)] * b[i];
  }
  for (int i = m - 1; i >= 0; --i) {
    for (int j = i + 1; j < m; ++j) b[i] -= l[cloud_upper(m, i, j)] * b[j];
    b[i] /= l[cloud_upper(m, i, i)];
  }
}

/* dN/dx row by row from its columns; lengths get their unit back. */
CLOUD_INLINE void cloud_store(int dim, const Cloud *cloud, const Pack *value, const Pack (*slope)[CLOUD_MAX_PACKS],
                              PetscReal h, PetscReal *N, PetscReal *dN)
{
  const PetscReal scale = 1.0 / h;
  for (int a = 0; a < cloud->n; ++a) {
    N[a] = value[a / PACK][a % PACK];
    for (int k = 0; k < dim; ++k) dN[a * dim + k] = slope[k][a / PACK][a % PACK] * scale;
  }
}
