/* Laws from shared libraries: the conformance suite, talus's own laws beside them, and libraries that are none. */
#include "../conformance/law_suite.h"
#include "material/plugin/plugin.h"

#define P(name, value)  \
  {                     \
    (char *)name, value \
  }

static void load(const char *spec, PetscBool umat)
{
  Diag *diag;
  if (DiagCreate(&diag)) fail();
  if (PluginLoad(spec, umat, diag)) fail();
  const PetscInt errors = diag_errors(diag);
  if (DiagFlush(diag, stderr) || DiagDestroy(&diag)) fail();
  if (errors) fail_msg("%s is not loaded", spec);
}

static const LawUnderTest gradient = {
  "gradient", 2, {P("lambda", 6e5), P("mu", 4e5)}, .strain = 0.3, .hyperelastic = PETSC_TRUE, .not_mixed = PETSC_TRUE};
static const LawUnderTest differences = {
  "differences",          2, {P("lambda", 6e5), P("mu", 4e5)}, .strain = 0.3, .hyperelastic = PETSC_TRUE,
  .not_mixed = PETSC_TRUE};
static const LawUnderTest voce = {
  "voce",
  5,
  {P("young", 1e6), P("poisson", 0.3), P("yield_stress", 5e4), P("saturation", 1e5), P("rate", 8)},
  .strain = 0.2};
static const LawUnderTest voce_differences = {
  "voce-differences",
  5,
  {P("young", 1e6), P("poisson", 0.3), P("yield_stress", 5e4), P("saturation", 1e5), P("rate", 8)},
  .strain = 0.2};

static const LawUnderTest umat_elastic = {
  "umat-elastic", 2, {P("prop_1", 1e6), P("prop_2", 0.3)}, .strain = 0.2, .not_mixed = PETSC_TRUE};
static const LawUnderTest umat_j2 = {"umat-j2",
                                     4,
                                     {P("prop_1", 1e6), P("prop_2", 0.3), P("prop_3", 3e4), P("prop_4", 1e5)},
                                     .strain = 0.1,
                                     .not_mixed = PETSC_TRUE};

static void test_umat(void **state)
{
  (void)state;
  law_suite_run(&umat_elastic);
}

static void test_umat_j2(void **state)
{
  (void)state;
  law_suite_run(&umat_j2);
}

static void test_gradient(void **state)
{
  (void)state;
  law_suite_run(&gradient);
}

static void test_differences(void **state)
{
  (void)state;
  law_suite_run(&differences);
}

static void test_strain(void **state)
{
  (void)state;
  law_suite_run(&voce);
}

static void test_strain_differences(void **state)
{
  (void)state;
  law_suite_run(&voce_differences);
}

/* Stress and tangent of two laws along the same random way. */
static void compare(const LawUnderTest *one, const LawUnderTest *other, PetscReal stress, PetscReal tangent)
{
  LawSuite a, b;
  law_suite_open(&a, one);
  law_suite_open(&b, other);
  for (int s = 0; s < 1000; ++s) {
    LawPoint p = {0}, q = {0};
    law_initial_state(a.law, p.old);
    law_initial_state(b.law, q.old);
    for (int n = 0; n < 4; ++n) {
      law_suite_random_increment(&a, p.dF);
      memcpy(q.dF, p.dF, sizeof p.dF);
      law_suite_update(&a, &p);
      law_suite_update(&b, &q);
      assert_int_equal(p.status, LAW_OK);
      assert_int_equal(q.status, LAW_OK);
      law_suite_near(&a, "stress of the two", 6, p.tau, q.tau, stress * a.material.wave_modulus);
      law_suite_near(&a, "tangent of the two", 36, p.c, q.c, tangent * a.material.wave_modulus);
      memcpy(p.old, p.state, sizeof p.old);
      memcpy(q.old, q.state, sizeof q.old);
    }
  }
}

static void test_same_as_own(void **state)
{
  const LawUnderTest neo = {"neo-hookean", 2, {P("lame", 6e5), P("shear", 4e5)}, .strain = 0.2};
  LawUnderTest perfect = {"voce",
                          5,
                          {P("bulk", 8e5), P("shear", 4e5), P("yield_stress", 5e4), P("saturation", 5e4), P("rate", 8)},
                          .strain = 0.2};
  /* on its compressive meridian sqrt(3) R = 2 c: the yield stress of von Mises */
  const LawUnderTest mises = {
    "drucker-prager",
    5,
    {P("bulk", 8e5), P("shear", 4e5), P("friction_angle", 0), P("cohesion", 2.5e4), P("dilatancy_angle", 0)},
    .strain = 0.2};
  LawUnderTest plain = gradient;
  (void)state;
  plain.strain = 0.2;
  compare(&plain, &neo, 1e-13, 1e-12);
  plain.law = "differences";
  compare(&plain, &neo, 1e-13, 1e-8);
  compare(&perfect, &mises, 1e-13, 1e-11);
  perfect.law = "voce-differences";
  compare(&perfect, &mises, 1e-13, 1e-7);
}

