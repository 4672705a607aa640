/* Loads act on whole sides of cells: what of a range or shape that ends within a side goes without. */
#pragma once
#include "boundary/sides/faces.h"

/* How much of a side, 0 to 1, the selector's coordinates and shape take: 1 where they take all its nodes, and else what
 * of a raster of it. */
PetscReal side_share(const Grid *grid, const Selector *on, PetscInt cell, PetscInt side);

/* Collective. Area of the n sides that bear a load, and of what the selector takes of sides that it cuts, *n_cut of
 * them; of the latter only what looks the same way as sides that bear something: others are cut by a tolerance. */
PetscErrorCode CutSides(const Kinematics *kinematics, const Grid *grid, const Selector *on, PetscInt n,
                        const PetscInt *cell, const PetscInt *side, PetscInt n_cut, const PetscInt *cut_cell,
                        const PetscInt *cut_side, PetscReal *borne, PetscReal *cut);
