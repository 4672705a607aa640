#include "io/vtk_read.h"
#include <hdf5.h>
#include <string.h>

struct VtkFile {
  hid_t file, root;
  PetscInt partitions;
  PetscInt64 *points, *cells, *connectivity; /* of each partition */
  PetscInt n_points, n_cells, n_connectivity;
  PetscReal time;
  PetscInt n_fields;
  VtkFieldInfo *fields;
};

/* Number of entries of a dataset, and of its second dimension (1 if it has none); -1: not there or not
 * readable. */
static PetscInt64 DatasetSize(hid_t root, const char *name, PetscInt *components)
{
  hsize_t size[2] = {0, 1};
  const hid_t set = H5Dopen2(root, name, H5P_DEFAULT);
  if (set < 0) return -1;
  const hid_t space = H5Dget_space(set);
  const int dims = H5Sget_simple_extent_ndims(space);
  if (dims == 1 || dims == 2) H5Sget_simple_extent_dims(space, size, NULL);
  H5Sclose(space);
  H5Dclose(set);
  if (components) *components = (PetscInt)size[1];
  return dims == 1 || dims == 2 ? (PetscInt64)size[0] : -1;
}

static PetscBool ReadAll(hid_t root, const char *name, hid_t type, void *values)
{
  const hid_t set = H5Dopen2(root, name, H5P_DEFAULT);
  if (set < 0) return PETSC_FALSE;
  const herr_t status = H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Dclose(set);
  return status < 0 ? PETSC_FALSE : PETSC_TRUE;
}

/* A string attribute of fixed length; "" if there is none. */
static void ReadString(hid_t object, const char *name, char *text, size_t n)
{
  text[0] = 0;
  if (H5Aexists(object, name) <= 0) return;
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT), stored = H5Aget_type(attribute);
  if (H5Tget_class(stored) == H5T_STRING && H5Tis_variable_str(stored) <= 0) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, n);
    if (H5Aread(attribute, type, text) < 0) text[0] = 0;
    H5Tclose(type);
  }
  H5Tclose(stored);
  H5Aclose(attribute);
}

static PetscErrorCode ReadCounts(VtkFile *file, const char *name, PetscInt64 **counts, PetscInt *sum, PetscBool *ok)
{
  PetscInt64 total = 0;

  PetscFunctionBeginUser;
  *ok = PETSC_FALSE;
  if (DatasetSize(file->root, name, NULL) != file->partitions) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(file->partitions, counts));
  *ok = ReadAll(file->root, name, H5T_NATIVE_INT64, *counts);
  for (PetscInt i = 0; i < file->partitions; ++i) {
    if ((*counts)[i] < 0 || (*counts)[i] > PETSC_MAX_INT) *ok = PETSC_FALSE;
    total += (*counts)[i];
  }
  if (total > PETSC_MAX_INT / 8) *ok = PETSC_FALSE;
  *sum = *ok ? (PetscInt)total : 0;
  PetscFunctionReturn(0);
}

static herr_t CountField(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  VtkFile *file = context;
  (void)group, (void)name, (void)info;
  ++file->n_fields;
  return 0;
}

static herr_t DescribeField(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  VtkFile *file = context;
  VtkFieldInfo *field = &file->fields[file->n_fields];
  (void)info;
  if (DatasetSize(group, name, &field->components) != file->n_points) return 0;
  snprintf(field->name, sizeof field->name, "%s", name);
  const hid_t set = H5Dopen2(group, name, H5P_DEFAULT);
  ReadString(set, "unit", field->unit, sizeof field->unit);
  H5Dclose(set);
  ++file->n_fields;
  return 0;
}

/* Fields in the order in which they were made would need tracking; names in order are as good. */
static PetscErrorCode FindFields(VtkFile *file)
{
  PetscFunctionBeginUser;
  const hid_t group = H5Gopen2(file->root, "PointData", H5P_DEFAULT);
  if (group < 0) PetscFunctionReturn(0);
  H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, CountField, file);
  PetscCall(PetscCalloc1(file->n_fields, &file->fields));
  file->n_fields = 0;
  H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, DescribeField, file);
  H5Gclose(group);
  PetscFunctionReturn(0);
}

/* Check that the pieces fit together; what fails is told in `reason`. */
static PetscErrorCode ReadFrame(VtkFile *file, char reason[256])
{
  char type[32];
  PetscBool ok[3];

  PetscFunctionBeginUser;
  ReadString(file->root, "Type", type, sizeof type);
  const PetscInt64 partitions = DatasetSize(file->root, "NumberOfPoints", NULL);
  if (strcmp(type, "UnstructuredGrid") || partitions < 1 || partitions > 1 << 24) {
    snprintf(reason, 256, "not a VTKHDF unstructured grid");
    PetscFunctionReturn(0);
  }
  file->partitions = (PetscInt)partitions;
  PetscCall(ReadCounts(file, "NumberOfPoints", &file->points, &file->n_points, &ok[0]));
  PetscCall(ReadCounts(file, "NumberOfCells", &file->cells, &file->n_cells, &ok[1]));
  PetscCall(ReadCounts(file, "NumberOfConnectivityIds", &file->connectivity, &file->n_connectivity, &ok[2]));
  if (!ok[0] || !ok[1] || !ok[2] || DatasetSize(file->root, "Points", NULL) != file->n_points) {
    snprintf(reason, 256, "its counts of points and cells do not fit together");
    PetscFunctionReturn(0);
  }
  if (DatasetSize(file->root, "FieldData/Time", NULL) == 1)
    ReadAll(file->root, "FieldData/Time", H5T_NATIVE_DOUBLE, &file->time);
  PetscCall(FindFields(file));
  PetscFunctionReturn(0);
}

