/* Files that cannot be written: the same error on every rank, nothing left behind, and the program
 * goes on. */
#include "test_output.h"
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include "output/vtk/vtk.h"

enum { N = 20000 };

static PetscErrorCode WriteZeros(const char *path, char reason[256])
{
  static PetscReal x[3 * N];
  const VtkData data = {.n_points = N, .x = x};
  return VtkWrite(PETSC_COMM_WORLD, path, &data, reason);
}

static void CheckNothingLeft(const char *folder)
{
  MPI_Barrier(PETSC_COMM_WORLD);
  assert_false(TestExists(folder, "points.hdf"));
  assert_false(TestExists(folder, "points.hdf.tmp-unfinished"));
  assert_false(TestExists(folder, "points.hdf.series"));
  MPI_Barrier(PETSC_COMM_WORLD);
}

static void test_no_folder(void **state)
{
  char folder[64], path[128], reason[256];
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/missing/points.hdf", folder);
  assert_int_equal(WriteZeros(path, reason), PETSC_ERR_FILE_WRITE);
  assert_string_equal(reason, "No such file or directory");
  assert_int_equal(VtkSeriesAppend(PETSC_COMM_WORLD, "/proc/none", "points", "points.hdf", 0, reason),
                   PETSC_ERR_FILE_WRITE);
  assert_string_equal(reason, "No such file or directory");
  TestRemove(folder);
}

/* A folder stands where the file should. */
static void test_blocked(void **state)
{
  char folder[64], path[128], reason[256];
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/points.hdf", folder);
  if (test_rank() == 0) assert_int_equal(mkdir(path, 0777), 0);
  assert_int_equal(WriteZeros(path, reason), PETSC_ERR_FILE_WRITE);
  assert_string_equal(reason, "Is a directory");
  assert_false(TestExists(folder, "points.hdf.tmp-unfinished"));
  TestRemove(folder);
}

/* A file as large as this is more than the process may write. No signal kills it. */
static void test_size_limit(void **state)
{
  char folder[64], path[128], reason[256];
  struct rlimit old, limit;
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/points.hdf", folder);
  getrlimit(RLIMIT_FSIZE, &old);
  limit = (struct rlimit){200000, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  assert_int_equal(WriteZeros(path, reason), PETSC_ERR_FILE_WRITE);
  setrlimit(RLIMIT_FSIZE, &old);
  assert_string_equal(reason, "File too large");
  CheckNothingLeft(folder);
  assert_int_equal(WriteZeros(path, reason), 0);
  TestRemove(folder);
}

/* A disk of 200 kB, where this may be mounted: it fills, and after the failure a smaller file still
 * fits. Nothing is asserted before the disk is gone again. */
static void test_full_disk(void **state)
{
  const PetscReal x[3] = {1, 2, 3};
  const VtkData small = {.n_points = 1, .x = x};
  char folder[64], path[128], reason[256], small_reason[256];
  int mounted = 0;
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/points.hdf", folder);
  if (test_rank() == 0) mounted = !mount("talus-test", folder, "tmpfs", 0, "size=200k");
  MPI_Bcast(&mounted, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (!mounted) {
    TestRemove(folder);
    skip();
  }
  const PetscErrorCode status = WriteZeros(path, reason);
  const PetscBool left = TestExists(folder, "points.hdf") || TestExists(folder, "points.hdf.tmp-unfinished");
  const PetscErrorCode small_status = VtkWrite(PETSC_COMM_WORLD, path, &small, small_reason);
  MPI_Barrier(PETSC_COMM_WORLD);
  if (test_rank() == 0) umount2(folder, MNT_DETACH);
  TestRemove(folder);
  assert_int_equal(status, PETSC_ERR_FILE_WRITE);
  assert_string_equal(reason, "No space left on device");
  assert_false(left);
  assert_int_equal(small_status, 0);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_no_folder), cmocka_unit_test(test_blocked),
                                     cmocka_unit_test(test_size_limit), cmocka_unit_test(test_full_disk)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
