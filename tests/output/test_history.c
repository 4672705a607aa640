/* history.csv: what is written is read back bit by bit, and a resumed run goes on where it
 * stood. */
#include "test_output.h"
#include "output/history.h"
#include "output/directory/run_dir.h"

static const char *const names[] = {"tip", "mass, total", "say \"x\""}, *const units[] = {"m", "kg", ""};

static RunDir *Start(const char *folder, Diag **diag)
{
  RunDir *dir;
  assert_int_equal(DiagCreate(diag), 0);
  assert_int_equal(RunDirCreate(PETSC_COMM_WORLD, folder, PETSC_TRUE, PETSC_TRUE, NULL, *diag, &dir), 0);
  assert_non_null(dir);
  return dir;
}

static void Stop(RunDir **dir, Diag **diag)
{
  assert_int_equal(RunDirDestroy(dir), 0);
  assert_int_equal(DiagDestroy(diag), 0);
}

static PetscReal value(PetscInt step, PetscInt column)
{
  return (1.0 / 3.0 + step) * PetscPowReal(10, 5 * column - 7) * (step % 2 ? -1 : 1);
}

static void WriteRows(RunDir *dir, PetscInt from, PetscInt to)
{
  for (PetscInt step = from; step < to; ++step) {
    const PetscReal row[3] = {value(step, 0), value(step, 1), value(step, 2)};
    assert_int_equal(HistoryWrite(dir, 0.1 * step, step, row, NULL), 0);
  }
}

static void CheckRows(const char *folder, PetscInt n)
{
  char path[128], reason[256];
  History history;
  if (test_rank() > 0) return;
  snprintf(path, sizeof path, "%s/history.csv", folder);
  assert_int_equal(HistoryRead(path, &history, reason), 0);
  assert_int_equal(history.n_columns, 5);
  assert_int_equal(history.n_rows, n);
  for (PetscInt step = 0; step < n; ++step) {
    const PetscReal *row = history.values + 5 * step;
    assert_true(row[0] == 0.1 * step && row[1] == step);
    for (PetscInt k = 0; k < 3; ++k) assert_true(row[2 + k] == value(step, k));
  }
  for (PetscInt k = 0; k < 3; ++k) {
    assert_string_equal(history.names[2 + k], names[k]);
    assert_string_equal(history.units[2 + k], units[k]);
    assert_int_equal(history_column(&history, names[k]), 2 + k);
  }
  assert_int_equal(history_column(&history, "nothing"), -1);
  assert_int_equal(HistoryFree(&history), 0);
}

static void test_round_trip(void **state)
{
  char folder[64];
  Diag *diag;
  (void)state;
  TestFolder(folder);
  RunDir *dir = Start(folder, &diag);
  assert_int_equal(HistoryOpen(dir, 3, names, units), 0);
  WriteRows(dir, 0, 20);
  CheckRows(folder, 20); /* flushed row by row: complete before the run ends */
  if (test_rank() == 0) {
    char *text = TestRead(folder, "history.csv");
    assert_true(!strncmp(text, "time [s],step,tip [m],\"mass, total [kg]\",\"say \"\"x\"\"\"\n", 53));
    free(text);
  }
  Stop(&dir, &diag);
  TestRemove(folder);
}

static void test_resume(void **state)
{
  char folder[64], path[128];
  Diag *diag;
  (void)state;
  TestFolder(folder);
  RunDir *dir = Start(folder, &diag);
  assert_int_equal(HistoryOpenFrom(dir, 3, names, units, -1, NULL, diag), 0); /* no history yet */
  WriteRows(dir, 0, 10);
  Stop(&dir, &diag);
  snprintf(path, sizeof path, "%s/history.csv", folder);
  if (test_rank() == 0) { /* the run was killed in the middle of a row */
    FILE *out = fopen(path, "a");
    fputs("0.3,3,7", out);
    fclose(out);
  }
  CheckRows(folder, 10);
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(RunDirOpen(PETSC_COMM_WORLD, folder, PETSC_TRUE, NULL, diag, &dir), 0);
  assert_int_equal(HistoryOpenFrom(dir, 3, names, units, 5, NULL, diag), 0);
  CheckRows(folder, 6);
  WriteRows(dir, 6, 15);
  CheckRows(folder, 15);
  assert_int_equal(diag_errors(diag), 0);
  assert_int_equal(HistoryOpenFrom(dir, 2, names, units, 10, NULL, diag), 0); /* other measures */
  if (test_rank() == 0) assert_int_equal(diag_errors(diag), 1);
  CheckRows(folder, 15);
  assert_int_equal(HistoryOpenFrom(dir, 3, names, units, 20, NULL, diag), 0); /* rows are missing */
  if (test_rank() == 0) assert_int_equal(diag_errors(diag), 2);
  CheckRows(folder, 15);
  Stop(&dir, &diag);
  TestRemove(folder);
}

/* /dev/full stands for the disk: the error arrives on every rank, and the run can go on. */
static void test_full_disk(void **state)
{
  char folder[64], path[128];
  Diag *diag;
  (void)state;
  TestFolder(folder);
  RunDir *dir = Start(folder, &diag);
  snprintf(path, sizeof path, "%s/history.csv", folder);
  if (test_rank() == 0) assert_int_equal(symlink("/dev/full", path), 0);
  assert_int_equal(HistoryOpen(dir, 3, names, units), PETSC_ERR_FILE_WRITE);
  if (test_rank() == 0) {
    char *log = TestRead(folder, "log.txt");
    assert_non_null(strstr(log, "history.csv: No space left on device"));
    free(log);
  }
  Stop(&dir, &diag);
  TestRemove(folder);
}

static void test_not_a_history(void **state)
{
  char folder[64], path[128], reason[256];
  History history;
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/history%d.csv", folder, test_rank());
  assert_int_equal(HistoryRead(path, &history, reason), PETSC_ERR_FILE_OPEN);
  assert_string_equal(reason, "No such file or directory");
  FILE *out = fopen(path, "w");
  fputs("a,b\n1,2\n", out);
  fclose(out);
  assert_int_equal(HistoryRead(path, &history, reason), PETSC_ERR_FILE_OPEN);
  assert_non_null(strstr(reason, "header"));
  TestRemove(folder);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_round_trip), cmocka_unit_test(test_resume),
                                     cmocka_unit_test(test_full_disk), cmocka_unit_test(test_not_a_history)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
