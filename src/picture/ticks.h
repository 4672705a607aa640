/* Numbers along an axis that is not logarithmic. */
#pragma once
#include <petscsys.h>

/* Digits in which they differ, six at least: those of a narrow range are a tenth of it apart. */
int ticks_digits(PetscReal min, PetscReal max);
/* Letters of the longest that may stand there, whatever their distance. */
PetscInt ticks_letters(PetscReal min, PetscReal max);
/* The distance of those that stand side by side along so many letters: as gnuplot chooses it, or the next of 1, 2 and 5
 * that is wide enough, as long as two are left. 0 if there is no range. */
PetscReal ticks_step(PetscReal min, PetscReal max, PetscReal room);
