#include "picture/compare/lack.h"

static PetscBool has_value(const Curve *c, PetscInt i) { return (PetscBool)!PetscIsInfOrNanReal(c->value[i]); }

/* The first entry at t or behind it, n if there is none. */
static PetscInt entry_at(const Curve *c, PetscReal t)
{
  PetscInt low = 0, high = c->n;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (c->time[middle] < t) low = middle + 1;
    else high = middle;
  }
  return low;
}

/* Times are sums of steps. */
static PetscReal air_at(PetscReal t) { return 1e-9 * PetscAbsReal(t); }

/* Is there surely no value at t? Between an entry with a value and one without nobody knows. */
static PetscBool lacks_at(const Curve *c, PetscReal t)
{
  const PetscInt first = entry_at(c, t - air_at(t));
  PetscInt i = first;
  for (; i < c->n && c->time[i] <= t + air_at(t); ++i)
    if (has_value(c, i)) return PETSC_FALSE;
  if (i > first) return PETSC_TRUE;
  return (PetscBool)(first > 0 && first < c->n && !has_value(c, first - 1) && !has_value(c, first));
}

/* Is there surely a value at t? */
static PetscBool has_at(const Curve *c, PetscReal t)
{
  const PetscInt first = entry_at(c, t - air_at(t));
  PetscInt i = first;
  for (; i < c->n && c->time[i] <= t + air_at(t); ++i)
    if (has_value(c, i)) return PETSC_TRUE;
  return (PetscBool)(i == first && first > 0 && first < c->n && has_value(c, first - 1) && has_value(c, first));
}

/* Where an interval with values and one without meet, one of them begins or ends: at an entry of `at`. */
static void look_at_entries(const Curve *at, const Curve *a, const Curve *b, Lack *lack)
{
  for (PetscInt i = 0; i < at->n; ++i) {
    const PetscReal t = at->time[i];
    if (!lacks_at(a, t) || !has_at(b, t)) continue;
    lack->from = lack->any ? PetscMin(lack->from, t) : t;
    lack->to = lack->any ? PetscMax(lack->to, t) : t;
    lack->any = PETSC_TRUE;
  }
}

PetscBool curve_lack(const Curve *a, const Curve *b, Lack *lack)
{
  *lack = (Lack){0};
  look_at_entries(a, a, b, lack);
  look_at_entries(b, a, b, lack);
  return lack->any;
}
