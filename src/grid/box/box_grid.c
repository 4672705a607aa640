/* Box grids: which operations they have, and what no box can be made of. */
#include "grid/box/box.h"

/* A mistake of the user, the same on all ranks: said once. */
#define GridError(comm, diag, path, ...)                           \
  do {                                                             \
    PetscMPIInt grid_error_rank;                                   \
    PetscCallMPI(MPI_Comm_rank((comm), &grid_error_rank));         \
    if (!grid_error_rank) diag_error((diag), (path), __VA_ARGS__); \
  } while (0)

/* What the case reader lets through but no grid can be made of. */
static PetscBool box_valid(MPI_Comm comm, const Case *c, Diag *diag)
{
  const GridSpec *spec = &c->grid;
  const PetscInt dim = kinematics_dim(c->kinematics);
  PetscReal entities = 6.0 * (PetscReal)case_fields(c); /* bounds cells, nodes and the entries of cell_node */
  if (cells[spec->cell].dim != dim) {
    GridError(comm, diag, "grid.cell", "a %s does not fit %s kinematics", cells[spec->cell].name,
              dim == 3 ? "three-dimensional" : "two-dimensional");
    return PETSC_FALSE;
  }
  for (PetscInt d = 0; d < dim; ++d) {
    entities *= (PetscReal)spec->counts[d] + 1.0;
    if (spec->counts[d] >= 1 && spec->max[d] > spec->min[d] && PetscIsNormalReal(spec->max[d] - spec->min[d])) continue;
    GridError(comm, diag, "grid", "the box has no cells along %c", (char)('x' + d));
    return PETSC_FALSE;
  }
  if (entities * cells[spec->cell].nodes < (PetscReal)PETSC_MAX_INT) return PETSC_TRUE;
  GridError(comm, diag, "grid", "the box would have about %.3g nodes, more than this build of PETSc can number",
            (double)(entities / 6.0));
  return PETSC_FALSE;
}

static PetscErrorCode Create(MPI_Comm comm, const Case *c, GridWeight weight, void *context, Diag *diag, Grid **grid)
{
  GridBox *box = NULL;

  PetscFunctionBeginUser;
  *grid = NULL;
  if (!box_valid(comm, c, diag)) PetscFunctionReturn(0);
  PetscCall(BoxCreate(comm, c, &box));
  PetscCall(BoxPartition(comm, box, weight, context));
  PetscCall(BoxBuild(comm, &grid_box, c->grid.cell, box, grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Grid *grid)
{
  PetscFunctionBeginUser;
  PetscCall(BoxDestroy(&grid->box));
  PetscFunctionReturn(0);
}

static PetscBool cells_alike(const Grid *grid)
{
  const PetscReal most = grid->smallest * (1 + 1e-9);
  for (PetscInt d = 0; d < grid->dim; ++d) {
    const PetscReal *line = grid->box->line[d];
    for (PetscInt i = 0; i < grid->box->counts[d]; ++i)
      if (line[i + 1] - line[i] > most) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

const GridOps grid_box = {
  .aligned = PETSC_TRUE,
  .starts_alike = PETSC_TRUE,
  .Create = Create,
  .Destroy = Destroy,
  .locate = box_locate,
  .clamp = box_clamp,
  .candidates = box_candidates,
  .cells_alike = cells_alike,
  .WeighCells = BoxWeighCells,
  .Widen = BoxWiden,
  .FromCuts = BoxFromCuts,
  .PartitionToTable = BoxPartitionToTable,
  .FromPartition = BoxFromPartition,
};
