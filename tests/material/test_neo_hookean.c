/* Neo-Hookean laws against golden numbers (energies differentiated twice in 40 digits) and against
 * closed forms. */
#include "../conformance/golden.h"
#include "base/math/tensor.h"
#include "material/elasticity.h"
#include <string.h>

static void pack(const Law *law, PetscReal young, PetscReal poisson, PetscReal *packed)
{
  const PetscReal value[ELASTIC_CONSTANTS] = {young, poisson};
  Elasticity elastic;
  assert_true(elasticity_from_two(3u, value, &elastic));
  law->prepare(&elastic, NULL, packed);
}

static void assert_near(PetscInt n, const PetscReal *value, const PetscReal *expected, PetscReal tolerance)
{
  for (PetscInt k = 0; k < n; ++k)
    if (!(fabs(value[k] - expected[k]) <= tolerance))
      fail_msg("number %d: %.17g, golden %.17g, tolerance %.2g", (int)k, value[k], expected[k], tolerance);
}

static void check_golden(struct fy_node *item, const Law *law)
{
  PetscReal packed[LAW_MAX_PARAMETERS], f[9], b[6], state[6], tau[6], c[36], golden_tau[6], golden_c[36];
  pack(law, golden_number(item, "E"), golden_number(item, "nu"), packed);
  golden_numbers(item, "F", 9, f);
  golden_symmetric(item, "tau", golden_tau);
  golden_numbers(item, "c_lie_voigt", 36, golden_c);
  law_initial_state(law, b);
  assert_int_equal(law->update(packed, 1, f, b, state, tau, c), LAW_OK);
  PetscReal scale = 0.0;
  for (int k = 0; k < 36; ++k) scale = fmax(scale, fabs(golden_c[k]));
  assert_near(6, tau, golden_tau, 1e-14 * scale);
  assert_near(36, c, golden_c, 1e-14 * scale);
  assert_true(fabs(sqrt(sym_det(state)) - golden_number(item, "J")) < 1e-14);
}

static void test_golden(void **state)
{
  (void)state;
  struct fy_document *document = golden_open("neohooke.json");
  struct fy_node *cases = fy_node_by_path(fy_document_root(document), "/cases", FY_NT, FYNWF_DONT_FOLLOW);
  void *at = NULL;
  int n = 0;
  for (struct fy_node *item; (item = fy_node_sequence_iterate(cases, &at)); ++n) {
    const char *name = golden_text(item, "law");
    if (!strcmp(name, "coupled")) check_golden(item, law_find("neo-hookean"));
    else if (!strcmp(name, "J-1")) check_golden(item, law_find("neo-hookean-split"));
    else fail_msg("golden data: unknown law %s", name);
  }
  assert_int_equal(n, 24);
  fy_document_destroy(document);
}

/* tau of a pure volume change J: shape does not change, so tau = J p I. */
static void pressure(const char *name, PetscReal J, PetscReal expected)
{
  const PetscReal stretch = cbrt(J), f[9] = {stretch, 0, 0, 0, stretch, 0, 0, 0, stretch};
  const PetscReal none[6] = {expected, expected, expected, 0, 0, 0};
  PetscReal packed[LAW_MAX_PARAMETERS], b[6], state[6], tau[6];
  const Law *law = law_find(name);
  pack(law, 3.0, 0.4, packed); /* bulk modulus 5, shear 3 / 2.8 */
  law_initial_state(law, b);
  assert_int_equal(law->update(packed, 1, f, b, state, tau, NULL), LAW_OK);
  assert_near(6, tau, none, 1e-14 * (1 + fabs(expected)));
}

static void test_volume_laws(void **state)
{
  (void)state;
  for (int k = 1; k < 40; ++k) {
    const PetscReal J = 0.1 * k, lambda = 3.0 * 0.4 / (1.4 * 0.2), mu = 3.0 / 2.8;
    pressure("neo-hookean-split", J, 5.0 * J * (J - 1.0));
    pressure("neo-hookean-split-log", J, 5.0 * log(J));
    pressure("neo-hookean", J, lambda * log(J) + mu * (cbrt(J * J) - 1.0));
  }
}

