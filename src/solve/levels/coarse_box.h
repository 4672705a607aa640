/* The coarse nodes of a box: every second line of its nodes along each axis, and the last one. */
#pragma once
#include "grid/grid.h"
#include "solve/system/system.h"

/* Collective. Interpolation from displacements of the coarse nodes, along the axes, to the unknowns of a
 * system: linear along each axis, and nothing where something is prescribed (fixed, n_nodes x
 * dim). Coarse nodes that no unknown needs are left out. motions: rigid ones of the coarse nodes. */
PetscErrorCode CoarseBoxInterpolation(const System *system, const Grid *grid, const unsigned char *fixed,
                                      Mat *interpolation, MatNullSpace *motions);
/* Has the grid such nodes, and does every rank know those that it needs? */
PetscBool coarse_box_fits(const Grid *grid);
