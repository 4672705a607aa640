/* Loops over the points of each kind of cells, and over nodes with all of their numbers at once. */
#pragma once
#include "method/discretisation.h"

#define UNROLLED static inline __attribute__((always_inline))

/* loop(dim, nn, run, ...) with sizes known to the compiler where that pays; nn 0: each group has its
 * own number of nodes. */
#define WITH_SIZES(loop, s, ...)                                                     \
  do {                                                                               \
    const Support *sized = (s)->support;                                             \
    const SupportRun any = {.nodes = 0, .first = 0, .end = sized->n_groups};         \
    const SupportRun *run = sized->n_runs ? sized->run : &any;                       \
    for (PetscInt k = 0; k < PetscMax(sized->n_runs, 1); ++k, ++run) {               \
      if ((s)->grid->dim == 2 && run->nodes == 4) loop(2, 4, run, __VA_ARGS__);      \
      else if ((s)->grid->dim == 2 && run->nodes == 3) loop(2, 3, run, __VA_ARGS__); \
      else if ((s)->grid->dim == 3 && run->nodes == 8) loop(3, 8, run, __VA_ARGS__); \
      else loop((s)->grid->dim, run->nodes, run, __VA_ARGS__);                       \
    }                                                                                \
  } while (0)

/* Four numbers of a node, which are one register: velocity and acceleration in the plane; in space it has two of
 * them, of which the second is half empty. */
typedef PetscReal Four __attribute__((vector_size(4 * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));

UNROLLED Four take(const PetscInt part, const PetscInt width, const PetscReal *x)
{
  if (4 * part + 4 <= width) return *(const Four *)(x + 4 * part);
  return (Four){x[4 * part], x[4 * part + 1], 0, 0};
}

UNROLLED void give(const PetscInt part, const PetscInt width, Four more, PetscReal *x)
{
  if (4 * part + 4 <= width) *(Four *)(x + 4 * part) += more;
  else x[4 * part] += more[0], x[4 * part + 1] += more[1];
}
