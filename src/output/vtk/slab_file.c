#include "output/vtk/slab_file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include <zlib.h>
#include "output/directory/run_dir_files.h"

/* Where this rank's rows start, and how many there are over all ranks. */
static PetscErrorCode NumberRows(MPI_Comm comm, PetscMPIInt n, Slab *slabs)
{
  PetscInt64 *rows, *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &rows, n, &sum));
  for (int i = 0; i < n; ++i) rows[i] = slabs[i].rows;
  PetscCallMPI(MPI_Scan(rows, sum, n, MPIU_INT64, MPI_SUM, comm));
  for (int i = 0; i < n; ++i) slabs[i].first = sum[i] - rows[i];
  PetscCallMPI(MPI_Allreduce(rows, sum, n, MPIU_INT64, MPI_SUM, comm));
  for (int i = 0; i < n; ++i) slabs[i].total = sum[i];
  PetscCall(PetscFree2(rows, sum));
  PetscFunctionReturn(0);
}

/* A piece of this rank and its checksum, for rank 0 to join. */
typedef struct {
  PetscInt64 bytes;
  uint64_t crc;
} Piece;

/* zlib counts in unsigned int. */
static uint64_t checksum(const void *data, PetscInt64 bytes)
{
  const unsigned char *next = data;
  uLong crc = crc32(0, Z_NULL, 0);
  while (bytes > 0) {
    const uInt part = (uInt)PetscMin(bytes, 1 << 30);
    crc = crc32(crc, next, part);
    next += part, bytes -= part;
  }
  return crc;
}

PetscErrorCode SlabChecksums(MPI_Comm comm, PetscInt n, const void *const *data, const PetscInt64 *bytes, uint32_t *crc)
{
  PetscMPIInt rank, size, length;
  Piece *mine, *all = NULL;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(n * (PetscInt)sizeof(Piece), &length));
  PetscCall(PetscMalloc1(n, &mine));
  if (rank == 0) PetscCall(PetscMalloc1((size_t)n * (size_t)size, &all));
  for (PetscInt i = 0; i < n; ++i) mine[i] = (Piece){bytes[i], checksum(data[i], bytes[i])};
  PetscCallMPI(MPI_Gather(mine, length, MPI_BYTE, all, length, MPI_BYTE, 0, comm));
  for (PetscInt i = 0; rank == 0 && i < n; ++i) {
    uLong joined = crc32(0, Z_NULL, 0);
    for (PetscMPIInt r = 0; r < size; ++r) {
      const Piece *piece = &all[(size_t)r * (size_t)n + (size_t)i];
      joined = crc32_combine(joined, (uLong)piece->crc, (z_off_t)piece->bytes);
    }
    crc[i] = (uint32_t)joined;
  }
  PetscCall(PetscFree(mine));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

static PetscErrorCode SumSlabs(MPI_Comm comm, PetscInt n, Slab *slabs)
{
  const void **data;
  PetscInt64 *bytes;
  uint32_t *crc;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &data, n, &bytes, n, &crc));
  for (PetscInt i = 0; i < n; ++i) {
    data[i] = slabs[i].data;
    bytes[i] = slabs[i].rows * slab_row_bytes(&slabs[i]);
  }
  PetscCall(SlabChecksums(comm, n, data, bytes, crc));
  for (PetscInt i = 0; i < n; ++i) slabs[i].crc = crc[i];
  PetscCall(PetscFree3(data, bytes, crc));
  PetscFunctionReturn(0);
}

/* Refuse what the process may not write, before the kernel sends it a deadly signal. */
static int check_size_limit(PetscInt n, const Slab *slabs)
{
  struct rlimit limit;
  PetscInt64 bytes = 8192;
  for (PetscInt i = 0; i < n; ++i) bytes += 2048 + slabs[i].total * slab_row_bytes(&slabs[i]);
  if (getrlimit(RLIMIT_FSIZE, &limit) || limit.rlim_cur == RLIM_INFINITY) return 0;
  return (rlim_t)bytes > limit.rlim_cur ? EFBIG : 0;
}

/* Claim the whole file at once: a disk that is too full says so here. */
static int file_reserve(int fd, PetscInt64 size)
{
  if (!fallocate(fd, 0, 0, (off_t)size)) return 0;
  if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG || errno == EIO) return errno;
  return ftruncate(fd, (off_t)size) ? errno : 0; /* a file system that cannot reserve */
}

/* Rank 0: the file with all but its numbers. */
static int write_frame(const char *path, const SlabHead *head, PetscInt n, Slab *slabs, SlabPreface preface)
{
  SlabFrame frame;
  int error = check_size_limit(n, slabs);
  if (error) return error;
  if (!slab_layout(head, n, slabs, &frame)) return ENOMEM;
  if (preface) preface(head, n, slabs, &frame);
  const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  error = fd < 0 ? errno : file_reserve(fd, frame.size);
  if (!error) error = file_write_at(fd, frame.bytes, frame.n, 0);
  if (fd >= 0 && close(fd) && !error) error = errno;
  free(frame.bytes);
  return error;
}

/* Every rank: its rows of every dataset. */
static int write_rows(const char *path, PetscInt n, const Slab *slabs)
{
  const int fd = open(path, O_WRONLY | O_CLOEXEC);
  int error = fd < 0 ? errno : 0;
  for (PetscInt i = 0; i < n && !error; ++i) {
    const PetscInt64 bytes = slab_row_bytes(&slabs[i]);
    if (slabs[i].rows > 0)
      error = file_write_at(fd, slabs[i].data, (size_t)(slabs[i].rows * bytes),
                            (off_t)(slabs[i].offset + slabs[i].first * bytes));
  }
  const int closing = fd < 0 ? 0 : file_finish(fd);
  return error ? error : closing;
}

static PetscErrorCode ShareOffsets(MPI_Comm comm, PetscMPIInt n, Slab *slabs)
{
  PetscInt64 *offsets;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &offsets));
  for (int i = 0; i < n; ++i) offsets[i] = slabs[i].offset;
  PetscCallMPI(MPI_Bcast(offsets, n, MPIU_INT64, 0, comm));
  for (int i = 0; i < n; ++i) slabs[i].offset = offsets[i];
  PetscCall(PetscFree(offsets));
  PetscFunctionReturn(0);
}

PetscErrorCode SlabFileWrite(MPI_Comm comm, const char *path, const SlabHead *head, PetscInt n, Slab *slabs,
                             SlabPreface preface, PetscBool durable, char reason[256])
{
  char unfinished[FILE_PATH];
  PetscMPIInt rank, count;
  int error = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCall(PetscSNPrintf(unfinished, sizeof unfinished, "%s" FILE_UNFINISHED, path));
  PetscCall(NumberRows(comm, count, slabs));
  if (head->checksums) PetscCall(SumSlabs(comm, n, slabs));
  if (rank == 0) error = write_frame(unfinished, head, n, slabs, preface);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, comm));
  if (!error) {
    PetscCall(ShareOffsets(comm, count, slabs));
    error = write_rows(unfinished, n, slabs);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPI_INT, MPI_MAX, comm));
  }
  if (rank == 0) error = file_commit(unfinished, path, error);
  if (rank == 0 && durable && !error) error = file_sync_folder(path);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, comm));
  reason[0] = 0;
  if (!error) PetscFunctionReturn(0);
  snprintf(reason, 256, "%s", strerror(error));
  PetscFunctionReturn(PETSC_ERR_FILE_WRITE);
}
