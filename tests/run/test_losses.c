/* Runs say when points have come together: their volumes are more than their cells hold. */
#include "../model/case_builder.h"
#include "run/report/losses.h"

/* Warnings of a block whose points count as so much larger than they are. */
static PetscInt warnings(PetscReal larger)
{
  Bench b;
  Diag *diag;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_dynamic(&b, 1, 1e-2);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) m->points->real[POINT_VOLUME][p] *= larger;
  CALL(DiagCreate(&diag));
  CALL(LossesWarn(m, NULL, diag));
  const PetscInt found = diag_warnings(diag);
  CALL(DiagDestroy(&diag));
  CALL(ModelDestroy(&m));
  return found;
}

static void test_crowd(void **state)
{
  (void)state;
  assert_int_equal(warnings(1), 0);
  assert_int_equal(warnings(1.3), 0); /* 23 % of the volume are too much */
  assert_int_equal(warnings(1.6), 1); /* 38 % */
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_crowd)};
  return run_model_tests(argc, argv, tests);
}
