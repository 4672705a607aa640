/* Which kind of grid a case asks for. */
#include "grid/grid_ops.h"

static const GridOps *const kinds[] = {[GRID_BOX] = &grid_box, [GRID_MESH] = &grid_mesh};

PetscErrorCode GridCreate(MPI_Comm comm, const Case *c, GridWeight weight, void *context, Diag *diag, Grid **grid)
{
  PetscFunctionBeginUser;
  PetscCall(kinds[c->grid.kind]->Create(comm, c, weight, context, diag, grid));
  PetscFunctionReturn(0);
}
