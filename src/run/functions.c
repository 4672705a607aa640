/* What functions of the program that calls act on: no file of the run holds them, and without them it would be another
 * run. functions.txt names what they act on, and a run goes on with as many. */
#include <string.h>
#include "output/directory/run_dir_files.h"
#include "run/run_private.h"

#define FUNCTIONS "functions.txt"

/* "body_force, loads.tractions[0]", of malloc of PETSc; "" if there are none. */
static PetscErrorCode NamesOf(const Case *c, const RunOptions *options, char **names)
{
  const size_t size = 32 + 80 * (size_t)c->n_loads;
  char path[64];
  size_t n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, names));
  if (options->body_force) n += (size_t)snprintf(*names, size, "body_force");
  for (PetscInt k = 0; options->load_factors && k < c->n_loads; ++k)
    if (options->load_factors[k].ask)
      n += (size_t)snprintf(*names + n, size - n, "%s%s", n ? ", " : "", case_load_path(c, k, path));
  PetscFunctionReturn(0);
}

PetscErrorCode FunctionsWrite(Run *r, const RunOptions *options)
{
  char *names;

  PetscFunctionBeginUser;
  PetscCall(NamesOf(r->whole, options, &names));
  if (names[0]) PetscCall(RunDirLog(r->dir, "functions = %s", names));
  if (names[0]) PetscCall(RunWritten(r, RunDirWriteText(r->dir, FUNCTIONS, names)));
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

/* Of one process. What the file says, of room for `size` bytes; "" without one. */
static void read_names(const Run *r, size_t size, char *names)
{
  char path[PETSC_MAX_PATH_LEN];
  snprintf(path, sizeof path, "%s/%s", run_dir_path(r->dir), FUNCTIONS);
  FILE *in = file_open_read(path);
  const size_t n = in ? fread(names, 1, size - 1, in) : 0;
  if (in) fclose(in);
  names[n] = '\0';
}

static void tell(const Run *r, const char *then, const char *now, Diag *diag)
{
  diag_error(diag, NULL, "the run in '%s' has functions of its caller for: %s; now there are: %s", run_dir_path(r->dir),
             then[0] ? then : "none", now[0] ? now : "none");
  diag_hint(diag,
            "it goes on with the same alone: talus.Case(DIR, body_force=..., loads=...).run(DIR, resume=True), or "
            "TalusCaseSetBodyForces and TalusCaseSetLoadFactors of the library");
}

PetscErrorCode FunctionsCheck(const Run *r, const RunOptions *options, Diag *diag, PetscBool *same)
{
  char *now, then[4096];
  PetscMPIInt rank;
  int equal = 1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(r->comm, &rank));
  PetscCall(NamesOf(r->whole, options, &now));
  if (!rank) {
    read_names(r, sizeof then, then);
    equal = !strncmp(now, then, sizeof then - 1);
    if (!equal) tell(r, then, now, diag);
  }
  PetscCallMPI(MPI_Bcast(&equal, 1, MPI_INT, 0, r->comm));
  *same = equal != 0;
  PetscCall(PetscFree(now));
  PetscFunctionReturn(0);
}
