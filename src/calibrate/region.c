#include "calibrate/region.h"
#include <math.h>
#include "calibrate/region_private.h"

void region_halton(PetscInt dim, PetscInt i, PetscReal *x)
{
  static const PetscInt primes[SURROGATE_MOST] = {2, 3, 5, 7, 11, 13};
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal share = 1;
    x[d] = 0;
    /* the first numbers of large primes lie on a line */
    for (PetscInt k = i + 20; k > 0; k /= primes[d]) {
      share /= (PetscReal)primes[d];
      x[d] += share * (PetscReal)(k % primes[d]);
    }
  }
}

void region_evaluate(Region *r, PetscInt i)
{
  r->miss[i] = r->doubt[i] = r->far[i] = 0;
  for (PetscInt k = 0; k < r->n_targets; ++k) {
    const PetscReal u = r->target[k]->uncertainty;
    PetscReal *v = &r->value[i * r->n_targets + k], *e = &r->error[i * r->n_targets + k];
    surrogate_at(r->surrogate[k], r->x + i * r->dim, v, e);
    const PetscReal off = PetscAbsReal(*v - r->target[k]->value);
    r->miss[i] = PetscMax(r->miss[i], off / (u + *e));
    r->far[i] = PetscMax(r->far[i], off / u);
    r->doubt[i] = PetscMax(r->doubt[i], *e / u);
  }
}

void region_judge(Region *r)
{
  r->inside = r->best = 0;
  for (PetscInt i = 0; i < r->n; ++i) {
    const PetscBool in = r->miss[i] <= 1, best_in = r->miss[r->best] <= 1;
    r->inside += in;
    if (in == best_in ? r->far[i] < r->far[r->best] : in) r->best = i;
  }
}

/* The box evenly. */
static void fill(Region *r)
{
  r->n = REGION_CLOUD;
  r->volume = 1;
  for (PetscInt i = 0; i < r->n; ++i) {
    PetscReal *x = r->x + i * r->dim;
    region_halton(r->dim, i, x);
    for (PetscInt d = 0; d < r->dim; ++d) x[d] = r->low[d] + x[d] * (r->high[d] - r->low[d]);
    region_evaluate(r, i);
  }
  region_judge(r);
  for (PetscInt d = 0; d < r->dim; ++d) r->volume *= r->high[d] - r->low[d];
  r->volume *= (PetscReal)r->inside / (PetscReal)r->n;
}

static void fill_all(Region *r)
{
  for (PetscInt d = 0; d < r->dim; ++d) r->low[d] = 0, r->high[d] = 1;
  fill(r);
}

/* The box about all points with miss <= limit, with so much air of its width. Returns its volume. */
static PetscReal box_about(Region *r, PetscReal limit, PetscReal share)
{
  PetscReal volume = 1;
  for (PetscInt d = 0; d < r->dim; ++d) {
    PetscReal low = 1, high = 0;
    for (PetscInt i = 0; i < r->n; ++i) {
      if (r->miss[i] > limit) continue;
      low = PetscMin(low, r->x[i * r->dim + d]);
      high = PetscMax(high, r->x[i * r->dim + d]);
    }
    const PetscReal air = share * (high - low) + 1e-9;
    r->low[d] = PetscMax(low - air, 0);
    r->high[d] = PetscMin(high + air, 1);
    volume *= r->high[d] - r->low[d];
  }
  return volume;
}

/* Where nothing is inside, runs about the nearest point tell most: not all on top of it. */
static void widen(Region *r)
{
  for (PetscInt d = 0; d < r->dim; ++d) {
    const PetscReal best = r->x[r->best * r->dim + d];
    r->low[d] = PetscMax(best - 0.1, 0);
    r->high[d] = PetscMin(best + 0.1, 1);
  }
}

/* The region is smaller than the points that fill the ranges see. */
static PetscErrorCode Approach(Region *r)
{
  PetscFunctionBeginUser;
  PetscCall(RegionWalk(r, r->miss));
  if (!r->inside) {
    fill_all(r);
    PetscCall(RegionWalk(r, r->far)); /* the least miss is that of the largest doubt */
    widen(r);
    fill(r);
  } else if (r->volume * REGION_CLOUD > REGION_ENOUGH * box_about(r, 1, 0.2)) fill(r);
  else (void)box_about(r, PETSC_MAX_REAL, 0);
  PetscFunctionReturn(0);
}

