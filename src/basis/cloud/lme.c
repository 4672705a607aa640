/* Local maximum entropy: Newton on the dual, safeguarded by a line search, and by Newton with a
 * shifted Hessian where the Hessian is no help. One kernel, compiled for two and three dimensions;
 * lengths in units of h. */
#include "basis/cloud/lme.h"
#include "base/math/eigen.h"

#define LME_ITERATIONS 100
#define LME_HALVINGS 30
#define LME_TOLERANCE 1e-13 /* of sum N d, in units of h */
#define LME_FLOOR 1e-12     /* is good enough where it falls no more, if rounding allows it */
/* a squared pivot of the Hessian relative to the largest: the cloud is flat */
#define LME_SINGULAR 1e-15
/* in units of h: a plane between point and nodes is farther from the nodes than this */
#define LME_OUTSIDE 1e-12
#define LME_STIFFEST 1e4 /* shifts beyond this share of |sum N d| move nothing any more */
/* |sum N d| at a given dual variable: from farther away zero is the better start */
#define LME_WARM 0.5

typedef struct {
  PetscReal lambda[3];
  PetscReal value;      /* ln Z */
  PetscReal mean[3];    /* sum N d: the gradient of ln Z */
  PetscReal hessian[6]; /* sum N d d - mean mean, upper triangle */
  /* largest lambda.d: below zero lambda is the normal of a plane between point and nodes */
  PetscReal reach;
  PetscReal sum;              /* of e */
  PetscReal rounding;         /* of the largest exponent that can matter */
  Pack e[CLOUD_MAX_PACKS];    /* Z N before division by the sum, window included */
  Pack bare[CLOUD_MAX_PACKS]; /* the same without the window; written only if there is one */
} Lme;

CLOUD_INLINE PetscReal lme_norm(int dim, const PetscReal *v)
{
  PetscReal square = v[0] * v[0];
  for (int k = 1; k < dim; ++k) square += v[k] * v[k];
  return sqrt(square);
}

/* Exponents, their maximum (so that the largest exponential is 1), and how far lambda reaches. */
CLOUD_INLINE PetscReal lme_exponents(int dim, PetscReal gamma, const Cloud *cloud, Lme *s)
{
  const Pack zero = {0};
  Pack largest = zero + CLOUD_PAD, farthest = zero + CLOUD_PAD;
  for (int i = 0; i < cloud->packs; ++i) {
    Pack along = cloud->d[0][i] * s->lambda[0];
    for (int k = 1; k < dim; ++k) along += cloud->d[k][i] * s->lambda[k];
    Pack e = along - gamma * cloud->r2[i];
    if ((i + 1) * PACK > cloud->n)
      for (int l = cloud->n - i * PACK; l < PACK; ++l) e[l] = along[l] = CLOUD_PAD;
    pack_max(&e, &largest);
    pack_max(&along, &farthest);
    s->e[i] = e;
  }
  s->reach = pack_largest(&farthest);
  return pack_largest(&largest);
}

/* Value, gradient and Hessian of ln Z at s->lambda. */
CLOUD_INLINE void lme_moments(int dim, PetscBool windowed, PetscReal gamma, const Cloud *cloud, Lme *s)
{
  const PetscReal top = lme_exponents(dim, gamma, cloud, s);
  Pack sum = {0}, first[3] = {{0}}, second[6] = {{0}};
  for (int i = 0; i < cloud->packs; ++i) {
    const Pack exponent = s->e[i] - top;
    Pack e;
    lanes_exp(&exponent, &e);
    if (windowed) {
      s->bare[i] = e;
      e *= cloud->window[i];
    }
    s->e[i] = e;
    sum += e;
    for (int k = 0; k < dim; ++k) {
      const Pack ed = e * cloud->d[k][i];
      first[k] += ed;
      for (int l = k; l < dim; ++l) second[cloud_upper(dim, k, l)] += ed * cloud->d[l][i];
    }
  }
  s->sum = pack_sum(&sum);
  s->value = top + log(s->sum);
  for (int k = 0; k < dim; ++k) s->mean[k] = pack_sum(&first[k]) / s->sum;
  for (int k = 0; k < dim; ++k)
    for (int l = k; l < dim; ++l) {
      const int kl = cloud_upper(dim, k, l);
      s->hessian[kl] = pack_sum(&second[kl]) / s->sum - s->mean[k] * s->mean[l];
    }
}

/* step = -(hessian + shift)^-1 mean; PETSC_FALSE if that is not positive definite. */
CLOUD_INLINE PetscBool lme_direction(int dim, const Lme *s, PetscReal shift, PetscReal *step)
{
  PetscReal factor[6];
  for (int k = 0; k < dim * (dim + 1) / 2; ++k) factor[k] = s->hessian[k];
  for (int k = 0; k < dim; ++k) factor[cloud_upper(dim, k, k)] += shift, step[k] = -s->mean[k];
  if (cloud_cholesky(dim, shift > 0.0 ? 0.0 : LME_SINGULAR, factor) < 0.0) return PETSC_FALSE;
  cloud_cholesky_solve(dim, factor, step);
  return PETSC_TRUE;
}

