#include "output/seal.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include "output/directory/run_dir_files.h"

#define SAMPLE 4096
#define SAMPLES 64

/* Sample k starts at an equal share of what lies before the last one; a short file is read from end
 * to end. */
static int sample(int fd, PetscInt64 bytes, PetscInt64 *crc)
{
  unsigned char block[SAMPLE];
  const PetscBool whole = bytes <= (PetscInt64)SAMPLE * SAMPLES;
  uLong sum = crc32(0, Z_NULL, 0);
  int error = 0;
  for (PetscInt64 k = 0; k < SAMPLES && !error; ++k) {
    const PetscInt64 at = whole ? k * SAMPLE : (bytes - SAMPLE) * k / (SAMPLES - 1), n = PetscMin(SAMPLE, bytes - at);
    if (n <= 0) break;
    error = file_read_at(fd, block, (size_t)n, (off_t)at);
    sum = crc32(sum, block, (uInt)n);
  }
  *crc = (PetscInt64)sum;
  return error;
}

static int sum_whole(int fd, PetscInt64 bytes, PetscInt64 *crc)
{
  unsigned char block[16 * SAMPLE];
  uLong sum = crc32(0, Z_NULL, 0);
  int error = 0;
  for (PetscInt64 at = 0, n; at < bytes && !error; at += n) {
    n = PetscMin((PetscInt64)sizeof block, bytes - at);
    error = file_read_at(fd, block, (size_t)n, (off_t)at);
    sum = crc32(sum, block, (uInt)n);
  }
  *crc = (PetscInt64)sum;
  return error;
}

static int seal_by(const char *path, int (*sum)(int fd, PetscInt64 bytes, PetscInt64 *crc), FileSeal *seal)
{
  struct stat status;
  const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return errno;
  int error = fstat(fd, &status) ? errno : 0;
  if (!error && !S_ISREG(status.st_mode)) error = EINVAL;
  seal->bytes = (PetscInt64)status.st_size;
  if (!error) error = sum(fd, seal->bytes, &seal->crc);
  close(fd);
  return error;
}

int file_seal(const char *path, FileSeal *seal) { return seal_by(path, sample, seal); }

int file_seal_whole(const char *path, FileSeal *seal) { return seal_by(path, sum_whole, seal); }

void file_check_seal(const char *path, const FileSeal *seal, char reason[128])
{
  FileSeal now;
  const int error = file_seal(path, &now);
  reason[0] = 0;
  if (error == ENOENT) snprintf(reason, 128, "it is missing");
  else if (error == EINVAL) snprintf(reason, 128, "it is no file");
  else if (error) snprintf(reason, 128, "%s", strerror(error));
  else if (seal->bytes >= 0 && now.bytes != seal->bytes)
    snprintf(reason, 128, "it is %lld bytes long and was %lld", (long long)now.bytes, (long long)seal->bytes);
  else if (seal->bytes >= 0 && now.crc != seal->crc)
    snprintf(reason, 128, "it is not as the run wrote it: its checksum is wrong");
}
