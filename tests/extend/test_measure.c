/* A measure from outside the house: the case file knows its key, and what it tells of a thrown
 * stone is y0 + v t - g t^2 / 2. */
#include "../input/test_case.h"
#include "model/measure/measure.h"

static const char thrown[] =
  "kinematics: plane-strain\nmethod: mpm\nanalysis: {type: dynamic, end: 0.4, step: 0.02}\n"
  "grid: {box: {min: [0, 0], max: [4, 4]}, size: 0.5}\n"
  "bodies: [{name: stone, shape: {box: {min: [1, 2], max: [2, 3]}}, material: rock, velocity: [1, 2]}]\n"
  "materials: {rock: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}\n"
  "loads: {gravity: [0, -10]}\n"
  "measures: {far: {centre: x}, high: {centre: y, of: {body: stone}}}\n";

static void test_thrown(void **state)
{
  PetscReal x, y;
  Model *m = NULL;
  StepReport report;
  Diag *diag;
  Case *c = read_good(thrown);
  (void)state;
  assert_string_equal(measure_unit(&c->measures[1]), "m");
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(ModelCreate(PETSC_COMM_WORLD, c, diag, &m), 0);
  assert_non_null(m);
  for (PetscInt step = 0; step < 20; ++step) {
    assert_int_equal(ModelStep(m, 0.02, &report), 0);
    assert_int_equal(report.outcome, STEP_ACCEPTED);
    assert_int_equal(ModelMeasure(m, &c->measures[0], 0, &x), 0);
    assert_int_equal(ModelMeasure(m, &c->measures[1], 1, &y), 0);
    ASSERT_NEAR(x, 1.5 + m->time, 1e-9);
    ASSERT_NEAR(y, 2.5 + 2 * m->time - 5 * m->time * m->time, 1e-9);
  }
  assert_int_equal(ModelDestroy(&m), 0);
  assert_int_equal(DiagDestroy(&diag), 0);
  assert_int_equal(CaseDestroy(&c), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_thrown)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
