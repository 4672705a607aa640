/* Boundary and loads in a running model: reactions balance what acts, rotation is objective,
 * velocities follow their table, loads move with the body, and geostatic stress is in
 * equilibrium. */
#include "case_builder.h"

static PetscReal reaction(Model *m, PetscInt entry, PetscInt component)
{
  const MeasureSpec measure = {.kind = "reaction", .component = component, .boundary = entry};
  PetscReal value;
  CALL(ModelMeasure(m, &measure, 0, &value));
  return value;
}

/* A bar clamped at one end (two entries, one per component) under gravity, a traction and a point
 * force. */
static void balance(const char *method, CellType cell)
{
  Bench b;
  const PetscBool is_3d = cell >= CELL_TETRAHEDRON;
  bench_init(&b, method, cell, 0);
  bench_grid(&b, (PetscReal[]){0, -0.5, 0}, (PetscReal[]){3, 1, 0.5}, 0.25);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 0.5, 0.5});
  b.c.gravity[1] = -3;
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_motion(&b, 0, 0, MOTION_FIXED, 6);
  bench_traction(&b, 0, 2, "body", 4000, -1000, 0);
  b.load[b.c.n_loads++] = (LoadSpec){.kind = LOAD_POINT, .at = {1.1, 0.3, 0.2}, .value = {-70, 50, 0}};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  model_step(m, 1);
  const PetscReal area = is_3d ? 0.25 : 0.5, weight = 3000 * 2 * area;
  CHECK_CLOSE(reaction(m, 0, 0), -(4000 * area - 70), 1e-8 * weight);
  CHECK_CLOSE(reaction(m, 1, 1), weight + 1000 * area - 50, 1e-8 * weight);
  CALL(ModelDestroy(&m));
}

/* A block in a box: entries share its corners, and each bears what it holds. What the floor holds along x, too, the
 * side does not, and one that comes last has nothing left. */
static void test_shared_corners(void **state)
{
  (void)state;
  for (int rough = 0; rough < 2; ++rough) {
    Bench b;
    bench_init(&b, rough ? "mpm" : "fem", CELL_QUADRILATERAL, 4);
    b.c.gravity[0] = 2;
    b.c.gravity[1] = -10;
    bench_motion(&b, 1, 0, MOTION_FIXED, rough ? 3 : 2);
    bench_motion(&b, 0, 0, MOTION_FIXED, 1);
    bench_motion(&b, 0, 1, MOTION_FIXED, 1);
    bench_motion(&b, 1, 0, MOTION_FIXED, 2);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    model_step(m, 1);
    CHECK_CLOSE(reaction(m, 0, 1), 10000, 1e-6);
    CHECK_CLOSE(reaction(m, 0, 0) + reaction(m, 1, 0) + reaction(m, 2, 0), -2000, 1e-6);
    if (!rough) CHECK_CLOSE(reaction(m, 0, 0), 0, 0);
    for (PetscInt side = 1; side < 3; ++side) CHECK_CLOSE(reaction(m, side, 1), 0, 0);
    CHECK_CLOSE(reaction(m, 3, 1), 0, 0);
    CALL(ModelDestroy(&m));
    b.c.n_measures = 1;
    b.measure[0] = (MeasureSpec){.name = "last", .kind = "reaction", .component = 1, .boundary = 3};
    bench_warned(&b, PETSC_COMM_WORLD, "measures.last.of.boundary", "its reaction is 0");
    b.measure[0].boundary = 0;
    bench_warned(&b, PETSC_COMM_WORLD, "measures.", NULL);
  }
}

static void test_balance(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
    balance("mpm", cell);
    balance("fem", cell);
  }
}

/* Dynamics: the impulse of the reaction is the change of momentum less that of gravity, step by
 * step. The block lands on a floor. */
static void test_impulse(void **state)
{
  (void)state;
  for (int moving = 0; moving < 2; ++moving) {
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1.5, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){0.25, moving ? 0.125 : 0, 0}, (PetscReal[]){0.75, 0.5, 0});
    b.c.gravity[1] = -9.81;
    b.body[0].velocity[1] = moving ? -1 : 0;
    bench_dynamic(&b, 1, 0.005);
    bench_motion(&b, 1, 0, MOTION_FIXED, 2);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const PetscReal mass = model_sum(m, "mass: total", 0);
    PetscReal before = model_sum(m, "momentum", 1), largest = 0, impulse = 0, gained = 0;
    for (PetscInt s = 0; s < 60; ++s) {
      const StepReport r = model_step(m, 0.005);
      const PetscReal now = model_sum(m, "momentum", 1), force = reaction(m, 0, 1);
      impulse += (force - mass * 9.81) * r.dt;
      gained += now - before;
      largest = PetscMax(largest, force);
      before = now;
    }
    CHECK(largest > mass * 9.81, "the floor carried %g N", (double)largest);
    /* Newmark's end-of-step force stands for the whole step: the sums agree to first order of the
     * step. */
    CHECK_CLOSE(gained, impulse, 0.05 * mass);
    CALL(ModelDestroy(&m));
  }
}

