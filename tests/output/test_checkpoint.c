/* Checkpoint files: what was written is read back on any number of ranks, and no damage goes
 * unnoticed. */
#include "test_output.h"
#include <fcntl.h>
#include <math.h>
#include <sys/stat.h>
#include "../conformance/random.h"
#include "output/checkpoint/checkpoint.h"
#include "output/checkpoint/checkpoint_contents.h"

/* Rows of this rank: rank 0 has none where there are others, so that shares never match. */
static PetscInt64 my_rows(void) { return test_ranks() == 1 ? 100 : 50 * test_rank(); }
static PetscInt64 all_rows(void) { return test_ranks() == 1 ? 100 : test_ranks() == 2 ? 50 : 150; }
static PetscInt64 first_row(void) { return test_rank() < 2 ? 0 : 50; }

static double real_at(PetscInt64 row, int k) { return sin((double)(3 * row + k)); }

static PetscErrorCode MakeTables(Tables **tables)
{
  Table *table;
  Column *x, *id, *kind, *flag, *time;
  PetscFunctionBeginUser;
  PetscCall(TablesCreate(tables));
  PetscCall(TablesAdd(*tables, "whole", PETSC_TRUE, 2, &table));
  PetscCall(TableAdd(table, "time", "s", COLUMN_REAL, 1, NULL, &time));
  ((PetscReal *)time->data)[0] = 0.1, ((PetscReal *)time->data)[1] = -1e300;
  PetscCall(TablesAdd(*tables, "rows", PETSC_FALSE, my_rows(), &table));
  PetscCall(TableAdd(table, "x", "m", COLUMN_REAL, 3, NULL, &x));
  PetscCall(TableAdd(table, "id", NULL, COLUMN_INT64, 1, NULL, &id));
  PetscCall(TableAdd(table, "kind", NULL, COLUMN_INT32, 1, NULL, &kind));
  PetscCall(TableAdd(table, "flag", NULL, COLUMN_BYTE, 1, NULL, &flag));
  for (PetscInt64 i = 0; i < my_rows(); ++i) {
    const PetscInt64 row = first_row() + i;
    for (int k = 0; k < 3; ++k) ((PetscReal *)x->data)[3 * i + k] = real_at(row, k);
    ((PetscInt64 *)id->data)[i] = row << 33;
    ((int32_t *)kind->data)[i] = -(int32_t)row;
    ((unsigned char *)flag->data)[i] = (unsigned char)row;
  }
  PetscCall(TablesAdd(*tables, "none", PETSC_FALSE, 0, &table));
  PetscCall(TableAdd(table, "x", "m", COLUMN_REAL, 2, NULL, NULL));
  PetscFunctionReturn(0);
}

static void Write(const char *path)
{
  Tables *tables;
  char reason[256];
  assert_int_equal(MakeTables(&tables), 0);
  assert_int_equal(CheckpointWrite(PETSC_COMM_WORLD, path, tables, reason), 0);
  assert_int_equal(TablesDestroy(&tables), 0);
}

/* Read on this comm and look at every number; *damaged: it was refused as damaged. */
static void Check(MPI_Comm comm, const char *path, PetscBool *damaged)
{
  Tables *tables;
  char reason[256] = "";
  PetscMPIInt rank, size;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const PetscErrorCode code = CheckpointRead(comm, path, &tables, reason);
  *damaged = code != 0;
  if (code) {
    assert_int_equal(code, PETSC_ERR_FILE_UNEXPECTED);
    assert_null(tables);
    assert_true(strlen(reason) > 10);
    return;
  }
  assert_int_equal(tables->n, 3);
  const PetscReal *time = table_data(tables_find(tables, "whole"), "time", COLUMN_REAL, 1, reason);
  assert_true(time[0] == 0.1 && time[1] == -1e300);
  const Table *table = tables_find(tables, "rows");
  const PetscReal *x = table_data(table, "x", COLUMN_REAL, 3, reason);
  const PetscInt64 *id = table_data(table, "id", COLUMN_INT64, 1, reason);
  const int32_t *kind = table_data(table, "kind", COLUMN_INT32, 1, reason);
  const unsigned char *flag = table_data(table, "flag", COLUMN_BYTE, 1, reason);
  PetscInt64 first = all_rows() / size * rank + PetscMin(rank, all_rows() % size);
  assert_true(labs((long)(table->rows - all_rows() / size)) <= 1);
  for (PetscInt64 i = 0; i < table->rows; ++i) {
    for (int k = 0; k < 3; ++k) assert_true(x[3 * i + k] == real_at(first + i, k));
    assert_true(id[i] == (first + i) << 33);
    assert_int_equal(kind[i], -(first + i));
    assert_int_equal(flag[i], (first + i) & 255);
  }
  assert_int_equal(tables_find(tables, "none")->rows, 0);
  assert_null(tables_find(tables, "nothing"));
  assert_null(table_data(table, "x", COLUMN_REAL, 2, reason));
  assert_string_equal(reason, "rows/x is of another kind: 3 numbers a row instead of 2");
  assert_null(table_data(table, "y", COLUMN_REAL, 2, reason));
  assert_string_equal(reason, "rows/y is missing");
  assert_int_equal(TablesDestroy(&tables), 0);
}

