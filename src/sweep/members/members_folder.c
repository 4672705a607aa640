/* Where members come from and go to. */
#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>
#include "output/directory/run_dir_files.h"
#include "output/directory/run_dir_mark.h"
#include "sweep/members/members.h"

void members_prepare_folder(const char *path, const char *table, Diag *diag, int *lock)
{
  int error = file_make_folders(path);
  *lock = -1;
  if (!error && !run_dir_is_signed(path) && file_exists(path, table)) {
    diag_error(diag, NULL, "'%s' holds a %s that talus has not written: it would be overwritten", path, table);
    diag_hint(diag, "name another directory with --out");
    return;
  }
  if (!error && access(path, W_OK | X_OK)) error = errno;
  if (!error) error = run_dir_sign(path);
  if (error) {
    diag_error(diag, NULL, "cannot write into '%s': %s", path, strerror(error));
    return;
  }
  *lock = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (*lock >= 0 && flock(*lock, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK)
    diag_error(diag, NULL, "another sweep is at work in '%s'", path);
}

PetscInt members_jobs(PetscInt asked)
{
  cpu_set_t set;
  if (asked > 0) return asked;
  return sched_getaffinity(0, sizeof set, &set) ? 1 : PetscMax(CPU_COUNT(&set), 1);
}
