#include "calibrate/surrogate.h"
#include <math.h>
#include "calibrate/dense.h"

/* DEVIATIONS: within so many a run lies, as far as the others tell. */
enum { TREND = SURROGATE_MOST + 1, HYPER = SURROGATE_MOST + 1, DEVIATIONS = 2 };

#define HUGE_ERROR 100. /* of a logarithm: whatever is measured lies within */

struct Surrogate {
  PetscInt dim, n, trend;               /* trend: terms of b0 + b.x */
  PetscReal sign;                       /* of all y where their logarithms are modelled; 0: they are themselves */
  PetscReal mean, scale;                /* y, or its logarithm, = mean + scale * what is modelled */
  PetscReal *x, *y;                     /* n x dim; n */
  PetscReal hyper[HYPER];               /* logarithms of lengths, and of the nugget */
  PetscReal *l;                         /* factor of K, n x n */
  PetscReal *h;                         /* L^-1 H, trend rows of n */
  PetscReal *r;                         /* L^-1 (y - H b) */
  PetscReal a[TREND * TREND], b[TREND]; /* factor of H^T K^-1 H */
  PetscReal variance, inflation, left_out;
};

static PetscReal correlation(const Surrogate *s, const PetscReal *a, const PetscReal *b)
{
  PetscReal r2 = 0;
  for (PetscInt d = 0; d < s->dim; ++d) {
    const PetscReal t = (a[d] - b[d]) / PetscExpReal(s->hyper[d]);
    r2 += t * t;
  }
  const PetscReal r = PetscSqrtReal(5 * r2);
  return (1 + r + r * r / 3) * PetscExpReal(-r);
}

static PetscReal trend_term(const PetscReal *x, PetscInt k) { return k ? x[k - 1] : 1; }

/* K = L L^T, and L^-1 of trend and values. */
static PetscBool factor(Surrogate *s)
{
  const PetscInt n = s->n;
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j <= i; ++j)
      s->l[i * n + j] =
        i == j ? 1 + PetscExpReal(s->hyper[s->dim]) : correlation(s, s->x + i * s->dim, s->x + j * s->dim);
  if (!dense_factor(n, s->l)) return PETSC_FALSE;
  for (PetscInt k = 0; k < s->trend; ++k) {
    for (PetscInt i = 0; i < n; ++i) s->h[k * n + i] = trend_term(s->x + i * s->dim, k);
    dense_forward(n, s->l, s->h + k * n);
  }
  for (PetscInt i = 0; i < n; ++i) s->r[i] = s->y[i];
  dense_forward(n, s->l, s->r);
  return PETSC_TRUE;
}

/* Trend and variance for these lengths and this nugget; minus the restricted log-likelihood. */
static PetscReal fit(Surrogate *s)
{
  const PetscInt n = s->n, m = s->trend;
  PetscReal value = 0;
  if (!factor(s)) return INFINITY;
  for (PetscInt i = 0; i < m; ++i)
    for (PetscInt j = 0; j < m; ++j) s->a[i * m + j] = dense_dot(n, s->h + i * n, s->h + j * n);
  if (!dense_factor(m, s->a)) return INFINITY;
  for (PetscInt k = 0; k < m; ++k) s->b[k] = dense_dot(n, s->h + k * n, s->r);
  dense_forward(m, s->a, s->b);
  dense_backward(m, s->a, s->b);
  for (PetscInt k = 0; k < m; ++k)
    for (PetscInt i = 0; i < n; ++i) s->r[i] -= s->b[k] * s->h[k * n + i];
  /* values that the trend meets to round-off have no likelihood */
  s->variance = PetscMax(dense_dot(n, s->r, s->r) / (PetscReal)(n - m), 1e-20);
  for (PetscInt i = 0; i < n; ++i) value += PetscLogReal(s->l[i * n + i]);
  for (PetscInt k = 0; k < m; ++k) value += PetscLogReal(s->a[k * m + k]);
  return value + 0.5 * (PetscReal)(n - m) * PetscLogReal(s->variance);
}

/* Lengths from a twentieth of the range to twenty of them, a nugget from 1e-8 to the variance
 * itself. */
static PetscReal bounded(const Surrogate *s, PetscInt k, PetscReal value)
{
  const PetscReal low = k < s->dim ? PetscLogReal(0.05) : PetscLogReal(1e-8);
  const PetscReal high = k < s->dim ? PetscLogReal(20) : 0;
  return PetscMin(PetscMax(value, low), high);
}

