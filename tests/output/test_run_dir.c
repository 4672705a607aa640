/* The run directory: created, recognised, refused, cleared, logged into. */
#include "test_output.h"
#include <sys/stat.h>
#include "output/directory/run_dir.h"
#include "output/directory/run_dir_files.h"
#include "output/directory/run_dir_mark.h"

static void Write(const char *folder, const char *name, const char *text)
{
  char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  if (test_rank() == 0) assert_int_equal(file_write_text(path, text), 0);
  MPI_Barrier(PETSC_COMM_WORLD);
}

static void Touch(const char *folder, const char *name) { Write(folder, name, "old\n"); }

static void MakeFolder(const char *folder, const char *name)
{
  char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  if (test_rank() == 0) assert_int_equal(file_make_folders(path), 0);
  MPI_Barrier(PETSC_COMM_WORLD);
}

/* What the diagnostics say, joined over the ranks; "" if nothing. To be freed on rank 0, NULL
 * elsewhere. */
static char *Complaints(Diag *diag)
{
  char *text = NULL;
  size_t size;
  PetscInt errors;
  assert_int_equal(DiagReduce(PETSC_COMM_WORLD, diag, &errors), 0);
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(DiagFlush(diag, out), 0);
  fclose(out);
  return text;
}

/* Try to start a run; `complaint` is part of what must be said, NULL if it must go well. */
static void Try(const char *path, PetscBool force, const char *complaint)
{
  Diag *diag;
  RunDir *dir;
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(RunDirCreate(PETSC_COMM_WORLD, path, force, PETSC_TRUE, NULL, diag, &dir), 0);
  assert_int_equal(dir == NULL, complaint != NULL);
  if (dir) assert_string_equal(run_dir_path(dir), path);
  char *text = Complaints(diag);
  if (test_rank() == 0) {
    if (complaint) assert_non_null(strstr(text, complaint));
    else assert_string_equal(text, "");
  }
  free(text);
  assert_int_equal(RunDirDestroy(&dir), 0);
  assert_int_equal(DiagDestroy(&diag), 0);
  MPI_Barrier(PETSC_COMM_WORLD);
}

static void test_create_and_refuse(void **state)
{
  char folder[64], path[128];
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/deep/er/run", folder);
  Try(path, PETSC_FALSE, NULL);
  assert_true(TestExists(path, "log.txt"));
  Touch(path, "points_000003.hdf");
  Try(path, PETSC_FALSE, "already holds a run");
  assert_true(TestExists(path, "points_000003.hdf"));
  TestRemove(folder);
}

static void test_force_removes_the_run_only(void **state)
{
  static const char *const gone[] = {"points_000003.hdf",
                                     "grid_000003.hdf",
                                     "points.hdf.series",
                                     "history.csv",
                                     "case.yaml",
                                     "pictures/state_velocity.png",
                                     "points_000004.hdf.tmp-unfinished"};
  static const char *const kept[] = {"notes.txt", "points_of_view.hdf", "mesh.msh", "pictures/holiday.png"};
  char folder[64];
  (void)state;
  TestFolder(folder);
  MakeFolder(folder, "pictures");
  Try(folder, PETSC_FALSE, NULL);
  for (size_t i = 0; i < sizeof gone / sizeof *gone; ++i) Touch(folder, gone[i]);
  for (size_t i = 0; i < sizeof kept / sizeof *kept; ++i) Touch(folder, kept[i]);
  Try(folder, PETSC_TRUE, NULL);
  for (size_t i = 0; i < sizeof gone / sizeof *gone; ++i) assert_false(TestExists(folder, gone[i]));
  for (size_t i = 0; i < sizeof kept / sizeof *kept; ++i) assert_true(TestExists(folder, kept[i]));
  TestRemove(folder);
}

/* A folder with the user's own case is no run: not even --force may overwrite it. */
static void test_users_case_is_safe(void **state)
{
  char folder[64];
  (void)state;
  TestFolder(folder);
  Touch(folder, "case.yaml");
  Try(folder, PETSC_FALSE, "would be overwritten");
  Try(folder, PETSC_TRUE, "would be overwritten");
  assert_true(TestExists(folder, "case.yaml"));
  assert_false(TestExists(folder, "log.txt"));
  TestRemove(folder);
}

/* A run that was killed while it signed its directory leaves a beginning of the signature: no
 * stranger's file. */
