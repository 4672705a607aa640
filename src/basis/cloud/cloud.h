/* Meshfree shape functions of a point in a cloud of nodes: moving least squares and local maximum
 * entropy.
 *
 * Positions come as rows; lengths inside the kernels are counted in units of h, the length that the
 * call gives. All functions are pure: no memory is allocated, none is kept. docs/theory.md,
 * "Meshfree bases". */
#pragma once
#include <petscsys.h>

#define CLOUD_MAX_NODES 128

typedef enum {
  CLOUD_OK,
  /* fewer nodes than the basis has functions (MLS) or than dim + 1 (LME), or more than
   * CLOUD_MAX_NODES */
  CLOUD_TOO_FEW,
  /* moment matrix (MLS) or Hessian (LME) singular: the nodes lie on a line or a plane */
  CLOUD_DEGENERATE,
  CLOUD_OUTSIDE,        /* the point is outside the convex hull of its nodes: LME has no solution */
  CLOUD_NO_CONVERGENCE, /* LME's minimisation did not end; also numbers that are not finite */
} CloudStatus;

extern const char *const cloud_status_names[];

typedef enum { CLOUD_MLS, CLOUD_LME } CloudKind;
/* bilinear: trilinear in 3D */
typedef enum { CLOUD_LINEAR, CLOUD_BILINEAR, CLOUD_QUADRATIC } CloudOrder;
typedef enum { CLOUD_GAUSSIAN, CLOUD_CUBIC_SPLINE } CloudWeight;

typedef struct {
  CloudKind kind;
  CloudOrder order;           /* MLS */
  CloudWeight weight;         /* MLS; the cubic spline ends at the effective radius */
  PetscReal effective_radius; /* MLS, in units of h: W = exp(-(r / (effective_radius h))^2) */
  PetscReal gamma;            /* LME: beta = gamma / h^2 */
  /* in units of h: weights fall to 0 there, smoothly; 0: they are not cut */
  PetscReal reach;
} CloudBasis;

/* Number of basis polynomials: the least number of nodes. */
int cloud_minimum(const CloudBasis *basis, int dim);

/* N (n) and exact gradients dN/dx (n x dim) at x from n nodes at X (n x dim), h taken as constant
 * in space. condition: ratio of the extreme eigenvalues of the Hessian (LME) or squared pivots of
 * the moment matrix (MLS), lengths in units of h; PETSC_MAX_REAL unless CLOUD_OK. dual (dim, or
 * NULL): LME's dual variable times h, where Newton starts, and where it ended; zeros to begin with.
 * Unless CLOUD_OK, N and dN are zero and dual as well. */
CloudStatus cloud_basis(const CloudBasis *basis, int dim, int n, const PetscReal *X, PetscReal h, const PetscReal *x,
                        PetscReal *N, PetscReal *dN, PetscReal *condition, PetscReal *dual);
