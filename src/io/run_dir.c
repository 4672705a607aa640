#include "io/run_dir.h"
#include <errno.h>
#include <fnmatch.h>
#include <dirent.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include "io/run_dir_files.h"
#include "io/run_dir_impl.h"

static const char unfinished[] = "*" FILE_UNFINISHED;
/* What a run leaves behind, and what `--force` removes. */
static const char *const run_files[] = {"case.yaml",
                                        "log.txt",
                                        "version.txt",
                                        "timings.txt",
                                        "history.csv",
                                        "points_[0-9]*.hdf",
                                        "grid_[0-9]*.hdf",
                                        "*.hdf.series",
                                        "checkpoint_[0-9]*.h5",
                                        "checkpoint_[0-9]*.h5.damaged",
                                        unfinished,
                                        NULL};
static const char *const picture_files[] = {"state_*.png", "history_*.png", unfinished, NULL};
/* Any of these tells a run. A case.yaml alone may be the user's own. */
static const char *const run_marks[] = {"log.txt", "version.txt", "history.csv", "points.hdf.series", NULL};

static PetscBool HoldsRun(const char *path)
{
  for (int i = 0; run_marks[i]; ++i)
    if (file_exists(path, run_marks[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool MatchesAny(const char *name, const char *const *patterns)
{
  for (int i = 0; patterns[i]; ++i)
    if (!fnmatch(patterns[i], name, 0)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static int RemoveFiles(const char *folder, const char *const *patterns)
{
  char path[PETSC_MAX_PATH_LEN];
  int error = 0;
  DIR *listing = opendir(folder);
  if (!listing) return errno == ENOENT || errno == ENOTDIR ? 0 : errno;
  for (struct dirent *entry = readdir(listing); entry && !error; entry = readdir(listing)) {
    if (!MatchesAny(entry->d_name, patterns)) continue;
    const int n = snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    if (n >= (int)sizeof path) error = ENAMETOOLONG;
    else if (unlink(path)) error = errno;
  }
  closedir(listing);
  return error;
}

static int RemoveRun(const char *path)
{
  char pictures[PETSC_MAX_PATH_LEN];
  const int error = RemoveFiles(path, run_files), n = snprintf(pictures, sizeof pictures, "%s/pictures", path);
  if (error || n >= (int)sizeof pictures) return error;
  return RemoveFiles(pictures, picture_files);
}

/* May a run start here? */
static PetscBool CheckFolder(const char *path, PetscBool force, Diag *diag)
{
  const int error = file_make_folders(path);
  if (error) {
    DiagError(diag, NULL, "cannot create the output directory '%s': %s", path, strerror(error));
    return PETSC_FALSE;
  }
  if (access(path, W_OK | X_OK)) {
    DiagError(diag, NULL, "cannot write into the output directory '%s': %s", path, strerror(errno));
    return PETSC_FALSE;
  }
  if (HoldsRun(path)) {
    if (force) return PETSC_TRUE;
    DiagError(diag, NULL, "the output directory '%s' already holds a run", path);
    DiagHint(diag, "--out names another directory, --force replaces the run that is there, --resume %s goes on with it",
             path);
    return PETSC_FALSE;
  }
  if (file_exists(path, "case.yaml")) {
    DiagError(diag, NULL, "the output directory '%s' holds a case.yaml that is not of a run: it would be overwritten",
              path);
    DiagHint(diag, "name another directory with --out");
    return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static FILE *OpenLog(const char *folder, const char *log, const char *mode, Diag *diag)
{
  char path[PETSC_MAX_PATH_LEN];
  if (log) snprintf(path, sizeof path, "%s", log);
  else snprintf(path, sizeof path, "%s/log.txt", folder);
  FILE *file = fopen(path, mode);
  if (!file) DiagError(diag, NULL, "cannot write the log file '%s': %s", path, strerror(errno));
  else setvbuf(file, NULL, _IOLBF, 0);
  return file;
}

/* A run at work holds a lock on its directory, which the system takes away when the process ends, however it ends. */
static PetscBool Lock(const char *path, Diag *diag, int *lock)
{
  *lock = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (*lock < 0 || !flock(*lock, LOCK_EX | LOCK_NB) || errno != EWOULDBLOCK) return PETSC_TRUE;
  close(*lock);
  *lock = -1;
  DiagError(diag, NULL, "another run is at work in the output directory '%s'", path);
  return PETSC_FALSE;
}

/* Rank 0; the log is opened before anything is removed if it stands outside. */
static FILE *Prepare(const char *path, PetscBool force, const char *log, Diag *diag, int *lock)
{
  if (!CheckFolder(path, force, diag) || !Lock(path, diag, lock)) return NULL;
  FILE *file = log ? OpenLog(path, log, "w", diag) : NULL;
  if (log && !file) return NULL;
  const int error = force ? RemoveRun(path) : 0;
  if (error) {
    DiagError(diag, NULL, "cannot remove the earlier run in '%s': %s", path, strerror(error));
    if (file) fclose(file);
    return NULL;
  }
  return file ? file : OpenLog(path, log, "w", diag);
}

/* Does a person watch? Open MPI gives the first rank a terminal of its own wherever mpiexec's output goes, so there the
 * output of the parent counts: mpiexec, or a daemon. */
static PetscBool OnTerminal(void)
{
  char link[64], target[16] = "";
  if (!isatty(STDOUT_FILENO)) return PETSC_FALSE;
  if (!getenv("OMPI_COMM_WORLD_SIZE")) return PETSC_TRUE;
  snprintf(link, sizeof link, "/proc/%d/fd/1", (int)getppid());
  if (readlink(link, target, sizeof target - 1) < 0) return PETSC_FALSE;
  return !strncmp(target, "/dev/pts/", 9) || !strncmp(target, "/dev/tty", 8) || !strncmp(target, "/dev/console", 12);
}

/* The same answer on all ranks: a directory with the open log, or none. */
static PetscErrorCode Finish(MPI_Comm comm, PetscMPIInt rank, const char *path, PetscBool quiet, FILE *log, int lock,
                             RunDir **dir)
{
  struct timespec now;
  int ok = log ? 1 : 0;

  PetscFunctionBeginUser;
  *dir = NULL;
  PetscCallMPI(MPI_Bcast(&ok, 1, MPI_INT, 0, comm));
  if (!ok && lock >= 0) close(lock);
  if (!ok) PetscFunctionReturn(0);
  PetscCall(PetscNew(dir));
  PetscCallMPI(MPI_Comm_dup(comm, &(*dir)->comm));
  clock_gettime(CLOCK_MONOTONIC, &now);
  (*dir)->rank = rank;
  (*dir)->log = log;
  (*dir)->lock = lock;
  (*dir)->quiet = quiet;
  (*dir)->terminal = OnTerminal();
  (*dir)->start = (PetscReal)now.tv_sec + 1e-9 * (PetscReal)now.tv_nsec;
  (*dir)->last_shown = -1;
  PetscCall(PetscStrncpy((*dir)->path, path, sizeof(*dir)->path));
  PetscFunctionReturn(0);
}

PetscErrorCode RunDirCreate(MPI_Comm comm, const char *path, PetscBool force, PetscBool quiet, const char *log,
                            Diag *diag, RunDir **dir)
{
  PetscMPIInt rank;
  int lock = -1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  FILE *file = rank ? NULL : Prepare(path, force, log, diag, &lock);
  PetscCall(Finish(comm, rank, path, quiet, file, lock, dir));
  PetscFunctionReturn(0);
}

static FILE *PrepareOpen(const char *path, const char *log, Diag *diag, int *lock)
{
  if (HoldsRun(path)) return Lock(path, diag, lock) ? OpenLog(path, log, "a", diag) : NULL;
  DiagError(diag, NULL, "there is no run to resume in '%s'", path);
  return NULL;
}

PetscErrorCode RunDirOpen(MPI_Comm comm, const char *path, PetscBool quiet, const char *log, Diag *diag, RunDir **dir)
{
  PetscMPIInt rank;
  int lock = -1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  FILE *file = rank ? NULL : PrepareOpen(path, log, diag, &lock);
  PetscCall(Finish(comm, rank, path, quiet, file, lock, dir));
  PetscFunctionReturn(0);
}

PetscErrorCode RunDirDestroy(RunDir **dir)
{
  PetscFunctionBeginUser;
  if (!*dir) PetscFunctionReturn(0);
  if ((*dir)->bar) puts("");
  if ((*dir)->log) fclose((*dir)->log);
  if ((*dir)->history) fclose((*dir)->history);
  if ((*dir)->lock >= 0) close((*dir)->lock);
  PetscCallMPI(MPI_Comm_free(&(*dir)->comm));
  PetscCall(PetscFree(*dir));
  PetscFunctionReturn(0);
}

PetscErrorCode RunDirDiscard(RunDir **dir)
{
  PetscFunctionBeginUser;
  if (*dir && (*dir)->rank == 0) RemoveRun((*dir)->path);
  PetscCall(RunDirDestroy(dir));
  PetscFunctionReturn(0);
}

const char *RunDirPath(const RunDir *dir) { return dir->path; }

/* A message takes the place of the bar; the next step draws the bar again below it. */
static void Print(RunDir *dir, const char *format, va_list arguments)
{
  if (dir->bar) fputs("\r\033[K", stdout);
  dir->bar = PETSC_FALSE;
  vprintf(format, arguments);
  putchar('\n');
  fflush(stdout);
}

PetscErrorCode RunDirLog(RunDir *dir, const char *format, ...)
{
  va_list arguments, again;

  PetscFunctionBeginUser;
  if (dir->rank > 0) PetscFunctionReturn(0);
  va_start(arguments, format);
  va_copy(again, arguments);
  if (dir->log) vfprintf(dir->log, format, arguments), fputc('\n', dir->log);
  if (!dir->quiet) Print(dir, format, again);
  va_end(again);
  va_end(arguments);
  PetscFunctionReturn(0);
}

PetscErrorCode RunDirAgree(RunDir *dir, const char *name, int error)
{
  PetscFunctionBeginUser;
  if (error && dir->rank == 0 && run_dir_present(dir)) error = ESTALE; /* that is why */
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, dir->comm));
  if (!error) PetscFunctionReturn(0);
  if (error == ESTALE)
    snprintf(dir->reason, sizeof dir->reason,
             "the run directory %s was removed, renamed or replaced while the run was at work", dir->path);
  else
    snprintf(dir->reason, sizeof dir->reason, "cannot write %s%s%s: %s", dir->path, name[0] ? "/" : "", name,
             strerror(error));
  PetscCall(RunDirLog(dir, "error = %s", dir->reason));
  PetscFunctionReturn(PETSC_ERR_FILE_WRITE);
}

const char *RunDirReason(const RunDir *dir) { return dir->reason; }

int run_dir_present(const RunDir *dir)
{
  struct stat held, named;
  if (dir->lock < 0 || fstat(dir->lock, &held)) return 0; /* nothing to compare with */
  if (stat(dir->path, &named)) return errno == ENOENT || errno == ENOTDIR ? ESTALE : 0;
  return held.st_dev == named.st_dev && held.st_ino == named.st_ino ? 0 : ESTALE;
}

PetscErrorCode RunDirPresent(RunDir *dir)
{
  PetscFunctionBeginUser;
  const PetscErrorCode status = RunDirAgree(dir, "", dir->rank ? 0 : run_dir_present(dir));
  PetscFunctionReturn(status);
}

PetscErrorCode RunDirWriteText(RunDir *dir, const char *name, const char *text)
{
  char path[PETSC_MAX_PATH_LEN];
  int error = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", dir->path, name));
  if (dir->rank == 0) error = run_dir_present(dir);
  if (dir->rank == 0 && !error) error = file_write_text(path, text);
  const PetscErrorCode status = RunDirAgree(dir, name, error);
  PetscFunctionReturn(status);
}