/* The same bar in a frame turned by 90 degrees, with its gravity: the answer is turned. */
static void test_turned_frame(void **state)
{
  (void)state;
  for (int fem = 0; fem < 2; ++fem) {
    PetscReal tip[2][2];
    for (int turned = 0; turned < 2; ++turned) { /* (x, y) -> (-y, x) */
      Bench b;
      bench_init(&b, fem ? "fem" : "mpm", CELL_QUADRILATERAL, 0);
      if (turned) bench_grid(&b, (PetscReal[]){-1, 0, 0}, (PetscReal[]){1.5, 3.25, 0}, 0.25);
      else bench_grid(&b, (PetscReal[]){0, -1.5, 0}, (PetscReal[]){3.25, 1, 0}, 0.25);
      if (turned) bench_box(&b, 0, (PetscReal[]){-0.5, 0, 0}, (PetscReal[]){0, 3, 0});
      else bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){3, 0.5, 0});
      b.c.gravity[turned ? 0 : 1] = turned ? 1.5 : -1.5;
      bench_motion(&b, turned ? 1 : 0, 0, MOTION_FIXED, 3);
      const PetscReal x[2] = {turned ? -0.25 : 3, turned ? 3 : 0.25};
      bench_tracer(&b, "displacement", turned ? 1 : 0, x[0], x[1], 0);
      bench_tracer(&b, "displacement", turned ? 0 : 1, x[0], x[1], 0);
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      model_step(m, 1);
      for (int k = 0; k < 2; ++k) CALL(ModelMeasure(m, &b.measure[k], k, &tip[turned][k]));
      CALL(ModelDestroy(&m));
    }
    CHECK(tip[0][1] < -0.2, "the tip sinks by %g m only", (double)tip[0][1]);
    CHECK_CLOSE(tip[1][0], tip[0][0], 1e-10);
    CHECK_CLOSE(-tip[1][1], tip[0][1], 1e-10);
  }
}

/* Loaded (a stretch of the whole body), then turned by 90 degrees about a point in ten steps with
 * all nodes prescribed: F and stress turn with the body, energy and |x - centre| stay. */
typedef struct {
  PetscInt dim;
} Whole;

static void stretch_then_turn(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  const PetscInt dim = ((Whole *)context)->dim;
  const PetscReal angle = PETSC_PI / 2 * (PetscMax(t1, 0.5) - PetscMax(t0, 0.5)) / 0.5;
  const PetscReal stretch = (1 + 0.4 * PetscMin(t1, 0.5)) / (1 + 0.4 * PetscMin(t0, 0.5)),
                  y[3] = {x[0] * stretch, x[1], dim == 3 ? x[2] : 0};
  increment[0] = cos(angle) * y[0] - sin(angle) * y[1] - x[0];
  increment[1] = sin(angle) * y[0] + cos(angle) * y[1] - x[1];
  if (dim == 3) increment[2] = 0;
}

static void test_turned_body(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
    Bench b;
    Whole whole = {cell >= CELL_TETRAHEDRON ? 3 : 2};
    PetscReal energy = 0, F[9] = {0, -1, 0, 1.2, 0, 0, 0, 0, 1}, expected[6];
    bench_init(&b, "fem", cell, 3);
    bench_motion(&b, -1, 0, MOTION_FIXED, 7);
    b.c.analysis.step = b.c.analysis.largest = 0.05;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    m->boundary->field = stretch_then_turn;
    m->boundary->field_context = &whole;
    while (m->time < 1 - 1e-9) {
      CHECK(model_step(m, 1 - m->time).cuts == 0, "a step was halved");
      const PetscReal now = model_sum(m, "energy: elastic", 0);
      if (m->time > 0.5 + 1e-9) CHECK_CLOSE(now, energy, 1e-11 * energy);
      energy = now;
    }
    rubber_stress(F, expected);
    for (PetscInt p = 0; p < m->points->n; ++p) {
      PetscReal f[9], sigma[6];
      point_F(m->points, p, f);
      CALL(ModelPointStress(m, p, sigma));
      for (int i = 0; i < 9; ++i) CHECK_CLOSE(f[i], F[i], 1e-12);
      for (int i = 0; i < 6; ++i) CHECK_CLOSE(sigma[i], expected[i], 1e-11 * 1e6);
    }
    CALL(ModelDestroy(&m));
  }
}

