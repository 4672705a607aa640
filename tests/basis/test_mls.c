/* Moving least squares: the suite of every basis, golden numbers, its polynomials, bad clouds. */
#include "clouds.h"
#include "../conformance/golden.h"

static void suite(void **state)
{
  (void)state;
  const CloudBasis linear = {.effective_radius = 1.2}, bilinear = {.order = CLOUD_BILINEAR, .effective_radius = 1.2};
  const CloudBasis quadratic = {.order = CLOUD_QUADRATIC, .effective_radius = 1.4};
  const CloudBasis spline = {.weight = CLOUD_CUBIC_SPLINE, .effective_radius = 3.3};
  const CloudBasis windowed = {.effective_radius = 1.2, .reach = 2.2};
  cloud_suite("mls linear", &linear, 1e-8);
  cloud_suite("mls bilinear", &bilinear, 1e-8);
  cloud_suite("mls quadratic", &quadratic, 1e-8);
  /* its third derivative jumps: differences lose an order */
  cloud_suite("mls linear, cubic spline", &spline, 1e-6);
  cloud_suite("mls linear, windowed", &windowed, 1e-6);
}

static void golden(void **state)
{
  (void)state;
  struct fy_document *document = golden_open("shape_functions.json");
  struct fy_node *list = fy_node_by_path(fy_document_root(document), "cases", FY_NT, FYNWF_DONT_FOLLOW), *item;
  int compared = 0;
  for (void *at = NULL; (item = fy_node_sequence_iterate(list, &at));) {
    PetscReal X[2 * CLOUD_MAX_NODES], x[2], N[CLOUD_MAX_NODES], dN[2 * CLOUD_MAX_NODES], condition;
    const PetscReal h = golden_number(item, "h");
    golden_numbers(item, "x", 2, x);
    const int n = golden_flatten(fy_node_by_path(item, "nodes", FY_NT, FYNWF_DONT_FOLLOW), 2 * CLOUD_MAX_NODES, X) / 2;
    struct fy_node *mls = fy_node_by_path(item, "mls", FY_NT, FYNWF_DONT_FOLLOW), *one;
    for (void *in = NULL; (one = fy_node_sequence_iterate(mls, &in)); ++compared) {
      PetscReal expected[CLOUD_MAX_NODES], slope[2 * CLOUD_MAX_NODES];
      const CloudBasis basis = {
        .order = strcmp(golden_text(one, "basis"), "linear") ? CLOUD_BILINEAR : CLOUD_LINEAR,
        .weight = strcmp(golden_text(one, "kernel"), "gauss") ? CLOUD_CUBIC_SPLINE : CLOUD_GAUSSIAN,
        .effective_radius = golden_number(one, "Reff") / h};
      golden_numbers(one, "N", n, expected);
      golden_numbers(one, "dN", 2 * n, slope);
      assert_int_equal(cloud_basis(&basis, 2, n, X, h, x, N, dN, &condition, NULL), CLOUD_OK);
      /* Rounding grows with the condition of the moment matrix. */
      const PetscReal tolerance = 1e-14 * PetscMax(10.0, condition);
      for (int a = 0; a < n; ++a) assert_true(fabs(N[a] - expected[a]) <= tolerance);
      for (int k = 0; k < 2 * n; ++k) assert_true(fabs(dN[k] - slope[k]) * h <= 10 * tolerance);
    }
  }
  assert_true(compared >= 20);
  fy_document_destroy(document);
}

/* x_i x_j comes back exactly, value and gradient. */
static void assert_product(int dim, int n, const PetscReal *X, const PetscReal *x, const PetscReal *N,
                           const PetscReal *dN, int i, int j)
{
  PetscReal value = 0.0, slope[3] = {0};
  for (int a = 0; a < n; ++a) {
    const PetscReal f = X[a * dim + i] * X[a * dim + j];
    value += N[a] * f;
    for (int k = 0; k < dim; ++k) slope[k] += dN[a * dim + k] * f;
  }
  assert_true(fabs(value - x[i] * x[j]) <= 1e-12);
  for (int k = 0; k < dim; ++k) assert_true(fabs(slope[k] - (k == i ? x[j] : 0.0) - (k == j ? x[i] : 0.0)) <= 1e-12);
}

