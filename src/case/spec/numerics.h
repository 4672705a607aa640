/* How equations are solved, and what functions of the grid carry them. */
#pragma once
#include "case/kinematics/kinematics.h"

typedef enum { LINEAR_AUTO, LINEAR_DIRECT, LINEAR_ITERATIVE } LinearChoice;

typedef struct {
  PetscReal residual, residual_absolute;   /* relative to the largest force met; N */
  PetscReal increment, increment_absolute; /* relative to the step's displacement; m */
  PetscInt max_iterations;
  PetscInt ease; /* a step that needs at most so many iterations lets the next grow */
} NewtonSpec;

typedef enum { ORDER_LINEAR, ORDER_BILINEAR, ORDER_QUADRATIC } BasisOrder;
typedef enum { WEIGHT_GAUSSIAN, WEIGHT_CUBIC_SPLINE } BasisWeight;
typedef enum { CLOUD_CHOICE_ADAPTIVE, CLOUD_CHOICE_NEAREST, CLOUD_CHOICE_FIXED } CloudChoice;
typedef enum { ESSENTIAL_AUTO, ESSENTIAL_DIRECT, ESSENTIAL_CONSTRAINTS } EssentialKind;

/* Shape functions, most numbers of clouds of nodes (gmm). Lengths are over the cell size of the
 * grid that gives the nodes. */
typedef struct {
  const char *kind;     /* one of basis_names[] (support/basis.h); NULL: the cell */
  PetscBool by_default; /* the case does not name it */
  CloudChoice choice;
  PetscReal radius;     /* of a cloud */
  PetscReal max_radius; /* that it may grow to */
  PetscReal condition;  /* of a basis that needs no more nodes */
  PetscInt minimum;     /* least number of nodes; 0: what the basis needs */
  /* nodes farther apart do not belong to the same material; 0: no limit */
  PetscReal gap;
  PetscReal effective_radius; /* mls: dilation of the weight function */
  BasisOrder order;           /* mls */
  BasisWeight weight;         /* mls */
  PetscReal gamma;            /* lme: locality, beta = gamma / h^2 */
  PetscReal split;            /* gimp: points whose neighbours stand farther away are split, cells; 0: never */
  EssentialKind essential;
} BasisSpec;

typedef struct {
  PetscReal stiffness, mass, inertia; /* see docs/theory.md, cells that are not full */
  PetscReal curvature;                /* see docs/theory.md, smooth shape functions */
  PetscReal follow;                   /* see docs/theory.md, nodes that follow */
  PetscBool room;                     /* see docs/theory.md, the room that points have */
} StabilisationSpec;

typedef struct {
  PetscReal stabilisation; /* of the pressure, alpha: the term is alpha / G */
} MixedSpec;
