/* What happens at the faces of cells: bodies that slide slowly over them, spray of single points,
 * points that leave the grid. */
#include <string.h>
#include "case_builder.h"

/* How a run went. */
typedef struct {
  PetscInt steps, cuts, most_iterations;
  /* largest component over all points and steps, Pa; largest deviation of a velocity, m/s */
  PetscReal stress, speed;
  PetscBool finished;
} Course;

static void look(const Model *m, const PetscReal v[3], Course *c)
{
  PetscReal local[2] = {c->stress, c->speed}, all[2];
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal sigma[6];
    CALL(ModelPointStress(m, p, sigma));
    for (int k = 0; k < 6; ++k) local[0] = PetscMax(local[0], PetscAbsReal(sigma[k]));
    for (PetscInt d = 0; d < m->dim; ++d)
      local[1] = PetscMax(local[1], PetscAbsReal(point_real(m->points, POINT_V, p)[d] - v[d]));
  }
  CALL(MPI_Allreduce(local, all, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  c->stress = all[0];
  c->speed = all[1];
}

static Course run(Bench *b, const PetscReal v[3], PetscInt steps)
{
  Course c = {.steps = steps};
  StepReport r;
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  for (PetscInt s = 0; s < steps; ++s) {
    CALL(ModelStep(m, PETSC_MAX_REAL, &r));
    c.cuts += r.cuts;
    c.most_iterations = PetscMax(c.most_iterations, r.newton.iterations);
    if (r.outcome != STEP_ACCEPTED) {
      PetscPrintf(PETSC_COMM_WORLD, "  step %d: %s\n", (int)s, r.reason);
      CALL(ModelDestroy(&m));
      return c;
    }
    look(m, v, &c);
  }
  c.finished = PETSC_TRUE;
  CALL(ModelDestroy(&m));
  return c;
}

static void tell(const char *what, const Bench *b, const Course *c)
{
  PetscPrintf(PETSC_COMM_WORLD,
              "%s, cell %d, stabilisation {%g, %g}: %s, %d cuts, at most %d iterations, stress up to %.3g Pa, speed "
              "off by %.3g m/s\n",
              what, (int)b->c.grid.cell, (double)b->c.stabilisation.stiffness, (double)b->c.stabilisation.mass,
              c->finished ? "finished" : "gave up", (int)c->cuts, (int)c->most_iterations, (double)c->stress,
              (double)c->speed);
}

/* A block pressed on a smooth floor by its weight (5 kPa at its foot) slides at 1/37 of a cell a
 * step over the faces of more than five cells. */
static void slide(CellType cell)
{
  Bench b;
  const PetscReal size = 0.125, dt = 0.01, v[3] = {size / 37 / dt, 0, 0};
  bench_init(&b, "mpm", cell, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 0.25}, size);
  bench_box(&b, 0, (PetscReal[]){0.25, 0, 0}, (PetscReal[]){0.75, 0.5, 0.25});
  bench_dynamic(&b, 10, dt);
  b.c.newton = (NewtonSpec){.residual = 1e-8, .increment = 1e-10, .max_iterations = 25, .ease = 6};
  b.body[0].velocity[0] = v[0];
  b.c.gravity[1] = -9.81;
  b.c.gravity_amplitude = (Amplitude){.n = 2, .time = (PetscReal[]){0, 0.5}, .value = (PetscReal[]){0, 1}};
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  if (b.c.kinematics == &kinematics_3d) {
    bench_motion(&b, 2, 0, MOTION_FIXED, 4);
    bench_motion(&b, 2, 0.25, MOTION_FIXED, 4);
  }
  const Course c = run(&b, v, 200);
  tell("sliding block", &b, &c);
  CHECK(c.finished && c.cuts == 0 && c.most_iterations <= 4, "the block stumbles");
  CHECK(c.stress < 1e4, "stress %g Pa", (double)c.stress);
  /* the foot starts to sag: a slow swing */
  CHECK(c.speed < 0.1, "speed off by %g m/s", (double)c.speed);
}

static void test_slide(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell) slide(cell);
  slide(CELL_HEXAHEDRON);
}

/* A block carried sideways on its clamped foot, statics: the nodes that it leaves behind and those
 * that it enters hold slivers. */
