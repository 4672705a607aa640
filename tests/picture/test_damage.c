/* Files of a run that were damaged: each is read, or refused with a reason; never a crash, never an
 * error of PETSc. */
#include "../output/test_output.h"
#include <hdf5.h>
#include <math.h>
#include <sys/stat.h>
#include "../conformance/random.h"
#include "output/history.h"
#include "picture/plot.h"
#include "picture/scene/scene.h"
#include "output/vtk/vtk.h"
#include "output/vtk/vtk_read.h"
#include "output/vtk/vtk_series.h"

static char folder[64];

/* Bytes of a file, to be freed. */
typedef struct {
  size_t n;
  unsigned char *bytes;
} Bytes;

static const char *PathOf(const char *name)
{
  static char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static Bytes Load(const char *name)
{
  Bytes file = {0};
  FILE *in = fopen(PathOf(name), "rb");
  assert_non_null(in);
  fseek(in, 0, SEEK_END);
  file.n = (size_t)ftell(in);
  rewind(in);
  file.bytes = malloc(file.n);
  assert_int_equal(fread(file.bytes, 1, file.n, in), file.n);
  fclose(in);
  return file;
}

static void Store(const char *name, const void *bytes, size_t n)
{
  FILE *out = fopen(PathOf(name), "wb");
  assert_non_null(out);
  assert_int_equal(fwrite(bytes, 1, n, out), n);
  fclose(out);
}

/* Four quadrilaterals, the nine nodes as points with a field. */
static void WriteValid(const char *name)
{
  PetscReal x[27], u[27], mass[9];
  PetscInt cells[16];
  char reason[256];
  for (int i = 0; i < 9; ++i) {
    x[3 * i] = i % 3, x[3 * i + 1] = i / 3, x[3 * i + 2] = 0;
    for (int d = 0; d < 3; ++d) u[3 * i + d] = 0.1 * x[3 * i + d];
    mass[i] = 1;
  }
  for (int c = 0; c < 4; ++c) {
    const PetscInt a = c % 2 + 3 * (c / 2);
    const PetscInt corners[4] = {a, a + 1, a + 4, a + 3};
    memcpy(cells + 4 * c, corners, sizeof corners);
  }
  const VtkField fields[] = {{"displacement", "m", 3, u}, {"mass", "kg", 1, mass}};
  const VtkData data = {.n_points = 9,
                        .x = x,
                        .n_cells = 4,
                        .connectivity = cells,
                        .nodes_per_cell = 4,
                        .vtk_type = 9,
                        .n_point_fields = 2,
                        .point_fields = fields,
                        .time = 0.5};
  assert_int_equal(VtkWrite(PETSC_COMM_WORLD, PathOf(name), &data, reason), 0);
}

/* Everything that a picture takes from a file but the drawing; what was refused is told in
 * reason. */
static void ReadForPicture(const char *name, char reason[256])
{
  static PlotScene scene;
  PlotScalar scalar = {.reduction = PLOT_MAGNITUDE};
  const VtkFieldInfo *fields;
  PlotPage page;
  VtkFile *file;
  memset(&scene, 0, sizeof scene);
  scene.up = 2;
  const PetscErrorCode code = VtkReadOpen(PathOf(name), &file, reason);
  assert_true(code == 0 || code == PETSC_ERR_FILE_OPEN);
  assert_true((code != 0) == (reason[0] != 0));
  if (code) return;
  for (PetscInt i = 0, n = vtk_read_fields(file, &fields); i < n && !reason[0]; ++i)
    assert_int_equal(PlotFrameRead(file, &fields[i], &scalar, &scene, reason), 0);
  if (!reason[0] && scene.n_frames) assert_int_equal(PlotFramesShape(&scene), 0);
  if (!reason[0] && scene.n_frames)
    assert_int_equal(PlotFrameGrid(file, &scene, &scene.frames[scene.n_frames - 1], reason), 0);
  if (!reason[0] && scene.n_frames && scene.frames[0].n) plot_lay_out(&scene, 0, 0, &page);
  assert_int_equal(PlotFramesFree(&scene), 0);
  assert_int_equal(VtkReadClose(&file), 0);
}

/* One to four places, or the end. */
static size_t Damage(unsigned char *bytes, size_t n, Random *random)
{
  static const unsigned char telling[] = {0, 1, 0x7f, 0x80, 0xff, 0x10};
  if (random_bits(random) % 16 == 0) return random_bits(random) % n;
  for (uint64_t k = 1 + random_bits(random) % 4; k > 0; --k) {
    const size_t at = random_bits(random) % n;
    const uint64_t how = random_bits(random) % 4;
    const unsigned char value = telling[random_bits(random) % sizeof telling];
    if (how == 0) bytes[at] ^= (unsigned char)(1u << random_bits(random) % 8);
    else if (how == 1) bytes[at] = value;
    else if (how == 2) bytes[at] = (unsigned char)random_bits(random);
    else memset(bytes + at, value, PetscMin(n - at, 8));
  }
  return n;
}

static void test_mutations(void **state)
{
  enum { ROUNDS = 250 };
  Random random = {1};
  char reason[256];
  int refused = 0;
  (void)state;
  WriteValid("valid.hdf");
  ReadForPicture("valid.hdf", reason);
  assert_string_equal(reason, "");
  const Bytes valid = Load("valid.hdf");
  unsigned char *bytes = malloc(valid.n);
  for (int k = 0; k < ROUNDS; ++k) {
    memcpy(bytes, valid.bytes, valid.n);
    Store("damaged.hdf", bytes, Damage(bytes, valid.n, &random));
    ReadForPicture("damaged.hdf", reason);
    refused += reason[0] != 0;
  }
  assert_true(refused > ROUNDS / 10); /* else it damages nothing that matters */
  free(bytes);
  free(valid.bytes);
}

/* Change a valid file with HDF5 itself. */
static void Changed(void (*change)(hid_t root), const char *word)
{
  char reason[256];
  WriteValid("changed.hdf");
  const hid_t file = H5Fopen(PathOf("changed.hdf"), H5F_ACC_RDWR, H5P_DEFAULT),
              root = H5Gopen2(file, "VTKHDF", H5P_DEFAULT);
  assert_true(root >= 0);
  change(root);
  H5Gclose(root);
  H5Fclose(file);
  ReadForPicture("changed.hdf", reason);
  if (!strstr(reason, word)) fail_msg("'%s' instead of '%s'", reason, word);
}

/* Entry `at` of a list of whole numbers becomes `value`. */
static void SetEntry(hid_t root, const char *name, hsize_t at, PetscInt64 value)
{
  const hsize_t one = 1;
  const hid_t set = H5Dopen2(root, name, H5P_DEFAULT), space = H5Dget_space(set),
              memory = H5Screate_simple(1, &one, NULL);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, &at, NULL, &one, NULL);
  assert_true(H5Dwrite(set, H5T_NATIVE_INT64, memory, space, H5P_DEFAULT, &value) >= 0);
  H5Sclose(memory), H5Sclose(space), H5Dclose(set);
}

