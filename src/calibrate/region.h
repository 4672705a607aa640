/* The region of parameters in which all surrogates meet their targets, as a cloud of points.
 *
 * A set of parameters belongs to it if for every target |value - target| <= uncertainty +
 * error, the surrogate's own: what the surrogate does not know does not exclude anything. */
#pragma once
#include "calibrate/calibrate_spec.h"

typedef struct {
  PetscInt dim, n_targets;
  const Target *const *target;
  Surrogate *const *surrogate;
  PetscInt n;                                          /* points of the cloud */
  PetscReal low[SURROGATE_MOST], high[SURROGATE_MOST]; /* the box that it fills, in [0, 1] */
  PetscReal *x;                                        /* n x dim */
  PetscReal *value, *error;                            /* n x n_targets */
  PetscReal *miss;                                     /* the largest |value - target| over (uncertainty + error) */
  PetscReal *doubt;                                    /* the largest error over uncertainty */
  PetscReal *far;                                      /* the largest |value - target| over uncertainty */
  PetscInt inside;                                     /* how many have miss <= 1 */
  PetscReal volume;                                    /* of the region, as a share of that of the ranges */
  PetscInt best; /* the one with the least `far` of those inside, or the one with the least `miss` */
} Region;

/* Fill the cloud: all of the ranges first. Where not enough points are inside it walks closer and closer to the region
 * until they are, and fills the box about them evenly, if enough of that is inside; else those of the walk stay. */
PetscErrorCode RegionCreate(PetscInt dim, PetscInt n_targets, const Target *const *target, Surrogate *const *surrogate,
                            Region *region);
PetscErrorCode RegionDestroy(Region *region);
/* Point i of a sequence that fills [0, 1]^dim evenly (Halton's). */
void region_halton(PetscInt dim, PetscInt i, PetscReal *x);
/* Range of a parameter in the region, in [0, 1]. */
void region_range(const Region *r, PetscInt parameter, PetscReal *low, PetscReal *high);
/* Are a and b the same to all targets? Predictions differ by a tenth of uncertainty and own error at most; with `meets`
 * none that meets its target at a misses it at b. */
PetscBool region_alike(const Region *r, const PetscReal *a, const PetscReal *b, PetscBool meets);
/* How parameters a and b go together in it: their correlation. */
PetscReal region_correlation(const Region *r, PetscInt a, PetscInt b);
/* The largest doubt in the region; of its best point if it is empty. */
PetscReal region_doubt(const Region *r);
/* Up to `most` points where runs would tell most: where the region may be and the surrogates are in
 * doubt, apart from each other and from the n runs at x. Returns how many. */
PetscInt region_next(const Region *r, PetscInt n, const PetscReal *x, PetscInt most, PetscInt *next);
