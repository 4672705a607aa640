/* Named sets of nodes, faces and cells. */
#include <string.h>
#include "grid/grid.h"

const GridSet *grid_find_set(const Grid *grid, const char *name)
{
  for (PetscInt s = 0; name && s < grid->n_sets; ++s)
    if (!strcmp(grid->sets[s].name, name)) return grid->sets + s;
  return NULL;
}

/* Collective: those with nodes or faces on any rank; NULL behind the last. */
static PetscErrorCode BoundaryNames(const Grid *grid, const char ***names)
{
  PetscInt *has, n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_sets + 1, &has));
  PetscCall(PetscMalloc1(grid->n_sets + 1, names));
  for (PetscInt s = 0; s < grid->n_sets; ++s) has[s] = grid->sets[s].n_nodes + grid->sets[s].n_faces;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, has, (PetscMPIInt)grid->n_sets, MPIU_INT, MPI_MAX, grid->comm));
  for (PetscInt s = 0; s < grid->n_sets; ++s)
    if (has[s]) (*names)[n++] = grid->sets[s].name;
  (*names)[n] = NULL;
  PetscCall(PetscFree(has));
  PetscFunctionReturn(0);
}

PetscErrorCode GridCheckBoundary(const Grid *grid, const char *name, const char *path, Diag *diag, PetscBool *good)
{
  const char **names;

  PetscFunctionBeginUser;
  *good = PETSC_FALSE;
  PetscCall(BoundaryNames(grid, &names));
  for (PetscInt k = 0; names[k]; ++k) *good |= !strcmp(names[k], name);
  if (!*good && !grid_find_set(grid, name)) diag_error(diag, path, "no boundary is named '%s'", name);
  else if (!*good) diag_error(diag, path, "'%s' is a region of cells, not a boundary", name);
  if (!*good) diag_hint_names(diag, name, names);
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

PetscErrorCode GridSetNames(const Grid *grid, const char ***names)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_sets + 1, names));
  for (PetscInt s = 0; s < grid->n_sets; ++s) (*names)[s] = grid->sets[s].name;
  (*names)[grid->n_sets] = NULL;
  PetscFunctionReturn(0);
}
