/* What a kind of grid can do. A box, a mesh and a cloud each fill one table; what is NULL it cannot
 * do. */
#pragma once
#include "grid/grid.h"
#include "grid/partition/partition.h"

struct GridOps {
  PetscBool aligned; /* do its sides lie across the axes? */
  /* is it always shared in the same way among as many ranks, for the same case? */
  PetscBool starts_alike;
  /* As GridCreate. */
  PetscErrorCode (*Create)(MPI_Comm comm, const Case *c, GridWeight weight, void *context, Diag *diag, Grid **grid);
  /* Free what only this kind has. */
  PetscErrorCode (*Destroy)(Grid *grid);
  /* As grid_locate, grid_clamp, grid_candidates and grid_cells_alike. */
  PetscInt (*locate)(const Grid *grid, const PetscReal *x, PetscInt guess, PetscReal *xi);
  void (*clamp)(const Grid *grid, PetscReal *x);
  PetscInt (*candidates)(const Grid *grid, const PetscReal *x, PetscInt max, PetscMPIInt *ranks);
  PetscBool (*cells_alike)(const Grid *grid);
  /* As GridWiden. */
  PetscErrorCode (*Widen)(const Grid *old, PetscInt halo, Grid **grid);
  /* Share anew: this rank's cells on a lattice of voxels (arrays to be freed with PetscFree2), and
   * the grid for cuts of that lattice. Collective. */
  PetscErrorCode (*WeighCells)(const Grid *grid, const PetscReal *weight, VoxelWeights *voxels);
  PetscErrorCode (*FromCuts)(const Grid *old, const PetscInt *cut_axis, const PetscInt *cut, Grid **grid);
  /* As GridPartitionToTable and GridFromPartition. */
  PetscErrorCode (*PartitionToTable)(const Grid *grid, Tables *tables);
  PetscErrorCode (*FromPartition)(const Grid *old, const Table *table, Grid **grid, char reason[256]);
};

extern const GridOps grid_box, grid_mesh;

/* What every builder ends with. Collective. */
PetscErrorCode GridFinish(Grid *grid);
