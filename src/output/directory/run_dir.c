#include "output/directory/run_dir.h"
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include "output/directory/run_dir_files.h"
#include "output/directory/run_dir_impl.h"
#include "output/directory/run_dir_mark.h"
#include "talus_version.h"

/* Does it hold another run, or somebody's files of the names that a run would write? */
static PetscBool check_contents(const char *path, PetscBool force, Diag *diag)
{
  char names[600];
  const PetscBool ours = run_dir_is_ours(path);
  if (ours && force) return PETSC_TRUE;
  if (ours) {
    diag_error(diag, NULL, "the output directory '%s' already holds a run", path);
    diag_hint(
      diag, "--out names another directory, --force replaces the run that is there, --resume %s goes on with it", path);
    return PETSC_FALSE;
  }
  const PetscInt n = run_dir_in_the_way(path, sizeof names, names);
  if (n == 0) return PETSC_TRUE;
  diag_error(diag, NULL, "the output directory '%s' holds a %s that %s not of a run: %s would be overwritten", path,
             names, n > 1 ? "are" : "is", n > 1 ? "they" : "it");
  diag_hint(diag,
            "name another directory with --out; not even --force touches a directory without a " RUN_DIR_SIGNATURE);
  return PETSC_FALSE;
}

/* May a run start here? */
static PetscBool check_folder(const char *path, PetscBool force, Diag *diag)
{
  const int error = file_make_folders(path);
  if (error) {
    diag_error(diag, NULL, "cannot create the output directory '%s': %s", path, strerror(error));
    return PETSC_FALSE;
  }
  if (access(path, W_OK | X_OK)) {
    diag_error(diag, NULL, "cannot write into the output directory '%s': %s", path, strerror(errno));
    return PETSC_FALSE;
  }
  return check_contents(path, force, diag);
}

/* May the file of --log be written? What stands there already must be a log. */
static PetscBool check_log(const char *folder, const char *log, Diag *diag)
{
  if (run_dir_names_as_its_own(folder, log))
    diag_error(diag, NULL, "the log cannot be written to '%s': the run itself writes a file of this name", log);
  else if (run_dir_spoils(log)) {
    diag_error(diag, NULL, "'%s' is no log of talus: the log would overwrite it", log);
    diag_hint(diag, "--log takes the name of a new file, or of an earlier log");
  } else return PETSC_TRUE;
  return PETSC_FALSE;
}

static void log_path(const char *folder, const char *log, char path[PETSC_MAX_PATH_LEN])
{
  if (log) snprintf(path, PETSC_MAX_PATH_LEN, "%s", log);
  else snprintf(path, PETSC_MAX_PATH_LEN, "%s/log.txt", folder);
}

static FILE *open_log(const char *folder, const char *log, const char *mode, Diag *diag)
{
  char path[PETSC_MAX_PATH_LEN];
  if (log && !check_log(folder, log, diag)) return NULL;
  log_path(folder, log, path);
  FILE *file = fopen(path, mode);
  if (!file) {
    diag_error(diag, NULL, "cannot write the log file '%s': %s", path, strerror(errno));
    return NULL;
  }
  setvbuf(file, NULL, _IOLBF, 0);
  if (mode[0] == 'w') fprintf(file, "talus = " TALUS_VERSION "\n");
  return file;
}

/* A run at work holds a lock on its directory, which the system takes away when the process ends,
 * however it ends. */
static PetscBool dir_lock(const char *path, Diag *diag, int *lock)
{
  *lock = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (*lock < 0 || !flock(*lock, LOCK_EX | LOCK_NB) || errno != EWOULDBLOCK) return PETSC_TRUE;
  close(*lock);
  *lock = -1;
  diag_error(diag, NULL, "another run is at work in the output directory '%s'", path);
  return PETSC_FALSE;
}

static PetscBool sign(const char *path, Diag *diag)
{
  const int error = run_dir_sign(path);
  if (error) diag_error(diag, NULL, "cannot write %s/" RUN_DIR_SIGNATURE ": %s", path, strerror(error));
  return !error;
}

/* Rank 0; the log is opened before anything is removed if it stands outside. */
static FILE *prepare(const char *path, PetscBool force, const char *log, Diag *diag, int *lock)
{
  if (!check_folder(path, force, diag) || !dir_lock(path, diag, lock)) return NULL;
  FILE *file = log ? open_log(path, log, "w", diag) : NULL;
  if (log && !file) return NULL;
  const int error = force ? run_dir_remove(path) : 0;
  if (error) diag_error(diag, NULL, "cannot remove the earlier run in '%s': %s", path, strerror(error));
  if (error || !sign(path, diag)) {
    if (file) fclose(file);
    return NULL;
  }
  return file ? file : open_log(path, log, "w", diag);
}

