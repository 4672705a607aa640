/* The lines of a box, and which rank has which block of voxels. */
#include "grid/box/box.h"

VoxelBlock box_nodes(const GridBox *box, const VoxelBlock *voxels)
{
  VoxelBlock nodes = *voxels;
  const PetscInt some = block_size(voxels) > 0;
  for (PetscInt d = 0; d < box->dim; ++d) {
    nodes.hi[d] = some ? PetscMin(nodes.hi[d] + box->halo, box->counts[d]) + 1 : nodes.lo[d];
    nodes.lo[d] = some ? PetscMax(nodes.lo[d] - box->halo, 0) : nodes.lo[d];
  }
  return nodes;
}

VoxelBlock box_owned_nodes(const GridBox *box, const VoxelBlock *voxels)
{
  VoxelBlock nodes = *voxels;
  const PetscInt some = block_size(voxels) > 0;
  for (PetscInt d = 0; d < box->dim; ++d)
    nodes.hi[d] = some ? nodes.hi[d] + (nodes.hi[d] == box->counts[d]) : nodes.lo[d];
  return nodes;
}

void box_voxel_of(const Grid *grid, PetscInt cell, PetscInt ijk[LATTICE])
{
  const VoxelBlock all = box_voxels(grid->box);
  block_at(&all, grid->global_cell[cell] / grid->box->pattern[0].n_cells, ijk);
}

PetscBool box_has_centres(const GridBox *box) { return box->pattern[0].code[0][2] == VOXEL_CENTRE; }

/* Geometric lines: the last interval is `grading` times the first. */
static void fill_line(PetscReal min, PetscReal max, PetscInt n, PetscReal grading, PetscReal *line)
{
  const PetscReal ratio = n > 1 ? PetscPowReal(grading, 1.0 / (PetscReal)(n - 1)) : 1.0;
  const PetscBool uniform = grading == 1.0 || n == 1;
  const PetscReal all = uniform ? (PetscReal)n : PetscExpReal((PetscReal)n * PetscLogReal(ratio)) - 1.0;
  for (PetscInt i = 0; i <= n; ++i) {
    const PetscReal part = uniform ? (PetscReal)i : PetscExpReal((PetscReal)i * PetscLogReal(ratio)) - 1.0;
    line[i] = min + (max - min) * (part / all);
  }
  line[0] = min;
  line[n] = max;
}

static PetscErrorCode Lines(GridBox *box, const GridSpec *spec, PetscInt n_fields)
{
  PetscFunctionBeginUser;
  box->tolerance = 0;
  box->counts[LATTICE - 1] = n_fields;
  for (PetscInt d = 0; d < 3; ++d) {
    const PetscBool real = d < box->dim;
    const PetscReal min = real ? spec->min[d] : 0, max = real ? spec->max[d] : 1;
    const PetscReal grading = real && spec->grading[d] > 0 ? spec->grading[d] : 1.0;
    box->counts[d] = real ? spec->counts[d] : 1;
    PetscCall(PetscMalloc1(box->counts[d] + 1, &box->line[d]));
    fill_line(min, max, box->counts[d], grading, box->line[d]);
    if (grading == 1.0) box->per_length[d] = (PetscReal)box->counts[d] / (max - min);
    if (real) box->tolerance = PetscMax(box->tolerance, 1e-12 * (max - min));
  }
  PetscFunctionReturn(0);
}

/* Room for what hangs on the ranks. */
static PetscErrorCode RanksCreate(MPI_Comm comm, GridBox *box)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &box->rank));
  PetscCallMPI(MPI_Comm_size(comm, &box->size));
  PetscCall(PetscCalloc4(box->size, &box->block, box->size, &box->cut_axis, box->size, &box->cut, box->size + 1,
                         &box->first_node));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxCreate(MPI_Comm comm, const Case *c, GridBox **out)
{
  GridBox *box;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&box));
  box->dim = kinematics_dim(c->kinematics);
  voxel_patterns(c->grid.cell, c->grid.diagonal, box->pattern);
  PetscCall(Lines(box, &c->grid, case_fields(c)));
  PetscCall(RanksCreate(comm, box));
  *out = box;
  PetscFunctionReturn(0);
}

PetscErrorCode BoxCopy(MPI_Comm comm, const GridBox *old, GridBox **out)
{
  GridBox *box;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&box));
  *box = *old;
  box->lattice = NULL;
  for (int d = 0; d < 3; ++d) {
    PetscCall(PetscMalloc1(box->counts[d] + 1, &box->line[d]));
    PetscCall(PetscArraycpy(box->line[d], old->line[d], box->counts[d] + 1));
  }
  PetscCall(RanksCreate(comm, box));
  *out = box;
  PetscFunctionReturn(0);
}

PetscErrorCode BoxDestroy(GridBox **box)
{
  PetscFunctionBeginUser;
  if (!*box) PetscFunctionReturn(0);
  for (int d = 0; d < 3; ++d) PetscCall(PetscFree((*box)->line[d]));
  PetscCall(PetscFree((*box)->lattice));
  PetscCall(PetscFree4((*box)->block, (*box)->cut_axis, (*box)->cut, (*box)->first_node));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(0);
}

PetscErrorCode BoxCut(GridBox *box, const PetscInt *cut_axis, const PetscInt *cut)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(box->cut_axis, cut_axis, box->size));
  PetscCall(PetscArraycpy(box->cut, cut, box->size));
  PetscCall(PartitionBlocks(box->size, box->counts, cut_axis, cut, box->block));
  for (PetscMPIInt r = 0; r < box->size; ++r) {
    const VoxelBlock owned = box_owned_nodes(box, box->block + r);
    box->first_node[r + 1] =
      box->first_node[r] + block_size(&owned) + (box_has_centres(box) ? block_size(box->block + r) : 0);
  }
  PetscFunctionReturn(0);
}
