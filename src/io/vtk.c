#include "io/vtk.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include "io/run_dir_files.h"
#include "io/vtk_layout.h"

/* Everything that goes into one file, and the buffers that VTK wants and talus does not keep. */
typedef struct {
  PetscInt n;
  VtkSlab *slabs;
  PetscInt64 counts[3], *connectivity, *offsets;
  unsigned char *types;
  PetscInt64 n_cells, n_connectivity;
  PetscBool has_cells, has_id; /* on any rank: an empty one has no arrays to tell */
} Image;

static void AddSlab(Image *image, const char *group, const char *name, const char *unit, VtkSlabType type,
                    PetscInt components, PetscInt64 rows, const void *data)
{
  VtkSlab *slab = &image->slabs[image->n++];
  memset(slab, 0, sizeof *slab);
  snprintf(slab->path, sizeof slab->path, "%s%s", group, name);
  slab->unit = unit;
  slab->type = type;
  slab->components = components;
  slab->rows = rows;
  slab->data = data;
}

/* Connectivity, offsets and types of this rank's partition, in VTK's 64-bit form. */
static PetscErrorCode MakeTopology(Image *image, const VtkData *data)
{
  PetscFunctionBeginUser;
  const PetscInt64 nodes = image->has_cells ? data->nodes_per_cell : 1;
  image->n_cells = image->has_cells ? data->n_cells : data->n_points;
  image->n_connectivity = image->n_cells * nodes;
  PetscCall(PetscMalloc3(image->n_connectivity, &image->connectivity, image->n_cells + 1, &image->offsets,
                         image->n_cells, &image->types));
  for (PetscInt64 i = 0; i < image->n_connectivity; ++i)
    image->connectivity[i] = image->has_cells ? data->connectivity[i] : i;
  for (PetscInt64 i = 0; i <= image->n_cells; ++i) image->offsets[i] = i * nodes;
  const int vertex = 1;
  if (image->n_cells > 0) memset(image->types, image->has_cells ? data->vtk_type : vertex, (size_t)image->n_cells);
  PetscFunctionReturn(0);
}

static void AddGeometry(Image *image, const VtkData *data)
{
  image->counts[0] = data->n_points;
  image->counts[1] = image->n_cells;
  image->counts[2] = image->n_connectivity;
  AddSlab(image, "", "NumberOfPoints", NULL, VTK_SLAB_INT64, 1, 1, &image->counts[0]);
  AddSlab(image, "", "NumberOfCells", NULL, VTK_SLAB_INT64, 1, 1, &image->counts[1]);
  AddSlab(image, "", "NumberOfConnectivityIds", NULL, VTK_SLAB_INT64, 1, 1, &image->counts[2]);
  AddSlab(image, "", "Points", "m", VTK_SLAB_REAL, 3, data->n_points, data->x);
  AddSlab(image, "", "Connectivity", NULL, VTK_SLAB_INT64, 1, image->n_connectivity, image->connectivity);
  AddSlab(image, "", "Offsets", NULL, VTK_SLAB_INT64, 1, image->n_cells + 1, image->offsets);
  AddSlab(image, "", "Types", NULL, VTK_SLAB_BYTE, 1, image->n_cells, image->types);
}

static PetscErrorCode ImageCreate(MPI_Comm comm, PetscMPIInt rank, const VtkData *data, Image *image)
{
  int has[2] = {data->connectivity != NULL, data->point_id != NULL};

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(image, sizeof *image));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, has, 2, MPI_INT, MPI_MAX, comm));
  image->has_cells = has[0] ? PETSC_TRUE : PETSC_FALSE;
  image->has_id = has[1] ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscMalloc1((size_t)(9 + data->n_point_fields + data->n_cell_fields), &image->slabs));
  PetscCall(MakeTopology(image, data));
  AddGeometry(image, data);
  for (PetscInt i = 0; i < data->n_point_fields; ++i) {
    const VtkField *field = &data->point_fields[i];
    AddSlab(image, "PointData/", field->name, field->unit, VTK_SLAB_REAL, field->components, data->n_points,
            field->data);
  }
  if (image->has_id) AddSlab(image, "PointData/", "id", NULL, VTK_SLAB_INT64, 1, data->n_points, data->point_id);
  for (PetscInt i = 0; i < data->n_cell_fields; ++i) {
    const VtkField *field = &data->cell_fields[i];
    AddSlab(image, "CellData/", field->name, field->unit, VTK_SLAB_REAL, field->components, image->n_cells,
            field->data);
  }
  AddSlab(image, "FieldData/", "Time", "s", VTK_SLAB_REAL, 1, rank ? 0 : 1, &data->time);
  PetscFunctionReturn(0);
}

static PetscErrorCode ImageDestroy(Image *image)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(image->connectivity, image->offsets, image->types));
  PetscCall(PetscFree(image->slabs));
  PetscFunctionReturn(0);
}

