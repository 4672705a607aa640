/* A Gaussian process in place of an expensive number: what a run would give at x, and how sure that
 * is.
 *
 * y(x) = b0 + b.x + z(x), z with the covariance s^2 (k(x, x') + nugget): k is Matern's of order 5/2
 * with a length for each parameter. Lengths and nugget maximise the restricted likelihood, b and s
 * follow (universal kriging). The same of the logarithm of y, where all values have one sign and it
 * is more likely: measures go by powers of stiffness and size. Every run is then predicted from all
 * others (leave one out): where those errors are larger than the process believes, its errors are
 * multiplied up to them, and up to the largest of them. */
#pragma once
#include <petscsys.h>

#define SURROGATE_MOST 6   /* parameters */
#define SURROGATE_RUNS 512 /* values */

typedef struct Surrogate Surrogate;

/* From n values at n x dim places in [0, 1]; needs dim + 4 <= n <= SURROGATE_RUNS. */
PetscErrorCode SurrogateCreate(PetscInt dim, PetscInt n, const PetscReal *x, const PetscReal *y, Surrogate **surrogate);
PetscErrorCode SurrogateDestroy(Surrogate **surrogate);
/* The value at x, and its own error: within that of it lies what a run would give, as far as the runs tell (two
 * standard deviations). */
void surrogate_at(const Surrogate *s, const PetscReal *x, PetscReal *value, PetscReal *error);
/* Root mean square of the errors when each value is predicted from all others. */
PetscReal surrogate_left_out(const Surrogate *s);
