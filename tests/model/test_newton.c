/* Newton's iteration and the control of the step: quadratic convergence, halving, giving up without
 * a trace, growing again. */
#include <string.h>
#include "case_builder.h"

/* The cantilever of the case book: 8 m x 1 m, E = 90 MPa, nu = 0, bent by its weight in one
 * step. */
static void cantilever(Bench *b, const char *method, PetscReal size)
{
  bench_init(b, method, CELL_QUADRILATERAL, 0);
  b->constants[0].value = 90e6;
  b->constants[1].value = 0;
  bench_grid(b, (PetscReal[]){0, -1.5, 0}, (PetscReal[]){8.5, 1.5, 0}, size);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){8, 1, 0});
  b->c.gravity[1] = -9.81;
  b->c.newton = (NewtonSpec){.residual = 1e-8, .increment = 1e-10, .max_iterations = 25, .ease = 6};
  bench_motion(b, 0, 0, MOTION_FIXED, 3);
}

static void test_quadratic(void **state)
{
  (void)state;
  for (int fem = 0; fem < 2; ++fem) {
    Bench b;
    cantilever(&b, fem ? "fem" : "mpm", 0.125);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const StepReport report = model_step(m, 1);
    const PetscReal *r = report.newton.residual;
    CHECK(report.cuts == 0 && report.newton.iterations <= 6, "%d iterations", (int)report.newton.iterations);
    PetscInt pairs = 0;
    for (PetscInt k = 1; k < report.newton.iterations; ++k) {
      if (r[k] >= 1) continue; /* the way from rest */
      CHECK(r[k + 1] <= 10 * r[k] * r[k] + 1e-9, "residuals %g, %g", (double)r[k],
            (double)r[k + 1]); /* 1e-9: round-off */
      ++pairs;
    }
    CHECK(pairs >= 2, "only %d quadratic iterations", (int)pairs);
    CALL(ModelDestroy(&m));
  }
}

/* Full steps let the residual rise by two orders before it falls; nothing may damp that. */
static void test_residual_may_grow(void **state)
{
  Bench b;
  (void)state;
  cantilever(&b, "mpm", 0.25);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const StepReport report = model_step(m, 1);
  CHECK(report.newton.residual[1] > 10, "residual %g", (double)report.newton.residual[1]);
  CALL(ModelDestroy(&m));
}

/* A block whose top is pushed down by `way` of its height. */
static void press(Bench *b, const char *method, PetscReal way)
{
  bench_init(b, method, CELL_QUADRILATERAL, 4);
  bench_motion(b, 1, 0, MOTION_FIXED, 3);
  bench_motion(b, 1, 1, MOTION_DISPLACEMENT, 3)->value[1] = -way;
  b->c.grid.outside = OUTSIDE_KEEP;
  bench_tracer(b, "position", 0, 0.3, 0.6, 0);
}

typedef struct {
  PetscInt n;
  size_t bytes[POINT_N_REAL];
  char *data[POINT_N_REAL];
} Snapshot;

static Snapshot snapshot(const Points *p)
{
  Snapshot s = {.n = p->n};
  for (int f = 0; f < POINT_N_REAL; ++f) {
    s.bytes[f] = (size_t)p->n * (size_t)p->components[f] * sizeof(PetscReal);
    CALL(PetscMalloc1(s.bytes[f], &s.data[f]));
    CALL(PetscMemcpy(s.data[f], p->real[f], s.bytes[f]));
  }
  return s;
}

static void check_unchanged(Snapshot *s, const Points *p)
{
  CHECK(s->n == p->n, "%d points, not %d", (int)p->n, (int)s->n);
  for (int f = 0; f < POINT_N_REAL; ++f) {
    CHECK(!s->bytes[f] || !memcmp(s->data[f], p->real[f], s->bytes[f]), "field %d changed", f);
    CALL(PetscFree(s->data[f]));
  }
}

/* The top would have to pass the bottom: whatever the method, the step is halved, then given up,
 * and the model stands as it stood. */
