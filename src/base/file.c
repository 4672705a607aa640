#include "base/file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The size of a plain file, which alone has one; -1 and a reason. */
static long size_of(int fd, const char **why)
{
  struct stat info;
  if (fd < 0 || fstat(fd, &info)) *why = strerror(errno);
  else if (S_ISDIR(info.st_mode)) *why = "this is a directory, not a file";
  else if (!S_ISREG(info.st_mode)) *why = "not a file";
  return *why ? -1 : (long)info.st_size;
}

PetscErrorCode FileLoad(const char *path, char **data, size_t *length, const char **why)
{
  PetscFunctionBeginUser;
  *data = NULL;
  *why = NULL;
  *length = 0;
  /* does not wait for the other end of a pipe */
  const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  const long size = size_of(fd, why);
  FILE *file = size < 0 ? NULL : fdopen(fd, "rb");
  if (!file) {
    if (!*why) *why = strerror(errno);
    if (fd >= 0) (void)close(fd);
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1((size_t)size + 1, data));
  *length = fread(*data, 1, (size_t)size, file);
  (*data)[*length] = 0; /* stops strtod at the end */
  if (ferror(file)) {
    *why = strerror(errno);
    PetscCall(PetscFree(*data));
  }
  (void)fclose(file);
  PetscFunctionReturn(0);
}
