/* VTKHDF files: what is written is what plain HDF5 reads, for any distribution over the ranks. */
#include "test_output.h"
#include <hdf5.h>
#include "output/vtk/vtk.h"
#include "output/vtk/vtk_read.h"
#include "output/vtk/vtk_series.h"

/* Points of one rank: `n` of them, numbered over all ranks from `first`. */
typedef struct {
  PetscInt n, first;
  PetscReal *x, *velocity, *stress, *mass;
  PetscInt64 *id;
} Cloud;

static PetscReal coordinate(PetscInt64 id, PetscInt d)
{
  return 0.1 * (PetscReal)id + 1000.0 * (PetscReal)d + 1.0 / 3.0;
}

static void CloudCreate(PetscInt n, Cloud *cloud)
{
  PetscInt last;
  MPI_Scan(&n, &last, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
  cloud->n = n;
  /* an empty rank has NULL for its arrays, the first one but for the ids */
  cloud->first = last - n;
  assert_int_equal(PetscMalloc5(3 * n, &cloud->x, 3 * n, &cloud->velocity, 6 * n, &cloud->stress, n, &cloud->mass,
                                n + (cloud->first == 0), &cloud->id),
                   0);
  for (PetscInt p = 0; p < n; ++p) {
    cloud->id[p] = cloud->first + p;
    cloud->mass[p] = 2.0 + (PetscReal)cloud->id[p];
    for (PetscInt d = 0; d < 3; ++d) cloud->x[3 * p + d] = coordinate(cloud->id[p], d);
    for (PetscInt d = 0; d < 3; ++d) cloud->velocity[3 * p + d] = -cloud->x[3 * p + d];
    for (PetscInt d = 0; d < 6; ++d) cloud->stress[6 * p + d] = 1e6 * cloud->x[3 * p] + (PetscReal)d;
  }
}

static void CloudWrite(const Cloud *cloud, const char *path)
{
  const VtkField fields[] = {
    {"velocity", "m/s", 3, cloud->velocity}, {"stress", "Pa", 6, cloud->stress}, {"mass", "kg", 1, cloud->mass}};
  const VtkData data = {.n_points = cloud->n,
                        .x = cloud->x,
                        .n_point_fields = 3,
                        .point_fields = fields,
                        .point_id = cloud->id,
                        .time = 0.7};
  char reason[256];
  assert_int_equal(VtkWrite(PETSC_COMM_WORLD, path, &data, reason), 0);
  assert_string_equal(reason, "");
}

static void CloudDestroy(Cloud *cloud) { PetscFree5(cloud->x, cloud->velocity, cloud->stress, cloud->mass, cloud->id); }

/* A whole dataset as 64-bit numbers or doubles; n must be its size. */
static void *ReadSet(hid_t root, const char *name, hid_t type, hssize_t n)
{
  const hid_t set = H5Dopen2(root, name, H5P_DEFAULT), space = H5Dget_space(set);
  assert_true(set >= 0);
  assert_int_equal(H5Sget_simple_extent_npoints(space), n);
  void *values = calloc((size_t)n + 1, 8);
  assert_true(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  H5Sclose(space);
  H5Dclose(set);
  return values;
}

static void CheckString(hid_t root, const char *object, const char *name, const char *expected)
{
  char text[64] = "";
  const hid_t attribute = H5Aopen_by_name(root, object, name, H5P_DEFAULT, H5P_DEFAULT), type = H5Aget_type(attribute);
  assert_true(attribute >= 0);
  assert_int_equal(H5Tget_class(type), H5T_STRING);
  assert_int_equal(H5Tis_variable_str(type), 0);
  assert_int_equal(H5Tget_cset(type), H5T_CSET_ASCII);
  assert_int_equal(H5Tget_size(type), strlen(expected));
  assert_true(H5Aread(attribute, type, text) >= 0);
  assert_string_equal(text, expected);
  H5Tclose(type);
  H5Aclose(attribute);
}

static void CheckHeader(hid_t root)
{
  PetscInt64 version[2] = {9, 9};
  const hid_t attribute = H5Aopen(root, "Version", H5P_DEFAULT);
  assert_true(H5Aread(attribute, H5T_NATIVE_INT64, version) >= 0);
  H5Aclose(attribute);
  assert_int_equal(version[0], 1);
  assert_int_equal(version[1], 0);
  CheckString(root, ".", "Type", "UnstructuredGrid");
  CheckString(root, "PointData/velocity", "unit", "m/s");
  CheckString(root, "PointData/stress", "unit", "Pa");
  CheckString(root, "Points", "unit", "m");
}

static void CheckPartitions(hid_t root, PetscInt ranks, const PetscInt *counts)
{
  static const char *const names[] = {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"};
  for (int k = 0; k < 3; ++k) {
    PetscInt64 *n = ReadSet(root, names[k], H5T_NATIVE_INT64, ranks);
    for (PetscInt r = 0; r < ranks; ++r) assert_int_equal(n[r], counts[r]);
    free(n);
  }
}

static void CheckTopology(hid_t root, PetscInt ranks, const PetscInt *counts, PetscInt total)
{
  PetscInt64 *node = ReadSet(root, "Connectivity", H5T_NATIVE_INT64, total);
  PetscInt64 *offset = ReadSet(root, "Offsets", H5T_NATIVE_INT64, total + ranks);
  PetscInt64 *type = ReadSet(root, "Types", H5T_NATIVE_INT64, total);
  PetscInt at = 0, at_offset = 0;
  for (PetscInt r = 0; r < ranks; ++r) {
    for (PetscInt i = 0; i < counts[r]; ++i) assert_int_equal(node[at + i], i);
    for (PetscInt i = 0; i <= counts[r]; ++i) assert_int_equal(offset[at_offset + i], i);
    for (PetscInt i = 0; i < counts[r]; ++i) assert_int_equal(type[at + i], 1);
    at += counts[r], at_offset += counts[r] + 1;
  }
  free(node);
  free(offset);
  free(type);
}

static void CheckNumbers(hid_t root, PetscInt total)
{
  double *x = ReadSet(root, "Points", H5T_NATIVE_DOUBLE, 3 * total),
         *v = ReadSet(root, "PointData/velocity", H5T_NATIVE_DOUBLE, 3 * total);
  double *s = ReadSet(root, "PointData/stress", H5T_NATIVE_DOUBLE, 6 * total),
         *m = ReadSet(root, "PointData/mass", H5T_NATIVE_DOUBLE, total);
  PetscInt64 *id = ReadSet(root, "PointData/id", H5T_NATIVE_INT64, total);
  double *time = ReadSet(root, "FieldData/Time", H5T_NATIVE_DOUBLE, 1);
  for (PetscInt p = 0; p < total; ++p) {
    assert_int_equal(id[p], p);
    assert_true(m[p] == 2.0 + p);
    for (PetscInt d = 0; d < 3; ++d) assert_true(x[3 * p + d] == coordinate(p, d) && v[3 * p + d] == -coordinate(p, d));
    for (PetscInt d = 0; d < 6; ++d) assert_true(s[6 * p + d] == 1e6 * coordinate(p, 0) + d);
  }
  assert_true(time[0] == 0.7);
  free(x), free(v), free(s), free(m), free(id), free(time);
}

/* Write with so many points on this rank, and let rank 0 read the file with nothing but HDF5. */
static void RoundTrip(PetscInt mine)
{
  char folder[64], path[128];
  PetscInt counts[16], total = 0;
  Cloud cloud;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/points_000001.hdf", folder);
  MPI_Allgather(&mine, 1, MPIU_INT, counts, 1, MPIU_INT, PETSC_COMM_WORLD);
  for (PetscInt r = 0; r < test_ranks(); ++r) total += counts[r];
  CloudCreate(mine, &cloud);
  CloudWrite(&cloud, path);
  if (test_rank() == 0) {
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), root = H5Gopen2(file, "VTKHDF", H5P_DEFAULT);
    assert_true(root >= 0);
    CheckHeader(root);
    CheckPartitions(root, test_ranks(), counts);
    CheckTopology(root, test_ranks(), counts, total);
    CheckNumbers(root, total);
    H5Gclose(root);
    H5Fclose(file);
    assert_false(TestExists(folder, "points_000001.hdf.tmp-unfinished"));
  }
  CloudDestroy(&cloud);
  TestRemove(folder);
}

static void test_points(void **state)
{
  (void)state;
  RoundTrip(700 + 11 * test_rank());
}

static void test_empty_ranks(void **state)
{
  (void)state;
  RoundTrip(test_rank() == test_ranks() - 1 ? 40 : 0);
  RoundTrip(test_rank() == 0 ? 40 : 0);
  RoundTrip(0);
}

/* A row of quadrilaterals on each rank, with a field on the cells. */
static void test_cells(void **state)
{
  char folder[64], path[128], reason[256];
  const PetscInt n = 2 + test_rank(), nodes = 2 * (n + 1);
  PetscReal x[64] = {0}, pressure[16];
  PetscInt cell[64];
  (void)state;
  for (PetscInt i = 0; i <= n; ++i)
    for (PetscInt j = 0; j < 2; ++j) x[3 * (2 * i + j)] = i, x[3 * (2 * i + j) + 1] = j + 10.0 * test_rank();
  for (PetscInt c = 0; c < n; ++c) {
    const PetscInt quad[4] = {2 * c, 2 * c + 2, 2 * c + 3, 2 * c + 1};
    memcpy(cell + 4 * c, quad, sizeof quad);
    pressure[c] = c + 100.0 * test_rank();
  }
  const VtkField field = {"pressure", "Pa", 1, pressure};
  const VtkData data = {.n_points = nodes,
                        .x = x,
                        .n_cells = n,
                        .connectivity = cell,
                        .nodes_per_cell = 4,
                        .vtk_type = 9,
                        .n_cell_fields = 1,
                        .cell_fields = &field};
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/grid_000001.hdf", folder);
  assert_int_equal(VtkWrite(PETSC_COMM_WORLD, path, &data, reason), 0);
  if (test_rank() == 0) {
    VtkFile *file;
    VtkCells cells;
    PetscReal *y;
    assert_int_equal(VtkReadOpen(path, &file, reason), 0);
    assert_int_equal(VtkReadTopology(file, &cells, reason), 0);
    assert_int_equal(VtkReadCoordinates(file, &y, reason), 0);
    for (PetscInt r = 0, c = 0; r < test_ranks(); ++r)
      for (PetscInt k = 0; k < 2 + r; ++k, ++c) {
        const PetscReal *a = y + 3 * cells.node[cells.start[c]], *b = y + 3 * cells.node[cells.start[c] + 2];
        assert_int_equal(cells.type[c], 9);
        assert_int_equal(cells.start[c + 1], 4 * (c + 1));
        assert_true(a[0] == k && a[1] == 10.0 * r && b[0] == k + 1 && b[1] == 10.0 * r + 1);
      }
    VtkCellsFree(&cells), PetscFree(y);
    VtkReadClose(&file);
    const hid_t plain = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    double *p = ReadSet(plain, "VTKHDF/CellData/pressure", H5T_NATIVE_DOUBLE, test_ranks() * (test_ranks() + 3) / 2);
    assert_true(p[0] == 0 && p[1] == 1 && (test_ranks() == 1 || p[2] == 100));
    free(p);
    H5Fclose(plain);
  }
  TestRemove(folder);
}

static void CheckSeries(const char *folder, PetscInt n, const PetscReal *times)
{
  VtkSeries series;
  char reason[256];
  MPI_Barrier(PETSC_COMM_WORLD);
  assert_int_equal(VtkSeriesRead(folder, "points", &series, reason), 0);
  assert_int_equal(series.n, n);
  for (PetscInt i = 0; i < n; ++i) assert_true(series.states[i].time == times[i]);
  assert_int_equal(VtkSeriesFree(&series), 0);
  MPI_Barrier(PETSC_COMM_WORLD);
}

static void Append(const char *folder, const char *file, PetscReal time)
{
  char reason[256];
  assert_int_equal(VtkSeriesAppend(PETSC_COMM_WORLD, folder, "points", file, time, reason), 0);
}

static void test_series(void **state)
{
  char folder[64];
  (void)state;
  TestFolder(folder);
  Append(folder, "points_000000.hdf", 0);
  Append(folder, "points_000001.hdf", 0.1);
  Append(folder, "points_000002.hdf", 0.1 + 0.1 + 0.1);
  CheckSeries(folder, 3, (PetscReal[]){0, 0.1, 0.1 + 0.1 + 0.1});
  if (test_rank() == 0) {
    char *text = TestRead(folder, "points.hdf.series");
    assert_string_equal(text,
                        "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [\n"
                        "    {\"name\": \"points_000000.hdf\", \"time\": 0},\n"
                        "    {\"name\": \"points_000001.hdf\", \"time\": 0.1},\n"
                        "    {\"name\": \"points_000002.hdf\", \"time\": 0.30000000000000004}\n  ]\n}\n");
    free(text);
  }
  Append(folder, "points_000001.hdf", 0.1); /* resumed: what follows is forgotten */
  CheckSeries(folder, 2, (PetscReal[]){0, 0.1});
  Append(folder, NULL, 0.1);
  CheckSeries(folder, 1, (PetscReal[]){0});
  Append(folder, "points_000001.hdf", 3.4); /* of a search, and of the stage behind it */
  Append(folder, "points_000002.hdf", 2);
  CheckSeries(folder, 3, (PetscReal[]){0, 3.4, 2});
  TestRemove(folder);
}

static void test_read_garbage(void **state)
{
  char folder[64], path[128], reason[256];
  VtkFile *file = NULL;
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/garbage%d.hdf", folder, test_rank());
  assert_int_equal(VtkReadOpen(path, &file, reason), PETSC_ERR_FILE_OPEN);
  FILE *out = fopen(path, "w");
  fputs("\x89HDF\r\n\x1a\nbut nothing more", out);
  fclose(out);
  assert_int_equal(VtkReadOpen(path, &file, reason), PETSC_ERR_FILE_OPEN);
  assert_null(file);
  assert_true(strlen(reason) > 10);
  TestRemove(folder);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_points), cmocka_unit_test(test_empty_ranks),
                                     cmocka_unit_test(test_cells), cmocka_unit_test(test_series),
                                     cmocka_unit_test(test_read_garbage)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
