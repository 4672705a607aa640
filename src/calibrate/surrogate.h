/* A Gaussian process in place of an expensive number: what a run would give at x, and how sure that
 * is.
 *
 * y(x) = b0 + b.x + z(x), z with the covariance s^2 (k(x, x') + nugget): k is Matern's of order 5/2
 * with a length for each parameter. Lengths and nugget maximise the restricted likelihood, b and s
 * follow (universal kriging). Every run is then predicted from all others (leave one out): where
 * those errors are larger than the process believes, its errors are multiplied up to them. */
#pragma once
#include <petscsys.h>

#define SURROGATE_MOST 6   /* parameters */
#define SURROGATE_RUNS 512 /* values */

typedef struct Surrogate Surrogate;

/* From n values at n x dim places in [0, 1]; needs dim + 4 <= n <= SURROGATE_RUNS. */
PetscErrorCode SurrogateCreate(PetscInt dim, PetscInt n, const PetscReal *x, const PetscReal *y, Surrogate **surrogate);
PetscErrorCode SurrogateDestroy(Surrogate **surrogate);
/* The value at x, and the standard deviation of what a run would give from it. */
void surrogate_at(const Surrogate *s, const PetscReal *x, PetscReal *value, PetscReal *deviation);
/* Root mean square of the errors when each value is predicted from all others. */
PetscReal surrogate_left_out(const Surrogate *s);