/* Along the step to where ln Z has fallen enough. PETSC_FALSE: nowhere, *s is as it was but for its
 * exponentials. */
CLOUD_INLINE PetscBool lme_search(int dim, PetscBool windowed, PetscReal gamma, const Cloud *cloud,
                                  const PetscReal *step, Lme *s)
{
  PetscReal start[3], slope = 0.0;
  const PetscReal value = s->value, rounding = s->rounding + 1e-15 * fabs(value);
  for (int k = 0; k < dim; ++k) start[k] = s->lambda[k], slope += s->mean[k] * step[k];
  PetscReal t = 1.0;
  for (int halving = 0; halving < LME_HALVINGS; ++halving, t *= 0.5) {
    for (int k = 0; k < dim; ++k) s->lambda[k] = start[k] + t * step[k];
    lme_moments(dim, windowed, gamma, cloud, s);
    if (s->value <= value + 1e-4 * t * slope + rounding) return PETSC_TRUE;
  }
  for (int k = 0; k < dim; ++k) s->lambda[k] = start[k];
  lme_moments(dim, windowed, gamma, cloud, s);
  return PETSC_FALSE;
}

/* The better of the dual variable given and zero. */
CLOUD_INLINE void lme_start(int dim, PetscBool windowed, PetscReal gamma, const Cloud *cloud, const PetscReal *dual,
                            Lme *s)
{
  Pack farthest = cloud->r2[0];
  for (int i = 1; i < cloud->packs; ++i) pack_max(&cloud->r2[i], &farthest);
  s->rounding = 1e-15 * (1.0 + gamma * pack_largest(&farthest));
  for (int k = 0; k < dim; ++k) s->lambda[k] = dual ? dual[k] : 0.0;
  lme_moments(dim, windowed, gamma, cloud, s);
  if (!dual || lme_norm(dim, s->mean) <= LME_WARM) return;
  for (int k = 0; k < dim; ++k) s->lambda[k] = 0.0;
  lme_moments(dim, windowed, gamma, cloud, s);
}

/* Newton where the Hessian is of use. Where it is not (all weight on one node, or running off to
 * infinity because the point is outside) its shift, a share `ease` of |mean|, adapts: steps grow
 * tenfold as long as they succeed. */
CLOUD_INLINE CloudStatus lme_minimise(int dim, PetscBool windowed, PetscReal gamma, const Cloud *cloud, Lme *s)
{
  PetscBool definite = PETSC_FALSE;
  PetscReal step[3], ease = 1.0, before = PETSC_MAX_REAL;
  const PetscReal floor = PetscMax(LME_FLOOR, 100.0 * s->rounding);
  for (int iteration = 0; iteration < LME_ITERATIONS; ++iteration) {
    const PetscReal error = lme_norm(dim, s->mean), length = lme_norm(dim, s->lambda);
    if (!(error < PETSC_MAX_REAL)) return CLOUD_NO_CONVERGENCE;
    if (s->reach < -LME_OUTSIDE * length) return CLOUD_OUTSIDE;
    definite = lme_direction(dim, s, 0.0, step);
    if (error <= LME_TOLERANCE) return definite ? CLOUD_OK : CLOUD_DEGENERATE;
    if (definite && error <= floor && error > 0.6 * before) return CLOUD_OK;
    before = error;
    if (definite && lme_search(dim, windowed, gamma, cloud, step, s)) continue;
    const PetscBool moved =
      lme_direction(dim, s, ease * error, step) && lme_search(dim, windowed, gamma, cloud, step, s);
    ease *= moved ? 0.1 : 10.0;
    if (ease > LME_STIFFEST) break;
  }
  return definite ? CLOUD_NO_CONVERGENCE : CLOUD_DEGENERATE;
}

/* Ratio of the Hessian's extreme eigenvalues. */
CLOUD_INLINE PetscReal lme_condition(int dim, const PetscReal *h)
{
  if (dim == 2) {
    const PetscReal mean = 0.5 * (h[0] + h[2]), half = 0.5 * (h[0] - h[2]), radius = sqrt(half * half + h[1] * h[1]);
    return (mean + radius) * (mean + radius) / (h[0] * h[2] - h[1] * h[1]);
  }
  const PetscReal voigt[6] = {h[0], h[3], h[5], h[1], h[4], h[2]};
  PetscReal value[3], vector[9];
  sym_eigen(voigt, value, vector);
  return value[0] / value[2];
}

