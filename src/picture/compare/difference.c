#include "picture/compare/difference.h"
#include <math.h>

/* A place between two entries of a curve that have values. */
typedef struct {
  const Curve *curve;
  PetscInt last, following; /* entries around it; -1: none */
} Walker;

/* The next entry with a value from `i` on, the last of those at its time; -1 if there is none. */
static PetscInt entry_from(const Curve *c, PetscInt i)
{
  while (i < c->n && (PetscIsInfOrNanReal(c->value[i]) || PetscIsInfOrNanReal(c->time[i]))) ++i;
  if (i >= c->n) return -1;
  for (PetscInt k = i + 1; k < c->n && c->time[k] <= c->time[i]; ++k)
    if (!PetscIsInfOrNanReal(c->value[k])) i = k;
  return i;
}

static void walker_begin(Walker *w, const Curve *curve)
{
  w->curve = curve;
  w->last = entry_from(curve, 0);
  w->following = w->last < 0 ? -1 : entry_from(curve, w->last + 1);
}

static void walker_step(Walker *w)
{
  w->last = w->following;
  w->following = w->last < 0 ? -1 : entry_from(w->curve, w->last + 1);
}

static PetscReal last_time(const Curve *c)
{
  for (PetscInt i = c->n; i-- > 0;)
    if (!PetscIsInfOrNanReal(c->value[i]) && !PetscIsInfOrNanReal(c->time[i])) return c->time[i];
  return -PETSC_MAX_REAL;
}

/* The value at t; the walker goes on until t lies behind its last entry. */
static PetscReal value_at(Walker *w, PetscReal t)
{
  const Curve *c = w->curve;
  while (w->following >= 0 && c->time[w->following] <= t) walker_step(w);
  const PetscReal t0 = c->time[w->last], a = c->value[w->last];
  if (w->following < 0 || t <= t0) return a;
  return a + (t - t0) / (c->time[w->following] - t0) * (c->value[w->following] - a);
}

/* The first time of either curve behind t, `end` at the latest. */
static PetscReal next_time(const Walker *a, const Walker *b, PetscReal end)
{
  const PetscReal of_a = a->following < 0 ? end : a->curve->time[a->following],
                  of_b = b->following < 0 ? end : b->curve->time[b->following];
  return PetscMin(PetscMin(of_a, of_b), end);
}

PetscReal difference_relative_to(const Difference *d, PetscReal size)
{
  return d->largest == 0 ? 0 : size > 0 ? PetscAbsReal(d->largest) / size : INFINITY;
}

PetscBool curve_difference(const Curve *a, const Curve *b, Difference *d)
{
  Walker in_a, in_b;
  walker_begin(&in_a, a);
  walker_begin(&in_b, b);
  *d = (Difference){0};
  if (in_a.last < 0 || in_b.last < 0) return PETSC_FALSE;
  d->from = PetscMax(a->time[in_a.last], b->time[in_b.last]);
  d->to = PetscMin(last_time(a), last_time(b));
  if (d->from > d->to) return PETSC_FALSE;
  d->at = d->from;
  for (PetscReal t = d->from;; t = next_time(&in_a, &in_b, d->to)) {
    const PetscReal first = value_at(&in_a, t), second = value_at(&in_b, t);
    d->size = PetscMax(d->size, PetscAbsReal(first));
    d->last = second - first;
    if (PetscAbsReal(d->last) > PetscAbsReal(d->largest)) d->largest = d->last, d->at = t;
    if (t >= d->to) break;
  }
  d->relative = difference_relative_to(d, d->size);
  return PETSC_TRUE;
}
