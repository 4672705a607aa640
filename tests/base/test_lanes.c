/* Logarithm, exponential, eigenvalues and functions of tensors, eight at once, against the scalar ones. */
#include "../conformance/random.h"
#include <float.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "base/math/eigen_lanes.h"
#include "base/math/projections_lanes.h"

/* Distance in units of the last place of the exact value. */
static PetscReal ulps(PetscReal value, long double exact)
{
  const PetscReal near = (PetscReal)exact, next = nextafter(fabs(near), INFINITY) - fabs(near);
  return (PetscReal)(fabsl((long double)value - exact) / (long double)next);
}

static void test_log(void **state)
{
  (void)state;
  Random random = {3};
  PetscReal worst = 0, near = 0;
  for (int k = 0; k < 100000; ++k) {
    Lanes x, y;
    for (int l = 0; l < LANES; ++l) {
      const PetscReal size = pow(10, -random_real(&random, 0, 17)), sign = l % 2 ? 1 : -1;
      x[l] = l < 6 ? 1 + sign * size * random_real(&random, 0, 0.99) : pow(2, random_real(&random, -1021, 1023));
    }
    lanes_log(&x, &y);
    for (int l = 0; l < LANES; ++l) worst = fmax(worst, x[l] == 1 ? fabs(y[l]) : ulps(y[l], logl((long double)x[l])));
    lanes_log_near(&x, &y);
    for (int l = 0; l < LANES; ++l) near = fmax(near, x[l] == 1 ? fabs(y[l]) : ulps(y[l], logl((long double)x[l])));
  }
  print_message("ln: %.3f units of the last place, near 1 %.3f\n", worst, near);
  assert_true(worst < 1.0 && near < 1.0);
}

static void test_exp(void **state)
{
  (void)state;
  Random random = {4};
  PetscReal worst = 0, near = 0;
  for (int k = 0; k < 100000; ++k) {
    Lanes x, y;
    for (int l = 0; l < LANES; ++l)
      x[l] = (l < 4 ? 1 : 690) * random_real(&random, -1, 1) * pow(10, -random_real(&random, 0, l % 4 ? 10 : 0));
    lanes_exp(&x, &y);
    for (int l = 0; l < LANES; ++l) worst = fmax(worst, ulps(y[l], expl((long double)x[l])));
    lanes_exp_near(&x, &y);
    for (int l = 0; l < LANES; ++l) near = fmax(near, ulps(y[l], expl((long double)x[l])));
  }
  print_message("exp: %.3f units of the last place, near 0 %.3f\n", worst, near);
  assert_true(worst < 2.0 && near < 2.0);
}

/* Where there is no logarithm a law must see that something is wrong. */
static void test_ends(void **state)
{
  (void)state;
  const Lanes x = {1, 0, -1, -INFINITY, INFINITY, NAN, DBL_MIN / 2, DBL_MIN}, large = {-1e30, -701, 701, 1e30, NAN, 0};
  Lanes y;
  lanes_log(&x, &y);
  assert_true(y[0] == 0 && fabs(y[7] - log(DBL_MIN)) < 1e-12);
  for (int l = 1; l < 7; ++l) assert_true(isnan(y[l]));
  lanes_exp(&large, &y);
  assert_true(y[0] > 0 && y[0] < 1e-300 && y[1] == y[0] && y[2] > 1e300 && isfinite(y[2]) && y[3] == y[2]);
  assert_true(isnan(y[4]) && y[5] == 1);
}

/* One lane: the values of base/math/eigen.h, and vectors that are orthonormal and belong to
 * them. */
static void check_lane(int l, const PetscReal s[6], const Lanes values[3], const Lanes vectors[9])
{
  PetscReal value[3], v[9];
  sym_eigen(s, value, v);
  for (int a = 0; a < 3; ++a) {
    assert_true(fabs(values[a][l] - value[a]) <= 4e-15);
    for (int i = 0; i < 3; ++i) {
      PetscReal product = -values[a][l] * vectors[3 * i + a][l];
      for (int j = 0; j < 3; ++j) product += s[voigt_of[i][j]] * vectors[3 * j + a][l];
      assert_true(fabs(product) <= 1e-14);
    }
    for (int b = 0; b <= a; ++b) {
      PetscReal dot = -(a == b);
      for (int i = 0; i < 3; ++i) dot += vectors[3 * i + a][l] * vectors[3 * i + b][l];
      assert_true(fabs(dot) <= 1e-14);
    }
  }
}