PetscErrorCode RegionCreate(PetscInt dim, PetscInt n_targets, const Target *const *target, Surrogate *const *surrogate,
                            Region *r)
{
  const PetscInt n = REGION_CLOUD;

  PetscFunctionBeginUser;
  *r = (Region){.dim = dim, .n_targets = n_targets, .target = target, .surrogate = surrogate};
  PetscCall(PetscMalloc6(n * dim, &r->x, n * n_targets, &r->value, n * n_targets, &r->error, n, &r->miss, n, &r->doubt,
                         n, &r->far));
  fill_all(r);
  if (r->inside < REGION_ENOUGH) PetscCall(Approach(r));
  PetscFunctionReturn(0);
}

PetscErrorCode RegionDestroy(Region *r)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(r->x, r->value, r->error, r->miss, r->doubt, r->far));
  r->n = 0;
  PetscFunctionReturn(0);
}

void region_range(const Region *r, PetscInt parameter, PetscReal *low, PetscReal *high)
{
  *low = 1, *high = 0;
  for (PetscInt i = 0; i < r->n; ++i) {
    if (r->miss[i] > 1) continue;
    *low = PetscMin(*low, r->x[i * r->dim + parameter]);
    *high = PetscMax(*high, r->x[i * r->dim + parameter]);
  }
}

PetscBool region_alike(const Region *r, const PetscReal *a, const PetscReal *b, PetscBool meets)
{
  PetscBool alike = PETSC_TRUE;
  for (PetscInt k = 0; k < r->n_targets && alike; ++k) {
    const PetscReal u = r->target[k]->uncertainty, target = r->target[k]->value;
    PetscReal at_a, at_b, own, unused;
    surrogate_at(r->surrogate[k], a, &at_a, &own);
    surrogate_at(r->surrogate[k], b, &at_b, &unused);
    alike = PetscAbsReal(at_a - at_b) <= 0.1 * (u + own);
    if (meets && PetscAbsReal(at_a - target) <= u) alike = alike && PetscAbsReal(at_b - target) <= u;
  }
  return alike;
}

PetscReal region_correlation(const Region *r, PetscInt a, PetscInt b)
{
  PetscReal n = 0, mean[2] = {0, 0}, c[3] = {0, 0, 0};
  for (PetscInt i = 0; i < r->n; ++i)
    if (r->miss[i] <= 1) ++n, mean[0] += r->x[i * r->dim + a], mean[1] += r->x[i * r->dim + b];
  for (PetscInt i = 0; i < r->n; ++i) {
    if (r->miss[i] > 1) continue;
    const PetscReal da = r->x[i * r->dim + a] - mean[0] / n, db = r->x[i * r->dim + b] - mean[1] / n;
    c[0] += da * da, c[1] += db * db, c[2] += da * db;
  }
  return c[0] > 0 && c[1] > 0 ? c[2] / PetscSqrtReal(c[0] * c[1]) : 0;
}

PetscReal region_doubt(const Region *r)
{
  PetscReal doubt = r->inside ? 0 : r->doubt[r->best];
  for (PetscInt i = 0; i < r->n; ++i)
    if (r->miss[i] <= 1) doubt = PetscMax(doubt, r->doubt[i]);
  return doubt;
}

/* Distance from a point of the cloud, in widths of its box. */
static PetscReal distance(const Region *r, const PetscReal *a, const PetscReal *b)
{
  PetscReal d2 = 0;
  for (PetscInt d = 0; d < r->dim; ++d) {
    const PetscReal t = (a[d] - b[d]) / (r->high[d] - r->low[d]);
    d2 += t * t;
  }
  return PetscSqrtReal(d2);
}

/* What a run at point i would tell: the doubt, where the region may be; a point that is farther off
 * counts the less the more it is. Less again near other runs. */
static PetscReal worth(const Region *r, PetscInt i, PetscReal nearest)
{
  const PetscReal apart = PetscMin(1, nearest / 0.3), off = PetscMax(r->miss[i] - 1, 0);
  return apart * (r->doubt[i] + 1e-3) / (1 + 100 * off * off);
}

PetscInt region_next(const Region *r, PetscInt n, const PetscReal *x, PetscInt most, PetscInt *next)
{
  PetscInt found = 0;
  for (; found < most; ++found) {
    PetscReal best = 0;
    for (PetscInt i = 0; i < r->n; ++i) {
      const PetscReal *at = r->x + i * r->dim;
      PetscReal nearest = INFINITY;
      for (PetscInt k = 0; k < n; ++k) nearest = PetscMin(nearest, distance(r, at, x + k * r->dim));
      for (PetscInt k = 0; k < found; ++k) nearest = PetscMin(nearest, distance(r, at, r->x + next[k] * r->dim));
      const PetscReal value = worth(r, i, nearest);
      if (value > best) best = value, next[found] = i;
    }
    if (!(best > 0)) break;
  }
  return found;
}
