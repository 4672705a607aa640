/* The sides of cells under a load, and what a user should know of them. */
#pragma once
#include "boundary/sides/faces.h"

/* Collective. Sides of the grid that the selector takes, those within a mesh as sides of the cell that holds points, if
 * one of both does. To be freed with PetscFree. */
PetscErrorCode SidesOfGrid(const Grid *grid, const Points *points, const Selector *on, PetscInt *n, PetscInt **cell,
                           PetscInt **side);
/* Collective. Those of them whose cells hold points. *both: of how many, over all ranks, the cell beyond does, too. */
PetscErrorCode FilledSides(const Grid *grid, const Points *points, const Selector *on, PetscInt *n, PetscInt **cell,
                           PetscInt **side, PetscInt *both);

/* Collective. Does the load, with n_faces sides on all ranks, act on anything, and on all that it asks for? fills: as
 * in LoadsCreate. */
PetscErrorCode LoadSidesTell(const Grid *grid, const Case *c, const Points *points, PetscInt load, PetscBool fills,
                             PetscInt n_faces, const char *path, Diag *diag);
