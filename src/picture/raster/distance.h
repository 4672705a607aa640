/* How far the pixels of an image are from some of them. */
#pragma once
#include <petscsys.h>

/* Of each pixel the distance to the nearest one that is `in`, in pixels, and which that is; -1 and
 * infinity if none is. */
PetscErrorCode DistanceTo(int width, int height, const unsigned char *in, float *distance, int *nearest);