/* Where this rank's rows start, and how many there are over all ranks. */
static PetscErrorCode NumberRows(MPI_Comm comm, Image *image)
{
  PetscMPIInt n;
  PetscInt64 *rows, *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(image->n, &n));
  PetscCall(PetscMalloc2(n, &rows, n, &sum));
  for (int i = 0; i < n; ++i) rows[i] = image->slabs[i].rows;
  PetscCallMPI(MPI_Scan(rows, sum, n, MPIU_INT64, MPI_SUM, comm));
  for (int i = 0; i < n; ++i) image->slabs[i].first = sum[i] - rows[i];
  PetscCallMPI(MPI_Allreduce(rows, sum, n, MPIU_INT64, MPI_SUM, comm));
  for (int i = 0; i < n; ++i) image->slabs[i].total = sum[i];
  PetscCall(PetscFree2(rows, sum));
  PetscFunctionReturn(0);
}

/* Refuse what the process may not write, before the kernel sends it a deadly signal. */
static int CheckSizeLimit(const Image *image)
{
  struct rlimit limit;
  PetscInt64 bytes = 8192;
  for (PetscInt i = 0; i < image->n; ++i) bytes += 2048 + image->slabs[i].total * vtk_row_bytes(&image->slabs[i]);
  if (getrlimit(RLIMIT_FSIZE, &limit) || limit.rlim_cur == RLIM_INFINITY) return 0;
  return (rlim_t)bytes > limit.rlim_cur ? EFBIG : 0;
}

/* Claim the whole file at once: a disk that is too full says so here. */
static int Reserve(int fd, PetscInt64 size)
{
  if (!fallocate(fd, 0, 0, (off_t)size)) return 0;
  if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG || errno == EIO) return errno;
  return ftruncate(fd, (off_t)size) ? errno : 0; /* a file system that cannot reserve */
}

/* Rank 0: the file with all but its numbers. */
static int WriteFrame(const char *path, Image *image, PetscReal time)
{
  VtkFrame frame;
  int error = CheckSizeLimit(image);
  if (error) return error;
  if (!vtk_layout(image->n, image->slabs, time, &frame)) return ENOMEM;
  const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  error = fd < 0 ? errno : Reserve(fd, frame.size);
  if (!error) error = file_write_at(fd, frame.bytes, frame.n, 0);
  if (fd >= 0 && close(fd) && !error) error = errno;
  free(frame.bytes);
  return error;
}

/* Every rank: its rows of every dataset. */
static int WriteRows(const char *path, const Image *image)
{
  const int fd = open(path, O_WRONLY | O_CLOEXEC);
  int error = fd < 0 ? errno : 0;
  for (PetscInt i = 0; i < image->n && !error; ++i) {
    const VtkSlab *slab = &image->slabs[i];
    const PetscInt64 bytes = vtk_row_bytes(slab);
    if (slab->rows > 0)
      error = file_write_at(fd, slab->data, (size_t)(slab->rows * bytes), (off_t)(slab->offset + slab->first * bytes));
  }
  const int closing = fd < 0 ? 0 : file_finish(fd);
  return error ? error : closing;
}

static PetscErrorCode ShareOffsets(MPI_Comm comm, Image *image)
{
  PetscMPIInt n;
  PetscInt64 *offsets;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(image->n, &n));
  PetscCall(PetscMalloc1(n, &offsets));
  for (int i = 0; i < n; ++i) offsets[i] = image->slabs[i].offset;
  PetscCallMPI(MPI_Bcast(offsets, n, MPIU_INT64, 0, comm));
  for (int i = 0; i < n; ++i) image->slabs[i].offset = offsets[i];
  PetscCall(PetscFree(offsets));
  PetscFunctionReturn(0);
}

/* All ranks write under the unfinished name; *error is the same on all. */
static PetscErrorCode WriteAll(MPI_Comm comm, PetscMPIInt rank, const char *unfinished, Image *image, PetscReal time,
                               int *error)
{
  PetscFunctionBeginUser;
  *error = rank ? 0 : WriteFrame(unfinished, image, time);
  PetscCallMPI(MPI_Bcast(error, 1, MPI_INT, 0, comm));
  if (*error) PetscFunctionReturn(0);
  PetscCall(ShareOffsets(comm, image));
  *error = WriteRows(unfinished, image);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, error, 1, MPI_INT, MPI_MAX, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode VtkWrite(MPI_Comm comm, const char *path, const VtkData *data, char reason[256])
{
  char unfinished[FILE_PATH];
  PetscMPIInt rank;
  Image image;
  int error;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscSNPrintf(unfinished, sizeof unfinished, "%s" FILE_UNFINISHED, path));
  PetscCall(ImageCreate(comm, rank, data, &image));
  PetscCall(NumberRows(comm, &image));
  PetscCall(WriteAll(comm, rank, unfinished, &image, data->time, &error));
  PetscCall(ImageDestroy(&image));
  if (rank == 0) error = file_commit(unfinished, path, error);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, comm));
  reason[0] = 0;
  if (error) {
    snprintf(reason, 256, "%s", strerror(error));
    PetscFunctionReturn(PETSC_ERR_FILE_WRITE);
  }
  PetscFunctionReturn(0);
}
