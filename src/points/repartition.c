/* Points follow their cells to the ranks that have them after a grid was shared anew. */
#include "grid/search/directory.h"
#include "points/points.h"

/* Points stand in the order of their cells: the number of each cell that holds some, once. at[p]:
 * where it stands, -1 of a lost point. */
static PetscErrorCode ListCells(const Points *points, const Grid *old, PetscInt *at, PetscInt *n, PetscInt **cell)
{
  PetscInt last = -1;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(points->n, cell));
  *n = 0;
  for (PetscInt p = 0; p < points->n; ++p) {
    at[p] = -1;
    if (points->cell[p] < 0) continue;
    if (points->cell[p] != last) (*cell)[(*n)++] = old->global_cell[points->cell[p]];
    last = points->cell[p];
    at[p] = *n - 1;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PointsRepartition(Points *points, const Grid *old, const Grid *grid, PetscInt *moved)
{
  PetscInt n = 0, *at, *cell = NULL;
  PetscMPIInt rank, *owner;
  DirectoryPlace *place;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCall(PetscMalloc2(points->n, &at, points->n, &owner));
  PetscCall(ListCells(points, old, at, &n, &cell));
  PetscCall(PetscMalloc1(n, &place));
  PetscCall(DirectoryFind(grid->comm, grid->n_cells_global, grid->n_cells, grid->global_cell, n, cell, place));
  for (PetscInt p = 0; p < points->n; ++p) {
    owner[p] = rank;
    if (at[p] < 0) continue;
    owner[p] = (PetscMPIInt)place[at[p]].rank;
    points->cell[p] = place[at[p]].index;
    *moved += owner[p] != rank;
  }
  PetscCall(PointsTransfer(points, grid, owner));
  PetscCall(PointsSort(points));
  PetscCall(PetscFree(place));
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree2(at, owner));
  PetscFunctionReturn(0);
}
