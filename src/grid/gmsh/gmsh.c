/* Grids from Gmsh: rank 0 reads (or has gmsh make) the mesh, checks it and hands out the parts. */
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "grid/gmsh/geo_check.h"
#include "grid/gmsh/msh.h"

#define MESSAGE_SIZE 1024

static PetscBool has_ending(const char *name, const char *ending)
{
  const size_t n = strlen(name), m = strlen(ending);
  return n > m && !strcmp(name + n - m, ending);
}

/* Pipes and devices have no end, or wait for somebody to write. */
static PetscBool is_readable(const char *file, char message[MESSAGE_SIZE])
{
  struct stat info;
  const char *why = NULL;
  if (stat(file, &info) || access(file, R_OK)) why = strerror(errno);
  else if (S_ISDIR(info.st_mode)) why = "this is a directory, not a file";
  else if (!S_ISREG(info.st_mode)) why = "this is a pipe or a device, not a file";
  if (why) (void)snprintf(message, MESSAGE_SIZE, "cannot read '%s': %s", file, why);
  return !why;
}

/* Rank 0: let gmsh make a mesh of a script and read it. */
static PetscErrorCode LoadScript(const GridSpec *spec, PetscInt dim, Diag *diag, char message[MESSAGE_SIZE],
                                 MshFile **msh)
{
  char made[PETSC_MAX_PATH_LEN] = "", shown[PETSC_MAX_PATH_LEN + 64];
  PetscBool safe = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (!spec->trusted) PetscCall(GeoCheck(spec->mesh, diag, &safe));
  if (!safe) PetscFunctionReturn(0);
  PetscCall(GeoRun(spec->mesh, dim, spec->n_parameters, spec->parameters, sizeof made, made, MESSAGE_SIZE, message));
  (void)snprintf(shown, sizeof shown, "the mesh that gmsh made of '%s'", spec->mesh);
  if (!message[0]) PetscCall(MshRead(made, shown, msh, MESSAGE_SIZE, message));
  if (made[0]) (void)unlink(made);
  PetscFunctionReturn(0);
}

/* Rank 0: the file as gmsh wrote it; NULL and a diagnostic if there is none. */
static PetscErrorCode LoadMesh(const GridSpec *spec, PetscInt dim, const char *path, Diag *diag, MshFile **msh)
{
  const PetscBool script = has_ending(spec->mesh, ".geo");
  char message[MESSAGE_SIZE] = "";

  PetscFunctionBeginUser;
  *msh = NULL;
  if (!script && !has_ending(spec->mesh, ".msh"))
    (void)snprintf(message, sizeof message, "'%s' is neither a .msh nor a .geo file", spec->mesh);
  else if (is_readable(spec->mesh, message)) {
    if (script) PetscCall(LoadScript(spec, dim, diag, message, msh));
    else PetscCall(MshRead(spec->mesh, spec->mesh, msh, sizeof message, message));
  }
  if (message[0]) diag_error(diag, path, "%s", message);
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