/* With centred d the sums of dN and of x dN are exact even while sum N d is not quite zero. */
CLOUD_INLINE void lme_plain_gradients(int dim, const Cloud *cloud, const PetscReal *inverse, const Lme *s, Pack *N,
                                      Pack (*slope)[CLOUD_MAX_PACKS])
{
  for (int i = 0; i < cloud->packs; ++i) {
    N[i] = s->e[i] * (1.0 / s->sum);
    for (int k = 0; k < dim; ++k) {
      Pack v = (cloud->d[0][i] - s->mean[0]) * inverse[k * dim];
      for (int l = 1; l < dim; ++l) v += (cloud->d[l][i] - s->mean[l]) * inverse[k * dim + l];
      slope[k][i] = N[i] * v;
    }
  }
}

/* With a window w the weight's own gradient is Q d, Q = 2 gamma N + (window's part), and
 * dN = Q d - N sum(Q d) + N (1 - sum Q d d) H^-1 d. */
CLOUD_INLINE void lme_windowed_gradients(int dim, PetscReal gamma, const Cloud *cloud, const PetscReal *inverse,
                                         const Lme *s, Pack *N, Pack (*slope)[CLOUD_MAX_PACKS])
{
  Pack Q[CLOUD_MAX_PACKS], first[3] = {{0}}, second[9] = {{0}};
  PetscReal centre[3], left[9], map[9];
  for (int i = 0; i < cloud->packs; ++i) {
    N[i] = s->e[i] * (1.0 / s->sum);
    Q[i] = 2.0 * gamma * N[i] + s->bare[i] * cloud->steepness[i] * (1.0 / s->sum);
    for (int k = 0; k < dim; ++k) {
      const Pack qd = Q[i] * cloud->d[k][i];
      first[k] += qd;
      for (int l = 0; l < dim; ++l) second[k * dim + l] += qd * (cloud->d[l][i] - s->mean[l]);
    }
  }
  for (int k = 0; k < dim; ++k) {
    centre[k] = pack_sum(&first[k]);
    for (int l = 0; l < dim; ++l) left[k * dim + l] = (k == l) - pack_sum(&second[k * dim + l]);
  }
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim; ++l) {
      map[k * dim + l] = 0.0;
      for (int j = 0; j < dim; ++j) map[k * dim + l] += left[k * dim + j] * inverse[j * dim + l];
    }
  for (int i = 0; i < cloud->packs; ++i)
    for (int k = 0; k < dim; ++k) {
      Pack v = (cloud->d[0][i] - s->mean[0]) * map[k * dim];
      for (int l = 1; l < dim; ++l) v += (cloud->d[l][i] - s->mean[l]) * map[k * dim + l];
      slope[k][i] = Q[i] * cloud->d[k][i] + N[i] * (v - centre[k]);
    }
}

CLOUD_INLINE void lme_invert(int dim, const PetscReal *hessian, PetscReal *inverse)
{
  PetscReal factor[6];
  for (int k = 0; k < dim * (dim + 1) / 2; ++k) factor[k] = hessian[k];
  (void)cloud_cholesky(dim, 0.0, factor);
  for (int k = 0; k < dim; ++k) {
    PetscReal *row = inverse + k * dim;
    for (int l = 0; l < dim; ++l) row[l] = k == l;
    cloud_cholesky_solve(dim, factor, row);
  }
}

CLOUD_INLINE CloudStatus lme_kernel(int dim, const CloudBasis *basis, PetscReal h, Cloud *cloud, PetscReal *N,
                                    PetscReal *dN, PetscReal *condition, PetscReal *dual)
{
  const PetscBool windowed = basis->reach > 0.0;
  Lme s;
  PetscReal inverse[9];
  Pack value[CLOUD_MAX_PACKS], slope[3][CLOUD_MAX_PACKS];
  if (windowed) cloud_window(basis->reach, cloud);
  lme_start(dim, windowed, basis->gamma, cloud, dual, &s);
  const CloudStatus status = lme_minimise(dim, windowed, basis->gamma, cloud, &s);
  if (status != CLOUD_OK) return status;
  *condition = lme_condition(dim, s.hessian);
  lme_invert(dim, s.hessian, inverse);
  if (windowed) lme_windowed_gradients(dim, basis->gamma, cloud, inverse, &s, value, slope);
  else lme_plain_gradients(dim, cloud, inverse, &s, value, slope);
  cloud_store(dim, cloud, value, slope, h, N, dN);
  for (int k = 0; dual && k < dim; ++k) dual[k] = s.lambda[k];
  return CLOUD_OK;
}

CloudStatus lme_evaluate(const CloudBasis *basis, int dim, PetscReal h, Cloud *cloud, PetscReal *N, PetscReal *dN,
                         PetscReal *condition, PetscReal *dual)
{
  return dim == 2 ? lme_kernel(2, basis, h, cloud, N, dN, condition, dual)
                  : lme_kernel(3, basis, h, cloud, N, dN, condition, dual);
}