static void polynomials(void **state)
{
  (void)state;
  Random random = {7};
  for (int dim = 2; dim <= 3; ++dim)
    for (int order = CLOUD_BILINEAR; order <= CLOUD_QUADRATIC; ++order) {
      const CloudBasis basis = {.order = (CloudOrder)order, .effective_radius = 1.3};
      PetscReal X[CLOUD_MAX_NODES * 3], N[CLOUD_MAX_NODES], dN[CLOUD_MAX_NODES * 3], condition, x[3];
      const int n = lattice_cloud(&random, dim, dim == 2 ? 6 : 4, 1.0, 0.25, X);
      for (int k = 0; k < dim; ++k) x[k] = random_real(&random, -0.5, 0.5);
      assert_int_equal(cloud_basis(&basis, dim, n, X, 1.0, x, N, dN, &condition, NULL), CLOUD_OK);
      for (int i = 0; i < dim; ++i)
        for (int j = i + (order == CLOUD_BILINEAR); j < dim; ++j) assert_product(dim, n, X, x, N, dN, i, j);
    }
}

static void expect_nothing(CloudStatus expected, const CloudBasis *basis, int dim, int n, const PetscReal *X,
                           const PetscReal *x)
{
  PetscReal N[CLOUD_MAX_NODES], dN[CLOUD_MAX_NODES * 3], condition;
  assert_int_equal(cloud_basis(basis, dim, n, X, 1.0, x, N, dN, &condition, NULL), expected);
  assert_true(condition == PETSC_MAX_REAL);
  for (int a = 0; a < n; ++a) assert_true(N[a] == 0.0);
  for (int k = 0; k < n * dim; ++k) assert_true(dN[k] == 0.0);
}

static void bad_clouds(void **state)
{
  (void)state;
  const CloudBasis basis = {.effective_radius = 1.0}, spline = {.weight = CLOUD_CUBIC_SPLINE, .effective_radius = 1.0};
  const CloudBasis quadratic = {.order = CLOUD_QUADRATIC, .effective_radius = 1.0};
  const PetscReal line[] = {0, 0, 1, 1, 2, 2, -1, -1, 3, 3, 4, 4}, x[] = {0.3, 0.2, 0.1};
  const PetscReal plane[] = {0, 0, 0.3, 1, 0, 0.3, 0, 1, 0.3, 1, 1, 0.3, 2, 1, 0.3};
  const PetscReal same[] = {1, 1, 1, 1, 1, 1, 1, 1}, far[] = {9, 0, 0, 9, 9, 9, -9, -9};
  const PetscReal bad[] = {0, 0, 1, NAN, 0, 1, 1, 1}, huge[] = {0, 0, 1, INFINITY, 0, 1, 1, 1};
  expect_nothing(CLOUD_TOO_FEW, &basis, 2, 2, line, x);
  expect_nothing(CLOUD_TOO_FEW, &basis, 2, 0, line, x);
  expect_nothing(CLOUD_TOO_FEW, &quadratic, 2, 5, line, x);
  expect_nothing(CLOUD_DEGENERATE, &basis, 2, 6, line, x);
  expect_nothing(CLOUD_DEGENERATE, &basis, 2, 4, same, x);
  expect_nothing(CLOUD_DEGENERATE, &basis, 3, 5, plane, x);
  expect_nothing(CLOUD_DEGENERATE, &spline, 2, 4, far, x);
  expect_nothing(CLOUD_NO_CONVERGENCE, &basis, 2, 4, bad, x);
  expect_nothing(CLOUD_NO_CONVERGENCE, &basis, 2, 4, huge, x);
  PetscReal N[4], dN[8], condition; /* far from every node, where Gaussians underflow */
  assert_int_equal(cloud_basis(&basis, 2, 4, far, 0.01, x, N, dN, &condition, NULL), CLOUD_DEGENERATE);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(suite), cmocka_unit_test(golden), cmocka_unit_test(polynomials),
                                     cmocka_unit_test(bad_clouds)};
  return cmocka_run_group_tests_name("mls", tests, NULL, NULL);
}
