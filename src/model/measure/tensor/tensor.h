/* Measures of a symmetric tensor that points have: its components, invariants, principal values. */
#pragma once
#include "model/measure/measure.h"

/* Which number of the tensor, in the order of the words. */
enum { TENSOR_XX, TENSOR_YY, TENSOR_ZZ, TENSOR_XY, TENSOR_YZ, TENSOR_ZX, TENSOR_1, TENSOR_2, TENSOR_3, TENSOR_OWN };

/* The tensor of point p times its volume, which is added to *volume: sums over points are integrals. */
typedef void PointTensor(const Model *m, PetscInt p, PetscReal share, PetscReal sum[6], PetscReal *volume);

/* Collective. At the measure's tracer, if it has one, else the mean over its body or shape; NAN where
 * there is nothing. */
PetscErrorCode MeasureTensor(Model *m, const MeasureSpec *s, PetscInt index, PointTensor *tensor, PetscReal value[6]);
/* Collective. A linear field, fitted by volume to the points of one body within three of their
 * spacings, at the place of tracer `index`. */
PetscErrorCode TensorNear(Model *m, PetscInt index, PointTensor *tensor, PetscReal value[6]);

/* A component or a principal value, the largest first. */
PetscReal tensor_number(const PetscReal value[6], int which);

#define TENSOR(text, what, number, ...) \
  WORD(text, what, .value = Value, .which = number, .in = PETSC_TRUE, .may_trace = PETSC_TRUE, __VA_ARGS__)
