/* Local maximum entropy: the suite of every basis, golden numbers, the hull, the finite-element
 * limit, bad clouds. */
#include "clouds.h"
#include "../conformance/golden.h"

static void suite(void **state)
{
  (void)state;
  const CloudBasis soft = {.kind = CLOUD_LME, .gamma = 0.6}, usual = {.kind = CLOUD_LME, .gamma = 1.8};
  const CloudBasis sharp = {.kind = CLOUD_LME, .gamma = 4.0},
                   windowed = {.kind = CLOUD_LME, .gamma = 1.0, .reach = 2.2};
  cloud_suite("lme gamma 0.6", &soft, 1e-8);
  cloud_suite("lme gamma 1.8", &usual, 1e-8);
  cloud_suite("lme gamma 4", &sharp,
              1e-5); /* the differences' own error: it falls with the fourth power of their step */
  cloud_suite("lme gamma 1, windowed", &windowed, 1e-6);
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
    struct fy_node *lme = fy_node_by_path(item, "lme", FY_NT, FYNWF_DONT_FOLLOW), *one;
    for (void *in = NULL; (one = fy_node_sequence_iterate(lme, &in)); ++compared) {
      PetscReal expected[CLOUD_MAX_NODES], slope[2 * CLOUD_MAX_NODES], dual[2] = {0};
      const CloudBasis basis = {.kind = CLOUD_LME, .gamma = golden_number(one, "beta") * h * h};
      golden_numbers(one, "N", n, expected);
      golden_numbers(one, "dN", 2 * n, slope);
      for (int warm = 0; warm < 2; ++warm) {
        assert_int_equal(cloud_basis(&basis, 2, n, X, h, x, N, dN, &condition, dual), CLOUD_OK);
        for (int a = 0; a < n; ++a) assert_true(fabs(N[a] - expected[a]) <= 1e-12);
        for (int k = 0; k < 2 * n; ++k) assert_true(fabs(dN[k] - slope[k]) * h <= 1e-11);
      }
    }
  }
  assert_true(compared >= 10);
  fy_document_destroy(document);
}

/* On a face of the hull only the nodes of that face matter, at a corner only that node. */
static void hull(void **state)
{
  (void)state;
  Random random = {3};
  for (int dim = 2; dim <= 3; ++dim)
    for (int trial = 0; trial < 50; ++trial) {
      const int side = dim == 2 ? 5 : 4;
      const CloudBasis basis = {.kind = CLOUD_LME, .gamma = random_real(&random, 0.6, 4)};
      PetscReal X[CLOUD_MAX_NODES * 3] = {0}, N[CLOUD_MAX_NODES], dN[CLOUD_MAX_NODES * 3], condition, x[3];
      const int n = lattice_cloud(&random, dim, side, 1.0, 0.0, X);
      const PetscReal edge = X[0];
      for (int k = 0; k < dim; ++k) x[k] = trial ? random_real(&random, -1, 1) : edge;
      x[dim - 1] = edge;
      assert_int_equal(cloud_basis(&basis, dim, n, X, 1.0, x, N, dN, &condition, NULL), CLOUD_OK);
      PetscReal sum = 0.0;
      for (int a = 0; a < n; ++a) {
        if (X[a * dim + dim - 1] > edge) assert_true(N[a] <= 1e-12);
        sum += N[a];
        for (int k = 0; k < dim; ++k) assert_true(isfinite(dN[a * dim + k]));
      }
      assert_true(fabs(sum - 1.0) <= 1e-12);
      if (!trial) assert_true(fabs(N[0] - 1.0) <= 1e-12);
    }
}

/* Ever nearer to the hull, and just behind it. */
static void near_hull(void **state)
{
  (void)state;
  const CloudBasis basis = {.kind = CLOUD_LME, .gamma = 1.8};
  Random random = {3};
  PetscReal X[50], N[25], dN[50], condition;
  const int n = lattice_cloud(&random, 2, 5, 1.0, 0.0, X);
  for (PetscReal t = 0.5; t > 1e-11; t *= 0.1) {
    const PetscReal inside[2] = {0.3, -2 + t}, outside[2] = {0.3, -2 - t}, corner[2] = {-2 + t, 2 - t};
    assert_int_equal(cloud_basis(&basis, 2, n, X, 1.0, inside, N, dN, &condition, NULL), CLOUD_OK);
    PetscReal height = 0.0, slope = 0.0;
    for (int a = 0; a < n; ++a) height += N[a] * X[2 * a + 1], slope += dN[2 * a + 1] * X[2 * a + 1];
    assert_true(fabs(height - inside[1]) <= 1e-12 && fabs(slope - 1) <= 1e-11);
    assert_int_equal(cloud_basis(&basis, 2, n, X, 1.0, corner, N, dN, &condition, NULL), CLOUD_OK);
    assert_int_equal(cloud_basis(&basis, 2, n, X, 1.0, outside, N, dN, &condition, NULL), CLOUD_OUTSIDE);
  }
}

/* With growing gamma: linear finite elements on the Delaunay triangulation, here hexagons'
 * equilateral triangles. */
