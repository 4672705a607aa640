/* Lists of numbers, one behind the other: those of list k are start[k] .. start[k + 1] - 1. */
#pragma once
#include <petscsys.h>

typedef struct {
  PetscInt *start, *item;
} Lists;

/* Room for `count` items in each of n lists. */
PetscErrorCode ListsCreate(PetscInt n, const PetscInt *count, Lists *lists);
PetscErrorCode ListsDestroy(Lists *lists);
/* Which of n lists hold each of n_items, ascending. */
PetscErrorCode ListsTranspose(PetscInt n, const Lists *lists, PetscInt n_items, Lists *transpose);
/* All items, each once, of the lists of `parts` that each of n lists names; in no order. */
PetscErrorCode ListsUnite(PetscInt n, const Lists *names, const Lists *parts, PetscInt n_items, Lists *united);
/* Those of two, each once, ascending. */
PetscErrorCode ListsMerge(PetscInt n, const Lists *a, const Lists *b, Lists *merged);
