/* The value of a parameter by its share x of the range, from 0 to 1, and numbers as text. */
#pragma once
#include "calibrate/calibrate_spec.h"

/* A range of a decade or more is divided by the logarithm: what is looked for may be of any size, and measures go by
 * powers of it more than by sums. */
PetscBool parameter_is_logarithmic(const Parameter *p);
PetscReal parameter_at(const Parameter *p, PetscReal x);
/* The share of the value next to that at x which has no more digits than tell a thousandth of the range, as it is
 * divided there, and `finer` more. */
PetscReal parameter_round(const Parameter *p, PetscReal x, int finer);
/* The value at x, with the fewest digits that give x back. Returns text. */
const char *parameter_text(const Parameter *p, PetscReal x, char text[32]);
/* With so many digits at least, and as many more as numbers want that lie `apart` from each other: a hundredth of that
 * is seen. Returns text. */
const char *number_text(PetscReal value, PetscReal apart, int least, char text[32]);
