/* The volumetric part of the laws with p = K (J - 1) or p = K ln J / J, for points side by side. */
#pragma once
#include "material/algebra/lanes.h"
#include "material/algebra/shape.h"

/* q = J p and dq = J dq/dJ = J (p + J dp/dJ). */
LANES_INLINE void volume_lanes(const PetscReal *parameters, const Lanes *J, Lanes *q, Lanes *dq)
{
  const PetscReal K = parameters[SPLIT_BULK];
  if (split_volume(parameters) == VOLUME_LOG) {
    lanes_log(J, q);
    *q *= K;
    *dq = 0.0 * *J + K;
  } else {
    *q = K * *J * (*J - 1.0);
    *dq = K * *J * (2.0 * *J - 1.0);
  }
}