/* A dataset of the same name with another shape or type; dims 0: none at all. */
static void Replace(hid_t root, const char *name, hid_t type, int dims, hsize_t rows, hsize_t columns)
{
  const hsize_t size[2] = {rows, columns};
  assert_true(H5Ldelete(root, name, H5P_DEFAULT) >= 0);
  if (dims == 0) return;
  const hid_t plan = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(dims, size, NULL);
  H5Pset_alloc_time(plan, H5D_ALLOC_TIME_EARLY);
  const hid_t set = H5Dcreate2(root, name, type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
  assert_true(set >= 0);
  H5Dclose(set), H5Sclose(space), H5Pclose(plan);
}

static void LastCellBehindTheEnd(hid_t root)
{
  SetEntry(root, "Offsets", 3, 16);
} /* the heap was read beyond its end */
static void LastOffsetTooSmall(hid_t root) { SetEntry(root, "Offsets", 4, 15); }
static void OffsetsFall(hid_t root) { SetEntry(root, "Offsets", 2, 2); }
static void OffsetFarOut(hid_t root) { SetEntry(root, "Offsets", 1, INT64_MAX - 3); }
static void OffsetNegative(hid_t root) { SetEntry(root, "Offsets", 1, -8); }
static void NodeFarOut(hid_t root) { SetEntry(root, "Connectivity", 5, 9); }
static void NodeNegative(hid_t root) { SetEntry(root, "Connectivity", 5, -1); }
static void CountNegative(hid_t root) { SetEntry(root, "NumberOfPoints", 0, -9); }
static void CountHuge(hid_t root) { SetEntry(root, "NumberOfCells", 0, (PetscInt64)1 << 40); }
static void CountTooSmall(hid_t root) { SetEntry(root, "NumberOfConnectivityIds", 0, 12); }
static void OtherTypes(hid_t root) { SetEntry(root, "Types", 0, 12); }
static void NoOffsets(hid_t root) { Replace(root, "Offsets", 0, 0, 0, 0); }
static void FewTypes(hid_t root) { Replace(root, "Types", H5T_STD_U8LE, 1, 3, 1); }
static void NoPoints(hid_t root) { Replace(root, "Points", 0, 0, 0, 0); }
static void PointsInAPlane(hid_t root) { Replace(root, "Points", H5T_IEEE_F64LE, 2, 9, 2); }
static void PointsInALine(hid_t root) { Replace(root, "Points", H5T_IEEE_F64LE, 1, 9, 1); }
static void PointsBackwards(hid_t root) { Replace(root, "Points", H5T_IEEE_F64BE, 2, 9, 3); }
static void WideOffsets(hid_t root) { Replace(root, "Offsets", H5T_STD_I64LE, 2, 5, 64); }
static void WideCounts(hid_t root) { Replace(root, "NumberOfCells", H5T_STD_I64LE, 2, 1, 64); }
static void WideTime(hid_t root) { Replace(root, "FieldData/Time", H5T_IEEE_F64LE, 2, 1, 64); }

static void TextForPoints(hid_t root)
{
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, 8);
  Replace(root, "Points", type, 2, 9, 3);
  H5Tclose(type);
}