/* Tensors of all kinds side by side. */
static void test_eigen(void **state)
{
  (void)state;
  Random random = {5};
  for (int k = 0; k < 20000; ++k) {
    PetscReal s[LANES][6];
    Lanes tensor[6], values[3], vectors[9];
    for (int l = 0; l < LANES; ++l) {
      const PetscReal near = pow(10, -random_real(&random, 0, 17));
      for (int i = 0; i < 6; ++i) s[l][i] = (i < 3) + (l < 5 ? near : 1) * random_real(&random, -0.4, 0.4);
      if (l == 0) s[l][3] = 0;
      if (l < 3) s[l][4] = s[l][5] = 0;
      for (int i = 0; i < 6; ++i) tensor[i][l] = s[l][i];
    }
    lanes_sym_eigen(tensor, values, vectors);
    for (int l = 0; l < LANES; ++l) check_lane(l, s[l], values, vectors);
  }
}

static PetscReal exact(PetscReal x) { return x; }
static PetscReal bent(PetscReal x) { return fmax(x, 1.0) * x * x; }

/* One lane: f(s) by what the closed form gives, and by the axes of base/math/eigen.h. */
static void check_function(PetscReal (*f)(PetscReal), int l, const PetscReal s[6], const Lanes values[3],
                           const Lanes first[6], const Lanes last[6])
{
  PetscReal value[3], v[9];
  sym_eigen(s, value, v);
  for (int i = 0; i < 6; ++i) {
    const int r = 3 * voigt_row[i], c = 3 * voigt_column[i];
    PetscReal expected = 0;
    for (int a = 0; a < 3; ++a) expected += f(value[a]) * v[r + a] * v[c + a];
    const PetscReal middle = f(values[1][l]), high = f(values[0][l]) - middle, low = f(values[2][l]) - middle;
    const PetscReal found = (i < 3 ? middle : 0) + high * first[i][l] + low * last[i][l];
    assert_true(fabs(found - expected) <= 2e-14);
  }
}

/* The closed form: tensors of all kinds, with pairs and triples of eigenvalues that are alike to rounding. */
static void test_projections(void **state)
{
  (void)state;
  Random random = {6};
  for (int k = 0; k < 40000; ++k) {
    PetscReal s[LANES][6], q[9];
    Lanes tensor[6], values[3], first[6], last[6];
    for (int l = 0; l < LANES; ++l) {
      const PetscReal wide = pow(10, -random_real(&random, 0, 18)),
                      near = k % 50 ? pow(10, -random_real(&random, 0, 18)) : 0, third[4] = {0, near, 0.4, 0};
      const PetscReal x[6] = {1 + wide, 1 + (l % 4 ? wide - near : 0), 1 - third[l % 4]};
      random_rotation(&random, q);
      if (l == 3) memcpy(s[l], x, sizeof x);
      else sym_push_forward(q, x, s[l]);
      if (l == 2) s[l][4] = s[l][5] = 0;
      for (int i = 0; i < 6; ++i) tensor[i][l] = s[l][i];
    }
    lanes_sym_projections(tensor, values, first, last);
    for (int l = 0; l < LANES; ++l) {
      PetscReal value[3], v[9];
      sym_eigen(s[l], value, v);
      for (int a = 0; a < 3; ++a) assert_true(fabs(values[a][l] - value[a]) <= 4e-15);
      assert_true(values[0][l] >= values[1][l] && values[1][l] >= values[2][l]);
      check_function(exact, l, s[l], values, first, last);
      check_function(bent, l, s[l], values, first, last);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_log), cmocka_unit_test(test_exp),
                                     cmocka_unit_test(test_ends), cmocka_unit_test(test_eigen),
                                     cmocka_unit_test(test_projections)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
