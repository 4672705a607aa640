/* Kernels compiled for one dimension and number of nodes each, and how a formulation finds its own. */
#pragma once
#include "formulation/formulation.h"

typedef struct {
  PetscInt dim, nn; /* nodes of a cell; 0: each group has its own number */
  void (*assemble)(const WeakFormInput *in, WeakFormOutput *out);
  LawStatus (*commit)(const WeakFormInput *in, Points *points);
} SizedKernels;

/* Kernels of one size from a file's own assemble_points and commit_points, which take it as constants. */
#define SIZED_KERNELS(dim, nn)                                                     \
  static void assemble_##dim##d_##nn(const WeakFormInput *in, WeakFormOutput *out) \
  {                                                                                \
    assemble_points(dim, nn, in, out);                                             \
  }                                                                                \
  static LawStatus commit_##dim##d_##nn(const WeakFormInput *in, Points *points)   \
  {                                                                                \
    return commit_points(dim, nn, in, points);                                     \
  }
#define SIZED_ROW(dim, nn)                                \
  {                                                       \
    dim, nn, assemble_##dim##d_##nn, commit_##dim##d_##nn \
  }

/* What Formulation asks for, by the kernels of the points' size; a table ends with dim = 0. Nothing is done where there are no points. */
PetscErrorCode SizedAssemble(const SizedKernels *table, const WeakFormInput *in, WeakFormOutput *out);
PetscErrorCode SizedCommit(const SizedKernels *table, const WeakFormInput *in, Points *points, LawStatus *status);