static void test_killed_while_it_signed(void **state)
{
  static const char *const begun[] = {"", "directory of tal"}, *const foreign[] = {"mine\n", "directory of tables\n"};
  const char *name = RUN_DIR_SIGNATURE FILE_UNFINISHED;
  char folder[64];
  (void)state;
  for (int i = 0; i < 4; ++i) {
    TestFolder(folder);
    Write(folder, name, begun[i % 2]);
    Try(folder, i > 1, NULL);
    assert_true(TestExists(folder, RUN_DIR_SIGNATURE));
    assert_false(TestExists(folder, name));
    TestRemove(folder);
    TestFolder(folder);
    Write(folder, name, foreign[i % 2]);
    Try(folder, i > 1, "would be overwritten");
    assert_true(TestExists(folder, name));
    TestRemove(folder);
  }
}

static void test_cannot_be_written(void **state)
{
  char folder[64], path[128];
  (void)state;
  TestFolder(folder);
  Touch(folder, "file");
  snprintf(path, sizeof path, "%s/file/run", folder);
  Try(path, PETSC_FALSE, "Not a directory");
  Try("/proc/talus/run", PETSC_FALSE, "cannot create the output directory '/proc/talus/run'");
  Try("", PETSC_FALSE, "cannot create");
  if (geteuid() != 0) {
    if (test_rank() == 0) assert_int_equal(chmod(folder, 0500), 0);
    MPI_Barrier(PETSC_COMM_WORLD);
    Try(folder, PETSC_FALSE, "Permission denied");
    if (test_rank() == 0) assert_int_equal(chmod(folder, 0700), 0);
  }
  TestRemove(folder);
}

static void test_log_and_texts(void **state)
{
  char folder[64];
  Diag *diag;
  RunDir *dir;
  (void)state;
  TestFolder(folder);
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(RunDirCreate(PETSC_COMM_WORLD, folder, PETSC_FALSE, PETSC_TRUE, NULL, diag, &dir), 0);
  assert_int_equal(RunDirLog(dir, "cells = %d", 12), 0);
  const RunProgress progress = {
    .step = 1, .iterations = 3, .time = 0.25, .end = 1, .dt = 0.25, .residual = 1.2e-10, .points = 100};
  assert_int_equal(RunDirProgress(dir, &progress), 0);
  assert_int_equal(RunDirWriteText(dir, "version.txt", "talus 0\n"), 0);
  assert_int_equal(RunDirWriteText(dir, "no/such/folder.txt", "text"), PETSC_ERR_FILE_WRITE);
  if (test_rank() == 0) {
    char *log = TestRead(folder, "log.txt"), *version = TestRead(folder, "version.txt");
    assert_non_null(strstr(log, "cells = 12\nstep = 1 time = 0.25 dt = 0.25 iterations = 3 residual = 1.2e-10"));
    assert_non_null(strstr(log, "cannot write"));
    assert_string_equal(version, "talus 0\n");
    free(log);
    free(version);
  }
  assert_int_equal(RunDirDestroy(&dir), 0);
  assert_int_equal(RunDirOpen(PETSC_COMM_WORLD, folder, PETSC_TRUE, NULL, diag, &dir), 0);
  assert_int_equal(RunDirLog(dir, "resumed"), 0);
  assert_int_equal(RunDirDestroy(&dir), 0);
  if (test_rank() == 0) {
    char *log = TestRead(folder, "log.txt");
    assert_true(strstr(log, "cells = 12") && strstr(log, "resumed"));
    free(log);
  }
  assert_int_equal(DiagDestroy(&diag), 0);
  TestRemove(folder);
}

static void test_resume_needs_a_run(void **state)
{
  char folder[64];
  Diag *diag;
  RunDir *dir;
  (void)state;
  TestFolder(folder);
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(RunDirOpen(PETSC_COMM_WORLD, folder, PETSC_TRUE, NULL, diag, &dir), 0);
  assert_null(dir);
  char *text = Complaints(diag);
  if (test_rank() == 0) assert_non_null(strstr(text, "no run to resume"));
  free(text);
  assert_int_equal(DiagDestroy(&diag), 0);
  TestRemove(folder);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_create_and_refuse),  cmocka_unit_test(test_force_removes_the_run_only),
    cmocka_unit_test(test_users_case_is_safe), cmocka_unit_test(test_killed_while_it_signed),
    cmocka_unit_test(test_cannot_be_written),  cmocka_unit_test(test_log_and_texts),
    cmocka_unit_test(test_resume_needs_a_run)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
