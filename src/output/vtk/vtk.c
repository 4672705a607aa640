#include "output/vtk/vtk.h"
#include <string.h>
#include "output/vtk/slab_file.h"

/* Everything that goes into one file, and the buffers that VTK wants and talus does not keep. */
typedef struct {
  PetscInt n;
  Slab *slabs;
  PetscInt64 counts[3], *connectivity, *offsets;
  unsigned char *types;
  PetscInt64 n_cells, n_connectivity;
  PetscBool has_cells, has_id; /* on any rank: an empty one has no arrays to tell */
} Image;

static void add_slab(Image *image, const char *group, const char *name, const char *unit, ColumnType type,
                     PetscInt components, PetscInt64 rows, const void *data)
{
  Slab *slab = &image->slabs[image->n++];
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
  const PetscInt64 stride = image->has_cells ? data->nodes_per_cell : 1, n_first = data->n_first;
  PetscInt64 n = 0;
  image->n_cells = image->has_cells ? data->n_cells : data->n_points;
  image->n_connectivity = image->n_cells * stride - n_first * (stride - data->first_nodes);
  PetscCall(PetscMalloc3(image->n_connectivity, &image->connectivity, image->n_cells + 1, &image->offsets,
                         image->n_cells, &image->types));
  const int vertex = 1;
  for (PetscInt64 i = 0; i < image->n_cells; ++i) {
    const PetscInt64 nodes = i < n_first ? data->first_nodes : stride;
    image->offsets[i] = n;
    image->types[i] = (unsigned char)(!image->has_cells ? vertex : i < n_first ? data->first_type : data->vtk_type);
    for (PetscInt64 k = 0; k < nodes; ++k)
      image->connectivity[n++] = image->has_cells ? data->connectivity[i * stride + k] : i;
  }
  image->offsets[image->n_cells] = n;
  PetscFunctionReturn(0);
}

static void add_geometry(Image *image, const VtkData *data)
{
  image->counts[0] = data->n_points;
  image->counts[1] = image->n_cells;
  image->counts[2] = image->n_connectivity;
  add_slab(image, "", "NumberOfPoints", NULL, COLUMN_INT64, 1, 1, &image->counts[0]);
  add_slab(image, "", "NumberOfCells", NULL, COLUMN_INT64, 1, 1, &image->counts[1]);
  add_slab(image, "", "NumberOfConnectivityIds", NULL, COLUMN_INT64, 1, 1, &image->counts[2]);
  add_slab(image, "", "Points", "m", COLUMN_REAL, 3, data->n_points, data->x);
  add_slab(image, "", "Connectivity", NULL, COLUMN_INT64, 1, image->n_connectivity, image->connectivity);
  add_slab(image, "", "Offsets", NULL, COLUMN_INT64, 1, image->n_cells + 1, image->offsets);
  add_slab(image, "", "Types", NULL, COLUMN_BYTE, 1, image->n_cells, image->types);
}

static PetscErrorCode ImageCreate(MPI_Comm comm, PetscMPIInt rank, const VtkData *data, Image *image)
{
  int has[2] = {data->connectivity != NULL, data->point_id != NULL};

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(image, sizeof *image));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, has, 2, MPI_INT, MPI_MAX, comm));
  image->has_cells = has[0] != 0;
  image->has_id = has[1] != 0;
  PetscCall(PetscMalloc1((size_t)(11 + data->n_point_fields + data->n_cell_fields), &image->slabs));
  PetscCall(MakeTopology(image, data));
  add_geometry(image, data);
  for (PetscInt i = 0; i < data->n_point_fields; ++i) {
    const VtkField *field = &data->point_fields[i];
    add_slab(image, "PointData/", field->name, field->unit, COLUMN_REAL, field->components, data->n_points,
             field->data);
  }
  if (image->has_id) add_slab(image, "PointData/", "id", NULL, COLUMN_INT64, 1, data->n_points, data->point_id);
  for (PetscInt i = 0; i < data->n_cell_fields; ++i) {
    const VtkField *field = &data->cell_fields[i];
    add_slab(image, "CellData/", field->name, field->unit, COLUMN_REAL, field->components, image->n_cells, field->data);
  }
  add_slab(image, "FieldData/", "Time", "s", COLUMN_REAL, 1, rank ? 0 : 1, &data->time);
  if (data->stage) add_slab(image, "FieldData/", "Stage", NULL, COLUMN_INT64, 1, rank ? 0 : 1, &data->stage);
  if (data->n_frames)
    add_slab(image, "FieldData/", "WallFrames", NULL, COLUMN_REAL, 12, rank ? 0 : data->n_frames, data->frames);
  PetscFunctionReturn(0);
}

static PetscErrorCode ImageDestroy(Image *image)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(image->connectivity, image->offsets, image->types));
  PetscCall(PetscFree(image->slabs));
  PetscFunctionReturn(0);
}

PetscErrorCode VtkWrite(MPI_Comm comm, const char *path, const VtkData *data, char reason[256])
{
  static const char *const groups[] = {"PointData", "CellData", "FieldData", NULL};
  static const PetscInt64 version[2] = {1, 0};
  const double time = (double)data->time;
  const SlabAttribute attributes[] = {{"Version", NULL, COLUMN_INT64, 2, version},
                                      {"Type", "UnstructuredGrid", COLUMN_BYTE, 0, NULL},
                                      {"Time", NULL, COLUMN_REAL, 1, &time}};
  const SlabHead head = {.group = "VTKHDF", .groups = groups, .n_attributes = 3, .attributes = attributes};
  PetscMPIInt rank;
  Image image;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(ImageCreate(comm, rank, data, &image));
  const PetscErrorCode code = SlabFileWrite(comm, path, &head, image.n, image.slabs, NULL, PETSC_FALSE, reason);
  PetscCall(ImageDestroy(&image));
  PetscFunctionReturn(code);
}
