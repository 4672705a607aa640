/* Sides of cells as all ranks know them, whichever of both cells one looks from. */
#pragma once
#include "grid/grid.h"

enum { SIDE_KEY = 4 };

/* Its nodes by their global numbers, rising; -1 behind the last one. */
void side_key(const Grid *grid, PetscInt cell, PetscInt side, PetscInt key[SIDE_KEY]);
/* Collective. The n keys of each rank on all of them, sorted; to be freed with PetscFree. */
PetscErrorCode SideKeysGather(MPI_Comm comm, PetscInt n, const PetscInt *keys, PetscInt *n_all, PetscInt **all);
/* The first place of a key among these, -1 if it is not there; and how often it stands there. */
PetscInt side_key_find(PetscInt n, const PetscInt *all, const PetscInt key[SIDE_KEY]);
PetscInt side_key_count(PetscInt n, const PetscInt *all, const PetscInt key[SIDE_KEY]);

/* Collective. Keeps those of n sides that are of the boundary of this name; none, if there is no such boundary. */
PetscErrorCode SidesNamed(const Grid *grid, const char *boundary, PetscInt *n, PetscInt *cell, PetscInt *side);
/* Collective. Sides of which only the cell beyond is filled are looked at from there: the arrays, for PetscFree, are
 * replaced, and a rank may have more or fewer than before. *both: of how many, over all ranks, both cells are. */
PetscErrorCode SidesFromMaterial(const Grid *grid, const PetscBool *filled, PetscInt *n, PetscInt **cell,
                                 PetscInt **side, PetscInt *both);
