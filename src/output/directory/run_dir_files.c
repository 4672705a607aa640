#include "output/directory/run_dir_files.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int make_folder(const char *path)
{
  struct stat status;
  if (!mkdir(path, 0777)) return 0;
  const int error = errno;
  if (!stat(path, &status)) return S_ISDIR(status.st_mode) ? 0 : ENOTDIR;
  return error;
}

int file_make_folders(const char *path)
{
  char part[PETSC_MAX_PATH_LEN];
  const size_t n = strlen(path);
  if (n == 0) return ENOENT;
  if (n >= sizeof part) return ENAMETOOLONG;
  memcpy(part, path, n + 1);
  for (char *slash = strchr(part + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
    *slash = 0;
    const int error = make_folder(part);
    if (error) return error;
    *slash = '/';
  }
  return make_folder(part);
}

PetscBool file_exists(const char *folder, const char *name)
{
  char path[PETSC_MAX_PATH_LEN];
  struct stat status;
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return !stat(path, &status);
}

FILE *file_open_read(const char *path)
{
  struct stat status;
  FILE *in = NULL;
  const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return NULL;
  int error = fstat(fd, &status) ? errno : S_ISDIR(status.st_mode) ? EISDIR : S_ISREG(status.st_mode) ? 0 : ENOTSUP;
  if (!error && !(in = fdopen(fd, "r"))) error = errno;
  if (error) close(fd), errno = error;
  return in;
}

int file_read_at(int fd, void *bytes, size_t n, off_t offset)
{
  char *next = bytes;
  while (n > 0) {
    const ssize_t done = pread(fd, next, n, offset);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return done ? errno : EIO;
    next += done, n -= (size_t)done, offset += done;
  }
  return 0;
}

int file_write_at(int fd, const void *bytes, size_t n, off_t offset)
{
  const char *next = bytes;
  while (n > 0) {
    const ssize_t done = pwrite(fd, next, n, offset);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return errno;
    if (done == 0) return ENOSPC;
    next += done, n -= (size_t)done, offset += done;
  }
  return 0;
}

/* Pipes and the like cannot be flushed to a disk: no failure. */
static int files_sync(int fd)
{
  if (!fsync(fd) || errno == EINVAL || errno == ENOTSUP || errno == EROFS) return 0;
  return errno;
}

int file_finish(int fd)
{
  int error = files_sync(fd);
  if (close(fd) && !error) error = errno;
  return error;
}

int file_sync_folder(const char *path)
{
  char folder[PETSC_MAX_PATH_LEN];
  const char *slash = strrchr(path, '/');
  const int n = snprintf(folder, sizeof folder, "%.*s", slash ? (int)PetscMax(1, slash - path) : 1, slash ? path : ".");
  if (n >= (int)sizeof folder) return ENAMETOOLONG;
  const int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  return fd < 0 ? errno : file_finish(fd);
}

int file_finish_stream(FILE *file)
{
  int error = 0;
  errno = 0;
  if (ferror(file) || fflush(file)) error = errno ? errno : EIO;
  if (!error) error = files_sync(fileno(file));
  if (fclose(file) && !error) error = errno;
  return error;
}

/* A device, a pipe, a socket: for root a file could take its place. */
static PetscBool is_special(const char *path)
{
  struct stat status;
  return !lstat(path, &status) && !S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode) && !S_ISDIR(status.st_mode);
}

int file_commit(const char *unfinished, const char *path, int error)
{
  if (!error && is_special(path)) error = EEXIST;
  if (!error && rename(unfinished, path)) error = errno;
  if (error) unlink(unfinished);
  return error;
}

int file_write_text(const char *path, const char *text)
{
  char unfinished[FILE_PATH];
  snprintf(unfinished, sizeof unfinished, "%s" FILE_UNFINISHED, path);
  (void)unlink(unfinished); /* left by a run that was killed; a link would be written through */
  const int fd = open(unfinished, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) return errno;
  int error = file_write_at(fd, text, strlen(text), 0);
  const int closing = file_finish(fd);
  if (!error) error = closing;
  return file_commit(unfinished, path, error);
}

void file_format_real(PetscReal value, char text[32])
{
  for (int digits = 15; digits <= 17; ++digits) {
    snprintf(text, 32, "%.*g", digits, (double)value);
    if (strtod(text, NULL) == (double)value) return;
  }
}
