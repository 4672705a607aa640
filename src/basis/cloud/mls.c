/* Moving least squares. One kernel, compiled for each dimension and set of polynomials.
 *
 * With polynomials fixed at the point (the same functions, since the sets are closed under
 * translation) only w depends on x in M, which gives the exact gradient with two more solves of M
 * per direction, none of M's derivatives formed: a = M^-1 p(0), d_j a = M^-1 (d_j p(0) - sum d_j w
 * (a.p) p), dN = d_j w (a.p) + w (d_j a.p). */
#include "basis/cloud/mls.h"

#define MLS_MAX_FUNCTIONS 10
#define MLS_SINGULAR 1e-13 /* of the largest squared pivot: what rounding leaves of a zero */

CLOUD_INLINE int mls_count(CloudOrder order, int dim)
{
  if (order == CLOUD_LINEAR) return dim + 1;
  if (order == CLOUD_BILINEAR) return dim == 2 ? 4 : 8;
  return dim == 2 ? 6 : 10;
}

/* 1, x, y, (z), then the products. */
CLOUD_INLINE void mls_polynomials(CloudOrder order, int dim, const Cloud *cloud, int i, Pack *p)
{
  const Pack zero = {0};
  int m = 0;
  p[m++] = zero + 1.0;
  for (int k = 0; k < dim; ++k) p[m++] = cloud->d[k][i];
  if (order == CLOUD_LINEAR) return;
  for (int k = 0; k < dim; ++k)
    for (int l = k + (order == CLOUD_BILINEAR); l < dim; ++l) p[m++] = cloud->d[k][i] * cloud->d[l][i];
  if (order == CLOUD_BILINEAR && dim == 3) p[m] = cloud->d[0][i] * cloud->d[1][i] * cloud->d[2][i];
}

/* w = exp(-(r^2 - least r^2) / R^2): the constant factor cancels and keeps far nodes from vanishing
 * all together. */
CLOUD_INLINE void mls_gaussian(PetscReal radius, const Cloud *cloud, Pack *w, Pack *q)
{
  const PetscReal rate = 1.0 / (radius * radius);
  PetscReal nearest = PETSC_MAX_REAL;
  for (int a = 0; a < cloud->n; ++a) nearest = PetscMin(nearest, cloud->r2[a / PACK][a % PACK]);
  for (int i = 0; i < cloud->packs; ++i) {
    const Pack exponent = (nearest - cloud->r2[i]) * rate;
    lanes_exp(&exponent, &w[i]);
    q[i] = (2.0 * rate) * w[i];
  }
}

/* 2/3 - 4 s^2 + 4 s^3 up to s = 1/2, then 4/3 (1 - s)^3. */
CLOUD_INLINE void mls_spline(PetscReal radius, const Cloud *cloud, Pack *w, Pack *q)
{
  const PetscReal rate = 1.0 / (radius * radius);
  for (int a = 0; a < cloud->packs * PACK; ++a) {
    const PetscReal s = PetscMin(sqrt(cloud->r2[a / PACK][a % PACK] * rate), 1.0), t = 1.0 - s;
    const PetscReal near = 2.0 / 3.0 - 4.0 * s * s * t, far = 4.0 / 3.0 * t * t * t;
    w[a / PACK][a % PACK] = s < 0.5 ? near : far;
    q[a / PACK][a % PACK] = rate * (s < 0.5 ? 8.0 - 12.0 * s : 4.0 * t * t / s);
  }
}

/* Weights w and q, the gradient of w being q d. */
CLOUD_INLINE void mls_weights(const CloudBasis *basis, Cloud *cloud, Pack *w, Pack *q)
{
  if (basis->weight == CLOUD_GAUSSIAN) mls_gaussian(basis->effective_radius, cloud, w, q);
  else mls_spline(basis->effective_radius, cloud, w, q);
  if (basis->reach > 0.0) {
    cloud_window(basis->reach, cloud);
    for (int i = 0; i < cloud->packs; ++i) {
      q[i] = q[i] * cloud->window[i] + w[i] * cloud->steepness[i];
      w[i] *= cloud->window[i];
    }
  }
  for (int a = cloud->n; a < cloud->packs * PACK; ++a) w[a / PACK][a % PACK] = q[a / PACK][a % PACK] = 0.0;
}

