/* Eigenvalues and vectors of symmetric 3 x 3 tensors. */
#include "../conformance/random.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "base/math/eigen.h"
#include <string.h>

/* Columns of v orthonormal, s v = v diag(value), falling. */
static void check(const PetscReal s[6], const PetscReal value[3], const PetscReal v[9])
{
  PetscReal full[9], sv[9], scale = 0.0;
  sym_to_full(s, full);
  tensor_multiply(full, v, sv);
  for (int k = 0; k < 6; ++k) scale = fmax(scale, fabs(s[k]));
  assert_true(value[0] >= value[1] && value[1] >= value[2]);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const PetscReal dot = v[a] * v[b] + v[3 + a] * v[3 + b] + v[6 + a] * v[6 + b];
      assert_true(fabs(dot - (a == b)) <= 1e-14);
      assert_true(fabs(sv[3 * a + b] - value[b] * v[3 * a + b]) <= 1e-14 * scale);
    }
}

/* Known eigenvalues in random directions, their differences from 1 down to rounding. */
static void test_known(void **state)
{
  (void)state;
  Random random = {8};
  for (int k = 0; k < 20000; ++k) {
    const PetscReal near = pow(10, -random_real(&random, 0, 17));
    const PetscReal x[3] = {1.5, 1.5 - near, k % 2 ? 1.5 - 2 * near : random_real(&random, -2, 1)};
    const PetscReal diagonal[6] = {x[1], x[2], x[0], 0, 0, 0}; /* out of order */
    PetscReal q[9], s[6], value[3], v[9], sorted[3];
    random_rotation(&random, q);
    sym_push_forward(q, diagonal, s);
    sym_eigen(s, value, v);
    check(s, value, v);
    memcpy(sorted, x, sizeof x);
    if (sorted[2] > sorted[1]) sorted[1] = x[2], sorted[2] = x[1];
    for (int a = 0; a < 3; ++a) assert_true(fabs(value[a] - sorted[a]) <= 4e-15);
  }
}

/* No rounding at all where there is nothing to turn; one turn in a plane leaves the third direction
 * alone. */
static void test_exact(void **state)
{
  (void)state;
  const PetscReal diagonal[6] = {2, -3, 7, 0, 0, 0}, plane[6] = {2, 1, 9, 0.5, 0, 0}, none[6] = {0};
  PetscReal value[3], v[9];
  sym_eigen(diagonal, value, v);
  assert_true(value[0] == 7 && value[1] == 2 && value[2] == -3);
  sym_eigen(plane, value, v);
  check(plane, value, v);
  assert_true(value[0] == 9 && v[6] == 1 && v[0] == 0 && v[3] == 0 && v[7] == 0 && v[8] == 0);
  assert_true(fabs(value[1] - (1.5 + sqrt(0.5))) <= 4e-16 && fabs(value[2] - (1.5 - sqrt(0.5))) <= 4e-16);
  sym_eigen(none, value, v);
  check(none, value, v);
}

/* Graded positive tensors D A D keep the small eigenvalues to relative accuracy: their product is
 * the determinant. */
static void test_graded(void **state)
{
  (void)state;
  Random random = {9};
  for (int k = 0; k < 5000; ++k) {
    const PetscReal a[6] = {
      1, 1, 1, random_real(&random, -0.4, 0.4), random_real(&random, -0.4, 0.4), random_real(&random, -0.4, 0.4)};
    PetscReal d[3], s[6], value[3], v[9];
    for (int i = 0; i < 3; ++i) d[i] = pow(10, random_real(&random, -8, 8));
    for (int m = 0; m < 6; ++m) s[m] = a[m] * d[voigt_row[m]] * d[voigt_column[m]];
    sym_eigen(s, value, v);
    const PetscReal expected = sym_det(a) * d[0] * d[0] * d[1] * d[1] * d[2] * d[2];
    assert_true(value[2] > 0.0);
    assert_true(fabs(value[0] * value[1] * value[2] / expected - 1.0) <= 1e-13);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_known),
    cmocka_unit_test(test_exact),
    cmocka_unit_test(test_graded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
