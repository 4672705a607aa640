/* A preconditioner of two levels: a sweep of Gauss-Seidel on blocks in single precision, what the coarse
 * nodes of the box make of the rest, and a sweep back (docs/theory.md, "Two levels in a box"). */
#pragma once
#include "solve/levels/coarse_box.h"

/* Collective. For the matrix of a system of displacements that is gathered, on a grid that coarse_box_fits. System,
 * grid and fixed (n_nodes x dim) must live on; they are read whenever the preconditioner is set up. */
PetscErrorCode TwoLevelsConfigure(PC pc, const System *system, const Grid *grid, const unsigned char *fixed,
                                  PetscBool symmetric);
