/* Named sets of nodes, faces and cells. */
#include "grid/grid.h"

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
