/* The sides of cells under a load, and what a user should know of them. */
#pragma once
#include "boundary/sides/faces.h"

/* Sides of the grid that the selector takes, of cells that hold points. To be freed with PetscFree. */
PetscErrorCode FilledSides(const Grid *grid, const Points *points, const Selector *on, PetscInt *n, PetscInt **cell,
                           PetscInt **side);

/* Collective. Does the load, with n_faces sides on all ranks, act on anything, and on all that it asks for? fills: as
 * in LoadsCreate. */
PetscErrorCode LoadSidesTell(const Grid *grid, const Case *c, const Points *points, PetscInt load, PetscBool fills,
                             PetscInt n_faces, const char *path, Diag *diag);
