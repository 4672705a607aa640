/* Grids from Gmsh: rank 0 reads (or has gmsh make) the mesh, checks it and hands out the parts. */
#include <unistd.h>
#include "grid/msh.h"

#define MESSAGE_SIZE 1024

static PetscBool has_ending(const char *name, const char *ending)
{
  const size_t n = strlen(name), m = strlen(ending);
  return n > m && !strcmp(name + n - m, ending) ? PETSC_TRUE : PETSC_FALSE;
}

/* Rank 0: the file as gmsh wrote it; NULL and a diagnostic if there is none. */
static PetscErrorCode LoadMesh(const GridSpec *spec, PetscInt dim, const char *path, Diag *diag, MshFile **msh)
{
  char made[PETSC_MAX_PATH_LEN] = "", message[MESSAGE_SIZE] = "";
  const char *file = spec->mesh;

  PetscFunctionBeginUser;
  *msh = NULL;
  if (has_ending(file, ".geo")) {
    if (access(file, R_OK)) (void)snprintf(message, sizeof message, "cannot read '%s'", file);
    else PetscCall(GeoRun(file, dim, spec->n_parameters, spec->parameters, sizeof made, made, sizeof message, message));
    file = made;
  } else if (!has_ending(file, ".msh")) {
    (void)snprintf(message, sizeof message, "'%s' is neither a .msh nor a .geo file", file);
  }
  if (!message[0]) PetscCall(MshRead(file, msh, sizeof message, message));
  if (made[0]) (void)unlink(made);
  if (!*msh) DiagError(diag, path, "%s", message);
  PetscFunctionReturn(0);
}

/* Rank 0: the checked mesh and the rank of each cell. */
static PetscErrorCode PrepareMesh(MPI_Comm comm, const GridSpec *spec, PetscInt dim, const char *path,
                                  GridWeight weight, void *context, Diag *diag, SerialMesh **mesh, PetscInt **owner)
{
  PetscMPIInt size;
  MshFile *msh;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(LoadMesh(spec, dim, path, diag, &msh));
  if (!msh) PetscFunctionReturn(0);
  PetscCall(SerialMeshCreate(msh, dim, path, diag, mesh));
  PetscCall(MshDestroy(&msh));
  if (!*mesh) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1((*mesh)->n_cells, owner));
  PetscCall(SerialMeshPartition(*mesh, size, weight, context, *owner));
  PetscFunctionReturn(0);
}

PetscErrorCode GridCreateMesh(MPI_Comm comm, const GridSpec *spec, PetscInt dim, const char *path, GridWeight weight,
                              void *context, Diag *diag, Grid **grid)
{
  PetscMPIInt rank;
  PetscInt *owner = NULL, good;
  SerialMesh *mesh = NULL;

  PetscFunctionBeginUser;
  *grid = NULL;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) PetscCall(PrepareMesh(comm, spec, dim, path, weight, context, diag, &mesh, &owner));
  good = mesh ? 1 : 0;
  PetscCallMPI(MPI_Bcast(&good, 1, MPIU_INT, 0, comm));
  if (good) PetscCall(GridDistribute(comm, mesh, owner, grid));
  PetscCall(SerialMeshDestroy(&mesh));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}