static void test_kinds(void **state)
{
  (void)state;
  Changed(LastCellBehindTheEnd, "a cell has more or fewer nodes than its type");
  Changed(OtherTypes, "a cell has more or fewer nodes than its type");
  Changed(LastOffsetTooSmall, "its cells name nodes that are not there");
  Changed(OffsetsFall, "its cells name nodes that are not there");
  Changed(OffsetFarOut, "its cells name nodes that are not there");
  Changed(OffsetNegative, "its cells name nodes that are not there");
  Changed(NodeFarOut, "its cells name nodes that are not there");
  Changed(NodeNegative, "its cells name nodes that are not there");
  Changed(NoOffsets, "its cells are not complete");
  Changed(FewTypes, "its cells are not complete");
  Changed(CountTooSmall, "its cells are not complete");
  Changed(WideOffsets, "its cells cannot be read");
  Changed(CountNegative, "its counts of points and cells do not fit together");
  Changed(CountHuge, "its counts of points and cells do not fit together");
  Changed(WideCounts, "its counts of points and cells do not fit together");
  Changed(NoPoints, "its counts of points and cells do not fit together");
  Changed(PointsBackwards, "its counts of points and cells do not fit together");
  Changed(TextForPoints, "its counts of points and cells do not fit together");
  Changed(PointsInAPlane, "its points have 2 coordinates instead of 3");
  Changed(PointsInALine, "its points have 1 coordinates instead of 3");
  Changed(WideTime, "its time is missing");
}

/* Not a whole file, or none: refused by a word. */
static void test_no_file(void **state)
{
  static const size_t sizes[] = {0, 1, 8, 96, 512, 2048, 4096};
  char reason[256];
  (void)state;
  WriteValid("valid.hdf");
  const Bytes valid = Load("valid.hdf");
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k) {
    Store("damaged.hdf", valid.bytes, sizes[k]);
    ReadForPicture("damaged.hdf", reason);
    assert_string_not_equal(reason, "");
  }
  Store("damaged.hdf", valid.bytes, valid.n - 2048); /* the last is only room */
  ReadForPicture("damaged.hdf", reason);
  assert_string_not_equal(reason, "");
  assert_int_equal(mkfifo(PathOf("pipe.hdf"), 0600), 0);
  ReadForPicture("pipe.hdf", reason); /* nobody writes: it would wait for ever */
  assert_non_null(strstr(reason, "no such file, or it is not an HDF5 file"));
  free(valid.bytes);
}

