#include "output/vtk/vtk_read.h"
#include <string.h>
#include <sys/stat.h>
#include "base/count.h"
#include "output/attempt.h"
#include "output/vtk/vtk_dataset.h"

#define MOST_FIELDS 256 /* that a picture may choose from */

struct VtkFile {
  hid_t file, root;
  PetscInt64 bytes; /* that the file has */
  PetscInt partitions;
  PetscBool too_many;
  PetscInt64 *points, *cells, *connectivity; /* of each partition */
  PetscInt n_points, n_cells, n_connectivity;
  PetscInt n_fields;
  VtkFieldInfo *fields;
};

static PetscInt64 rows(const VtkFile *file, const char *name)
{
  return dataset_rows(file->root, name, file->bytes, NULL);
}

static PetscErrorCode ReadCounts(VtkFile *file, const char *name, PetscInt64 **counts, PetscInt *sum, PetscBool *ok)
{
  PetscInt64 total = 0;

  PetscFunctionBeginUser;
  *ok = PETSC_FALSE;
  if (rows(file, name) != file->partitions) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(file->partitions, counts));
  *ok = dataset_read(file->root, name, H5T_NATIVE_INT64, file->partitions, *counts);
  for (PetscInt i = 0; i < file->partitions && *ok; ++i) {
    if ((*counts)[i] < 0 || (*counts)[i] > PETSC_MAX_INT) *ok = PETSC_FALSE;
    else total += (*counts)[i];
  }
  if (*ok && total > count_most(8)) file->too_many = PETSC_TRUE, *ok = PETSC_FALSE;
  *sum = *ok ? (PetscInt)total : 0;
  PetscFunctionReturn(0);
}

/* The fields of as many points as there are, while there is room. */
static herr_t describe_field(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  VtkFile *file = context;
  (void)info;
  if (file->n_fields == MOST_FIELDS) return 1;
  VtkFieldInfo *field = &file->fields[file->n_fields];
  if (strlen(name) >= sizeof field->name) return 0;
  if (dataset_rows(group, name, file->bytes, &field->components) != file->n_points) return 0;
  snprintf(field->name, sizeof field->name, "%s", name);
  const hid_t set = H5Dopen2(group, name, H5P_DEFAULT);
  dataset_string(set, "unit", field->unit, sizeof field->unit);
  H5Dclose(set);
  ++file->n_fields;
  return 0;
}

/* Fields in the order in which they were made would need tracking; names in order are as good. */
static PetscErrorCode FindFields(VtkFile *file, char reason[256])
{
  PetscFunctionBeginUser;
  const hid_t group = H5Gopen2(file->root, "PointData", H5P_DEFAULT);
  if (group < 0) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(MOST_FIELDS, &file->fields));
  if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, describe_field, file) < 0)
    snprintf(reason, 256, "its fields cannot be listed");
  H5Gclose(group);
  PetscFunctionReturn(0);
}

/* Check that the pieces fit together; what fails is told in `reason`. */
static PetscErrorCode ReadFrame(VtkFile *file, char reason[256])
{
  char type[32];
  PetscReal time;
  PetscBool ok[3];
  PetscInt dim = 0;

  PetscFunctionBeginUser;
  dataset_string(file->root, "Type", type, sizeof type);
  const PetscInt64 partitions = rows(file, "NumberOfPoints");
  if (strcmp(type, "UnstructuredGrid") || partitions < 1 || partitions > 1 << 24) {
    snprintf(reason, 256, "not a VTKHDF unstructured grid");
    PetscFunctionReturn(0);
  }
  file->partitions = (PetscInt)partitions;
  PetscCall(ReadCounts(file, "NumberOfPoints", &file->points, &file->n_points, &ok[0]));
  PetscCall(ReadCounts(file, "NumberOfCells", &file->cells, &file->n_cells, &ok[1]));
  PetscCall(ReadCounts(file, "NumberOfConnectivityIds", &file->connectivity, &file->n_connectivity, &ok[2]));
  if (file->too_many) {
    snprintf(reason, 256, "it has more points or cells than a picture can show (%d)", (int)count_most(8));
    PetscFunctionReturn(0);
  }
  if (!ok[0] || !ok[1] || !ok[2] || dataset_rows(file->root, "Points", file->bytes, &dim) != file->n_points) {
    snprintf(reason, 256, "its counts of points and cells do not fit together");
    PetscFunctionReturn(0);
  }
  if (dim != 3) snprintf(reason, 256, "its points have %d coordinates instead of 3", (int)dim);
  if (rows(file, "FieldData/Time") != 1 || !dataset_read(file->root, "FieldData/Time", H5T_NATIVE_DOUBLE, 1, &time))
    snprintf(reason, 256, "its time is missing");
  PetscCall(FindFields(file, reason));
  PetscFunctionReturn(0);
}

