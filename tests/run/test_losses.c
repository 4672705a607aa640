/* Runs say when points have come together: their volumes are more than their cells hold. */
#include "../model/case_builder.h"
#include "model/model_private.h"
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

/* What a strain that is no number is said to be, of a body that is there and of a place where nothing is. */
static void test_no_number(void **state)
{
  static const char *const why[] = {"deformed beyond what numbers hold", "no point is left"};
  const PetscReal values[] = {NAN};
  MeasureSpec measure = {.name = (char *)"e", .kind = "strain", .word = (char *)"volumetric"};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    Diag *diag;
    char *said = NULL;
    size_t length = 0;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
    bench_dynamic(&b, 1, 1e-2);
    measure.has_in = k > 0;
    measure.in = (Shape){.kind = SHAPE_BOX, .min = {5, 5}, .max = {6, 6}};
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    b.c.measures = &measure;
    b.c.n_measures = 1;
    CALL(MeasuresStart(m));
    CALL(DiagCreate(&diag));
    CALL(LossesWarn(m, values, diag));
    FILE *out = open_memstream(&said, &length);
    CALL(DiagFlush(diag, out));
    fclose(out);
    PetscMPIInt rank;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    CHECK(rank || strstr(said, why[k]), "%s", said);
    free(said);
    CALL(DiagDestroy(&diag));
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_crowd), cmocka_unit_test(test_no_number)};
  return run_model_tests(argc, argv, tests);
}