static void test_gives_up(void **state)
{
  (void)state;
  for (int fem = 0; fem < 2; ++fem)
    for (int dynamic = 0; dynamic < 2; ++dynamic) {
      Bench b;
      StepReport report;
      press(&b, fem ? "fem" : "mpm", 3);
      if (dynamic) bench_dynamic(&b, 1, 1);
      b.motion[1].amplitude =
        /* at once */
        (Amplitude){.n = 2, .time = (PetscReal[]){0, 1e-9}, .value = (PetscReal[]){0, 1}};
      b.c.analysis.smallest = 0.1;
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      Snapshot points = snapshot(m->points), tracers = snapshot(m->tracers);
      PetscReal *x;
      CALL(PetscMalloc1(m->grid->n_nodes * 2, &x));
      CALL(PetscArraycpy(x, m->grid->x, m->grid->n_nodes * 2));
      CALL(ModelStep(m, 1, &report));
      CHECK(report.outcome == STEP_TOO_SMALL, "outcome %d", (int)report.outcome);
      CHECK(report.cuts == 4, "%d tries", (int)report.cuts); /* 1, 1/2, 1/4, 1/8 s */
      CHECK(strstr(report.reason, "0.125") && strstr(report.reason, "analysis.smallest"), "%s", report.reason);
      CHECK(m->time == 0 && m->step == 0 && m->external_work == 0 && m->boundary_work == 0, "time went on");
      check_unchanged(&points, m->points);
      check_unchanged(&tracers, m->tracers);
      for (PetscInt i = 0; i < m->grid->n_nodes * 2; ++i) CHECK(x[i] == m->grid->x[i], "the grid moved");
      CALL(PetscFree(x));
      CALL(ModelDestroy(&m));
    }
}

/* A step that fails and is halved leaves no trace: the same as taking the halves from the start. */
static void test_halved_is_small(void **state)
{
  (void)state;
  for (int fem = 0; fem < 2; ++fem) {
    Bench b, c;
    press(&b, fem ? "fem" : "mpm", 0.7);
    press(&c, fem ? "fem" : "mpm", 0.7);
    b.c.newton.max_iterations = c.c.newton.max_iterations = 4; /* too few for the whole */
    b.c.newton.residual = c.c.newton.residual = 1e-10;
    c.c.analysis.step = c.c.analysis.largest = 0.5;
    Model *m = bench_model(&b, PETSC_COMM_WORLD), *n = bench_model(&c, PETSC_COMM_SELF);
    const StepReport first = model_step(m, 1), small = model_step(n, 1);
    CHECK(first.cuts == 1 && small.cuts == 0, "%d and %d cuts", (int)first.cuts, (int)small.cuts);
    CHECK(first.dt == 0.5 && m->time == 0.5 && m->control.next == 0.5, "a step of %g s", (double)first.dt);
    CHECK(m->cuts == 1, "%d cuts", (int)m->cuts);
    CHECK_CLOSE(points_difference(m, n, POINT_X), 0, 1e-13);
    CHECK_CLOSE(points_difference(m, n, POINT_STATE), 0, 1e-12);
    CALL(ModelDestroy(&m));
    CALL(ModelDestroy(&n));
  }
}

/* Easy steps double up to `largest`, and end where the caller says. */
static void test_growth(void **state)
{
  static const PetscReal expected[] = {0.05, 0.1, 0.2, 0.3, 0.3, 0.05};
  Bench b;
  (void)state;
  press(&b, "fem", 0.01);
  b.c.analysis.step = 0.05;
  b.c.analysis.largest = 0.3;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (size_t k = 0; k < sizeof expected / sizeof *expected; ++k)
    CHECK_CLOSE(model_step(m, 1 - m->time).dt, expected[k], 1e-12);
  CHECK_CLOSE(m->time, 1, 1e-12);
  CHECK(m->control.next == 0.3, "the short last step must not shorten the next: %g", (double)m->control.next);
  CALL(ModelDestroy(&m));
}

/* After a cut the step grows again. */
static void test_grows_again(void **state)
{
  Bench b;
  (void)state;
  press(&b, "fem", 0.7);
  b.c.newton.max_iterations = 4;
  b.c.newton.residual = 1e-10;
  b.motion[1].amplitude = (Amplitude){.n = 3, .time = (PetscReal[]){0, 1, 10}, .value = (PetscReal[]){0, 1, 1.01}};
  b.c.analysis.end = 10;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  PetscReal smallest = 1, last = 0;
  while (m->time < 5) {
    last = model_step(m, 10).dt;
    smallest = PetscMin(smallest, last);
  }
  CHECK(smallest < 1 && last == 1, "steps down to %g s, %g s at the end", (double)smallest, (double)last);
  CALL(ModelDestroy(&m));
}

/* Half as long again in one step: the linear step that carries the boundary's motion inside is not
 * held against the iteration. */
static void test_large_stretch(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
    Bench b;
    bench_init(&b, "fem", cell, 4);
    bench_motion(&b, 0, 0, MOTION_FIXED, 7);
    bench_motion(&b, 0, 1, MOTION_DISPLACEMENT, 7)->value[0] = 0.5;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const StepReport r = model_step(m, 1);
    CHECK(r.cuts == 0 && r.newton.iterations <= 9, "%d cuts, %d iterations", (int)r.cuts, (int)r.newton.iterations);
    CALL(ModelDestroy(&m));
  }
}

/* A soft block, held below, in a step so long that it all but comes to rest. */
static void slow_block(Bench *b)
{
  bench_init(b, "mpm", CELL_QUADRILATERAL, 4);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.75, 0});
  bench_dynamic(b, 40, 10);
  bench_motion(b, 1, 0, MOTION_FIXED, 3);
  b->body[0].velocity[0] = 1e-3;
  b->c.newton.residual = 1e-10;
}

