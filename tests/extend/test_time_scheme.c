/* Backward Euler of backward_euler.c against its own recurrences: after n steps of dt in free
 * fall v = n g dt and u = n (n + 1) / 2 g dt^2, with Rayleigh damping c and no weight v = v0 /
 * (1 + c dt)^n, and a floor gives back in each step the momentum that weight brings. */
#include "../model/case_builder.h"

#define STEPS 5
#define DT 0.01

static void start(Bench *b, const char *method, PetscReal gravity)
{
  bench_init(b, method, CELL_QUADRILATERAL, 4);
  bench_dynamic(b, 1, DT);
  b->c.analysis.scheme = "backward-euler";
  b->c.gravity[1] = gravity;
  bench_box(b, 0, (const PetscReal[3]){0.25, 0.5, 0}, (const PetscReal[3]){0.75, 1, 0});
}

static void test_free_fall(void **state)
{
  static const char *const method[] = {"fem", "mpm"};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    start(&b, method[k], -10);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt n = 1; n <= STEPS; ++n) {
      model_step(m, DT);
      for (PetscInt p = 0; p < m->points->n; ++p) {
        CHECK_CLOSE(point_real(m->points, POINT_V, p)[1], -10 * DT * (PetscReal)n, 1e-10);
        CHECK_CLOSE(point_real(m->points, POINT_U, p)[1], -10 * DT * DT * (PetscReal)(n * (n + 1)) / 2, 1e-11);
      }
    }
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
}

static void test_damping(void **state)
{
  PetscReal v = 0.3;
  Bench b;
  (void)state;
  start(&b, "fem", 0);
  b.body[0].velocity[0] = v;
  b.c.analysis.damping = 20;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt n = 1; n <= STEPS; ++n) {
    model_step(m, DT);
    v /= 1 + 20 * DT;
    for (PetscInt p = 0; p < m->points->n; ++p) CHECK_CLOSE(point_real(m->points, POINT_V, p)[0], v, 1e-10);
  }
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

/* Momentum that the floor and the weight bring over the steps is what the body has: the reaction
 * is the mean that the scheme means. */
static void test_momentum(void **state)
{
  PetscReal impulse = 0;
  Bench b;
  (void)state;
  start(&b, "fem", -10);
  bench_motion(&b, 1, 0.5, MOTION_FIXED, 3);
  b.measure[b.c.n_measures++] = (MeasureSpec){.name = "floor", .kind = "reaction", .component = 1};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal weight = -10 * 1000 * 0.25;
  for (PetscInt n = 1; n <= STEPS; ++n) {
    PetscReal reaction;
    model_step(m, DT);
    CALL(ModelMeasure(m, &b.measure[0], 0, &reaction));
    impulse += (reaction + weight) * DT;
    CHECK_CLOSE(model_sum(m, "momentum", 1), impulse, 1e-6 * PetscAbsReal(weight * DT));
  }
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_unknown(void **state)
{
  Bench b;
  (void)state;
  start(&b, "fem", 0);
  b.c.analysis.scheme = "backward-eular";
  bench_refused(&b, PETSC_COMM_WORLD, "analysis.scheme", "backward-euler");
  bench_end(&b);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_free_fall), cmocka_unit_test(test_damping),
                                     cmocka_unit_test(test_momentum), cmocka_unit_test(test_unknown)};
  return run_model_tests(argc, argv, tests);
}
