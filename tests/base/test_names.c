/* Names are found in the time of one; and products of counts do not wrap. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <string.h>
#include "base/count.h"
#include "base/names.h"

enum { MANY = 100000 };

static void FindsAll(void **state)
{
  static char text[MANY][16];
  Names names = {0};
  (void)state;
  assert_int_equal(names_find(&names, "a"), -1);
  for (PetscInt i = 0; i < MANY; ++i) {
    snprintf(text[i], sizeof text[i], "k%d", (int)i);
    assert_int_equal(NamesSet(&names, text[i], i), 0);
  }
  assert_int_equal(names.n, MANY);
  for (PetscInt i = 0; i < MANY; ++i) assert_int_equal(names_find(&names, text[i]), i);
  assert_int_equal(names_find(&names, "k100000"), -1);
  assert_int_equal(NamesSet(&names, "k7", 70), 0); /* the newest number counts */
  assert_int_equal(names_find(&names, "k7"), 70);
  assert_int_equal(names.n, MANY);
  assert_int_equal(NamesFree(&names), 0);
}

/* A few steps for each name, not one for each of the others. */
static void WorkIsLinear(void **state)
{
  static char text[MANY][16];
  Names names = {0};
  (void)state;
  for (PetscInt i = 0; i < MANY; ++i) {
    snprintf(text[i], sizeof text[i], "a%d", (int)i);
    assert_int_equal(names_find(&names, text[i]), -1);
    assert_int_equal(NamesSet(&names, text[i], i), 0);
  }
  assert_true(names.steps < 10 * (PetscInt64)MANY);
  assert_int_equal(NamesFree(&names), 0);
}

static void CountsDoNotWrap(void **state)
{
  PetscInt64 sum;
  (void)state;
  assert_true(count_numbers(300000000, 9) == 2700000000u); /* as PetscInt: -1594967296 */
  assert_true(count_fits(5, 1000, 64, PETSC_MAX_INT, &sum) && sum == 64005);
  assert_false(count_fits(0, 44000000, 64, PETSC_MAX_INT, &sum));
  assert_true(sum == 2816000000);
  assert_true(count_fits(PETSC_MAX_INT - 4, 1, 4, PETSC_MAX_INT, &sum));
  assert_false(count_fits(PETSC_MAX_INT - 3, 1, 4, PETSC_MAX_INT, &sum));
  assert_int_equal(count_most(8), 268435455);
  assert_int_equal(count_most(0), PETSC_MAX_INT);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(FindsAll), cmocka_unit_test(WorkIsLinear),
                                     cmocka_unit_test(CountsDoNotWrap)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
