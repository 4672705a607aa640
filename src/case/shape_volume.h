/* How much of space a shape takes. */
#pragma once
#include "case/case.h"

/* m3; m2 in plane strain, that of the full circle in axisymmetry (its part with x > 0). Exact
 * for boxes, balls and polygons; of others what lies between `min` and `max` (m: the grid's), by
 * lines to about 3e-4. Infinite if they are boxes without an end. */
PetscReal shape_volume(const Shape *shape, const Kinematics *kinematics, const PetscReal *min, const PetscReal *max);
