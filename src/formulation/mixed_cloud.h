/* The mixed formulation of points that each have a cloud of nodes of their own (group g is point
 * g), for this room only. */
#pragma once
#include "formulation/sizes.h"

extern const SizedKernels mixed_cloud_kernels[];
