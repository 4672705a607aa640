#include "picture/compare/found.h"

/* The first entry of what was found, -1 if this is no such curve. */
static PetscInt found_from(const Curve *c)
{
  PetscInt from = c->n;
  if (c->n < 2 || PetscIsInfOrNanReal(c->value[c->n - 1])) return -1;
  while (from > 0 && c->value[from - 1] == c->value[c->n - 1]) --from;
  for (PetscInt i = 0; i < from; ++i)
    if (!PetscIsInfOrNanReal(c->value[i])) return -1;
  return from > 0 ? from : -1;
}

PetscBool curve_found_difference(const Curve *a, const Curve *b, Difference *d)
{
  const PetscInt i = found_from(a), k = found_from(b);
  if (i < 0 || k < 0 || a->time[i] == b->time[k]) return PETSC_FALSE;
  const PetscReal first = a->value[i], apart = b->value[k] - first;
  *d = (Difference){.from = PetscMin(a->time[i], b->time[k]),
                    .to = PetscMax(a->time[i], b->time[k]),
                    .size = PetscAbsReal(first),
                    .largest = apart,
                    .last = apart};
  d->at = d->to;
  d->relative = difference_relative_to(d, d->size);
  return PETSC_TRUE;
}