/* The same through the case's own rotation, about a centre and (3D) a tilted axis: a body that
 * turns as a whole has no stress. */
static void rotate(CellType cell, PetscInt steps)
{
  Bench b;
  const PetscBool is_3d = cell >= CELL_TETRAHEDRON;
  PetscReal n[3] = {0, 0, 1}, worst = 0;
  bench_init(&b, "fem", cell, 3);
  MotionSpec *turn = bench_motion(&b, -1, 0, MOTION_ROTATION, 7);
  for (int d = 0; d < 3; ++d) turn->centre[d] = 0.3;
  if (is_3d) turn->axis[0] = 2, turn->axis[1] = -1, turn->axis[2] = 2, n[0] = 2. / 3, n[1] = -1. / 3, n[2] = 2. / 3;
  turn->rate = PETSC_PI / 2;
  b.c.analysis.step = b.c.analysis.largest = 1.0 / (PetscReal)steps;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), *u = point_real(m->points, POINT_U, p);
    PetscReal r[3] = {0, 0, 0}, sigma[6], along = 0;
    CALL(ModelPointStress(m, p, sigma));
    for (int k = 0; k < 6; ++k) CHECK(PetscAbsReal(sigma[k]) < 1e-6, "stress %g Pa", (double)sigma[k]);
    for (PetscInt d = 0; d < m->dim; ++d) r[d] = x[d] - u[d] - 0.3;
    for (int d = 0; d < 3; ++d) along += r[d] * n[d];
    for (PetscInt d = 0; d < m->dim; ++d) { /* a quarter turn: n x r + n (n . r) */
      const int j = (int)(d + 1) % 3, k = (int)(d + 2) % 3;
      worst = PetscMax(worst, PetscAbsReal(x[d] - 0.3 - (n[j] * r[k] - n[k] * r[j]) - n[d] * along));
    }
  }
  CHECK(worst < 1e-11, "points are off by %g m", (double)worst);
  CALL(ModelDestroy(&m));
}

static void test_rotation(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) rotate(cell, 9);
  rotate(CELL_QUADRILATERAL, 4);
}

/* A prescribed velocity with a table: the way is the integral of the table. */
static void test_velocity_table(void **state)
{
  (void)state;
  for (int dynamic = 0; dynamic < 2; ++dynamic) {
    Bench b;
    bench_init(&b, "fem", CELL_QUADRILATERAL, 2);
    MotionSpec *motion = bench_motion(&b, -1, 0, MOTION_VELOCITY, 3);
    motion->value[0] = 2;
    motion->value[1] = -1;
    motion->amplitude = (Amplitude){.n = 3, .time = (PetscReal[]){0, 0.4, 1}, .value = (PetscReal[]){0, 1, 0.5}};
    if (dynamic) bench_dynamic(&b, 1, 0.1);
    else b.c.analysis.step = b.c.analysis.largest = 0.1;
    bench_tracer(&b, "displacement", 0, 0.5, 0.5, 0);
    bench_tracer(&b, "displacement", 1, 0, 0, 0);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    PetscReal u[2];
    while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
    const PetscReal way = 0.5 * 0.4 + 0.75 * 0.6;
    for (int k = 0; k < 2; ++k) CALL(ModelMeasure(m, &b.measure[k], k, &u[k]));
    CHECK_CLOSE(u[1], -way, 1e-13);
    if (!dynamic) CHECK_CLOSE(u[0], 2 * way, 1e-12); /* inside, the body follows */
    CALL(ModelDestroy(&m));
  }
}

/* Carried loads: the resultant is exact, and when the body flies on it takes them along: a constant
 * force accelerates it as a mass point, the same as if its cells had not changed. */
static void test_load_moves(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
    Bench b;
    const PetscBool is_3d = cell >= CELL_TETRAHEDRON;
    const PetscReal size = is_3d ? 0.25 : 0.125, side = 0.5, area = is_3d ? side * side : side;
    bench_init(&b, "mpm", cell, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 1}, size);
    bench_box(&b, 0, (PetscReal[]){0.25, 0.25, 0.25}, (PetscReal[]){0.75, 0.75, 0.75});
    bench_dynamic(&b, 1, 0.01);
    b.body[0].velocity[0] = 1.5;
    bench_traction(&b, 0, 0.25, "body", 1000, 0, 0); /* pushes from behind, all along the face */
    b.load[b.c.n_loads++] = (LoadSpec){.kind = LOAD_POINT, .at = {0.5, 0.5, 0.5}, .value = {0, 30 * area, 0}};
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const PetscReal mass = model_sum(m, "mass: total", 0);
    for (PetscInt s = 0; s < 50; ++s) CHECK(model_step(m, 0.01).cuts == 0, "a step was halved");
    CHECK_CLOSE(model_sum(m, "momentum", 0), mass * 1.5 + 1000 * area * 0.5, 1e-9 * mass);
    CHECK_CLOSE(model_sum(m, "momentum", 1), 30 * area * 0.5, 1e-9 * mass);
    PetscReal x = 0, n = 0;
    for (PetscInt p = 0; p < m->loads->carriers->n; ++p)
      if (m->loads->carriers->body[p] == 0) x += point_real(m->loads->carriers, POINT_X, p)[0], n += 1;
    PetscReal local[2] = {x, n}, all[2];
    CALL(MPI_Allreduce(local, all, 2, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
    const PetscReal way = 1.5 * 0.5 + 0.5 * (1000 * area / mass) * 0.25;
    CHECK_CLOSE(all[0] / all[1], 0.25 + way, 0.01);
    CALL(ModelDestroy(&m));
  }
}

