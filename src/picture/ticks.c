#include "picture/ticks.h"
#include <stdio.h>

enum { LEAST_DIGITS = 6 };

/* 1, 2 or 5 of a decade. */
typedef struct {
  PetscInt decade;
  int part; /* 0, 1, 2 */
} Step;

static PetscReal step_size(Step s)
{
  static const PetscReal parts[] = {1, 2, 5};
  return parts[s.part] * PetscPowReal(10, (PetscReal)s.decade);
}

static Step wider(Step s) { return s.part < 2 ? (Step){s.decade, s.part + 1} : (Step){s.decade + 1, 0}; }

/* No range whose steps a double knows. */
static PetscBool is_point(PetscReal min, PetscReal max)
{
  const PetscReal range = max - min, size = PetscMax(PetscAbsReal(min), PetscAbsReal(max));
  return (PetscBool) !(range > 1e-12 * size && range > 1e-300 && range < PETSC_MAX_REAL);
}

int ticks_digits(PetscReal min, PetscReal max)
{
  const PetscReal size = PetscMax(PetscAbsReal(min), PetscAbsReal(max));
  if (is_point(min, max)) return LEAST_DIGITS;
  return (int)PetscMax(LEAST_DIGITS, PetscCeilReal(PetscLog10Real(size / (max - min))) + 2);
}

/* Five to ten steps, as gnuplot takes them. */
static Step most_steps(PetscReal range)
{
  const PetscInt decade = (PetscInt)PetscFloorReal(PetscLog10Real(range));
  const PetscReal share = range / PetscPowReal(10, (PetscReal)decade);
  if (share >= 5) return (Step){decade, 0};
  return (Step){decade - 1, share >= 2 ? 2 : 1};
}

/* Numbers from *first to *last times the step lie in the range; rounding takes none of its ends away. */
static void find_ends(PetscReal min, PetscReal max, PetscReal step, PetscReal *first, PetscReal *last)
{
  *first = PetscCeilReal(min / step - 1e-9);
  *last = PetscFloorReal(max / step + 1e-9);
}

static PetscInt longest(PetscReal min, PetscReal max, PetscReal step)
{
  PetscReal first, last;
  PetscInt letters = 0;
  char number[32];
  find_ends(min, max, step, &first, &last);
  for (PetscReal k = first; k <= last; ++k)
    letters = PetscMax(letters, snprintf(number, sizeof number, "%.*g", ticks_digits(min, max), (double)(k * step)));
  return letters;
}

PetscInt ticks_letters(PetscReal min, PetscReal max)
{
  char number[32];
  if (is_point(min, max)) return snprintf(number, sizeof number, "%.*g", LEAST_DIGITS, (double)max);
  return longest(min, max, step_size(most_steps(max - min)));
}

/* Half a letter between two. */
static PetscBool fits(PetscReal min, PetscReal max, PetscReal step, PetscReal room)
{
  return (PetscBool)((PetscReal)longest(min, max, step) + 0.5 <= room * step / (max - min));
}

static PetscBool two_are_left(PetscReal min, PetscReal max, PetscReal step)
{
  PetscReal first, last;
  find_ends(min, max, step, &first, &last);
  return (PetscBool)(last > first);
}

PetscReal ticks_step(PetscReal min, PetscReal max, PetscReal room)
{
  if (is_point(min, max)) return 0;
  Step s = most_steps(max - min);
  while (!fits(min, max, step_size(s), room) && two_are_left(min, max, step_size(wider(s)))) s = wider(s);
  return step_size(s);
}