static PetscErrorCode OpenQuietly(const char *path, VtkFile *file, char reason[256])
{
  PetscFunctionBeginUser;
  file->file = H5Fis_hdf5(path) > 0 ? H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  file->root = file->file < 0 ? -1 : H5Gopen2(file->file, "VTKHDF", H5P_DEFAULT);
  if (file->file < 0) snprintf(reason, 256, "there is no such file, or it is not an HDF5 file");
  else if (file->root < 0) snprintf(reason, 256, "it has no group VTKHDF");
  else PetscCall(ReadFrame(file, reason));
  PetscFunctionReturn(0);
}

PetscErrorCode VtkReadOpen(const char *path, VtkFile **file, char reason[256])
{
  H5E_auto2_t report;
  void *context;

  PetscFunctionBeginUser;
  reason[0] = 0;
  PetscCall(PetscNew(file));
  H5Eget_auto2(H5E_DEFAULT, &report, &context);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  const PetscErrorCode status = OpenQuietly(path, *file, reason);
  H5Eset_auto2(H5E_DEFAULT, report, context);
  PetscCall(status);
  if (reason[0]) {
    PetscCall(VtkReadClose(file));
    PetscFunctionReturn(PETSC_ERR_FILE_OPEN);
  }
  PetscFunctionReturn(0);
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

PetscInt VtkReadPoints(const VtkFile *file) { return file->n_points; }

PetscInt VtkReadCells(const VtkFile *file) { return file->n_cells; }

PetscReal VtkReadTime(const VtkFile *file) { return file->time; }

PetscInt VtkReadFields(const VtkFile *file, const VtkFieldInfo **fields)
{
  *fields = file->fields;
  return file->n_fields;
}

PetscErrorCode VtkReadCoordinates(VtkFile *file, PetscReal **x)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * (size_t)file->n_points, x));
  PetscCheck(ReadAll(file->root, "Points", H5T_NATIVE_DOUBLE, *x), PETSC_COMM_SELF, PETSC_ERR_FILE_READ,
             "The points cannot be read");
  PetscFunctionReturn(0);
}

PetscErrorCode VtkReadField(VtkFile *file, const char *name, PetscReal **data)
{
  char path[256];
  PetscInt i = 0;

  PetscFunctionBeginUser;
  while (i < file->n_fields && strcmp(file->fields[i].name, name)) ++i;
  PetscCheck(i < file->n_fields, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "No field %s", name);
  PetscCall(PetscSNPrintf(path, sizeof path, "PointData/%s", name));
  PetscCall(PetscMalloc1((size_t)file->n_points * (size_t)file->fields[i].components, data));
  PetscCheck(ReadAll(file->root, path, H5T_NATIVE_DOUBLE, *data), PETSC_COMM_SELF, PETSC_ERR_FILE_READ,
             "Field %s cannot be read", name);
  PetscFunctionReturn(0);
}

/* Offsets start anew in each partition, and so do node numbers. */
static PetscErrorCode JoinPartitions(const VtkFile *file, const PetscInt64 *offsets, const PetscInt64 *local,
                                     PetscInt *start, PetscInt *node)
{
  PetscInt64 point = 0, cell = 0, id = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < file->partitions; ++p) {
    for (PetscInt64 c = 0; c < file->cells[p]; ++c) start[cell + c] = (PetscInt)(id + offsets[cell + p + c]);
    for (PetscInt64 k = 0; k < file->connectivity[p]; ++k) {
      PetscCheck(local[id + k] >= 0 && local[id + k] < file->points[p], PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
                 "A cell names a node that is not there");
      node[id + k] = (PetscInt)(point + local[id + k]);
    }
    point += file->points[p], cell += file->cells[p], id += file->connectivity[p];
  }
  start[cell] = (PetscInt)id;
  for (PetscInt64 c = 0; c < cell; ++c)
    PetscCheck(start[c] >= 0 && start[c] <= start[c + 1], PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "Cells overlap");
  PetscFunctionReturn(0);
}

PetscErrorCode VtkReadTopology(VtkFile *file, PetscInt **start, PetscInt **node, int **vtk_type)
{
  const PetscInt n_offsets = file->n_cells + file->partitions;
  PetscInt64 *offsets, *local;

  PetscFunctionBeginUser;
  PetscCheck(DatasetSize(file->root, "Offsets", NULL) == n_offsets &&
               DatasetSize(file->root, "Types", NULL) == file->n_cells &&
               DatasetSize(file->root, "Connectivity", NULL) == file->n_connectivity,
             PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "The cells are not complete");
  PetscCall(PetscMalloc2(n_offsets, &offsets, file->n_connectivity, &local));
  PetscCall(PetscMalloc1(file->n_cells + 1, start));
  PetscCall(PetscMalloc1(file->n_connectivity, node));
  PetscCall(PetscMalloc1(file->n_cells, vtk_type));
  PetscCheck(ReadAll(file->root, "Offsets", H5T_NATIVE_INT64, offsets) &&
               ReadAll(file->root, "Connectivity", H5T_NATIVE_INT64, local) &&
               ReadAll(file->root, "Types", H5T_NATIVE_INT, *vtk_type),
             PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "The cells cannot be read");
  PetscCall(JoinPartitions(file, offsets, local, *start, *node));
  PetscCall(PetscFree2(offsets, local));
  PetscFunctionReturn(0);
}