/* A column of soil-like stiffness with its geostatic stress, held at the sides: the first static
 * step does nothing. For sides that do not move K0 is nu / (1 - nu) in the limit of small strains;
 * the stress of the law is exact for any K0. */
static void test_geostatic(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
    for (int fem = 0; fem < 2; ++fem) {
      Bench b;
      PetscReal worst = 0;
      const PetscInt dim = cell >= CELL_TETRAHEDRON ? 3 : 2;
      bench_init(&b, fem ? "fem" : "mpm", cell, 0);
      bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 2, 1}, 0.25);
      bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1.5, 1});
      b.body[0].has_k0 = PETSC_TRUE;
      b.body[0].k0 = 0.5;
      b.body[0].surface = 1.5;
      b.c.gravity[1] = -9.81;
      b.c.gravity_amplitude = (Amplitude){.n = 1, .time = (PetscReal[]){0}, .value = (PetscReal[]){1}};
      for (int d = 0; d < dim; ++d) {
        bench_motion(&b, d, 0, MOTION_FIXED, 1u << d);
        if (d != 1) bench_motion(&b, d, 1, MOTION_FIXED, 1u << d);
      }
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      model_step(m, 1);
      for (PetscInt p = 0; p < m->points->n; ++p) {
        const PetscReal *u = point_real(m->points, POINT_U, p), *x = point_real(m->points, POINT_X, p);
        PetscReal sigma[6];
        CALL(ModelPointStress(m, p, sigma));
        const PetscReal vertical = -1000 * 9.81 * (1.5 - x[1]);
        CHECK_CLOSE(sigma[1], vertical, 1);
        CHECK_CLOSE(sigma[0], 0.5 * vertical, 1);
        for (PetscInt d = 0; d < dim; ++d) worst = PetscMax(worst, PetscAbsReal(u[d]));
      }
      CHECK(worst < 1e-8, "%s, cell %d: the column moved by %g m", b.c.method, (int)cell, (double)worst);
      CALL(ModelDestroy(&m));
    }
}

/* Bad cases are refused with the path of the value. */
static void test_refused(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_motion(&b, 0, 0, MOTION_FIXED, 3);
  bench_motion(&b, 1, 0, MOTION_DISPLACEMENT, 2)->value[1] = 0.1;
  bench_refused(&b, PETSC_COMM_WORLD, "boundary[1]", "contradicts boundary[0]");
  b.motion[1].value[1] = 0; /* the same motion said twice is none */
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CALL(ModelDestroy(&m));
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_motion(&b, 0, 5, MOTION_FIXED, 3);
  bench_refused(&b, PETSC_COMM_WORLD, "boundary[0].on", "selects no node");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_motion(&b, -1, 0, MOTION_FIXED, 3)->on.boundary = "lft";
  bench_refused(&b, PETSC_COMM_WORLD, "boundary[0].on.boundary", "left");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_traction(&b, 0, 0.4, NULL, 1, 0, 0);
  bench_refused(&b, PETSC_COMM_WORLD, "loads.tractions[0].on", "no face");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  b.load[b.c.n_loads++] = (LoadSpec){.kind = LOAD_POINT, .at = {3, 0, 0}, .value = {1, 0, 0}};
  bench_refused(&b, PETSC_COMM_WORLD, "loads.points[0].at", "outside the grid");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_tracer(&b, "position", 0, 3, 0, 0);
  bench_refused(&b, PETSC_COMM_WORLD, "measures.tracer.of.tracer", "outside the grid");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_impulse),    cmocka_unit_test(test_turned_frame),   cmocka_unit_test(test_turned_body),
    cmocka_unit_test(test_rotation),   cmocka_unit_test(test_velocity_table), cmocka_unit_test(test_shared_corners),
    cmocka_unit_test(test_load_moves), cmocka_unit_test(test_geostatic),      cmocka_unit_test(test_refused),
    cmocka_unit_test(test_balance),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
