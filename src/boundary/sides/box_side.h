/* Sides of a box, as places in space, and what bodies that fill their shapes have there. */
#pragma once
#include "boundary/sides/faces.h"

/* A selector that names a side of a box takes the place of that side instead. */
void put_on_side(const Grid *grid, Selector *on);
/* Collective. Area of what the selector takes of the surface of a body that fills its shape. */
PetscErrorCode SurfaceArea(const Grid *grid, const Case *c, PetscInt body, const Selector *on, PetscReal *area);
/* Collective. A warning where sides of cells of this area bear a load on a side of the box, of which bodies that fill
 * their shapes take less; at the start alone, while these are where they were drawn. fills: as in LoadsCreate. */
PetscErrorCode TellUncovered(const Grid *grid, const Case *c, const Selector *on, PetscBool fills, PetscReal borne,
                             const char *path, Diag *diag);
