/* Checkpoints in a run directory, and its way back to one of them. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "output/directory/run_dir_files.h"
#include "output/directory/run_dir_impl.h"

static void checkpoint_path(const char *folder, PetscInt step, char path[CHECKPOINT_PATH])
{
  snprintf(path, CHECKPOINT_PATH, "%s/checkpoint_%09" PetscInt_FMT ".h5", folder, step);
}

void run_dir_checkpoint_path(const RunDir *dir, PetscInt step, char path[CHECKPOINT_PATH])
{
  checkpoint_path(dir->path, step, path);
}

void run_dir_stage_path(const char *folder, PetscInt stage, char path[CHECKPOINT_PATH])
{
  snprintf(path, CHECKPOINT_PATH, "%s/stage_%02" PetscInt_FMT ".h5", folder, stage + 1);
}

/* The number in PREFIX_number.SUFFIX, -1 if the name is another. */
static PetscInt number_of(const char *name, const char *prefix, const char *suffix)
{
  const size_t n = strlen(prefix);
  char *end;
  if (strncmp(name, prefix, n) || name[n] < '0' || name[n] > '9') return -1;
  const long long number = strtoll(name + n, &end, 10);
  return strcmp(end, suffix) || number > PETSC_MAX_INT ? -1 : (PetscInt)number;
}

static PetscInt checkpoint_step(const char *name) { return number_of(name, "checkpoint_", ".h5"); }

static int newest_first(const void *a, const void *b)
{
  const PetscInt p = *(const PetscInt *)a, q = *(const PetscInt *)b;
  return (q > p) - (q < p);
}

/* Rank 0. */
static PetscErrorCode ListSteps(const char *folder, PetscInt *n, PetscInt **steps)
{
  PetscInt capacity = 0;

  PetscFunctionBeginUser;
  *n = 0;
  *steps = NULL;
  DIR *listing = opendir(folder);
  for (struct dirent *entry = listing ? readdir(listing) : NULL; entry; entry = readdir(listing)) {
    const PetscInt step = checkpoint_step(entry->d_name);
    if (step < 0) continue;
    if (*n == capacity) {
      capacity = 2 * capacity + 8;
      PetscCall(PetscRealloc((size_t)capacity * sizeof **steps, steps));
    }
    (*steps)[(*n)++] = step;
  }
  if (listing) closedir(listing);
  if (*n) qsort(*steps, (size_t)*n, sizeof **steps, newest_first);
  PetscFunctionReturn(0);
}

PetscErrorCode RunDirNewest(MPI_Comm comm, const char *folder, char path[CHECKPOINT_PATH])
{
  PetscInt n = 0, *steps = NULL, newest = -1;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(ListSteps(folder, &n, &steps));
  if (n) newest = steps[0];
  PetscCall(PetscFree(steps));
  PetscCallMPI(MPI_Bcast(&newest, 1, MPIU_INT, 0, comm));
  path[0] = '\0';
  if (newest >= 0) checkpoint_path(folder, newest, path);
  PetscFunctionReturn(0);
}

PetscErrorCode RunDirCheckpoints(RunDir *dir, PetscInt *n, PetscInt **steps)
{
  PetscFunctionBeginUser;
  *n = 0;
  *steps = NULL;
  if (dir->rank == 0) PetscCall(ListSteps(dir->path, n, steps));
  PetscCallMPI(MPI_Bcast(n, 1, MPIU_INT, 0, dir->comm));
  if (dir->rank) PetscCall(PetscMalloc1(*n, steps));
  PetscCallMPI(MPI_Bcast(*steps, (PetscMPIInt)*n, MPIU_INT, 0, dir->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode RunDirKeepCheckpoints(RunDir *dir, PetscInt keep)
{
  char path[CHECKPOINT_PATH];
  PetscInt n = 0, *steps = NULL;

  PetscFunctionBeginUser;
  if (dir->rank) PetscFunctionReturn(0);
  PetscCall(ListSteps(dir->path, &n, &steps));
  for (PetscInt i = keep; steps && i < n; ++i) {
    run_dir_checkpoint_path(dir, steps[i], path);
    unlink(path); /* one that stays takes place, and does no harm */
  }
  PetscCall(PetscFree(steps));
  PetscFunctionReturn(0);
}

/* What a file of the directory is to a run that goes back to `step` and the first `states`
 * states. Contact of the state after them stays: it may be that of `step` itself, and is known after a step alone. */
static int rewind_files(const RunDir *dir, const char *name, PetscInt states, PetscInt step)
{
  static const char *const kinds[] = {"points_", "grid_", "walls_", "contact_"};
  char path[FILE_PATH], aside[FILE_PATH + 16];
  const size_t n = strlen(name), tail = strlen(FILE_UNFINISHED);
  PetscInt number = -1; /* of a state; a name begins with one of these at most */
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(kinds); ++k)
    number = PetscMax(number, number_of(name, kinds[k], ".hdf"));
  snprintf(path, sizeof path, "%s/%s", dir->path, name);
  const PetscBool later = number >= states && number_of(name, "contact_", ".hdf") != states;
  if ((n > tail && !strcmp(name + n - tail, FILE_UNFINISHED)) || later)
    return unlink(path) && errno != ENOENT ? errno : 0;
  if (checkpoint_step(name) <= step) return 0;
  snprintf(aside, sizeof aside, "%s.damaged", path);
  return rename(path, aside) ? errno : 0;
}

PetscErrorCode RunDirRewind(RunDir *dir, PetscInt states, PetscInt step)
{
  int error = 0;

  PetscFunctionBeginUser;
  if (dir->rank == 0) {
    DIR *listing = opendir(dir->path);
    if (!listing) error = errno;
    for (struct dirent *entry = listing ? readdir(listing) : NULL; entry && !error; entry = readdir(listing))
      error = rewind_files(dir, entry->d_name, states, step);
    if (listing) closedir(listing);
  }
  const PetscErrorCode status = RunDirAgree(dir, "", error);
  PetscFunctionReturn(status);
}
