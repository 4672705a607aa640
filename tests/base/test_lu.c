/* Small systems, full and in a band: exact answers, rows that must change places, matrices without an answer. */
#include "../conformance/random.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "base/math/lu.h"

enum { MOST = 40 };

/* A with so many empty diagonals at its start that rows must change places. */
static void check_solve(Random *random, PetscInt n, PetscInt band, PetscInt empty)
{
  PetscReal lost[MOST * (3 * MOST + 1)] = {0}, x[MOST], b[MOST] = {0};
  for (PetscInt i = 0; i < n; ++i) x[i] = random_real(random, -1, 1);
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) {
      if (j < i - band || j > i + band || (i == j && i < empty)) continue;
      lost[lu_at(band, i, j)] = random_real(random, -1, 1);
      b[i] += lost[lu_at(band, i, j)] * x[j];
    }
  assert_true(lu_solve(n, band, lost, b));
  for (PetscInt i = 0; i < n; ++i) assert_true(fabs(b[i] - x[i]) <= 1e-9);
}

static void test_solves(void **state)
{
  (void)state;
  Random random = {5};
  for (PetscInt n = 1; n <= MOST; ++n) check_solve(&random, n, n - 1, n > 1 ? n / 2 : 0);
  for (PetscInt band = 1; band < 12; ++band) check_solve(&random, MOST, band, 6);
}

static void test_singular(void **state)
{
  (void)state;
  const PetscReal full[9] = {1, 2, 3, 2, 4, 6, 0, 1, 1};
  PetscReal A[21] = {0}, b[3] = {1, 2, 3};
  for (PetscInt i = 0; i < 9; ++i) A[lu_at(2, i / 3, i % 3)] = full[i];
  assert_false(lu_solve(3, 2, A, b));
  PetscReal broken[8] = {0, NAN, 1, 0, NAN, 1, 0, 0}, c[2] = {1, 1};
  assert_false(lu_solve(2, 1, broken, c));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_solves), cmocka_unit_test(test_singular)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
