/* Which rank has which nodes and points. A cloud's owners move with the material, so their parts
 * stay compact while a body only bends or turns; when it flows they grow ragged and need ever more
 * ghosts. Then space is cut anew. */
#include "grid/partition/bisection.h"
#include "method/gmm/gmm.h"

#define RAGGED 1.5 /* so many times the ghosts of fresh cuts call for new ones */

static PetscErrorCode SendPoints(const SpaceCuts *cuts, const Grid *grid, Points *points)
{
  PetscMPIInt *owner;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(points->n, &owner));
  for (PetscInt p = 0; p < points->n; ++p) owner[p] = space_owner(cuts, point_real(points, POINT_X, p));
  PetscCall(PointsTransfer(points, grid, owner));
  PetscCall(PointsSort(points));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}

static PetscErrorCode SendNodes(const SpaceCuts *cuts, Grid *grid)
{
  PetscMPIInt *owner;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_owned, &owner));
  for (PetscInt i = 0; i < grid->n_owned; ++i) owner[i] = space_owner(cuts, grid->x + i * grid->dim);
  PetscCall(GridCloudMigrate(grid, owner));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}

PetscErrorCode GmmRedistribute(Discretisation *s)
{
  SpaceCuts cuts;

  PetscFunctionBeginUser;
  PetscCall(SpaceCutsCreate(s->grid->comm, s->grid->dim, s->points->n, s->points->real[POINT_X], &cuts));
  PetscCall(SendNodes(&cuts, s->grid));
  PetscCall(SendPoints(&cuts, s->grid, s->points));
  PetscCall(SendPoints(&cuts, s->grid, s->tracers));
  PetscCall(SendPoints(&cuts, s->grid, s->loads->carriers));
  PetscCall(SpaceCutsDestroy(&cuts));
  s->grid->cloud->balanced_ghosts = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode GmmBalance(Discretisation *s)
{
  PetscInt ghosts = s->grid->n_nodes - s->grid->n_owned, all;

  PetscFunctionBeginUser;
  if (!s->started) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Allreduce(&ghosts, &all, 1, MPIU_INT, MPI_SUM, s->grid->comm));
  if (!s->grid->cloud->balanced_ghosts) s->grid->cloud->balanced_ghosts = all;
  if ((PetscReal)all > RAGGED * (PetscReal)s->grid->cloud->balanced_ghosts) PetscCall(GmmRedistribute(s));
  PetscFunctionReturn(0);
}
