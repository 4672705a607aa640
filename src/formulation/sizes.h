/* Kernels compiled for one dimension, number of nodes and kind of kinematics each, and how a
 * formulation finds its own. */
#pragma once
#include "formulation/walk.h"

typedef struct {
  PetscInt dim, nn; /* nodes of a cell; 0: each group has its own number */
  PetscBool hoop;   /* see Kinematics */
  /* The groups of one run; slot: where those of its first group stand in out->slot. */
  void (*assemble)(const WeakFormInput *in, const SupportRun *run, PetscInt slot, WeakFormOutput *out);
  /* the stress of one batch */
  LawStatus (*update)(const WeakFormInput *in, PetscBool tangent, Batch *b);
} SizedKernels;

/* Kernels of one size from a file's own assemble_points and batch_update, which take it as
 * constants; the former alone where the file has a commit of its own. */
#define SIZED_ASSEMBLE(dim, nn, hoop)                                                                        \
  static void assemble_##dim##d_##nn##_##hoop(const WeakFormInput *in, const SupportRun *run, PetscInt slot, \
                                              WeakFormOutput *out)                                           \
  {                                                                                                          \
    assemble_points(dim, nn, hoop, in, run, slot, out);                                                      \
  }
#define SIZED_KERNELS(dim, nn, hoop)                                                                   \
  SIZED_ASSEMBLE(dim, nn, hoop)                                                                        \
  static LawStatus update_##dim##d_##nn##_##hoop(const WeakFormInput *in, PetscBool tangent, Batch *b) \
  {                                                                                                    \
    return batch_update(dim, nn, hoop, in, tangent, b);                                                \
  }
#define SIZED_ASSEMBLE_ROW(dim, nn, hoop) {dim, nn, hoop, assemble_##dim##d_##nn##_##hoop, NULL},
#define SIZED_ROW(dim, nn, hoop) {dim, nn, hoop, assemble_##dim##d_##nn##_##hoop, update_##dim##d_##nn##_##hoop},

/* All cells in all kinematics. */
#define CELL_SIZES(EACH) EACH(2, 3, 0) EACH(2, 4, 0) EACH(2, 3, 1) EACH(2, 4, 1) EACH(3, 4, 0) EACH(3, 8, 0)
#define CLOUD_SIZES(EACH) EACH(2, 0, 0) EACH(2, 0, 1) EACH(3, 0, 0)

/* What Formulation asks for, by the kernels of each run's size; a table ends with dim = 0. */
PetscErrorCode SizedAssemble(const SizedKernels *table, const WeakFormInput *in, WeakFormOutput *out);
PetscErrorCode SizedCommit(const SizedKernels *table, const WeakFormInput *in, Points *points, LawStatus *status);
