/* Loads that vary from place to place: by formulas of the case file, and by functions that a caller
 * of the library gives, as amplitudes give factors that vary with time. */
#pragma once
#include <petscsys.h>

struct Diag;
struct Loads;

/* Factors of a load at n places of this rank at time t, s: f (n x 3, ones on entry) multiplies
 * the components of its traction or force; a pressure, which has a direction of its own, takes
 * the first. X, x: places of the material as undeformed and when the step begins, m, n x 3, in
 * the plane too. */
typedef void (*LoadFactors)(void *context, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t,
                            PetscReal *f);

typedef struct {
  LoadFactors ask; /* NULL: ones */
  void *context;
} LoadAsked;

/* Of a ring that a piece x + s edge, |s| <= 1, makes: from x to the mean of its places by their radius. A load that
 * varies as the places do has its mean there. */
static inline PetscReal load_lean(const PetscReal *x, const PetscReal *edge, PetscInt d)
{
  return x[0] > 0 ? edge[0] / (3 * x[0]) * edge[d] : 0;
}

/* Not collective, but functions are asked on every rank. Factors of a load on faces of the grid,
 * at their quadrature points, at time t; *f is NULL if there are none, else to be freed. */
PetscErrorCode LoadFactorsOfFaces(const struct Loads *loads, PetscInt load, PetscReal t, PetscReal **f);
/* Likewise of all carriers (n x 3), of pressures or of all other loads that are carried; ones
 * for those without a function. */
PetscErrorCode LoadFactorsOfCarriers(const struct Loads *loads, PetscBool pressures, PetscReal t, PetscReal **f);
/* Collective. Is a formula of the case no number somewhere when the case begins? */
PetscErrorCode LoadFactorsCheck(const struct Loads *loads, MPI_Comm comm, struct Diag *diag);