/* The case file says more than numbers. */
static void test_parameters(void **state)
{
  const Law *law = law_find("gradient");
  PetscReal two[2];
  (void)state;
  assert_non_null(law);
  law->elastic((PetscReal[]){6e5, 4e5}, two);
  assert_true(fabs(two[0] - (6e5 + 2.0 / 3.0 * 4e5)) < 1e-6 && fabs(two[1] - 4e5) < 1e-6);
  law_find("differences")->elastic((PetscReal[]){6e5, 4e5}, two);
  assert_true(fabs(two[0] / (6e5 + 2.0 / 3.0 * 4e5) - 1) < 1e-8 && fabs(two[1] / 4e5 - 1) < 1e-8);
  assert_non_null(law->check((PetscReal[]){-6e5, 4e5}));
  assert_null(law->volume);
  assert_null(law->reduce);
  assert_null(law->initial_stress);
  assert_non_null(law_find("voce")->volume);
  assert_string_equal(law_find("voce")->check((PetscReal[]){2e5, 1e5, 8}), "saturation must not be below yield_stress");
}

/* Each of them is told by its own words. */
static void test_bad(void **state)
{
  static const struct {
    const char *spec, *said;
  } bad[] = {{"x1=" BAD_1, "'young' of the law is a key of every material"},
             {"x2=" BAD_2, "'mu' of the law has a default out of its range"},
             {"x3=" BAD_3, "has neither 1 nor 6 components"},
             {"x4=" BAD_4, "was built for version 2 of talus/law.h, and this talus knows version 1"},
             {"x5=" BAD_5, "size is not sizeof(TalusLaw)"},
             {"x6=" BAD_6, "help is missing"},
             {"x7=" BAD_7, "update is missing"},
             {"x8=" BAD_8, "has no function talus_law"},
             {"x9=" BAD_9, "the state 'b' of the law has 1 numbers, and that of another law does not"},
             {"x10=" UMAT_ELASTIC, "it has a subroutine UMAT"},
             {"j2=" GRADIENT, "there is a law 'j2' already"},
             {"Big=" GRADIENT, "cannot be the name of a law"},
             {"lost=/no/such/law.so", "No such file"},
             {"text=" TALUS_SOURCE_DIR "/README.md", "cannot be loaded"},
             {"no-file", "is not NAME=FILE.so"}};
  char text[4096];
  Diag *diag;
  (void)state;
  for (size_t k = 0; k < sizeof bad / sizeof bad[0]; ++k) {
    FILE *out = fmemopen(text, sizeof text, "w");
    assert_non_null(out);
    assert_int_equal(DiagCreate(&diag), 0);
    assert_int_equal(PluginLoad(bad[k].spec, PETSC_FALSE, diag), 0);
    assert_int_equal(diag_errors(diag), 1);
    assert_int_equal(DiagFlush(diag, out), 0);
    (void)fclose(out);
    if (!strstr(text, bad[k].said)) fail_msg("%s: said '%s' and not '%s'", bad[k].spec, text, bad[k].said);
    assert_int_equal(DiagDestroy(&diag), 0);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_umat),        cmocka_unit_test(test_umat_j2),    cmocka_unit_test(test_gradient),
    cmocka_unit_test(test_differences), cmocka_unit_test(test_strain),     cmocka_unit_test(test_strain_differences),
    cmocka_unit_test(test_same_as_own), cmocka_unit_test(test_parameters), cmocka_unit_test(test_bad)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  load("gradient=" GRADIENT, PETSC_FALSE);
  load("differences=" DIFFERENCES, PETSC_FALSE);
  load("umat-elastic=" UMAT_ELASTIC ",2,0", PETSC_TRUE);
  load("umat-j2=" UMAT_J2 ",4,1", PETSC_TRUE);
  load("voce=" VOCE, PETSC_FALSE);
  load("voce-differences=" VOCE_DIFFERENCES, PETSC_FALSE);
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
