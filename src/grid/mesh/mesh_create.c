/* Meshes from files: rank 0 reads and checks the mesh, which is then a grid like any other, all of
 * it on one rank, and goes to the others as it would from any ranks. */
#include "grid/mesh/file_mesh.h"

/* What is the same on all ranks, from rank 0. */
static PetscErrorCode ShareFacts(MPI_Comm comm, Grid *grid)
{
  PetscInt fact[] = {grid->type, grid->first_type, grid->n_cells_global, grid->n_nodes_global, grid->n_sets};
  PetscReal extent[7] = {grid->min[0], grid->min[1], grid->min[2],  grid->max[0],
                         grid->max[1], grid->max[2], grid->smallest};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(fact, 5, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(extent, 7, MPIU_REAL, 0, comm));
  grid->type = (CellType)fact[0];
  grid->first_type = (CellType)fact[1];
  grid->nodes_per_cell = cells[grid->type].nodes;
  grid->n_cells_global = fact[2];
  grid->n_nodes_global = fact[3];
  grid->n_sets = fact[4];
  for (int d = 0; d < 3; ++d) grid->min[d] = extent[d], grid->max[d] = extent[3 + d];
  grid->smallest = extent[6];
  if (!grid->sets) PetscCall(PetscCalloc1(grid->n_sets, &grid->sets));
  for (PetscInt s = 0; s < grid->n_sets; ++s) {
    char **name = &grid->sets[s].name;
    PetscMPIInt size = *name ? (PetscMPIInt)strlen(*name) + 1 : 0;
    PetscCallMPI(MPI_Bcast(&size, 1, MPI_INT, 0, comm));
    if (!*name) PetscCall(PetscMalloc1(size, name));
    PetscCallMPI(MPI_Bcast(*name, size, MPI_CHAR, 0, comm));
  }
  PetscFunctionReturn(0);
}

/* Rank 0: the checked mesh and the rank of each of its cells; no owners if there are mistakes. */
static PetscErrorCode Prepare(FileMesh *mesh, const Case *c, const GridSpec *spec, const char *path, GridWeight weight,
                              void *context, Diag *diag, PetscMPIInt **owner)
{
  const PetscInt errors = diag_errors(diag);
  PetscMPIInt size;
  MshFile *msh;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->grid->comm, &size));
  PetscCall(MshLoad(spec, mesh->grid->dim, path, diag, &msh));
  if (msh) PetscCall(FileMeshFill(mesh, msh, path, diag));
  PetscCall(MshDestroy(&msh));
  if (diag_errors(diag) != errors) PetscFunctionReturn(0);
  PetscCall(FileMeshTellTorn(mesh, c, path, diag));
  PetscCall(PetscMalloc1(mesh->grid->n_cells, owner));
  PetscCall(FileMeshPartition(mesh->grid, size, weight, context, *owner));
  PetscFunctionReturn(0);
}

/* c: whose bodies may meet in it, or NULL. */
static PetscErrorCode CreateOf(MPI_Comm comm, const Case *c, const GridSpec *spec, PetscInt dim, const char *path,
                               GridWeight weight, void *context, Diag *diag, Grid **grid)
{
  PetscMPIInt rank, *owner = NULL;
  PetscInt good;
  FileMesh mesh;

  PetscFunctionBeginUser;
  *grid = NULL;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(FileMeshCreate(comm, &grid_mesh, dim, &mesh));
  if (!rank) PetscCall(Prepare(&mesh, c, spec, path, weight, context, diag, &owner));
  good = owner != NULL;
  PetscCallMPI(MPI_Bcast(&good, 1, MPIU_INT, 0, comm));
  if (good) {
    PetscCall(ShareFacts(comm, mesh.grid));
    PetscCall(MeshFromOwners(mesh.grid, owner, grid));
  }
  PetscCall(FileMeshDestroy(&mesh));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}

PetscErrorCode GridCreateMesh(MPI_Comm comm, const GridSpec *spec, PetscInt dim, const char *path, GridWeight weight,
                              void *context, Diag *diag, Grid **grid)
{
  PetscFunctionBeginUser;
  PetscCall(CreateOf(comm, NULL, spec, dim, path, weight, context, diag, grid));
  PetscFunctionReturn(0);
}

PetscErrorCode GridCheckAxis(const Kinematics *kinematics, const char *path, Diag *diag, Grid **grid)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (!*grid || !kinematics->hoop || (*grid)->min[0] >= -1e-9 * ((*grid)->max[0] - (*grid)->min[0]))
    PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank((*grid)->comm, &rank));
  if (!rank) {
    diag_error(diag, path, "the mesh %s the axis x = 0: x is the radius, but its nodes go from x = %g to %g",
               (*grid)->max[0] > 0 ? "crosses" : "lies beyond", (double)(*grid)->min[0], (double)(*grid)->max[0]);
    diag_hint(diag, "mesh the half of the section with x >= 0");
  }
  PetscCall(GridDestroy(grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(MPI_Comm comm, const Case *c, GridWeight weight, void *context, Diag *diag, Grid **grid)
{
  PetscFunctionBeginUser;
  PetscCall(GeoCheckParameters(comm, c, diag));
  PetscCall(CreateOf(comm, c, &c->grid, kinematics_dim(c->kinematics), "grid.mesh", weight, context, diag, grid));
  PetscCall(GridCheckAxis(c->kinematics, "grid.mesh", diag, grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Grid *grid)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(grid->mesh->neighbour));
  PetscCall(PetscFree(grid->mesh->far_cell));
  PetscCall(PetscFree(grid->mesh->file_node));
  PetscCall(BoxTreeDestroy(&grid->mesh->cell_tree));
  PetscCall(BoxTreeDestroy(&grid->mesh->face_tree));
  PetscCall(PetscFree(grid->mesh));
  PetscFunctionReturn(0);
}

const GridOps grid_mesh = {
  .Create = Create,
  .Destroy = Destroy,
  .locate = mesh_locate,
  .clamp = mesh_clamp,
  .candidates = mesh_candidates,
  .Widen = MeshWiden,
  .WeighCells = MeshWeighCells,
  .FromCuts = MeshFromCuts,
  .PartitionToTable = MeshPartitionToTable,
  .FromPartition = MeshFromPartition,
};