static void test_round_trip(void **state)
{
  char folder[64], path[128];
  PetscBool damaged;
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/checkpoint.h5", folder);
  Write(path);
  Check(PETSC_COMM_WORLD, path, &damaged);
  assert_false(damaged);
  Check(PETSC_COMM_SELF, path, &damaged); /* another number of ranks */
  assert_false(damaged);
  TestRemove(folder);
}

static void Flip(const char *path, long at, unsigned char bits)
{
  unsigned char byte = 0;
  const int fd = open(path, O_RDWR);
  assert_true(fd >= 0 && pread(fd, &byte, 1, at) == 1);
  byte ^= bits;
  assert_int_equal(pwrite(fd, &byte, 1, at), 1);
  close(fd);
}

/* A bit anywhere: the file is refused, or every number is still right (HDF5's own part is not what
 * is read). */
static void test_wrong_bits(void **state)
{
  char folder[64], path[128];
  struct stat info;
  PetscBool damaged;
  Random random = {12345};
  int refused = 0;
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/checkpoint.h5", folder);
  Write(path);
  assert_int_equal(stat(path, &info), 0);
  for (int k = 0; k < 300; ++k) {
    const long at = (long)((double)random_real(&random, 0, 1) * (double)info.st_size);
    const unsigned char bit = (unsigned char)(1u << (int)(8 * (double)random_real(&random, 0, 1)));
    if (test_rank() == 0) Flip(path, at, bit);
    MPI_Barrier(PETSC_COMM_WORLD);
    Check(PETSC_COMM_WORLD, path, &damaged);
    refused += damaged;
    MPI_Barrier(PETSC_COMM_WORLD);
    if (test_rank() == 0) Flip(path, at, bit);
    MPI_Barrier(PETSC_COMM_WORLD);
  }
  assert_in_range(refused, 10, 290);
  Check(PETSC_COMM_WORLD, path, &damaged);
  assert_false(damaged);
  TestRemove(folder);
}

static void test_cut_off(void **state)
{
  char folder[64], path[128];
  struct stat info;
  PetscBool damaged;
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/checkpoint.h5", folder);
  Write(path);
  assert_int_equal(stat(path, &info), 0);
  for (long size = (long)info.st_size - 1; size >= 0; size = size > 600 ? size - 997 : size - 41) {
    if (test_rank() == 0) assert_int_equal(truncate(path, size), 0);
    MPI_Barrier(PETSC_COMM_WORLD);
    Check(PETSC_COMM_WORLD, path, &damaged);
    assert_true(damaged);
    MPI_Barrier(PETSC_COMM_WORLD);
  }
  TestRemove(folder);
}

static void test_missing(void **state)
{
  Tables *tables;
  char reason[256];
  (void)state;
  assert_int_equal(CheckpointRead(PETSC_COMM_WORLD, "/nowhere/checkpoint.h5", &tables, reason), PETSC_ERR_FILE_OPEN);
  assert_string_equal(reason, "No such file or directory");
  assert_int_equal(CheckpointRead(PETSC_COMM_WORLD, "/tmp", &tables, reason), PETSC_ERR_FILE_OPEN);
  assert_string_equal(reason, "Is a directory");
  assert_int_equal(CheckpointRead(PETSC_COMM_WORLD, "/dev/zero", &tables, reason), PETSC_ERR_FILE_OPEN);
}

/* Lists with a right checksum that make no sense all the same: nothing in them is believed. */
static void test_contents(void **state)
{
  static const ContentsEntry good = {"a", "x", COLUMN_REAL, 2, PETSC_FALSE, 10, 4096, 7};
  ContentsEntry entries[2];
  Contents c = {.file_bytes = 10000, .n = 2, .entries = entries}, back;
  char reason[256];
  (void)state;
  for (int k = 0; k < 9; ++k) {
    entries[0] = entries[1] = good;
    strcpy(entries[1].column, "y");
    if (k == 1) entries[0].rows = 1000;
    if (k == 2) entries[0].offset = 9999;
    if (k == 3) entries[0].rows = -1;
    if (k == 4) entries[0].offset = -8;
    if (k == 5) entries[0].components = 1 << 30;
    if (k == 6) entries[1].rows = 9; /* another number of rows in the same table */
    if (k == 7) entries[1].everywhere = PETSC_TRUE;
    if (k == 8) entries[0].rows = (PetscInt64)1 << 62;
    char *text = contents_write(&c);
    const PetscBool ok = contents_read(text, strlen(text), k == 0 ? 10000 : c.file_bytes, &back, reason);
    assert_int_equal(ok, k == 0);
    if (ok) {
      assert_int_equal(back.n, 2);
      assert_true(!strcmp(back.entries[1].column, "y") && back.entries[1].offset == 4096 && back.entries[1].crc == 7);
      free(back.entries);
      assert_false(contents_read(text, strlen(text), 9999, &back, reason));
      assert_string_equal(reason, "it is 9999 bytes long and should have 10000");
    } else assert_non_null(strstr(reason, "makes no sense"));
    free(text);
  }
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_round_trip), cmocka_unit_test(test_wrong_bits),
                                     cmocka_unit_test(test_cut_off), cmocka_unit_test(test_missing),
                                     cmocka_unit_test(test_contents)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