/* Places and values that are no numbers, or beyond reason, leave the rest to be drawn. */
static void test_numbers(void **state)
{
  static const double strange[] = {NAN, INFINITY, -INFINITY, 1e300, 1e-310, -1e29, 1e29};
  char reason[256];
  (void)state;
  for (size_t k = 0; k < sizeof strange / sizeof *strange; ++k) {
    double x[27];
    for (int i = 0; i < 27; ++i) x[i] = i % 3 < 2 && i > 2 ? i * 0.1 : strange[k];
    WriteValid("changed.hdf");
    const hid_t file = H5Fopen(PathOf("changed.hdf"), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t set = H5Dopen2(file, "VTKHDF/Points", H5P_DEFAULT);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x) >= 0);
    H5Dclose(set);
    H5Fclose(file);
    ReadForPicture("changed.hdf", reason);
    assert_string_equal(reason, "");
  }
}

/* What a list of states with these lines is refused for. */
static void Listed(const char *text, const char *word)
{
  char reason[256];
  VtkSeries series;
  Store("points.hdf.series", text, strlen(text));
  const PetscErrorCode code = VtkSeriesRead(folder, "points", &series, reason);
  assert_int_equal(code, *word ? PETSC_ERR_FILE_UNEXPECTED : 0);
  if (!strstr(reason, word)) fail_msg("'%s' instead of '%s'", reason, word);
  assert_int_equal(VtkSeriesFree(&series), 0);
}

static void test_series(void **state)
{
  (void)state;
  Listed("", "");
  Listed("{\n  \"files\": [\n    {\"name\": \"a.hdf\", \"time\": 1}\n  ]\n}\n", "");
  Listed("{\n    {\"name\": \"a.hdf\", \"time\": nan}\n", "line 2 names no file and its time");
  Listed("{\n    {\"name\": \"a.hdf\", \"time\": }\n", "line 2 names no file and its time");
  Listed("{\n    {\"name\": \"a.hdf\"}\n", "line 2 names no file and its time");
  Listed("{\n    {\"name\": \"\", \"time\": 1}\n", "line 2 names no file and its time");
  Listed("{\n    {\"name\": \"../secret.hdf\", \"time\": 1}\n", "line 2 names no file and its time");
  Listed("{\n    {\"na\x01e\": \"a.hdf\", \"time\": 1}\n", "line 2 names no file and its time");
}

static void Recorded(const char *text, size_t n, const char *word)
{
  char reason[256];
  History history;
  Store("history.csv", text, n);
  const PetscErrorCode code = HistoryRead(PathOf("history.csv"), &history, reason);
  assert_int_equal(code, *word ? PETSC_ERR_FILE_OPEN : 0);
  if (!strstr(reason, word)) fail_msg("'%s' instead of '%s'", reason, word);
  assert_int_equal(HistoryFree(&history), 0);
}

static void test_history(void **state)
{
  static char wide[400000];
  (void)state;
#define RECORDED(text, word) Recorded(text, sizeof text - 1, word)
  RECORDED("time [s],step,tip [m]\n0,0,1\n1,1,nan\n2,2,3", "");
  RECORDED("", "header");
  RECORDED("time [s],steppe\n", "header");
  RECORDED("time [s],step,tip [m]\n0,0,1\n1,1\n2,2,3\n", "line 3 is no row of 3 numbers");
  RECORDED("time [s],step,tip [m]\n0,0,1\n1,1,2,3\n2,2,3\n", "line 3 is no row of 3 numbers");
  RECORDED("time [s],step,tip [m]\n0,0,1\nnan,1,2\n", "line 3 is no row of 3 numbers");
  RECORDED("time [s],step,tip [m]\n0,0,x\n", "line 2 is no row of 3 numbers");
  RECORDED("time [s],step,tip [m]\n0,0,1\n\n", "line 3 is no row of 3 numbers");
  RECORDED("time [s],step,tip [m]\n0,0\0,1\n", "line 2 is no row of 3 numbers");
  memset(wide, ',', sizeof wide); /* 400,000 columns and no row: rows of that many took 205 MB */
  memcpy(wide, "time [s],step", 13);
  wide[sizeof wide - 1] = '\n';
  Recorded(wide, sizeof wide, "");
}

static int Tests(void)
{
  TestFolder(folder);
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_kinds),   cmocka_unit_test(test_no_file),
                                     cmocka_unit_test(test_numbers), cmocka_unit_test(test_series),
                                     cmocka_unit_test(test_history), cmocka_unit_test(test_mutations)};
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  TestRemove(folder);
  return failed;
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
