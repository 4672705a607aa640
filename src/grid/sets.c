/* Named sets of nodes, faces and cells. */
#include "grid/grid_private.h"

PetscErrorCode GridSetDestroy(GridSet *set)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(set->name));
  PetscCall(PetscFree(set->nodes));
  PetscCall(PetscFree(set->face_cell));
  PetscCall(PetscFree(set->face_side));
  PetscCall(PetscFree(set->cells));
  PetscFunctionReturn(0);
}

PetscErrorCode GridSortUnique(PetscInt *n, PetscInt *values)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSortRemoveDupsInt(n, values));
  PetscFunctionReturn(0);
}

PetscErrorCode GridOuterFromSets(Grid *grid)
{
  GridSet *outer = &grid->outer;
  PetscInt n_nodes = 0, n_faces = 0;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < grid->n_sets; ++s) n_nodes += grid->sets[s].n_nodes, n_faces += grid->sets[s].n_faces;
  PetscCall(PetscMalloc1(n_nodes, &outer->nodes));
  PetscCall(PetscMalloc1(n_faces, &outer->face_cell));
  PetscCall(PetscMalloc1(n_faces, &outer->face_side));
  for (PetscInt s = 0; s < grid->n_sets; ++s) {
    const GridSet *set = grid->sets + s;
    PetscCall(PetscArraycpy(outer->nodes + outer->n_nodes, set->nodes, set->n_nodes));
    PetscCall(PetscArraycpy(outer->face_cell + outer->n_faces, set->face_cell, set->n_faces));
    PetscCall(PetscArraycpy(outer->face_side + outer->n_faces, set->face_side, set->n_faces));
    outer->n_nodes += set->n_nodes;
    outer->n_faces += set->n_faces;
  }
  PetscCall(GridSortUnique(&outer->n_nodes, outer->nodes));
  PetscFunctionReturn(0);
}

const GridSet *grid_find_set(const Grid *grid, const char *name)
{
  for (PetscInt s = 0; name && s < grid->n_sets; ++s)
    if (!strcmp(grid->sets[s].name, name)) return grid->sets + s;
  return NULL;
}

PetscErrorCode GridSetNames(const Grid *grid, const char ***names)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_sets + 1, names));
  for (PetscInt s = 0; s < grid->n_sets; ++s) (*names)[s] = grid->sets[s].name;
  (*names)[grid->n_sets] = NULL;
  PetscFunctionReturn(0);
}