static void finite_element_limit(void **state)
{
  (void)state;
  Random random = {11};
  PetscReal X[2 * 64];
  int n = 0;
  for (int j = -3; j <= 3; ++j)
    for (int i = -3; i <= 3; ++i) X[2 * n] = i + 0.5 * (j & 1), X[2 * n++ + 1] = j * sqrt(0.75);
  PetscReal error[3] = {0};
  for (int s = 0; s < 200; ++s) {
    PetscReal b = random_real(&random, 0.02, 0.96), c = random_real(&random, 0.02, 0.98 - b), a = 1 - b - c;
    if (a < 0.02) continue;
    const PetscReal x[2] = {b + 0.5 * c, c * sqrt(0.75)}, gamma[3] = {4, 20, 400};
    const PetscReal expected[3] = {a, b, c}, node[3][2] = {{0, 0}, {1, 0}, {0.5, sqrt(0.75)}};
    for (int g = 0; g < 3; ++g) {
      const CloudBasis basis = {.kind = CLOUD_LME, .gamma = gamma[g]};
      PetscReal N[64], dN[128], condition;
      assert_int_equal(cloud_basis(&basis, 2, n, X, 1.0, x, N, dN, &condition, NULL), CLOUD_OK);
      for (int v = 0; v < 3; ++v)
        for (int k = 0; k < n; ++k)
          if (hypot(X[2 * k] - node[v][0], X[2 * k + 1] - node[v][1]) < 1e-9)
            error[g] = PetscMax(error[g], fabs(N[k] - expected[v]));
    }
  }
  if (getenv("TALUS_TEST_PRINT")) print_message("off linear elements: %g %g %g\n", error[0], error[1], error[2]);
  assert_true(error[0] > error[1] && error[1] > error[2] && error[2] < 1e-2);
}

static void bad_clouds(void **state)
{
  (void)state;
  const CloudBasis basis = {.kind = CLOUD_LME, .gamma = 1.8};
  const PetscReal line[] = {0, 0, 1, 1, 2, 2, -1, -1}, on[] = {0.5, 0.5}, off[] = {0.5, 0.4};
  const PetscReal square[] = {0, 0, 1, 0, 1, 1, 0, 1}, bad[] = {0, 0, 1, NAN, 0, 1, 1, 1}, far[] = {300, 20};
  PetscReal N[4], dN[8], condition, dual[2] = {NAN, 1e9};
  assert_int_equal(cloud_basis(&basis, 2, 2, line, 1, on, N, dN, &condition, NULL), CLOUD_TOO_FEW);
  assert_int_equal(cloud_basis(&basis, 2, 4, line, 1, on, N, dN, &condition, NULL), CLOUD_DEGENERATE);
  assert_int_not_equal(cloud_basis(&basis, 2, 4, line, 1, off, N, dN, &condition, NULL), CLOUD_OK);
  assert_int_equal(cloud_basis(&basis, 2, 4, bad, 1, on, N, dN, &condition, NULL), CLOUD_NO_CONVERGENCE);
  assert_int_equal(cloud_basis(&basis, 2, 4, square, 1, far, N, dN, &condition, NULL), CLOUD_OUTSIDE);
  assert_true(condition == PETSC_MAX_REAL);
  for (int k = 0; k < 8; ++k) assert_true(dN[k] == 0.0);
  /* a useless start */
  assert_int_equal(cloud_basis(&basis, 2, 4, square, 1, on, N, dN, &condition, dual), CLOUD_OK);
  for (int a = 0; a < 4; ++a) assert_true(fabs(N[a] - 0.25) <= 1e-12);
  assert_true(hypot(dual[0], dual[1]) <= 1e-12);
}

/* Random clouds of any shape at random positions: a basis that reproduces, or a status; never a
 * NaN. */
static void anything(void **state)
{
  (void)state;
  Random random = {5};
  int count[5] = {0};
  for (int trial = 0; trial < 20000; ++trial) {
    const int dim = trial % 2 ? 2 : 3, n = 1 + (int)random_real(&random, 0, 20);
    const CloudBasis basis = {.kind = CLOUD_LME, .gamma = pow(10, random_real(&random, -1, 2))};
    PetscReal X[60], N[20], dN[60], condition, x[3], sum = 0.0;
    const PetscReal flat = pow(10, random_real(&random, -9, 1));
    for (int a = 0; a < n; ++a)
      for (int k = 0; k < dim; ++k) X[a * dim + k] = random_real(&random, -2, 2) * (k ? 1.0 : flat);
    for (int k = 0; k < dim; ++k) x[k] = random_real(&random, -1, 1) * (k ? 1.0 : flat);
    const CloudStatus status = cloud_basis(&basis, dim, n, X, 1.0, x, N, dN, &condition, NULL);
    ++count[status];
    for (int a = 0; a < n; ++a) sum += N[a];
    for (int k = 0; k < n * dim; ++k) assert_true(isfinite(dN[k]));
    assert_true(fabs(sum - (status == CLOUD_OK)) <= 1e-12);
  }
  if (getenv("TALUS_TEST_PRINT"))
    print_message("%d ok, %d few, %d degenerate, %d outside, %d no convergence\n", count[0], count[1], count[2],
                  count[3], count[4]);
  assert_true(count[CLOUD_OK] > 5000 && count[CLOUD_NO_CONVERGENCE] == 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(suite),     cmocka_unit_test(golden),
                                     cmocka_unit_test(hull),      cmocka_unit_test(near_hull),
                                     cmocka_unit_test(anything),  cmocka_unit_test(finite_element_limit),
                                     cmocka_unit_test(bad_clouds)};
  return cmocka_run_group_tests_name("lme", tests, NULL, NULL);
}
