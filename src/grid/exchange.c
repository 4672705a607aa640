/* Ghost exchange of nodal arrays. */
#include "grid/grid.h"

/* PETSc sums blocks of reals, but not a block of one: that is a real itself. */
static PetscErrorCode BlockType(PetscInt components, MPI_Datatype *type)
{
  PetscMPIInt n;

  PetscFunctionBeginUser;
  if (components == 1) {
    *type = MPIU_REAL;
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMPIIntCast(components, &n));
  PetscCallMPI(MPI_Type_contiguous(n, MPIU_REAL, type));
  PetscCallMPI(MPI_Type_commit(type));
  PetscFunctionReturn(0);
}

/* With no node shared anywhere there is nothing to say. */
static PetscBool alone(const Grid *grid)
{
  PetscMPIInt size;
  return MPI_Comm_size(grid->comm, &size) == MPI_SUCCESS && size == 1;
}

/* Owners to ghosts, or the sum of all to the owners. */
static PetscErrorCode Exchange(const Grid *grid, PetscBool sum, PetscInt components, PetscReal *values)
{
  MPI_Datatype type;

  PetscFunctionBeginUser;
  if (alone(grid) || !components) PetscFunctionReturn(0);
  PetscCall(BlockType(components, &type));
  if (sum) {
    PetscCall(PetscSFReduceBegin(grid->node_sf, type, values, values, MPI_SUM));
    PetscCall(PetscSFReduceEnd(grid->node_sf, type, values, values, MPI_SUM));
  } else {
    PetscCall(PetscSFBcastBegin(grid->node_sf, type, values, values, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(grid->node_sf, type, values, values, MPI_REPLACE));
  }
  if (type != MPIU_REAL) PetscCallMPI(MPI_Type_free(&type));
  PetscFunctionReturn(0);
}

PetscErrorCode GridToGhosts(const Grid *grid, PetscInt components, PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(Exchange(grid, PETSC_FALSE, components, values));
  PetscFunctionReturn(0);
}

PetscErrorCode GridSumToOwners(const Grid *grid, PetscInt components, PetscReal *values)
{
  PetscFunctionBeginUser;
  PetscCall(Exchange(grid, PETSC_TRUE, components, values));
  PetscFunctionReturn(0);
}
