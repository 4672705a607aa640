/* A law from outside the house: the conformance suite, and a case that names it. */
#include "../conformance/law_suite.h"
#include "../input/test_case.h"
#include "model/model.h"

static void test_suite(void **state)
{
  const LawUnderTest list[] = {
    {"hencky", 2, {{(char *)"young", 1e6}, {(char *)"poisson", 0.3}}, .strain = 0.3, .hyperelastic = PETSC_TRUE},
    {"hencky", 2, {{(char *)"young", 70}, {(char *)"poisson", 0.49}}, .strain = 0.1, .hyperelastic = PETSC_TRUE},
  };
  (void)state;
  for (int k = 0; k < 2; ++k) law_suite_run(&list[k]);
}

/* Pulled to 1.5 of its length between smooth walls: sigma_x = (lambda + 2 mu) ln s / s, sigma_y =
 * lambda ln s / s, lambda = mu = 0.4 MPa. */
static const char pulled[] =
  "kinematics: plane-strain\nmethod: fem\nanalysis: {type: static, steps: 4}\n"
  "grid: {box: {min: [0, 0], max: [1, 1]}, size: 0.5}\n"
  "bodies: [{name: bar, shape: {box: {min: [0, 0], max: [1, 1]}}, material: metal}]\n"
  "materials: {metal: {law: hencky, density: 1000, young: 1e6, poisson: 0.25}}\n"
  "boundary:\n  - {on: {x: 0}, fix: [x]}\n  - {name: grip, on: {x: 1}, displacement: {x: 0.5}}\n"
  "  - {on: {y: 0}, fix: [y]}\n  - {on: {y: 1}, fix: [y]}\n"
  "measures: {pull: {reaction: x, of: {boundary: grip}}}\n";

static void test_stretch(void **state)
{
  const PetscReal rise = 0.4e6 * log(1.5) / 1.5;
  PetscReal sigma[6], pull;
  Model *m = NULL;
  StepReport report;
  Diag *diag;
  Case *c = read_good(pulled);
  (void)state;
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(ModelCreate(PETSC_COMM_WORLD, c, diag, &m), 0);
  assert_non_null(m);
  while (m->time < 1 - 1e-12) {
    assert_int_equal(ModelStep(m, 1 - m->time, &report), 0);
    assert_int_equal(report.outcome, STEP_ACCEPTED);
  }
  for (PetscInt p = 0; p < m->points->n; ++p) {
    assert_int_equal(ModelPointStress(m, p, sigma), 0);
    ASSERT_NEAR(sigma[0], 3 * rise, 1e-9 * rise);
    ASSERT_NEAR(sigma[1], rise, 1e-9 * rise);
    ASSERT_NEAR(sigma[2], rise, 1e-9 * rise);
  }
  assert_int_equal(ModelMeasure(m, &c->measures[0], 0, &pull), 0);
  ASSERT_NEAR(pull, 3 * rise, 1e-8 * rise);
  assert_int_equal(ModelDestroy(&m), 0);
  assert_int_equal(DiagDestroy(&diag), 0);
  assert_int_equal(CaseDestroy(&c), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_suite), cmocka_unit_test(test_stretch)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