static void creep(CellType cell, PetscInt points_per_cell, PetscReal step)
{
  Bench b;
  const PetscReal size = 0.125, v[3] = {0, 0, 0};
  bench_init(&b, "mpm", cell, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 0}, size);
  bench_box(&b, 0, (PetscReal[]){0.25, 0, 0}, (PetscReal[]){0.75, 0.5, 0});
  b.c.newton = (NewtonSpec){.residual = 1e-8, .increment = 1e-10, .max_iterations = 25, .ease = 6};
  b.body[0].points_per_cell = points_per_cell;
  b.c.analysis = (AnalysisSpec){.type = ANALYSIS_STATIC, .end = 200, .step = 1, .smallest = 1. / 64, .largest = 1};
  b.c.gravity[1] = -9.81;
  b.c.gravity_amplitude = (Amplitude){.n = 2, .time = (PetscReal[]){0, 10}, .value = (PetscReal[]){0, 1}};
  MotionSpec *foot = bench_motion(&b, 1, 0, MOTION_VELOCITY, 3);
  foot->value[0] = size * step;
  const Course c = run(&b, v, (PetscInt)(200. / 37 / step));
  PetscPrintf(PETSC_COMM_WORLD, "%d points a cell, %g cells a step: ", (int)points_per_cell, (double)step);
  tell("creeping block", &b, &c);
  CHECK(c.finished && c.cuts == 0, "the block stumbles");
  CHECK(c.most_iterations <= (cell == CELL_TRIANGLE && points_per_cell == 1 ? 20 : 4), "%d iterations",
        (int)c.most_iterations);
  CHECK(c.stress < 1e4, "stress %g Pa", (double)c.stress);
}

static void test_creep(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell) {
    creep(cell, cell == CELL_TRIANGLE ? 3 : 4, 1. / 37);
    creep(cell, cell == CELL_TRIANGLE ? 3 : 4, 0.5 - 0.5 / PetscSqrtReal(3)); /* Gauss points land on faces */
    creep(cell, 1, 1. / 37);
  }
}

/* Points alone in their cells, each on a course of its own: most points of a block are taken away,
 * the rest fly apart and fall. Alone in its nodes' cells a point is a free mass, so that its course
 * is exact. */
static void spray(CellType cell, PetscBool stabilised)
{
  Bench b;
  const PetscReal size = 0.25, dt = 0.01;
  const PetscBool is_3d = cell >= CELL_TETRAHEDRON;
  PetscReal worst = 0;
  PetscInt cuts = 0, iterations = 0;
  PetscBool *drop;
  bench_init(&b, "mpm", cell, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){3, 4, 3}, size);
  bench_box(&b, 0, (PetscReal[]){0.5, 2, 0.5}, (PetscReal[]){2.5, 3.5, 2.5});
  bench_dynamic(&b, 1, dt);
  b.body[0].points_per_cell = 1;
  b.body[0].velocity[0] = 0.9;
  b.body[0].velocity[1] = 1.1;
  b.c.gravity[1] = -9.81;
  if (!stabilised) b.c.stabilisation = (StabilisationSpec){0};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CALL(PetscCalloc1(m->points->n, &drop));
  for (PetscInt p = 0; p < m->points->n; ++p) { /* keep every third cell in each direction */
    const PetscReal *x = point_real(m->points, POINT_X, p);
    for (PetscInt d = 0; d < m->dim; ++d)
      if ((PetscInt)(x[d] / size) % 3) drop[p] = PETSC_TRUE;
  }
  CALL(PointsCompact(m->points, drop));
  CALL(PetscFree(drop));
  CALL(m->method->initialise(m->space));
  for (PetscInt s = 0; s < 40; ++s) {
    StepReport r = model_step(m, dt);
    cuts += r.cuts;
    iterations = PetscMax(iterations, r.newton.iterations);
  }
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *u = point_real(m->points, POINT_U, p), *v = point_real(m->points, POINT_V, p);
    const PetscReal t = 40 * dt, exact[4] = {0.9 * t, 1.1 * t - 0.5 * 9.81 * t * t, 0.9, 1.1 - 9.81 * t};
    for (int d = 0; d < 2; ++d)
      worst = PetscMax(worst, PetscMax(PetscAbsReal(u[d] - exact[d]), PetscAbsReal(v[d] - exact[2 + d])));
  }
  worst = model_max(m, worst);
  PetscPrintf(PETSC_COMM_WORLD, "spray, cell %d, stabilisation %d: off by %.3g, %d cuts, %d iterations\n", (int)cell,
              (int)stabilised, (double)worst, (int)cuts, (int)iterations);
  CHECK(worst <= 1e-10 && cuts == 0, "%s", is_3d ? "3D" : "2D");
  CALL(ModelDestroy(&m));
}