/* A blow: the points of the upper layers fly against each other, so fast that with inertia alone
 * they would pass within a step. */
static void blow(Model *m)
{
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p);
    point_real(m->points, POINT_V, p)[0] = (x[0] < 0.5 ? 0.2 : -0.2) * x[1];
  }
  CALL(m->method->initialise(m->space));
}

/* Newton fails from inertia's guess and finds the solution from the increments of the step before:
 * no step is halved, the failed try is counted, and the solution is that of a model on one rank
 * that starts from the better guess at once. */
static void test_second_try(void **state)
{
  Bench b;
  (void)state;
  slow_block(&b);
  Model *m = bench_model(&b, PETSC_COMM_WORLD), *n = bench_model(&b, PETSC_COMM_SELF);
  model_step(m, 10);
  model_step(n, 10);
  CHECK(!m->tries.again && !m->tries.lost, "%d second tries of an easy step", (int)m->tries.again);
  blow(m);
  blow(n);
  m->guess.previous = PETSC_FALSE;
  n->guess.previous = PETSC_TRUE;
  const PetscInt before = m->total_iterations;
  const StepReport second = model_step(m, 10), first = model_step(n, 10);
  CHECK(first.tries.again == 0 && first.cuts == 0, "%d further tries from the better guess", (int)first.tries.again);
  CHECK(second.tries.again == 1 && second.cuts == 0, "%d further tries, %d cuts", (int)second.tries.again,
        (int)second.cuts);
  CHECK(m->tries.again == 1 && m->tries.lost == second.tries.lost, "%d tries in all", (int)m->tries.again);
  CHECK(m->total_iterations - before == second.newton.iterations + second.tries.lost, "%d iterations in all",
        (int)(m->total_iterations - before));
  CHECK(second.newton.iterations == first.newton.iterations, "%d and %d iterations", (int)second.newton.iterations,
        (int)first.newton.iterations);
  CHECK_CLOSE(points_difference(m, n, POINT_X), 0, 1e-10);
  CALL(ModelDestroy(&m));
  CALL(ModelDestroy(&n));
}

/* A block in free flight, whose first guess is its solution. */
static Model *flying_block(Bench *b, const char *basis)
{
  bench_init(b, "mpm", CELL_QUADRILATERAL, 8);
  b->c.basis.kind = (char *)basis;
  bench_box(b, 0, (PetscReal[]){0.25, 0.5, 0}, (PetscReal[]){0.625, 0.875, 0});
  bench_dynamic(b, 1, 0.01);
  b->c.linear = LINEAR_AUTO; /* MUMPS on several ranks adds in the order in which messages come: bits may differ */
  b->c.gravity[1] = -9.81;
  b->c.newton.residual = 1e-9;
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Another solver in its place, as after a checkpoint: it knows nothing of the steps before. */
static void forget_flight(Model *m)
{
  CALL(NewtonDestroy(&m->newton));
  CALL(NewtonCreate(m->comm, &m->c->newton, &m->newton));
}

/* Nobody asks for a tangent in flight; and when a blow asks for one after all, the step is the same, to the last bit,
 * as that of a solver which begins with one. */
static void test_no_iteration(void **state)
{
  static const char *const bases[] = {"cell", "gimp"};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b, c;
    Model *m = flying_block(&b, bases[k]), *n = flying_block(&c, bases[k]);
    for (int step = 0; step < 3; ++step) {
      const StepReport r = model_step(m, 1);
      model_step(n, 1);
      CHECK(r.newton.iterations == 0, "%d iterations in flight", (int)r.newton.iterations);
    }
    CHECK(m->system->later == m->space->support, "a tangent was asked for");
    forget_flight(n);
    blow(m);
    blow(n);
    const StepReport r = model_step(m, 1);
    model_step(n, 1);
    CHECK(r.newton.iterations > 0 && !m->system->later, "the blow was not felt");
    CHECK(m->points->n == n->points->n, "%d points, not %d", (int)m->points->n, (int)n->points->n);
    for (PetscInt i = 0; i < m->points->n * m->dim; ++i)
      CHECK(m->points->real[POINT_V][i] == n->points->real[POINT_V][i], "another velocity");
    CALL(ModelDestroy(&m));
    CALL(ModelDestroy(&n));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_quadratic),     cmocka_unit_test(test_residual_may_grow),
    cmocka_unit_test(test_gives_up),      cmocka_unit_test(test_halved_is_small),
    cmocka_unit_test(test_growth),        cmocka_unit_test(test_grows_again),
    cmocka_unit_test(test_large_stretch), cmocka_unit_test(test_second_try),
    cmocka_unit_test(test_no_iteration),
  };
  return run_model_tests(argc, argv, tests);
}
