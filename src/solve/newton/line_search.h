/* How far to go along a Newton direction. */
#pragma once
#include <petscsnes.h>

/* What a search remembers from one iteration of a step to the next. */
typedef struct {
  PetscReal best; /* smallest residual of this step */
  PetscInt stale; /* iterations since it was met */
  PetscInt block; /* unknowns per node of which the last is a pressure; 0: none is */
} LineSearchMemory;

/* For SNESLineSearchShellSetUserFunc, with a LineSearchMemory as context. The first direction of a
 * step is taken in full, unless a point would be turned inside out: from rest a good iteration lets
 * the residual grow by two orders before it falls. Later directions are shortened (a bracketed
 * secant on y . F) if too much work along the direction is left. Plastic points can also hand the
 * iteration back and forth between two sides of their yield surface, each full step passing that
 * test: after three iterations without progress half steps are taken. */
PetscErrorCode LineSearchDescend(SNESLineSearch search, void *memory);
