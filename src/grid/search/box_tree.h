/* Bounding boxes (6 numbers each: min[3], max[3]; axes beyond dim 0) in a balanced tree. Those of
 * very different sizes cost no more than equal ones, as they would in uniform bins. */
#pragma once
#include <petscsys.h>

typedef struct BoxTree BoxTree;

/* Takes the bounds. */
PetscErrorCode BoxTreeCreate(PetscInt n, PetscReal (*bounds)[6], BoxTree **tree);
PetscErrorCode BoxTreeDestroy(BoxTree **tree);
/* Call `visit` for the boxes that hold x, until it returns PETSC_FALSE. */
typedef PetscBool (*BoxVisit)(void *context, PetscInt index);
void box_tree_holding(const BoxTree *tree, const PetscReal x[3], BoxVisit visit, void *context);
/* The nearest object, by `distance` (squared), which is never less than that of its box; -1: none is
 * nearer than `within` (squared, m2). */
typedef PetscReal (*BoxDistance)(void *context, PetscInt index);
PetscInt box_tree_nearest(const BoxTree *tree, const PetscReal x[3], PetscReal within, BoxDistance distance,
                          void *context);
/* Squared distance of x from a box, 0 inside. */
static inline PetscReal box_squared_distance(const PetscReal bounds[6], const PetscReal x[3])
{
  PetscReal sum = 0;
  for (int d = 0; d < 3; ++d) {
    const PetscReal gap = PetscMax(PetscMax(bounds[d] - x[d], x[d] - bounds[d + 3]), 0.0);
    sum += gap * gap;
  }
  return sum;
}

/* The box around n positions x (n x dim). */
static inline void box_around(PetscInt dim, PetscInt n, const PetscReal *x, PetscReal bounds[6])
{
  for (PetscInt d = 0; d < 3; ++d) {
    bounds[d] = d < dim ? PETSC_MAX_REAL : 0;
    bounds[d + 3] = d < dim ? -PETSC_MAX_REAL : 0;
  }
  for (PetscInt k = 0; k < n * dim; ++k) {
    bounds[k % dim] = PetscMin(bounds[k % dim], x[k]);
    bounds[k % dim + 3] = PetscMax(bounds[k % dim + 3], x[k]);
  }
}