/* The same answer on all ranks: a directory with the open log, or none. */
static PetscErrorCode Finish(MPI_Comm comm, PetscMPIInt rank, const char *path, PetscBool quiet, const char *named,
                             FILE *log, int lock, RunDir **dir)
{
  int ok = log ? 1 : 0;

  PetscFunctionBeginUser;
  *dir = NULL;
  PetscCallMPI(MPI_Bcast(&ok, 1, MPI_INT, 0, comm));
  if (!ok && lock >= 0) close(lock);
  if (!ok) PetscFunctionReturn(0);
  PetscCall(PetscNew(dir));
  PetscCallMPI(MPI_Comm_dup(comm, &(*dir)->comm));
  (*dir)->rank = rank;
  (*dir)->log = log;
  log_path(path, named, (*dir)->log_path);
  (*dir)->lock = lock;
  (*dir)->quiet = quiet;
  (*dir)->terminal = progress_on_terminal();
  (*dir)->start = MPI_Wtime();
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
  FILE *file = rank ? NULL : prepare(path, force, log, diag, &lock);
  PetscCall(Finish(comm, rank, path, quiet, log, file, lock, dir));
  PetscFunctionReturn(0);
}

static FILE *prepare_open(const char *path, const char *log, Diag *diag, int *lock)
{
  char link[256] = "";
  if (run_dir_is_ours(path)) run_dir_find_link(path, link);
  else diag_error(diag, NULL, "there is no run to resume in '%s'", path);
  if (link[0]) {
    diag_error(diag, NULL, "'%s/%s' is a link or a pipe: the run would write elsewhere", path, link);
    diag_hint(diag, "talus makes plain files only; look where it leads before you put a file in its place");
  }
  if (!run_dir_is_ours(path) || link[0] || !dir_lock(path, diag, lock)) return NULL;
  return open_log(path, log, "a", diag);
}

PetscErrorCode RunDirOpen(MPI_Comm comm, const char *path, PetscBool quiet, const char *log, Diag *diag, RunDir **dir)
{
  PetscMPIInt rank;
  int lock = -1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  FILE *file = rank ? NULL : prepare_open(path, log, diag, &lock);
  PetscCall(Finish(comm, rank, path, quiet, log, file, lock, dir));
  PetscFunctionReturn(0);
}

PetscErrorCode RunDirSpares(MPI_Comm comm, const char *path, const char *file, Diag *diag, PetscBool *spares)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  *spares = rank || !run_dir_holds_as_its_own(path, file);
  if (!*spares) {
    diag_error(diag, NULL, "the case '%s' stands in the output directory '%s': the run would replace it", file, path);
    diag_hint(diag, "name another directory with --out");
  }
  PetscCallMPI(MPI_Bcast(spares, 1, MPIU_BOOL, 0, comm));
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
  if (*dir && (*dir)->rank == 0) run_dir_remove((*dir)->path);
  PetscCall(RunDirDestroy(dir));
  PetscFunctionReturn(0);
}

const char *run_dir_path(const RunDir *dir) { return dir->path; }

/* A message takes the place of the bar; the next step draws the bar again below it. */
static void print(RunDir *dir, const char *format, va_list arguments)
{
  if (dir->bar) fputs("\r\033[K", stdout);
  dir->bar = PETSC_FALSE;
  vprintf(format, arguments);
  putchar('\n');
  fflush(stdout);
}

/* A line of the log that warns, of who wants to hear nothing else. */
static void print_warning(const char *format, va_list arguments)
{
  static const char mark[] = "warning = ";
  if (strncmp(format, mark, sizeof mark - 1) != 0) return;
  fputs("warning: ", stderr);
  vfprintf(stderr, format + sizeof mark - 1, arguments);
  fputc('\n', stderr);
}

PetscErrorCode RunDirLog(RunDir *dir, const char *format, ...)
{
  va_list arguments, again;

  PetscFunctionBeginUser;
  if (dir->rank > 0) PetscFunctionReturn(0);
  va_start(arguments, format);
  va_copy(again, arguments);
  if (dir->log) vfprintf(dir->log, format, arguments), fputc('\n', dir->log);
  run_dir_note_log(dir);
  if (!dir->quiet) print(dir, format, again);
  else print_warning(format, again);
  va_end(again);
  va_end(arguments);
  PetscFunctionReturn(0);
}

void run_dir_keep(RunDir *dir, const char *text)
{
  if (dir->rank > 0 || !dir->log || !text) return;
  fputs(text, dir->log);
  run_dir_note_log(dir);
}

void run_dir_note_log(RunDir *dir)
{
  if (dir->log && !dir->log_error && ferror(dir->log)) dir->log_error = errno ? errno : EIO;
}

PetscErrorCode RunDirCheckLog(RunDir *dir)
{
  int error = dir->log_error;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, dir->comm));
  if (!error) PetscFunctionReturn(0);
  snprintf(dir->reason, sizeof dir->reason, "cannot write the log '%s': %s", dir->log_path, strerror(error));
  PetscFunctionReturn(PETSC_ERR_FILE_WRITE);
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

const char *run_dir_reason(const RunDir *dir) { return dir->reason; }

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