static PetscErrorCode OpenQuietly(const char *path, VtkFile *file, char reason[256])
{
  struct stat status;

  PetscFunctionBeginUser;
  /* a pipe would be waited for */
  const PetscBool plain = !stat(path, &status) && S_ISREG(status.st_mode);
  file->bytes = plain ? (PetscInt64)status.st_size : 0;
  file->file = plain && H5Fis_hdf5(path) > 0 ? H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  file->root = file->file < 0 ? -1 : H5Gopen2(file->file, "VTKHDF", H5P_DEFAULT);
  if (file->file < 0) snprintf(reason, 256, "there is no such file, or it is not an HDF5 file");
  else if (file->root < 0) snprintf(reason, 256, "it has no group VTKHDF");
  else PetscCall(ReadFrame(file, reason));
  PetscFunctionReturn(0);
}

/* All that HDF5 does with the structure of a file, which it believes: 1.10 crashes on some that are
 * damaged. */
static void try_structure(void *path, char reason[256])
{
  static const char *const cells[] = {"Offsets", "Connectivity", "Types"};
  VtkFile file = {.file = -1, .root = -1};
  H5E_BEGIN_TRY { (void)OpenQuietly(path, &file, reason); }
  H5E_END_TRY
  for (int i = 0; i < 3 && !reason[0]; ++i) (void)rows(&file, cells[i]);
  if (file.root >= 0) H5Gclose(file.root);
  if (file.file >= 0) H5Fclose(file.file);
}

PetscErrorCode VtkReadOpen(const char *path, VtkFile **file, char reason[256])
{
  PetscErrorCode status;
  char name[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscNew(file));
  (*file)->file = (*file)->root = -1;
  PetscCall(PetscStrncpy(name, path, sizeof name));
  attempt(try_structure, name, reason);
  if (!reason[0]) {
    H5E_BEGIN_TRY { status = OpenQuietly(path, *file, reason); }
    H5E_END_TRY
    PetscCall(status);
  }
  if (!reason[0]) PetscFunctionReturn(0);
  PetscCall(VtkReadClose(file));
  PetscFunctionReturn(PETSC_ERR_FILE_OPEN);
}

PetscErrorCode VtkReadClose(VtkFile **file)
{
  PetscFunctionBeginUser;
  if (!*file) PetscFunctionReturn(0);
  if ((*file)->root >= 0) H5Gclose((*file)->root);
  if ((*file)->file >= 0) H5Fclose((*file)->file);
  PetscCall(PetscFree((*file)->points));
  PetscCall(PetscFree((*file)->cells));
  PetscCall(PetscFree((*file)->connectivity));
  PetscCall(PetscFree((*file)->fields));
  PetscCall(PetscFree(*file));
  PetscFunctionReturn(0);
}

PetscInt vtk_read_points(const VtkFile *file) { return file->n_points; }

PetscInt vtk_read_fields(const VtkFile *file, const VtkFieldInfo **fields)
{
  *fields = file->fields;
  return file->n_fields;
}

/* n numbers, or none and a reason. */
static PetscErrorCode ReadNumbers(const VtkFile *file, const char *name, PetscInt64 n, PetscReal **numbers,
                                  char reason[256])
{
  PetscFunctionBeginUser;
  reason[0] = 0;
  PetscCall(PetscMalloc1(n, numbers));
  if (dataset_read(file->root, name, H5T_NATIVE_DOUBLE, n, *numbers)) PetscFunctionReturn(0);
  PetscCall(PetscFree(*numbers));
  snprintf(reason, 256, "%.200s cannot be read", name);
  PetscFunctionReturn(PETSC_ERR_FILE_UNEXPECTED);
}

PetscErrorCode VtkReadCoordinates(VtkFile *file, PetscReal **x, char reason[256])
{
  PetscFunctionBeginUser;
  const PetscErrorCode code = ReadNumbers(file, "Points", 3 * (PetscInt64)file->n_points, x, reason);
  PetscFunctionReturn(code);
}

PetscErrorCode VtkReadField(VtkFile *file, const VtkFieldInfo *field, PetscReal **data, char reason[256])
{
  char path[256];

  PetscFunctionBeginUser;
  snprintf(path, sizeof path, "PointData/%s", field->name);
  const PetscErrorCode code = ReadNumbers(file, path, (PetscInt64)file->n_points * field->components, data, reason);
  PetscFunctionReturn(code);
}

/* A partition's offsets rise from 0 to the number of its node numbers, and these name its
 * points. */
