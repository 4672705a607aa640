/* Rates and means of measures in windows whose ends lie between the ends of steps, which change: of forces that are
 * means over the step, and of what is linear in time; and of what stands as the run begins. */
#include "model/stage/stage.h"
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

/* What stands has at its start, too: force of the wall, of the boundary beside it, pressure, its peak, area. Of each
 * the value, its mean and its rate. */
enum { WALL, SIDE, PRESSURE, PEAK, AREA, KINDS, ALL = 3 * KINDS };

typedef struct {
  const char *method, *basis;
  PetscBool sought, dynamic;
} Stands;

static const Stands stands[] = {{"fem", "cell", PETSC_TRUE, PETSC_FALSE},
                                {"mpm", "gimp", PETSC_TRUE, PETSC_FALSE},
                                {"fem", "cell", PETSC_FALSE, PETSC_FALSE},
                                {"mpm", "cell", PETSC_FALSE, PETSC_TRUE}};

static PetscReal start[1] = {0}, whole[1] = {1}; /* gravity acts from the start */

/* A block under the stress of its weight, K0 = 0.5. What a wall or the boundary bears of it. */
static void standing(Bench *b, const Stands *s, WallSpec *floor, MeasureSpec all[ALL])
{
  static const MeasureSpec kinds[KINDS] = {
    [WALL] = {.name = "wall", .kind = "wall_force", .component = 1, .wall = "floor"},
    [SIDE] = {.name = "side", .kind = "reaction", .boundary = 0},
    [PRESSURE] = {.name = "pressure", .kind = "contact", .word = "pressure", .wall = "floor"},
    [PEAK] = {.name = "peak", .kind = "contact", .word = "peak_pressure", .wall = "floor"},
    [AREA] = {.name = "area", .kind = "contact", .word = "area", .wall = "floor"}};
  bench_init(b, s->method, CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){0, -0.5, 0}, (PetscReal[]){1, 1.5, 0}, 0.25);
  if (s->dynamic) bench_dynamic(b, 1, 0.1);
  b->c.analysis.step = 0.1;
  b->c.output.history = -1;
  b->c.basis = (BasisSpec){.kind = s->basis};
  b->constants[1].value = 1. / 3;
  *floor = (WallSpec){.name = "floor", .shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1, 0}}};
  b->c.n_walls = 1, b->c.walls = floor;
  for (int side = 0; side < 2; ++side) bench_motion(b, 0, side, MOTION_FIXED, 1);
  b->c.gravity[1] = -gravity;
  b->c.gravity_amplitude = (Amplitude){.n = 1, .time = start, .value = whole};
  b->body[0].has_k0 = PETSC_TRUE, b->body[0].k0 = 0.5;
  if (s->sought) b->c.initial = (InitialSpec){.equilibrium = EQUILIBRIUM_DIRECT, .reset = PETSC_TRUE};
  for (int k = 0; k < ALL; ++k) {
    all[k] = kinds[k / 3];
    all[k].has_mean = k % 3 == 1, all[k].has_rate = k % 3 == 2;
    all[k].window[1] = 10;
  }
  b->c.n_measures = ALL, b->c.measures = all;
}

static PetscReal number(Model *m, PetscInt k)
{
  PetscReal value;
  CALL(ModelMeasure(m, &m->c->measures[k], k, &value));
  return value;
}

/* All is as it should be at the start, and stays so. */
static void check_stands(Model *m)
{
  static const PetscReal expected[KINDS] = {[WALL] = 1e4, [SIDE] = 2500, [PRESSURE] = 1e4, [PEAK] = 1e4, [AREA] = 1};
  for (int k = 0; k < KINDS; ++k) CHECK_CLOSE(number(m, 3 * k), expected[k], 1e-6 * expected[k]);
  for (int step = 0; step < 2; ++step) {
    model_step(m, 0.1);
    for (int k = 0; k < KINDS; ++k) {
      CHECK_CLOSE(number(m, 3 * k + 1), expected[k], 1e-6 * expected[k]);
      if (step) CHECK_CLOSE(number(m, 3 * k + 2), 0, 1e-5 * expected[k]);
    }
  }
}

static Model *equilibrium(Bench *b)
{
  StepReport report;
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  CALL(ModelEquilibrate(m, &report));
  CHECK(report.outcome == STEP_ACCEPTED, "it stands");
  return m;
}

static void test_stands(void **state)
{
  (void)state;
  EACH_OF (k, stands) {
    Bench b;
    WallSpec floor;
    MeasureSpec all[ALL];
    standing(&b, stands + k, &floor, all);
    Model *m = equilibrium(&b);
    check_stands(m);
    CALL(ModelDestroy(&m));
  }
}

/* So do measures that begin with a stage, and those of a run that begins with the state of this one. */
static void take_over(Bench *b, PetscBool next, Model **m)
{
  Model *before = *m;
  Imbalance imbalance;
  Tables *tables;
  Diag *diag;
  CALL(DiagCreate(&diag));
  if (next) CALL(ModelSucceed(&b->c, diag, m, &imbalance));
  else {
    CALL(TablesCreate(&tables));
    CALL(ModelToTables(before, tables));
    *m = bench_model(b, PETSC_COMM_WORLD);
    CALL(ModelTake(*m, tables, before->c, NULL, diag, &imbalance));
    CALL(TablesDestroy(&tables));
    CALL(ModelDestroy(&before));
  }
  CALL(DiagFlush(diag, stderr));
  CALL(DiagDestroy(&diag));
}

static void test_goes_on(void **state)
{
  (void)state;
  for (int next = 0; next < 2; ++next)
    EACH_VARIANT (k, 2) {
      Bench b, then;
      WallSpec floor;
      MeasureSpec all[ALL];
      standing(&b, stands + k, &floor, all);
      standing(&then, stands + k, &floor, all);
      b.c.n_measures = 0;
      Model *m = equilibrium(&b);
      model_step(m, 0.1);
      then.c.initial = (InitialSpec){.run = next ? NULL : (char *)"another"};
      then.c.stage = next, then.c.start = next * m->time;
      for (int i = 0; i < ALL; ++i) all[i].since = next;
      take_over(&then, (PetscBool)next, &m);
      check_stands(m);
      CALL(ModelDestroy(&m));
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_impulse), cmocka_unit_test(test_line),
                                     cmocka_unit_test(test_stands), cmocka_unit_test(test_goes_on)};
  return run_model_tests(argc, argv, tests);
}
