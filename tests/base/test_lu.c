/* Small dense systems: exact answers, rows that must change places, matrices without an answer. */
#include "../conformance/random.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "base/math/lu.h"

enum { MOST = 40 };

/* A with so many empty diagonals at its start that rows must change places. */
static void check_solve(Random *random, PetscInt n, PetscInt empty)
{
  PetscReal A[MOST * MOST], lost[MOST * MOST], x[MOST], b[MOST] = {0};
  for (PetscInt i = 0; i < n * n; ++i) A[i] = random_real(random, -1, 1);
  for (PetscInt i = 0; i < empty; ++i) A[i * n + i] = 0;
  for (PetscInt i = 0; i < n; ++i) x[i] = random_real(random, -1, 1);
  for (PetscInt i = 0; i < n * n; ++i) b[i / n] += A[i] * x[i % n];
  for (PetscInt i = 0; i < n * n; ++i) lost[i] = A[i];
  assert_true(lu_solve(n, lost, b));
  for (PetscInt i = 0; i < n; ++i) assert_true(fabs(b[i] - x[i]) <= 1e-9);
}

static void test_solves(void **state)
{
  (void)state;
  Random random = {5};
  for (PetscInt n = 1; n <= MOST; ++n) check_solve(&random, n, n > 1 ? n / 2 : 0);
}

static void test_singular(void **state)
{
  (void)state;
  PetscReal A[9] = {1, 2, 3, 2, 4, 6, 0, 1, 1}, b[3] = {1, 2, 3};
  assert_false(lu_solve(3, A, b));
  PetscReal broken[4] = {NAN, 1, NAN, 1}, c[2] = {1, 1};
  assert_false(lu_solve(2, broken, c));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_solves), cmocka_unit_test(test_singular)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