static PetscBool is_partition(PetscInt64 cells, const PetscInt64 *offsets, PetscInt64 connectivity,
                              const PetscInt64 *local, PetscInt64 points)
{
  if (offsets[0] != 0 || offsets[cells] != connectivity) return PETSC_FALSE;
  for (PetscInt64 c = 0; c < cells; ++c)
    if (offsets[c] > offsets[c + 1]) return PETSC_FALSE;
  for (PetscInt64 k = 0; k < connectivity; ++k)
    if (local[k] < 0 || local[k] >= points) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Offsets start anew in each partition, and so do node numbers. */
static PetscBool join_partitions(const VtkFile *file, const PetscInt64 *offsets, const PetscInt64 *local, VtkCells *all)
{
  PetscInt64 point = 0, cell = 0, id = 0;
  for (PetscInt p = 0; p < file->partitions; ++p) {
    const PetscInt64 cells = file->cells[p], ids = file->connectivity[p];
    if (!is_partition(cells, offsets + cell + p, ids, local + id, file->points[p])) return PETSC_FALSE;
    for (PetscInt64 c = 0; c < cells; ++c) all->start[cell + c] = (PetscInt)(id + offsets[cell + p + c]);
    for (PetscInt64 k = 0; k < ids; ++k) all->node[id + k] = (PetscInt)(point + local[id + k]);
    point += file->points[p], cell += cells, id += ids;
  }
  all->start[cell] = (PetscInt)id;
  return PETSC_TRUE;
}

/* Corners of VTK's cells; -1: any number. */
static PetscInt cell_nodes(int type)
{
  return type == 1 ? 1 : type == 3 ? 2 : type == 5 ? 3 : type == 9 || type == 10 ? 4 : type == 12 ? 8 : -1;
}

static PetscBool have_their_nodes(const VtkCells *cells)
{
  for (PetscInt c = 0; c < cells->n; ++c) {
    const PetscInt wanted = cell_nodes(cells->type[c]);
    if (wanted >= 0 && cells->start[c + 1] - cells->start[c] != wanted) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscErrorCode FillCells(const VtkFile *file, VtkCells *cells, char reason[256])
{
  const PetscInt64 n_offsets = (PetscInt64)file->n_cells + file->partitions;
  PetscInt64 *offsets, *local;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n_offsets, &offsets, file->n_connectivity, &local));
  if (!dataset_read(file->root, "Offsets", H5T_NATIVE_INT64, n_offsets, offsets) ||
      !dataset_read(file->root, "Connectivity", H5T_NATIVE_INT64, file->n_connectivity, local) ||
      !dataset_read(file->root, "Types", H5T_NATIVE_INT, file->n_cells, cells->type))
    snprintf(reason, 256, "its cells cannot be read");
  else if (!join_partitions(file, offsets, local, cells))
    snprintf(reason, 256, "its cells name nodes that are not there");
  else if (!have_their_nodes(cells)) snprintf(reason, 256, "a cell has more or fewer nodes than its type");
  PetscCall(PetscFree2(offsets, local));
  PetscFunctionReturn(0);
}

PetscErrorCode VtkReadTopology(VtkFile *file, VtkCells *cells, char reason[256])
{
  PetscFunctionBeginUser;
  reason[0] = 0;
  PetscCall(PetscMemzero(cells, sizeof *cells));
  if (rows(file, "Offsets") != (PetscInt64)file->n_cells + file->partitions || rows(file, "Types") != file->n_cells ||
      rows(file, "Connectivity") != file->n_connectivity) {
    snprintf(reason, 256, "its cells are not complete");
    PetscFunctionReturn(PETSC_ERR_FILE_UNEXPECTED);
  }
  cells->n = file->n_cells;
  PetscCall(
    PetscMalloc3((size_t)cells->n + 1, &cells->start, file->n_connectivity, &cells->node, cells->n, &cells->type));
  PetscCall(FillCells(file, cells, reason));
  if (!reason[0]) PetscFunctionReturn(0);
  PetscCall(VtkCellsFree(cells));
  PetscFunctionReturn(PETSC_ERR_FILE_UNEXPECTED);
}

PetscErrorCode VtkCellsFree(VtkCells *cells)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(cells->start, cells->node, cells->type));
  cells->n = 0;
  PetscFunctionReturn(0);
}

PetscBool vtk_read_frames(const VtkFile *file, PetscInt n, PetscReal *frames)
{
  PetscInt numbers = 0;
  PetscBool ok = PETSC_FALSE;
  H5E_BEGIN_TRY
  {
    if (dataset_rows(file->root, "FieldData/WallFrames", file->bytes, &numbers) == n && numbers == 12)
      ok = dataset_read(file->root, "FieldData/WallFrames", H5T_NATIVE_DOUBLE, 12 * n, frames);
  }
  H5E_END_TRY
  for (PetscInt i = 0; i < 12 * n && ok; ++i) ok = PetscAbsReal(frames[i]) < 1e30;
  return ok;
}

PetscInt vtk_read_stage(const VtkFile *file)
{
  PetscReal stage = 0;
  H5E_BEGIN_TRY
  {
    if (rows(file, "FieldData/Stage") != 1 ||
        !dataset_read(file->root, "FieldData/Stage", H5T_NATIVE_DOUBLE, 1, &stage))
      stage = 0;
  }
  H5E_END_TRY
  return stage >= 1 && stage < 1e6 ? (PetscInt)stage : 0;
}
