/* The coarse nodes of a box: every second line of its nodes along each axis, and the last one. */
#pragma once
#include "grid/grid.h"
#include "solve/system/system.h"

typedef struct {
  PetscInt n;           /* coarse nodes of this rank; those that no unknown needs are left out */
  PetscInt width;       /* the most that a node has beside it: 4 or 8 */
  PetscInt *parent;     /* rows of the system x width, ghost rows too: global numbers of coarse nodes, -1: none */
  PetscReal *weight;    /* and their weights: linear along each axis */
  Mat interpolation;    /* from their displacements, along the axes, to the unknowns; nothing where one is prescribed */
  MatNullSpace motions; /* rigid ones of the coarse nodes */
} CoarseBox;

/* Collective. For a system of displacements, of which fixed (n_nodes x dim) are prescribed. */
PetscErrorCode CoarseBoxCreate(const System *system, const Grid *grid, const unsigned char *fixed, CoarseBox **box);
PetscErrorCode CoarseBoxDestroy(CoarseBox **box);
/* Has the grid such nodes, and does every rank know those that it needs? */
PetscBool coarse_box_fits(const Grid *grid);
