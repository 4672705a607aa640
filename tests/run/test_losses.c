/* Runs say when points have come together: their volumes are more than their cells hold; and when those that bear count
 * as farther apart than they are, or than they were. */
#include "../model/case_builder.h"
#include "model/model_private.h"
#include "run/report/losses.h"

/* What LossesWarn says, to be freed. */
static char *said_of(Model *m, const PetscReal *values)
{
  Diag *diag;
  char *said = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&said, &length);
  CALL(DiagCreate(&diag));
  CALL(LossesWarn(m, values, diag));
  CALL(DiagFlush(diag, out));
  fclose(out);
  CALL(DiagDestroy(&diag));
  return said;
}

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
  assert_int_equal(warnings(1.04), 0); /* 4 % of the volume are too much */
  assert_int_equal(warnings(1.1), 1);  /* 9 % */
}

/* Is that said of soil that fills this share of its grid, bears so much and has this J? */
static PetscBool said_apart(const char *words, PetscReal share, PetscReal pressure, PetscReal J)
{
  NamedValue soil[] = {{(char *)"young", 1e6}, {(char *)"poisson", 0.25}, {(char *)"yield_stress", 1e3}};
  PetscMPIInt rank;
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_dynamic(&b, 1, 1e-2);
  b.material.law = (char *)"j2";
  b.material.n_parameters = 3;
  b.material.parameters = soil;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscBool left = (PetscBool)(point_real(m->points, POINT_X, p)[0] < 0.5); /* the others hang free */
    for (int k = 0; k < 3; ++k) point_real(m->points, POINT_TAU, p)[k] = left ? -pressure : pressure;
    m->points->real[POINT_J][p] = left ? J : 4;
    m->points->real[POINT_VOLUME][p] *= share;
  }
  char *said = said_of(m, NULL);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  PetscBool found = (PetscBool)(strstr(said, words) != NULL);
  CALL(MPI_Bcast(&found, 1, MPIU_BOOL, 0, PETSC_COMM_WORLD));
  free(said);
  CALL(ModelDestroy(&m));
  return found;
}

static void test_apart(void **state)
{
  (void)state;
  assert_false(said_apart("too small", 1, 100, 1));
  assert_false(said_apart("too small", 1, 100, 1.04));
  assert_true(said_apart("too small, by 17 %", 1, 100, 1.2)); /* 1 - 1 / 1.2 */
  assert_false(said_apart("too small", 1, 0, 1.2));           /* nothing bears */
  assert_false(said_apart("too small", 0.5, 100, 1.9));       /* there is room for it */
  assert_true(said_apart("swollen: what bears counts as 1.9 times", 0.5, 100, 1.9));
  assert_false(said_apart("swollen", 0.5, 100, 1.4));
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
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
    bench_dynamic(&b, 1, 1e-2);
    measure.has_in = k > 0;
    measure.in = (Shape){.kind = SHAPE_BOX, .min = {5, 5}, .max = {6, 6}};
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    b.c.measures = &measure;
    b.c.n_measures = 1;
    CALL(MeasuresStart(m));
    char *said = said_of(m, values);
    PetscMPIInt rank;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    CHECK(rank || strstr(said, why[k]), "%s", said);
    free(said);
    CALL(ModelDestroy(&m));
  }
}

/* A block that is pushed askew and let go, two steps each time: fem gives all back, and what gmm keeps is told, as
 * nothing that a load does which is there at once. */
static void test_kept(void **state)
{
  static const char *const method[] = {"fem", "gmm"};
  PetscReal time[] = {0, 1, 2}, factor[] = {0, 1, 0};
  enum { CYCLES = 5 };
  (void)state;
  EACH_OF (k, method) {
    Bench b;
    StepReport report;
    bench_init(&b, method[k], CELL_QUADRILATERAL, 4);
    if (k)
      b.c.basis = (BasisSpec){.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
    b.c.analysis.end = 2;
    bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    bench_traction(&b, 1, 1, "body", 5e4, -1e5, 0)->amplitude = (Amplitude){.n = 3, .time = time, .value = factor};
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (int step = 0; step < 2 * CYCLES; ++step) {
      m->time = step % 2;
      CALL(ModelStep(m, 1, &report));
      CHECK(report.outcome == STEP_ACCEPTED, "step %d", step);
      CHECK(step > 0 || m->kept_energy == 0, "nothing is known while it acts");
    }
    const PetscReal share = m->kept_energy / m->most_energy;
    CHECK(k ? share > 0.01 : share < 1e-12, "%s kept %g", method[k], (double)share);
    char *said = said_of(m, NULL);
    PetscMPIInt rank;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    CHECK(rank || !k == !strstr(said, "elastic bodies kept"), "%s", said);
    CHECK(!strstr(said, "there at once"), "%s", said);
    free(said);
    CALL(ModelDestroy(&m));
  }
}

/* What the transfer makes where nothing is or comes in is no share of anything, and told all the same. */
static void test_made(void **state)
{
  (void)state;
  for (int made = 0; made < 2; ++made) {
    Bench b;
    Diag *diag;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
    bench_dynamic(&b, 1, 1e-2);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CHECK(m->most_energy == 0, "%g J were there", (double)m->most_energy);
    m->transfer_energy = -1.0 * made;
    CALL(DiagCreate(&diag));
    CALL(LossesWarn(m, NULL, diag));
    assert_int_equal(diag_warnings(diag), made);
    CALL(DiagDestroy(&diag));
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_crowd), cmocka_unit_test(test_apart),
                                     cmocka_unit_test(test_no_number), cmocka_unit_test(test_kept),
                                     cmocka_unit_test(test_made)};
  return run_model_tests(argc, argv, tests);
}
