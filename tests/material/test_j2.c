/* J2 laws against golden numbers (a direct solve of the thesis' 3.68 to 3.70) and against closed
 * forms. */
#include "../conformance/golden.h"
#include "../conformance/random.h"
#include "base/math/tensor.h"
#include "packed.h"
#include <string.h>

static void assert_near(const char *what, PetscInt n, const PetscReal *value, const PetscReal *expected,
                        PetscReal tolerance)
{
  for (PetscInt k = 0; k < n; ++k)
    if (!(fabs(value[k] - expected[k]) <= tolerance))
      fail_msg("%s, number %d: %.17g, expected %.17g, tolerance %.2g", what, (int)k, value[k], expected[k], tolerance);
}

/* Flow keeps the trace in golden tensors, as in the thesis, and the determinant in talus: both share the deviator. */
static void assert_shape(PetscBool flows, const PetscReal bbar[6], PetscReal golden[6])
{
  const PetscReal shift = (bbar[0] + bbar[1] + bbar[2] - golden[0] - golden[1] - golden[2]) / 3.0;
  const PetscReal det = sym_det(bbar), one = 1.0;
  for (int k = 0; k < 3 && flows; ++k) golden[k] += shift;
  assert_near("bbar", 6, bbar, golden, 1e-12);
  if (flows) assert_near("det bbar", 1, &det, &one, 1e-12);
}

static int check_golden(struct fy_node *item)
{
  const PetscReal given[2] = {golden_number(item, "sigma_Y"), golden_number(item, "H")};
  const char *volume = golden_text(item, "law");
  PetscReal packed[LAW_MAX_PARAMETERS], f[9], old[8], state[8], tau[6], c[36], golden[36];
  const Law *law = packed_law(strcmp(volume, "J-1") ? "j2-log" : "j2", golden_number(item, "E"),
                              golden_number(item, "nu"), given, packed);
  golden_numbers(item, "f", 9, f);
  golden_symmetric(item, "bbar_n", old);
  old[6] = golden_number(item, "J_n");
  old[7] = golden_number(item, "alpha_n");
  assert_int_equal(law->update(packed, 1, f, old, state, tau, c), LAW_OK);
  golden_symmetric(item, "tau", golden);
  const PetscReal scale = packed_largest(6, golden);
  assert_near("tau", 6, tau, golden, 1e-9 * scale);
  golden_symmetric(item, "bbar", golden);
  assert_shape((PetscBool)(golden_number(item, "f_trial") > 0.0), state, golden);
  golden[0] = golden_number(item, "J"), golden[1] = golden_number(item, "alpha");
  assert_near("J, alpha", 2, state + 6, golden, 1e-12);
  golden_numbers(item, "c_lie_voigt", 36, golden);
  /* golden tangents are differences */
  const PetscReal blur = golden_number(item, "fd_uncertainty");
  assert_near("c", 36, c, golden, fmax(1e-9 * packed_largest(36, golden), blur));
  return golden_number(item, "f_trial") > 0.0;
}

static void test_golden(void **unused)
{
  (void)unused;
  struct fy_document *document = golden_open("j2.json");
  struct fy_node *cases = fy_node_by_path(fy_document_root(document), "/cases", FY_NT, FYNWF_DONT_FOLLOW);
  void *at = NULL;
  int n = 0, plastic = 0;
  for (struct fy_node *item; (item = fy_node_sequence_iterate(cases, &at)); ++n) plastic += check_golden(item);
  assert_int_equal(n, 10);
  assert_int_equal(plastic, 7);
  fy_document_destroy(document);
}

static PetscReal deviator_norm(const PetscReal tau[6])
{
  const PetscReal mean = (tau[0] + tau[1] + tau[2]) / 3.0;
  PetscReal norm2 = 0.0;
  for (int k = 0; k < 6; ++k) norm2 += (k < 3 ? 1.0 : 2.0) * pow(tau[k] - (k < 3 ? mean : 0.0), 2);
  return sqrt(norm2);
}

/* The stress is on or inside the yield surface after every step of random paths, on it whenever
 * alpha grew. */
static void test_yield(void **unused)
{
  (void)unused;
  static const PetscReal given[3][2] = {{150e6, 0.0}, {1e3, 2e3}, {0.5, 0.0}};
  static const PetscReal young[3] = {196.2e9, 1e6, 100.0}, poisson[3] = {0.3, 0.1, 0.4999};
  Random random = {77};
  int plastic = 0;
  for (int path = 0; path < 3000; ++path) {
    const PetscReal *g = given[path % 3];
    PetscReal packed[LAW_MAX_PARAMETERS], old[8], state[8], tau[6], f[9];
    const Law *law = packed_law("j2", young[path % 3], poisson[path % 3], g, packed);
    const PetscReal size = pow(10, random_real(&random, -4, -0.7));
    law_initial_state(law, old);
    for (int step = 0; step < 5; ++step) {
      for (int k = 0; k < 9; ++k) f[k] = (k % 4 == 0) + size * random_real(&random, -1, 1);
      assert_int_equal(law->update(packed, 1, f, old, state, tau, NULL), LAW_OK);
      const PetscReal radius = sqrt(2.0 / 3.0) * (g[0] + g[1] * state[7]), excess = deviator_norm(tau) - radius;
      const PetscReal scale = radius + packed_largest(6, tau);
      assert_true(excess <= 1e-10 * scale);
      assert_true(state[7] >= old[7]);
      if (state[7] > old[7]) ++plastic, assert_true(fabs(excess) <= 1e-10 * scale);
      memcpy(old, state, sizeof old);
    }
  }
  assert_true(plastic > 5000);
}

