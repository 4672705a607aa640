/* Nodes that slide along walls: which of their directions are held, beside what other entries
 * prescribe. */
#pragma once
#include "boundary/boundary.h"

/* After all entries have marked their dofs: mark those of the walls and make their frames.
 * Contradictions go to diag; NULL: they were sought before. */
PetscErrorCode SlipMark(Boundary *boundary, const Grid *grid, Diag *diag);
/* Collective. Nodes of entries with `fix: [normal]` at which there is no wall. */
PetscErrorCode SlipCheck(const Boundary *boundary, const Grid *grid, Diag *diag);
