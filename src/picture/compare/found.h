/* What a run finds at some time and keeps: a limit load, a factor of safety. */
#pragma once
#include "picture/compare/difference.h"

/* Both curves have no value at first and a single one from some time to their ends, and these times are two: the
 * difference of what was found, and from the earlier to the later one. PETSC_FALSE of all others. */
PetscBool curve_found_difference(const Curve *a, const Curve *b, Difference *difference);