/* Along each logarithm in turn, in steps that halve where none is downhill. */
static PetscReal descend(Surrogate *s)
{
  PetscReal best = fit(s);
  for (PetscReal step = 1.5; step > 0.05;) {
    PetscBool moved = PETSC_FALSE;
    for (PetscInt k = 0; k <= s->dim; ++k)
      for (int sign = -1; sign <= 1; sign += 2) {
        const PetscReal old = s->hyper[k];
        s->hyper[k] = bounded(s, k, old + sign * step * (k < s->dim ? 1 : 2));
        const PetscReal value = s->hyper[k] == old ? INFINITY : fit(s);
        if (value < best - 1e-6) best = value, moved = PETSC_TRUE;
        else s->hyper[k] = old;
      }
    if (!moved) step /= 2;
  }
  return best;
}

/* Lengths and nugget; minus the logarithm of the likelihood. */
static PetscReal search(Surrogate *s)
{
  static const PetscReal lengths[] = {0.3, 1, 4}, nuggets[] = {1e-6, 1e-2};
  PetscReal best = INFINITY, hyper[HYPER] = {0};
  for (size_t i = 0; i < 6; ++i) {
    for (PetscInt d = 0; d < s->dim; ++d) s->hyper[d] = PetscLogReal(lengths[i / 2]);
    s->hyper[s->dim] = PetscLogReal(nuggets[i % 2]);
    const PetscReal value = descend(s);
    if (!(value < best)) continue;
    best = value;
    for (PetscInt k = 0; k <= s->dim; ++k) hyper[k] = s->hyper[k];
  }
  for (PetscInt k = 0; k <= s->dim; ++k) s->hyper[k] = hyper[k];
  return fit(s);
}

/* The error at value i when it is predicted from all others, and its variance (per s^2), without
 * fitting anew: Q = K^-1 - K^-1 H (H^T K^-1 H)^-1 H^T K^-1 has e_i = (Q y)_i / Q_ii, v_i = 1 / Q_ii.
 * column, row: room for n and trend numbers. */
static PetscReal leave_out(const Surrogate *s, PetscInt i, PetscReal *column, PetscReal *row, PetscReal *variance)
{
  const PetscInt n = s->n, m = s->trend;
  for (PetscInt k = 0; k < n; ++k) column[k] = k == i;
  dense_forward(n, s->l, column); /* L^-1 e_i: its products with L^-1 H, L^-1 r give those with K^-1 */
  for (PetscInt k = 0; k < m; ++k) row[k] = dense_dot(n, s->h + k * n, column);
  dense_forward(m, s->a, row);
  const PetscReal q = dense_dot(n, column, column) - dense_dot(m, row, row);
  *variance = 1 / q;
  return dense_dot(n, column, s->r) / q;
}

/* What is modelled at mean 0 and mean square 1, as y. */
static PetscReal as_value(const Surrogate *s, PetscReal modelled)
{
  const PetscReal value = s->mean + s->scale * modelled;
  return s->sign != 0 ? s->sign * PetscExpReal(value) : value;
}

/* No run is farther from what all others tell of it than its own error, two deviations, nor are they all together
 * farther than one. */
static PetscErrorCode LeaveOneOut(Surrogate *s)
{
  PetscReal *column, row[TREND], variance, squares = 0, normal = 0, largest = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n, &column));
  for (PetscInt i = 0; i < s->n; ++i) {
    const PetscReal e = leave_out(s, i, column, row, &variance);
    const PetscReal off = as_value(s, s->y[i]) - as_value(s, s->y[i] - e), square = e * e / (variance * s->variance);
    squares += off * off / (PetscReal)s->n;
    normal += square / (PetscReal)s->n;
    largest = PetscMax(largest, square);
  }
  s->left_out = PetscSqrtReal(squares);
  s->inflation = PetscMax(PetscMax(PetscSqrtReal(normal), PetscSqrtReal(largest) / DEVIATIONS), 1);
  PetscCall(PetscFree(column));
  PetscFunctionReturn(0);
}

/* To mean 0 and mean square 1. */
static void normalise(Surrogate *s, const PetscReal *y)
{
  PetscReal squares = 0;
  s->mean = 0;
  for (PetscInt i = 0; i < s->n; ++i) s->y[i] = s->sign != 0 ? PetscLogReal(s->sign * y[i]) : y[i];
  for (PetscInt i = 0; i < s->n; ++i) s->mean += s->y[i] / (PetscReal)s->n;
  for (PetscInt i = 0; i < s->n; ++i) squares += (s->y[i] - s->mean) * (s->y[i] - s->mean) / (PetscReal)s->n;
  s->scale = PetscSqrtReal(squares);
  if (!(s->scale > 1e-12 * PetscAbsReal(s->mean))) s->scale = PetscMax(1e-12 * PetscAbsReal(s->mean), 1e-300);
  for (PetscInt i = 0; i < s->n; ++i) s->y[i] = (s->y[i] - s->mean) / s->scale;
}

