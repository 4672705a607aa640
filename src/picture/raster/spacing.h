/* How far apart points are, so that drawn with the right size they fill their body. */
#pragma once
#include <petscsys.h>

/* radius[i]: with a ball of this size around every point, a body is covered and its edge hardly
 * grows. x is n x 3; dim 2 looks at the first two coordinates. Points that fly alone are not blown
 * up. */
PetscErrorCode PlotSpacing(PetscInt dim, PetscInt n, const PetscReal *x, PetscReal *radius);
/* The number that half of them do not exceed. */
PetscErrorCode PlotMedian(PetscInt n, const PetscReal *values, PetscReal *median);