/* Monotonous simple shear under perfect plasticity: the shear stress stays at sigma_Y / sqrt 3, and
 * the plastic strain is the shear over sqrt 3 less the elastic part. */
static void test_shear(void **unused)
{
  (void)unused;
  const PetscReal given[2] = {1e6, 0.0}, E = 1e9, nu = 0.25, mu = E / 2.5, step = 1e-4;
  const PetscReal f[9] = {1, step, 0, 0, 1, 0, 0, 0, 1};
  PetscReal packed[LAW_MAX_PARAMETERS], old[8], state[8], tau[6];
  const Law *law = packed_law("j2", E, nu, given, packed);
  law_initial_state(law, old);
  for (int k = 0; k < 500; ++k) {
    assert_int_equal(law->update(packed, 1, f, old, state, tau, NULL), LAW_OK);
    memcpy(old, state, sizeof old);
  }
  const PetscReal limit = given[0] / sqrt(3.0), plastic = (500 * step - limit / mu) / sqrt(3.0);
  assert_near("shear", 1, &tau[3], &limit, 1e-4 * limit);
  assert_near("alpha", 1, &state[7], &plastic, 1e-4 * plastic);
}

/* The elastic energy stays at what the yield stress can store, however far the flow goes, and the
 * work not stored was dissipated. */
static void test_dissipation(void **unused)
{
  (void)unused;
  const PetscReal given[2] = {1e6, 0.0}, E = 1e9, nu = 0.25, mu = E / 2.5, step = 1e-4;
  const PetscReal f[9] = {1, step, 0, 0, 1, 0, 0, 0, 1};
  PetscReal packed[LAW_MAX_PARAMETERS], old[8], state[8], tau[6], work = 0.0, before = 0.0;
  const Law *law = packed_law("j2", E, nu, given, packed);
  law_initial_state(law, old);
  for (int k = 0; k < 5000; ++k) {
    assert_int_equal(law->update(packed, 1, f, old, state, tau, NULL), LAW_OK);
    work += 0.5 * (before + tau[3]) * step;
    before = tau[3];
    memcpy(old, state, sizeof old);
  }
  const PetscReal stored = law->energy(packed, state), limit = given[0] * given[0] / (6.0 * mu);
  const PetscReal dissipated = given[0] * state[7], rest = work - stored;
  assert_near("stored", 1, &stored, &limit, 1e-4 * limit);
  assert_near("dissipated", 1, &rest, &dissipated, 2e-3 * dissipated);
}

/* Sheared to and fro by half of its height twenty times, a stiff and a soft one, in the plane and across it: unloading
 * has the slope G that it began with, but for the square of elastic strains, and no shape has another volume. */
static void check_cycles(PetscReal E, PetscReal step, int across)
{
  const PetscReal given[2] = {2e4, 0.0}, nu = 0.3, mu = E / 2.6, one = 1.0;
  PetscReal f[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, packed[LAW_MAX_PARAMETERS], old[8], state[8], tau[6];
  const Law *law = packed_law("j2", E, nu, given, packed);
  const int half = (int)(0.5 / step + 0.5), shear = across ? 5 : 3;
  law_initial_state(law, old);
  for (int k = 0; k < 40 * half; ++k) {
    f[across ? 2 : 1] = k / half % 2 ? -step : step;
    assert_int_equal(law->update(packed, 1, f, old, state, tau, NULL), LAW_OK);
    memcpy(old, state, sizeof old);
    const PetscReal det = sym_det(state);
    assert_near("det bbar", 1, &det, &one, 1e-12);
  }
  const PetscReal yielding = tau[shear];
  f[across ? 2 : 1] = 1e-2 * given[0] / mu;
  assert_int_equal(law->update(packed, 1, f, old, state, tau, NULL), LAW_OK);
  const PetscReal slope = (tau[shear] - yielding) / (1e-2 * given[0]), elastic = given[0] / mu;
  assert_near("G", 1, &slope, &one, 3 * elastic * elastic);
}

static void test_cycles(void **unused)
{
  (void)unused;
  for (int across = 0; across < 2; ++across)
    for (int k = 0; k < 2; ++k) check_cycles(k ? 4e5 : 1e6, 0.02, across), check_cycles(1e8, 0.005, across);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_golden),      cmocka_unit_test(test_yield),  cmocka_unit_test(test_shear),
    cmocka_unit_test(test_dissipation), cmocka_unit_test(test_cycles),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
