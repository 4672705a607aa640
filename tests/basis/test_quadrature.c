/* Gauss rules: every monomial up to the rule's degree to 1e-14, and the first degree beyond it
 * missed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "basis/cell.h"

#define MAX_POINTS 64

static const PetscInt degrees[4][6] = {
  [CELL_TRIANGLE] = {1, 2, 4, 6},
  [CELL_QUADRILATERAL] = {1, 3, 5, 7, 9, 11}, /* in each direction */
  [CELL_TETRAHEDRON] = {1, 2, 5, 6},
  [CELL_HEXAHEDRON] = {1, 3, 5, 7},
};

static PetscReal factorial(PetscInt n) { return n < 2 ? 1.0 : (PetscReal)n * factorial(n - 1); }

static PetscReal exact(CellType type, const PetscInt power[3])
{
  const PetscInt dim = cells[type].dim;
  PetscReal value = 1.0;
  if (type == CELL_TRIANGLE || type == CELL_TETRAHEDRON) {
    for (PetscInt d = 0; d < dim; ++d) value *= factorial(power[d]);
    return value / factorial(power[0] + power[1] + power[2] + dim);
  }
  for (PetscInt d = 0; d < dim; ++d) value *= power[d] % 2 ? 0.0 : 2.0 / (PetscReal)(power[d] + 1);
  return value;
}

static PetscReal quadrature(CellType type, PetscInt n, const PetscReal *xi, const PetscReal *weight,
                            const PetscInt power[3])
{
  PetscReal sum = 0.0;
  for (PetscInt p = 0; p < n; ++p) {
    PetscReal term = weight[p];
    for (PetscInt d = 0; d < cells[type].dim; ++d) term *= pow(xi[p * cells[type].dim + d], (PetscReal)power[d]);
    sum += term;
  }
  return sum;
}

/* Largest error over the monomials of this degree (total for simplices, in each direction for
 * cubes). */
static PetscReal largest_error(CellType type, PetscInt n, PetscInt degree)
{
  const PetscBool simplex = type == CELL_TRIANGLE || type == CELL_TETRAHEDRON;
  PetscReal xi[MAX_POINTS * 3], weight[MAX_POINTS], largest = 0.0;
  assert_true(cell_quadrature(type, n, xi, weight));
  PetscInt power[3];
  for (power[2] = 0; power[2] <= (cells[type].dim == 3 ? degree : 0); ++power[2])
    for (power[1] = 0; power[1] <= degree; ++power[1])
      for (power[0] = 0; power[0] <= degree; ++power[0]) {
        if (simplex && power[0] + power[1] + power[2] > degree) continue;
        largest = fmax(largest, fabs(quadrature(type, n, xi, weight, power) - exact(type, power)));
      }
  return largest;
}

static void test_degree(void **state)
{
  (void)state;
  for (int type = 0; type < 4; ++type)
    for (int r = 0; cell_rules((CellType)type)[r]; ++r) {
      const PetscInt n = cell_rules((CellType)type)[r];
      assert_true(largest_error((CellType)type, n, degrees[type][r]) <= 1e-14);
      assert_true(largest_error((CellType)type, n, degrees[type][r] + 1) > 1e-7);
    }
}

static void test_points_inside_weights_positive(void **state)
{
  (void)state;
  PetscReal xi[MAX_POINTS * 3], weight[MAX_POINTS];
  for (int type = 0; type < 4; ++type)
    for (const PetscInt *n = cell_rules((CellType)type); *n; ++n) {
      PetscReal sum = 0.0;
      assert_true(cell_quadrature((CellType)type, *n, xi, weight));
      for (PetscInt p = 0; p < *n; ++p) {
        sum += weight[p];
        assert_true(weight[p] > 0.0);
        assert_true(cell_outside((CellType)type, xi + p * cells[type].dim) < -0.03);
        for (PetscInt q = 0; q < p; ++q) { /* all different */
          PetscReal distance = 0.0;
          for (PetscInt d = 0; d < cells[type].dim; ++d)
            distance += fabs(xi[p * cells[type].dim + d] - xi[q * cells[type].dim + d]);
          assert_true(distance > 0.05);
        }
      }
      assert_true(fabs(sum - cells[type].reference_volume) < 1e-14);
    }
}

static void test_no_such_rule(void **state)
{
  (void)state;
  PetscReal xi[MAX_POINTS * 3], weight[MAX_POINTS];
  const PetscInt wrong[] = {-1, 0, 2, 5, 65};
  for (int type = 0; type < 4; ++type)
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; ++k)
      assert_false(cell_quadrature((CellType)type, wrong[k], xi, weight));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_degree),
    cmocka_unit_test(test_points_inside_weights_positive),
    cmocka_unit_test(test_no_such_rule),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
