/* The mesh file of a case: read as it is, or made by gmsh. */
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

/* Let gmsh make a mesh of a script and read it. */
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

PetscErrorCode MshLoad(const GridSpec *spec, PetscInt dim, const char *path, Diag *diag, MshFile **msh)
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
  if (*msh && spec->mesh_scale > 0)
    for (PetscInt k = 0; k < 3 * (*msh)->n_nodes; ++k) (*msh)->x[k] *= spec->mesh_scale;
  if (message[0]) diag_error(diag, path, "%s", message);
  PetscFunctionReturn(0);
}
