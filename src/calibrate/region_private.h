/* What the files of the region share. */
#pragma once
#include "calibrate/region.h"

enum { REGION_CLOUD = 12000, REGION_ENOUGH = 600 }; /* points that are tried at a time, and wanted inside */

/* What the surrogates say of point i. */
void region_evaluate(Region *r, PetscInt i);
/* How many points are inside, and the best one. */
void region_judge(Region *r);
/* region_walk.c: from points that fill the ranges evenly to where `off` (miss or far) is at most 1, until enough points
 * are inside or none is any nearer. Points that fill the region evenly stay, each once. */
PetscErrorCode RegionWalk(Region *r, const PetscReal *off);
