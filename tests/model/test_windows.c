/* Rates and means of measures in windows whose ends lie between the ends of steps, which change: of forces that are
 * means over the step, and of what is linear in time. */
#include "resumed.h"

#define ROWS 64
#define FROM 0.0131
#define TO 0.0457
#define LONG 0.033 /* of a window that slides */
static const PetscReal mass = 1000, gravity = 10;

static PetscReal measured(Model *m, const Bench *b, PetscInt k)
{
  PetscReal value;
  CALL(ModelMeasure(m, &b->measure[k], k, &value));
  return value;
}

static PetscReal momentum(Model *m) { return model_sum(m, "momentum", 1); }

/* What has come to a moment, between the rows along lines. */
static PetscReal at(const PetscReal *time, const PetscReal *y, PetscInt n, PetscReal t)
{
  PetscInt k = 1;
  while (k < n - 1 && time[k] < t) ++k;
  return y[k - 1] + (t - time[k - 1]) / (time[k] - time[k - 1]) * (y[k] - y[k - 1]);
}

static void square(Bench *b)
{
  bench_init(b, "fem", CELL_QUADRILATERAL, 3);
  bench_dynamic(b, 0.2, 0.01);
}

static void step_on(Model *m) { model_step(m, (PetscReal[]){0.01, 0.004, 0.007}[m->step % 3]); }

/* A block is thrown at its held foot: what the foot gives in a window is what the block gets, with steps of any length,
 * and with any factor. */
static void test_impulse(void **state)
{
  PetscReal time[ROWS] = {0}, got[ROWS];
  PetscInt n = 1;
  Bench b;
  (void)state;
  square(&b);
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  b.body[0].velocity[1] = -2;
  const MeasureSpec foot = {.name = "foot", .kind = "reaction", .component = 1};
  const MeasureSpec twice = {.name = "twice", .kind = "formula", .word = "2 * foot", .has_mean = PETSC_TRUE};
  b.measure[0] = foot;
  for (int k = 1; k < 5; ++k) {
    b.measure[k] = k < 3 ? foot : twice;
    b.measure[k].has_mean = PETSC_TRUE;
    b.measure[k].window[0] = k % 2 ? FROM : LONG, b.measure[k].window[1] = k % 2 ? TO : LONG;
  }
  b.c.n_measures = 5;
  Model *m = bench_model(&b, PETSC_COMM_WORLD), *again = bench_model(&b, PETSC_COMM_WORLD);
  got[0] = -2 * mass; /* all of it; what its foot had is lost in the first step */
  CHECK(PetscIsNanReal(measured(m, &b, 2)), "no step has a mean");
  while (m->time < 0.15) {
    step_on(m);
    time[n] = m->time, got[n++] = momentum(m);
    const PetscReal to = PetscMin(m->time, TO), since = PetscMax(0, m->time - LONG);
    for (int k = 1; k < 5; ++k) {
      const PetscReal from = k % 2 ? FROM : since, end = k % 2 ? to : m->time, factor = k < 3 ? 1 : 2;
      if (end <= from) continue;
      CHECK_CLOSE(measured(m, &b, k) * (end - from), factor * (at(time, got, n, end) - at(time, got, n, from)),
                  1e-9 * mass);
    }
    if (n == 4) model_take_up(m, again);
  }
  while (again->time < 0.15) step_on(again);
  for (int k = 1; k < 5; ++k) CHECK_CLOSE(measured(again, &b, k), measured(m, &b, k), 1e-9 * mass);
  CALL(ModelDestroy(&again));
  CALL(ModelDestroy(&m));
}

/* A block falls freely: its momentum is linear in time, as are its means over windows, and its rate is its weight. */
static void test_line(void **state)
{
  Bench b;
  (void)state;
  square(&b);
  b.c.gravity[1] = -gravity;
  for (int k = 0; k < 4; ++k)
    b.measure[k] = (MeasureSpec){.name = "p",
                                 .kind = "momentum",
                                 .component = 1,
                                 .has_mean = k < 2,
                                 .has_rate = k >= 2,
                                 .window = {k % 2 ? FROM : LONG, k % 2 ? TO : LONG}};
  b.c.n_measures = 4;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.15) {
    step_on(m);
    const PetscReal since = PetscMax(0, m->time - LONG), to = PetscMin(m->time, TO);
    CHECK_CLOSE(measured(m, &b, 0), -mass * gravity * (since + m->time) / 2, 1e-9 * mass);
    if (m->time > FROM) CHECK_CLOSE(measured(m, &b, 1), -mass * gravity * (FROM + to) / 2, 1e-9 * mass);
    else CHECK(PetscIsNanReal(measured(m, &b, 1)), "it is not its time");
    CHECK_CLOSE(measured(m, &b, 2), -mass * gravity, 1e-7 * mass);
    if (m->time > FROM) CHECK_CLOSE(measured(m, &b, 3), -mass * gravity, 1e-7 * mass);
  }
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_impulse), cmocka_unit_test(test_line)};
  return run_model_tests(argc, argv, tests);
}
