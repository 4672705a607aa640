#include "calibrate/parameter.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_DIGITS = 15 }; /* that a double surely has */

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

PetscReal parameter_round(const Parameter *p, PetscReal x, int finer)
{
  const PetscReal exact = parameter_at(p, x);
  const PetscReal step = PetscPowReal(10, floor(log10(slope(p, exact) / 1000)) - finer);
  char text[32];
  snprintf(text, 32, "%.*g", MOST_DIGITS, (double)PetscMin(PetscMax(round(exact / step) * step, p->low), p->high));
  return share_of(p, (PetscReal)strtod(text, NULL)); /* of the number that stands in cases and names */
}

const char *parameter_text(const Parameter *p, PetscReal x, char text[32])
{
  const double exact = (double)parameter_at(p, x);
  double value = exact;
  for (int digits = 1; digits <= MOST_DIGITS; ++digits) {
    snprintf(text, 32, "%.*g", digits, exact);
    value = strtod(text, NULL);
    if (share_of(p, (PetscReal)value) == x) break;
  }
  snprintf(text, 32, "%.*g", MOST_DIGITS, value);
  return text;
}

const char *number_text(PetscReal value, PetscReal apart, int least, char text[32])
{
  const PetscReal size = PetscAbsReal(value);
  const PetscReal wanted = size > 0 && apart > 0 ? PetscCeilReal(PetscLog10Real(size / apart)) + 2 : 0;
  snprintf(text, 32, "%.*g", (int)PetscMin(PetscMax(wanted, least), MOST_DIGITS), (double)value);
  return text;
}
