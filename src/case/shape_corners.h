#pragma once
#include "case/case.h"

/* Narrows a box around an intersection to what its half-spaces leave of it; a box with an open side stays. */
void corner_bounds(const Shape *intersection, PetscInt dim, PetscReal min[3], PetscReal max[3]);