static void test_spray(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
    spray(cell, PETSC_TRUE);
    spray(cell, PETSC_FALSE);
  }
}

/* A block that flies out of the grid on its right side. */
static void leaving(Bench *b, OutsidePolicy policy)
{
  bench_init(b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0}, 0.125);
  bench_box(b, 0, (PetscReal[]){0.5, 0.25, 0}, (PetscReal[]){0.75, 0.5, 0});
  b->body[0].velocity[0] = 3;
  b->c.grid.outside = policy;
  bench_dynamic(b, 1, 0.02);
}

static void test_outside_stop(void **state)
{
  Bench b;
  StepReport r = {.outcome = STEP_ACCEPTED};
  (void)state;
  leaving(&b, OUTSIDE_STOP);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  PetscInt n, before;
  CALL(ModelCountPoints(m, &before));
  for (PetscInt s = 0; s < 20 && r.outcome == STEP_ACCEPTED; ++s) CALL(ModelStep(m, PETSC_MAX_REAL, &r));
  CHECK(r.outcome == STEP_POINTS_LOST, "outcome %d", (int)r.outcome);
  CHECK(strstr(r.reason, "left the grid") && strstr(r.reason, "velocity (3, ") && strstr(r.reason, "outside: remove"),
        "%s", r.reason);
  CHECK(m->time > 0.08 && m->time < 0.11, "at %g s", (double)m->time); /* 0.25 m at 3 m/s */
  CALL(ModelCountPoints(m, &n));
  CHECK(n == before, "%d of %d points", (int)n, (int)before);
  CALL(ModelDestroy(&m));
}

/* Removed points take their mass along, and what is left flies on. */
static void test_outside_remove(void **state)
{
  Bench b;
  (void)state;
  leaving(&b, OUTSIDE_REMOVE);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  PetscReal mass = model_sum(m, "mass: total", 0);
  PetscInt n = 1, last = 0;
  CALL(ModelCountPoints(m, &last));
  for (PetscInt s = 0; s < 20; ++s) {
    model_step(m, PETSC_MAX_REAL);
    CALL(ModelCountPoints(m, &n));
    CHECK(n <= last, "points came back");
    const PetscReal left = model_sum(m, "mass: total", 0);
    CHECK_CLOSE(left, mass * n / 16., 1e-10);
    CHECK_CLOSE(model_sum(m, "momentum", 0), 3 * left, 1e-9 * mass);
    last = n;
  }
  CHECK(n == 0, "%d points stayed", (int)n);
  CALL(ModelDestroy(&m));
}

/* Kept points stay on the boundary, none is lost. */
static void test_outside_keep(void **state)
{
  Bench b;
  (void)state;
  leaving(&b, OUTSIDE_KEEP);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  PetscInt n, before;
  CALL(ModelCountPoints(m, &before));
  for (PetscInt s = 0; s < 15; ++s) {
    StepReport r;
    CALL(ModelStep(m, PETSC_MAX_REAL, &r));
    if (r.outcome != STEP_ACCEPTED) PetscPrintf(PETSC_COMM_WORLD, "kept: step %d: %s\n", (int)s, r.reason);
    CHECK(r.outcome == STEP_ACCEPTED, "%s", r.reason);
    for (PetscInt p = 0; p < m->points->n; ++p) CHECK(point_real(m->points, POINT_X, p)[0] <= 1, "outside");
  }
  CALL(ModelCountPoints(m, &n));
  CHECK(n == before, "%d of %d points", (int)n, (int)before);
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_slide),        cmocka_unit_test(test_creep),          cmocka_unit_test(test_spray),
    cmocka_unit_test(test_outside_stop), cmocka_unit_test(test_outside_remove), cmocka_unit_test(test_outside_keep),
  };
  return run_model_tests(argc, argv, tests);
}