/* Fit y, or the logarithm of y by its sign; minus the logarithm of the likelihood of y itself, which has the
 * derivative of the logarithm, 1 / y. */
static PetscReal learn(Surrogate *s, const PetscReal *y, PetscReal sign)
{
  PetscReal logarithms = 0;
  s->sign = sign;
  normalise(s, y);
  for (PetscInt i = 0; i < s->n && sign != 0; ++i) logarithms += PetscLogReal(sign * y[i]) / (PetscReal)s->n;
  return search(s) + (PetscReal)(s->n - s->trend) * (PetscLogReal(s->scale) + logarithms);
}

/* The sign of all values if the largest is more than twice the smallest: nearer to each other their logarithms have the
 * same shape. 0: there is none. */
static PetscReal common_sign(PetscInt n, const PetscReal *y)
{
  const PetscReal sign = y[0] > 0 ? 1 : -1;
  PetscReal low = sign * y[0], high = low;
  for (PetscInt i = 1; i < n; ++i) low = PetscMin(low, sign * y[i]), high = PetscMax(high, sign * y[i]);
  return low > 0 && high > 2 * low ? sign : 0;
}

PetscErrorCode SurrogateCreate(PetscInt dim, PetscInt n, const PetscReal *x, const PetscReal *y, Surrogate **surrogate)
{
  const PetscReal sign = common_sign(n, y);
  Surrogate *s;

  PetscFunctionBeginUser;
  PetscCheck(dim <= SURROGATE_MOST && n >= dim + 4 && n <= SURROGATE_RUNS, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ,
             "so many values make no surrogate");
  PetscCall(PetscNew(surrogate));
  s = *surrogate;
  s->dim = dim;
  s->n = n;
  s->trend = dim + 1;
  PetscCall(PetscMalloc5(n * dim, &s->x, n, &s->y, n * n, &s->l, n * s->trend, &s->h, n, &s->r));
  PetscCall(PetscArraycpy(s->x, x, n * dim));
  const PetscReal by_value = learn(s, y, 0);
  if (sign != 0 && !(learn(s, y, sign) < by_value)) (void)learn(s, y, 0);
  PetscCall(LeaveOneOut(s));
  dense_backward(n, s->l, s->r); /* from here on K^-1 (y - H b) */
  PetscFunctionReturn(0);
}

PetscErrorCode SurrogateDestroy(Surrogate **surrogate)
{
  PetscFunctionBeginUser;
  if (!*surrogate) PetscFunctionReturn(0);
  PetscCall(PetscFree5((*surrogate)->x, (*surrogate)->y, (*surrogate)->l, (*surrogate)->h, (*surrogate)->r));
  PetscCall(PetscFree(*surrogate));
  PetscFunctionReturn(0);
}

void surrogate_at(const Surrogate *s, const PetscReal *x, PetscReal *value, PetscReal *error)
{
  const PetscInt n = s->n, m = s->trend;
  PetscReal k[SURROGATE_RUNS], u[TREND], mean = 0, variance = 1 + PetscExpReal(s->hyper[s->dim]);
  for (PetscInt i = 0; i < n; ++i) k[i] = correlation(s, x, s->x + i * s->dim);
  for (PetscInt t = 0; t < m; ++t) mean += s->b[t] * trend_term(x, t);
  mean += dense_dot(n, k, s->r);
  dense_forward(n, s->l, k);
  variance -= dense_dot(n, k, k);
  for (PetscInt t = 0; t < m; ++t) u[t] = trend_term(x, t) - dense_dot(n, s->h + t * n, k);
  dense_forward(m, s->a, u);
  variance += dense_dot(m, u, u);
  *value = as_value(s, mean);
  *error = DEVIATIONS * s->scale * s->inflation * PetscSqrtReal(s->variance * PetscMax(variance, 0));
  if (s->sign != 0) *error = PetscAbsReal(*value) * PetscExpReal(PetscMin(*error, HUGE_ERROR)) - PetscAbsReal(*value);
}

PetscReal surrogate_left_out(const Surrogate *s) { return s->left_out; }
