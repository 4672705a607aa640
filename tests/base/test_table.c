/* Tables: what was put in comes out under its name, and nothing that is of another kind. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "base/table/table.h"

#define OK(call) assert_int_equal((call), 0)

static void test_columns(void **state)
{
  PetscReal x[] = {1, 2, 3, 4, 5, 6};
  Tables *tables;
  Table *points, *other;
  Column *own;
  char reason[256] = "";
  (void)state;
  OK(TablesCreate(&tables));
  OK(TablesAdd(tables, "points", PETSC_FALSE, 3, &points));
  OK(TablesAdd(tables, "other", PETSC_TRUE, 1, &other));
  OK(TableAdd(points, "position", "m", COLUMN_REAL, 2, x, NULL));
  OK(TableAdd(points, "id", NULL, COLUMN_INT64, 1, NULL, &own));
  for (int k = 0; k < 3; ++k) ((PetscInt64 *)own->data)[k] = 7 * k;
  assert_ptr_equal(tables_find(tables, "points"), points);
  assert_ptr_equal(tables_find(tables, "other"), other);
  assert_null(tables_find(tables, "point"));
  assert_ptr_equal(table_data(points, "position", COLUMN_REAL, 2, reason), x);
  assert_int_equal(((const PetscInt64 *)table_data(points, "id", COLUMN_INT64, 1, reason))[2], 14);
  assert_string_equal(reason, "");
  OK(TablesDestroy(&tables));
}

static void test_other_kinds(void **state)
{
  static const struct {
    const char *name;
    ColumnType type;
    PetscInt components;
    const char *words;
  } table[] = {
    {"position", COLUMN_REAL, 1, "points/position is of another kind: 2 numbers a row instead of 1"},
    {"position", COLUMN_REAL, 3, "points/position is of another kind: 2 numbers a row instead of 3"},
    {"position", COLUMN_INT64, 2, "points/position is of another kind"},
    {"positions", COLUMN_REAL, 2, "points/positions is missing"},
  };
  PetscReal x[2] = {0, 0};
  Tables *tables;
  Table *points;
  (void)state;
  OK(TablesCreate(&tables));
  OK(TablesAdd(tables, "points", PETSC_FALSE, 1, &points));
  OK(TableAdd(points, "position", "m", COLUMN_REAL, 2, x, NULL));
  for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
    char reason[256] = "";
    assert_null(table_data(points, table[k].name, table[k].type, table[k].components, reason));
    assert_non_null(strstr(reason, table[k].words));
  }
  OK(TablesDestroy(&tables));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_columns), cmocka_unit_test(test_other_kinds)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
