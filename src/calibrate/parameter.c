#include "calibrate/parameter.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

PetscBool parameter_is_logarithmic(const Parameter *p) { return (PetscBool)(p->low > 0 && p->high >= 10 * p->low); }

PetscReal parameter_at(const Parameter *p, PetscReal x)
{
  if (parameter_is_logarithmic(p)) return p->low * PetscPowReal(p->high / p->low, x);
  return p->low + x * (p->high - p->low);
}

static PetscReal share_of(const Parameter *p, PetscReal value)
{
  if (parameter_is_logarithmic(p)) return PetscLogReal(value / p->low) / PetscLogReal(p->high / p->low);
  return (value - p->low) / (p->high - p->low);
}

/* By how much the value changes with x. */
static PetscReal slope(const Parameter *p, PetscReal value)
{
  return parameter_is_logarithmic(p) ? value * PetscLogReal(p->high / p->low) : p->high - p->low;
}

const char *parameter_text(const Parameter *p, PetscReal *x, char text[32])
{
  const PetscReal exact = parameter_at(p, *x), step = PetscPowReal(10, floor(log10(slope(p, exact) / 1000)));
  const PetscReal value = PetscMin(PetscMax(round(exact / step) * step, p->low), p->high);
  snprintf(text, 32, "%.15g", (double)value);
  *x = share_of(p, (PetscReal)strtod(text, NULL));
  return text;
}

const char *number_text(PetscReal value, PetscReal apart, int least, char text[32])
{
  enum { MOST = 15 };
  const PetscReal size = PetscAbsReal(value);
  const PetscReal wanted = size > 0 && apart > 0 ? PetscCeilReal(PetscLog10Real(size / apart)) + 2 : 0;
  snprintf(text, 32, "%.*g", (int)PetscMin(PetscMax(wanted, least), MOST), (double)value);
  return text;
}
