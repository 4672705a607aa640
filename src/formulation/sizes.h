/* Kernels compiled for one dimension and number of nodes each, and how a formulation finds its own. */
#pragma once
#include "formulation/formulation.h"

typedef struct {
  PetscInt dim, nn; /* nodes of a cell; 0: each group has its own number */
  void (*assemble)(const WeakFormInput *in, WeakFormOutput *out);
  LawStatus (*commit)(const WeakFormInput *in, Points *points);
} SizedKernels;

/* What Formulation asks for, by the kernels of the points' size; a table ends with dim = 0. Nothing is done where there are no points. */
PetscErrorCode SizedAssemble(const SizedKernels *table, const WeakFormInput *in, WeakFormOutput *out);
PetscErrorCode SizedCommit(const SizedKernels *table, const WeakFormInput *in, Points *points, LawStatus *status);