CLOUD_INLINE void mls_moments(CloudOrder order, int dim, const Cloud *cloud, const Pack *w, PetscReal *moment)
{
  const int m = mls_count(order, dim), entries = m * (m + 1) / 2;
  Pack sum[MLS_MAX_FUNCTIONS * (MLS_MAX_FUNCTIONS + 1) / 2], p[MLS_MAX_FUNCTIONS];
  for (int k = 0; k < entries; ++k) sum[k] = (Pack){0};
  for (int c = 0; c < cloud->packs; ++c) {
    mls_polynomials(order, dim, cloud, c, p);
    for (int i = 0; i < m; ++i) {
      const Pack wp = w[c] * p[i];
      for (int j = i; j < m; ++j) sum[cloud_upper(m, i, j)] += wp * p[j];
    }
  }
  for (int k = 0; k < entries; ++k) moment[k] = pack_sum(&sum[k]);
}

/* da[j] = d_j a from the factor of M; a = M^-1 p(0). */
CLOUD_INLINE void mls_coefficients(CloudOrder order, int dim, const Cloud *cloud, const Pack *q,
                                   const PetscReal *factor, PetscReal *a, PetscReal (*da)[MLS_MAX_FUNCTIONS])
{
  const int m = mls_count(order, dim);
  Pack sum[3][MLS_MAX_FUNCTIONS], p[MLS_MAX_FUNCTIONS];
  for (int i = 0; i < m; ++i) a[i] = i == 0;
  cloud_cholesky_solve(m, factor, a);
  for (int k = 0; k < dim; ++k)
    for (int i = 0; i < m; ++i) sum[k][i] = (Pack){0};
  for (int c = 0; c < cloud->packs; ++c) {
    mls_polynomials(order, dim, cloud, c, p);
    Pack t = p[0] * a[0];
    for (int i = 1; i < m; ++i) t += p[i] * a[i];
    t *= q[c];
    for (int k = 0; k < dim; ++k)
      for (int i = 0; i < m; ++i) sum[k][i] += t * cloud->d[k][c] * p[i];
  }
  for (int k = 0; k < dim; ++k) {
    for (int i = 0; i < m; ++i) da[k][i] = (i == k + 1) - pack_sum(&sum[k][i]);
    cloud_cholesky_solve(m, factor, da[k]);
  }
}

CLOUD_INLINE CloudStatus mls_kernel(CloudOrder order, int dim, const CloudBasis *basis, PetscReal h, Cloud *cloud,
                                    PetscReal *N, PetscReal *dN, PetscReal *condition)
{
  const int m = mls_count(order, dim);
  Pack w[CLOUD_MAX_PACKS], q[CLOUD_MAX_PACKS], slope[3][CLOUD_MAX_PACKS], p[MLS_MAX_FUNCTIONS];
  PetscReal factor[MLS_MAX_FUNCTIONS * (MLS_MAX_FUNCTIONS + 1) / 2], a[MLS_MAX_FUNCTIONS], da[3][MLS_MAX_FUNCTIONS];
  mls_weights(basis, cloud, w, q);
  mls_moments(order, dim, cloud, w, factor);
  *condition = cloud_cholesky(m, MLS_SINGULAR, factor);
  if (!(*condition > 0.0)) return CLOUD_DEGENERATE;
  mls_coefficients(order, dim, cloud, q, factor, a, da);
  for (int c = 0; c < cloud->packs; ++c) {
    mls_polynomials(order, dim, cloud, c, p);
    Pack t = p[0] * a[0];
    for (int i = 1; i < m; ++i) t += p[i] * a[i];
    for (int k = 0; k < dim; ++k) {
      Pack s = p[0] * da[k][0];
      for (int i = 1; i < m; ++i) s += p[i] * da[k][i];
      slope[k][c] = q[c] * t * cloud->d[k][c] + w[c] * s;
    }
    w[c] *= t;
  }
  cloud_store(dim, cloud, w, slope, h, N, dN);
  return CLOUD_OK;
}

int mls_functions(CloudOrder order, int dim) { return mls_count(order, dim); }

CloudStatus mls_evaluate(const CloudBasis *basis, int dim, PetscReal h, Cloud *cloud, PetscReal *N, PetscReal *dN,
                         PetscReal *condition)
{
  if (basis->order == CLOUD_LINEAR)
    return dim == 2 ? mls_kernel(CLOUD_LINEAR, 2, basis, h, cloud, N, dN, condition)
                    : mls_kernel(CLOUD_LINEAR, 3, basis, h, cloud, N, dN, condition);
  if (basis->order == CLOUD_BILINEAR)
    return dim == 2 ? mls_kernel(CLOUD_BILINEAR, 2, basis, h, cloud, N, dN, condition)
                    : mls_kernel(CLOUD_BILINEAR, 3, basis, h, cloud, N, dN, condition);
  return dim == 2 ? mls_kernel(CLOUD_QUADRATIC, 2, basis, h, cloud, N, dN, condition)
                  : mls_kernel(CLOUD_QUADRATIC, 3, basis, h, cloud, N, dN, condition);
}