/* All laws of this family have Hooke's tangent at rest. */
static void test_tangent_at_rest(void **state)
{
  (void)state;
  const char *names[] = {"neo-hookean", "neo-hookean-split", "neo-hookean-split-log"};
  const PetscReal f[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, lambda = 3.0 * 0.4 / (1.4 * 0.2), mu = 3.0 / 2.8;
  PetscReal packed[LAW_MAX_PARAMETERS], b[6], out[6], tau[6], c[36], hooke[36] = {0};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) hooke[6 * i + j] = lambda + (i == j ? 2 * mu : 0);
    hooke[7 * (i + 3)] = mu;
  }
  for (int i = 0; i < 3; ++i) {
    const Law *law = law_find(names[i]);
    pack(law, 3.0, 0.4, packed);
    law_initial_state(law, b);
    assert_int_equal(law->update(packed, 1, f, b, out, tau, c), LAW_OK);
    assert_near(36, c, hooke, 1e-14);
  }
}

/* Energy of an isochoric stretch (2, 1/2, 1): mu/2 (4 + 1/4 + 1 - 3). */
static void test_energy_of_a_stretch(void **state)
{
  (void)state;
  const PetscReal b[6] = {4, 0.25, 1, 0, 0, 0};
  for (const Law *const *law = laws; *law; ++law) {
    PetscReal packed[LAW_MAX_PARAMETERS];
    if (strncmp((*law)->name, "neo-hookean", 11)) continue;
    pack(*law, 2.8, 0.4, packed);
    assert_true(fabs((*law)->energy(packed, b) - 1.125) < 1e-14);
  }
}

/* Where there is no such state, the answer is no; where there is one beyond the easy start, it is
 * found. */
static void test_initial_stress_limits(void **state)
{
  (void)state;
  const PetscReal pull[6] = {50, 50, 50, 0, 0, 0}, push[6] = {-50, -50, -50, 0, 0, 0};
  const PetscReal shear[6] = {1.5, -1.5, 0, 0, 0, 0}, nan[6] = {NAN, 0, 0, 0, 0, 0};
  const PetscReal f[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal packed[LAW_MAX_PARAMETERS], b[6], out[6], tau[6];
  for (const Law *const *law = laws; *law; ++law) {
    if (strncmp((*law)->name, "neo-hookean", 11)) continue;
    pack(*law, 3.0, 0.4, packed);
    assert_false((*law)->initial_stress(packed, nan, b));
    assert_true((*law)->initial_stress(packed, shear, b));
    assert_int_equal((*law)->update(packed, 1, f, b, out, tau, NULL), LAW_OK);
    const PetscReal J = sqrt(sym_det(b));
    assert_true(fabs(tau[0] - 1.5 * J) < 1e-13 && fabs(tau[1] + 1.5 * J) < 1e-13 && fabs(tau[2]) < 1e-13);
  }
  pack(law_find("neo-hookean"), 3.0, 0.4, packed);
  /* its peak tension is lower */
  assert_false(law_find("neo-hookean")->initial_stress(packed, pull, b));
  assert_true(law_find("neo-hookean")->initial_stress(packed, push, b));
  pack(law_find("neo-hookean-split"), 3.0, 0.4, packed);
  assert_false(law_find("neo-hookean-split")->initial_stress(packed, push, b)); /* p > -K always */
  assert_true(law_find("neo-hookean-split")->initial_stress(packed, pull, b));
  pack(law_find("neo-hookean-split-log"), 3.0, 0.4, packed);
  /* p < K / e always */
  assert_false(law_find("neo-hookean-split-log")->initial_stress(packed, pull, b));
  assert_true(law_find("neo-hookean-split-log")->initial_stress(packed, push, b));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_golden),
    cmocka_unit_test(test_volume_laws),
    cmocka_unit_test(test_tangent_at_rest),
    cmocka_unit_test(test_energy_of_a_stretch),
    cmocka_unit_test(test_initial_stress_limits),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
