/* Numbers taken from the model: the free surface, run-out time, energies and their balance. */
#include "case_builder.h"

static PetscReal measure(Model *m, const MeasureSpec *spec, PetscInt index)
{
  PetscReal value;
  CALL(ModelMeasure(m, spec, index, &value));
  return value;
}

/* Points of a right triangle with its corner at the origin, 1 m wide and `height` high, on cells of
 * 0.1 m, four points a side of a cell. */
static Model *triangle(Bench *b, PetscReal height)
{
  static PetscReal vertices[6];
  bench_init(b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1.2, 0}, 0.1);
  b->body[0].points_per_cell = 16;
  b->body[0].fill = FILL_CELLS;           /* stairs, which flatten() makes exact */
  bench_motion(b, 1, 0, MOTION_FIXED, 7); /* statics wants it held */
  for (int k = 0; k < 6; ++k) vertices[k] = (PetscReal[]){0, 0, 1, 0, 0, height}[k];
  b->body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 3, .vertices = vertices};
  return bench_model(b, PETSC_COMM_WORLD);
}

/* The seeded triangle is stairs of whole cells; squeezing each column of points to the line y = 1 -
 * x makes the shape exact. Volumes change with the height that a column loses. */
static void flatten(Model *m)
{
  const PetscReal dx = 0.1;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal *x = point_real(m->points, POINT_X, p);
    const PetscReal factor = (1 - x[0]) / (1 - PetscFloorReal(x[0] / dx) * dx);
    x[1] *= factor;
    m->points->real[POINT_J][p] *= factor;
  }
}

static void test_surface_of_a_triangle(void **state)
{
  const PetscReal heights[] = {1, 0.5}, seeded[] = {1.01, 0.5}; /* no cell centre on the line */
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    Model *m = triangle(&b, seeded[k]);
    const MeasureSpec front = {.kind = "surface", .word = "front"},
                      slope = {.kind = "surface", .word = "slope", .body = "body"};
    if (heights[k] == 1) flatten(m);
    CHECK_CLOSE(measure(m, &front, 0), 1, 0.1 + 1e-9);
    for (PetscReal x = 0.2; x < 0.85; x += 0.05) {
      const MeasureSpec height = {.kind = "surface", .word = "height", .has_at = PETSC_TRUE, .at = x};
      CHECK_CLOSE(measure(m, &height, 0), heights[k] * (1 - x), heights[k] == 1 ? 5e-3 : 0.05);
    }
    for (PetscReal high = 0.1; high < 0.45; high += 0.05) {
      const MeasureSpec reach = {.kind = "surface", .word = "reach", .has_at = PETSC_TRUE, .at = high};
      CHECK_CLOSE(measure(m, &reach, 0), 1 - high / heights[k], heights[k] == 1 ? 5e-3 : 0.1);
    }
    CHECK_CLOSE(measure(m, &slope, 0), PetscAtanReal(heights[k]) * 180 / PETSC_PI, heights[k] == 1 ? 0.3 : 3);
    CALL(ModelDestroy(&m));
  }
}

/* A unit square of 4 x 4 cells with 4 points each: eight columns of points with an eighth of the
 * mass each. */
static void test_inner_extent(void **state)
{
  static const struct {
    PetscReal beyond;
    int column; /* counted from outside */
  } wanted[] = {{0, 0}, {0.124, 0}, {0.125, 1}, {0.2, 1}, {0.25, 2}, {0.5, 4}, {0.99, 7}};
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  b.body[0].points_per_cell = 4;
  bench_motion(&b, 1, 0, MOTION_FIXED, 7); /* statics wants it held */
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(wanted); ++k) {
    const PetscReal side = (wanted[k].column % 2 ? 0.5 : -0.5) / PetscSqrtReal(3);
    const int cell = wanted[k].column / 2;
    const PetscReal place = 0.25 * (cell + 0.5 + side); /* from the edge inwards */
    for (int axis = 0; axis < 2; ++axis) {
      const MeasureSpec high = {.kind = "extent", .component = axis, .maximum = PETSC_TRUE, .beyond = wanted[k].beyond};
      const MeasureSpec low = {.kind = "extent", .component = axis, .beyond = wanted[k].beyond, .body = "body"};
      CHECK_CLOSE(measure(m, &high, 0), 1 - place, 1e-9);
      CHECK_CLOSE(measure(m, &low, 0), place, 1e-9);
    }
  }
  CALL(ModelDestroy(&m));
}

/* A square of 16 x 16 equal points, of which 2.56 may lie beyond: its outermost row on every side, which round-off may
 * neither part nor take for two, wherever the grid ends. */
static void test_mirrored_extent(void **state)
{
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){-1, -1 - k, 0}, (PetscReal[]){2 + k, 2, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
    b.body[0].points_per_cell = 4;
    b.c.basis.kind = "gimp";
    bench_dynamic(&b, 0.01, 0.01);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    model_step(m, 0.01);
    for (int axis = 0; axis < 2; ++axis) {
      const MeasureSpec high = {.kind = "extent", .component = axis, .maximum = PETSC_TRUE, .beyond = 0.01};
      const MeasureSpec low = {.kind = "extent", .component = axis, .beyond = 0.01};
      CHECK_CLOSE(measure(m, &high, 0), 1 - 0.03125, 1e-12);
      CHECK_CLOSE(measure(m, &low, 0), 0.03125, 1e-12);
    }
    CALL(ModelDestroy(&m));
  }
}

/* The same square, stretched by hand: outermost points advance by what they move, inner ones by less. */
static void test_advance(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  b.body[0].points_per_cell = 4;
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal edge = 0.125 * (1 - 1 / PetscSqrtReal(3)); /* from a side to the outermost points */
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal *x = point_real(m->points, POINT_X, p), *u = point_real(m->points, POINT_U, p);
    u[0] = 0.1 * x[0] - 0.02;
    x[0] += u[0];
  }
  for (int k = 0; k < 2; ++k) {
    const PetscReal beyond = k ? 0.125 : 0, place = k ? 0.25 - edge : edge;
    MeasureSpec s = {.kind = "extent", .maximum = PETSC_TRUE, .advance = PETSC_TRUE, .beyond = beyond};
    CHECK_CLOSE(measure(m, &s, 0), 0.1 * (1 - place) - 0.02, 1e-9);
    s.maximum = PETSC_FALSE;
    CHECK_CLOSE(measure(m, &s, 0), 0.02 - 0.1 * place, 1e-9);
    s.component = 1;
    CHECK_CLOSE(measure(m, &s, 0), 0, 1e-9);
  }
  CALL(ModelDestroy(&m));
}

/* A disc of radius 1 and thickness 1, 4 x 4 cells with 4 points each, all round: the mass of a
 * column of points goes with its radius. Within which one all but a share of it lie is told by
 * adding up from outside. */
static void test_inner_extent_of_rings(void **state)
{
  PetscReal radius[8], total = 0;
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  b.c.kinematics = &kinematics_axisymmetric;
  b.body[0].points_per_cell = 4;
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int k = 0; k < 8; ++k) {
    radius[k] = 0.25 * (k / 2 + 0.5 + (k % 2 ? 0.5 : -0.5) / PetscSqrtReal(3));
    total += radius[k];
  }
  for (PetscReal beyond = 0.001; beyond < 1; beyond += 0.0173) {
    const MeasureSpec spec = {.kind = "extent", .maximum = PETSC_TRUE, .beyond = beyond};
    PetscReal outside = 0;
    int k = 7;
    while (outside + radius[k] <= beyond * total) outside += radius[k--];
    CHECK_CLOSE(measure(m, &spec, 0), radius[k], 1e-9);
  }
  CALL(ModelDestroy(&m));
}

/* A block is thrown along x and stopped by a prescribed amplitude: all its nodes move with v = 1
 * m/s until 0.1 s, then slow down linearly to rest at 0.2 s. Its front is slower than 0.25 m/s from
 * 0.175 s on. */
static void test_run_out_time(void **state)
{
  PetscReal time[] = {0, 0.1, 0.2}, value[] = {1, 1, 0};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    bench_init(&b, k ? "fem" : "mpm", CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 0}, 0.25);
    bench_box(&b, 0, (PetscReal[]){0.5, 0, 0}, (PetscReal[]){1, 0.5, 0});
    bench_dynamic(&b, 0.3, 5e-3);
    MotionSpec *motion = bench_motion(&b, 1, 0, MOTION_VELOCITY, 3);
    motion->on.min[1] = -1, motion->on.max[1] = 2;
    motion->value[0] = 1;
    motion->amplitude = (Amplitude){.n = 3, .time = time, .value = value};
    b.c.n_measures = 4;
    b.measure[0] = (MeasureSpec){.name = "right", .kind = "run_out_time", .maximum = PETSC_TRUE, .speed = 0.25};
    b.measure[1] = (MeasureSpec){.name = "left", .kind = "run_out_time", .speed = 0.25, .body = "body"};
    b.measure[2] = b.measure[0];
    b.measure[2].front = FRONT_SURFACE;
    b.measure[3] = b.measure[0];
    b.measure[3].beyond = 0.3; /* of a block that moves as one this place stops with the others */
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CHECK(measure(m, &b.measure[0], 0) == 0, "it moved before the start");
    while (m->time < 0.3 - 1e-9) model_step(m, 0.3 - m->time);
    CHECK_CLOSE(measure(m, &b.measure[0], 0), 0.175, 5e-3 + 1e-9);
    CHECK_CLOSE(measure(m, &b.measure[3], 3), 0.175, 5e-3 + 1e-9);
    CHECK(measure(m, &b.measure[1], 1) == 0, "the left side does not advance to the left");
    if (!k) CHECK_CLOSE(measure(m, &b.measure[2], 2), 0.175, 0.03);
    CALL(ModelDestroy(&m));
  }
}

/* J is det F while F is tame, and the stress is that of F. */
static void test_volume_ratio(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 4);
  bench_motion(&b, 0, 0, MOTION_FIXED, 3);
  bench_motion(&b, 0, 1, MOTION_DISPLACEMENT, 3)->value[0] = 0.3;
  b.c.analysis.step = b.c.analysis.largest = 0.25;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal F[9], sigma[6], expected[6];
    point_F(m->points, p, F);
    CHECK_CLOSE(m->points->real[POINT_J][p], tensor_det(F), 1e-14 * tensor_det(F));
    CALL(ModelPointStress(m, p, sigma));
    rubber_stress(F, expected);
    for (int k = 0; k < 6; ++k) CHECK_CLOSE(sigma[k], expected[k], 1e-12 * 1e6);
  }
  CALL(ModelDestroy(&m));
}

static Energies energies(Model *m)
{
  Energies e;
  CALL(ModelEnergies(m, &e));
  return e;
}

static PetscReal balance(Model *m) { return model_sum(m, "energy: balance", 0); }

/* A block held at its foot is thrown against itself. */
static Model *thrown(Bench *b, const char *method, PetscReal dt)
{
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2.5, 2, 0}, 0.125);
  bench_box(b, 0, (PetscReal[]){0.25, 0, 0}, (PetscReal[]){1.25, 1, 0});
  bench_motion(b, 1, 0, MOTION_FIXED, 3);
  b->c.method = (char *)method;
  b->body[0].velocity[0] = 3;
  b->body[0].velocity[1] = -3;
  b->c.gravity[1] = -9.81;
  bench_dynamic(b, 0.1, dt);
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Largest imbalance on the way to the end. */
static PetscReal worst_balance(Model *m)
{
  PetscReal worst = 0;
  while (m->time < m->c->analysis.end - 1e-9) {
    model_step(m, m->c->analysis.end - m->time);
    worst = PetscMax(worst, PetscAbsReal(balance(m)));
  }
  return worst;
}

/* All energy goes back and forth between motion, stress and gravity: what the trapezoidal rule
 * calls dissipated is its own error, and vanishes with the square of the step. */
static void test_elastic_balance(void **state)
{
  PetscReal worst[2], apparent[2];
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    bench_init(&b, "fem", CELL_QUADRILATERAL, 0);
    Model *m = thrown(&b, "fem", k ? 1e-3 : 2e-3);
    worst[k] = worst_balance(m);
    const Energies e = energies(m);
    apparent[k] = PetscAbsReal(e.dissipated) / e.start;
    PetscPrintf(PETSC_COMM_WORLD,
                "elastic, fem, dt %g s: start %g, kinetic %g, elastic %g, dissipated %g, external %g, transfer %g, "
                "imbalance %.3g\n",
                k ? 1e-3 : 2e-3, (double)e.start, (double)e.kinetic, (double)e.elastic, (double)e.dissipated,
                (double)e.external, (double)e.transfer, (double)worst[k]);
    CHECK(e.elastic > 0.05 * e.start, "the block is rigid");
    CALL(ModelDestroy(&m));
  }
  CHECK(worst[0] < 1e-9 && worst[1] < 1e-9, "imbalance %g and %g", (double)worst[0], (double)worst[1]);
  CHECK(apparent[0] < 0.01 && apparent[1] < 0.35 * apparent[0], "apparent dissipation %g and %g", (double)apparent[0],
        (double)apparent[1]);
}

/* The same block of a metal that yields: half of the energy and more is dissipated, never given
 * back. */
static void plastic(Bench *b)
{
  static NamedValue constants[] = {{"young", 1e6}, {"poisson", 0.3}, {"yield_stress", 1e4}};
  bench_init(b, "fem", CELL_QUADRILATERAL, 0);
  b->material.law = "j2";
  b->material.n_parameters = 3;
  b->material.parameters = constants;
}

static void test_plastic_balance(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    PetscReal last = 0, worst = 0;
    plastic(&b);
    b.c.analysis.damping = 1;
    b.c.analysis.bossak = 0;
    Model *m = thrown(&b, k ? "mpm" : "fem", 2e-3);
    while (m->time < 0.1 - 1e-9) {
      model_step(m, 0.1 - m->time);
      const PetscReal now = model_sum(m, "energy: dissipated", 0);
      CHECK(now > last - 2e-3 * m->start_energy, "dissipated %g after %g J", (double)now, (double)last);
      last = now;
      worst = PetscMax(worst, PetscAbsReal(balance(m)));
    }
    const Energies e = energies(m);
    PetscPrintf(PETSC_COMM_WORLD,
                "plastic, %s: start %g, kinetic %g, elastic %g, dissipated %g, damped %g, external %g, transfer %g, "
                "imbalance %.3g\n",
                m->method->name, (double)e.start, (double)e.kinetic, (double)e.elastic, (double)e.dissipated,
                (double)e.damped, (double)e.external, (double)e.transfer, (double)worst);
    CHECK(e.dissipated > 0.3 * e.start && e.damped > 0, "nothing yields");
    CHECK(worst < 1e-6, "imbalance %g", (double)worst);
    /* the lowest row of cells is stopped at its foot at once and keeps a third of its energy; what damped it before is
     * out of balance in the first step */
    if (!k) CHECK_CLOSE(e.transfer, 2. / 3 * 0.125 * 9000, 1e-4 * e.start);
    CALL(ModelDestroy(&m));
  }
}

/* Simple shear of perfectly plastic metal by gamma: tau = sigma_y / sqrt 3 after gamma_y = tau / G,
 * so that tau (gamma - gamma_y) per volume is dissipated and tau gamma_y / 2 stored; the boundary
 * does the work. */
static void test_shear_dissipation(void **state)
{
  const PetscReal tau = 1e4 / PetscSqrtReal(3), G = 1e6 / 2.6, gamma = 0.06, yield = tau / G;
  Bench b;
  (void)state;
  plastic(&b);
  b.c.grid.counts[0] = b.c.grid.counts[1] = 2;
  b.c.grid.max[0] = b.c.grid.max[1] = 1;
  for (int axis = 0; axis < 2; ++axis) bench_motion(&b, axis, axis, MOTION_FIXED, 2);
  b.c.n_boundary = 0;
  MotionSpec *flat = bench_motion(&b, 1, 0.5, MOTION_FIXED, 2); /* no vertical motion anywhere */
  flat->on.min[1] = -1, flat->on.max[1] = 2;
  bench_motion(&b, 1, 0, MOTION_FIXED, 1);
  bench_motion(&b, 1, 0.5, MOTION_DISPLACEMENT, 1)->value[0] = gamma / 2;
  bench_motion(&b, 1, 1, MOTION_DISPLACEMENT, 1)->value[0] = gamma;
  b.c.analysis.step = b.c.analysis.largest = 0.02;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
  const Energies e = energies(m);
  CHECK_CLOSE(e.dissipated, tau * (gamma - yield), 0.01 * tau * gamma);
  CHECK_CLOSE(e.elastic, 0.5 * tau * yield, 0.01 * tau * yield);
  CHECK_CLOSE(e.boundary, e.dissipated + e.elastic, 1e-6 * e.boundary);
  const MeasureSpec of_body = {.kind = "energy", .word = "dissipated", .body = "body"};
  CHECK_CLOSE(measure(m, &of_body, 0), e.dissipated, 1e-12 * e.dissipated);
  CALL(ModelDestroy(&m));
}

/* Dead load on rubber in one static step: the load grows with the step, its work is half of force
 * times way and is stored. */
static void test_static_work(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    bench_init(&b, k ? "mpm" : "fem", CELL_QUADRILATERAL, 2);
    if (k) bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 0}, 0.5);
    bench_motion(&b, 0, 0, MOTION_FIXED, 1);
    bench_motion(&b, 1, 0, MOTION_FIXED, 2);
    bench_traction(&b, 0, 1, "body", 1000, 0, 0);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    model_step(m, 1);
    const Energies e = energies(m);
    const PetscReal u = 1000 * (1 - 0.09) / 1e6; /* plane strain */
    CHECK_CLOSE(e.external, 0.5 * 1000 * u, 0.005 * 1000 * u);
    CHECK_CLOSE(e.elastic, e.external, 0.005 * e.external);
    CHECK(PetscAbsReal(balance(m)) < 1e-3, "imbalance %g", (double)balance(m));
    CALL(ModelDestroy(&m));
  }
}

/* A block hits a wall of fixed nodes in mpm: what the impact and the transfers take is told to the
 * last digit. A boundary that drives material does the work of its impulses, and loses the half of
 * it that an inelastic impact loses. */
static void test_impact_is_told(void **state)
{
  (void)state;
  for (int driven = 0; driven < 2; ++driven) {
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){0.25, 0.25, 0}, (PetscReal[]){0.75, 0.75, 0});
    if (driven) bench_motion(&b, 0, 0.25, MOTION_VELOCITY, 1)->value[0] = 2;
    else {
      bench_motion(&b, 0, 1.5, MOTION_FIXED, 1);
      b.body[0].velocity[0] = 5;
    }
    bench_dynamic(&b, driven ? 0.05 : 0.2, 2e-3);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const PetscReal worst = worst_balance(m);
    const Energies e = energies(m);
    PetscPrintf(PETSC_COMM_WORLD,
                "%s: start %g, kinetic %g, elastic %g, dissipated %g, boundary %g, transfer %g, imbalance %.3g\n",
                driven ? "driven" : "impact", (double)e.start, (double)e.kinetic, (double)e.elastic,
                (double)e.dissipated, (double)e.boundary, (double)e.transfer, (double)worst);
    CHECK(worst < 1e-6, "imbalance %g", (double)worst);
    CHECK(e.transfer > 0, "an impact that gives energy");
    if (driven) CHECK(e.boundary > 0, "the boundary takes energy");
    CALL(ModelDestroy(&m));
  }
}

/* A block flies out of the grid and is forgotten: its energy goes with it. */
static void test_removed_points(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 0}, 0.125);
  bench_box(&b, 0, (PetscReal[]){1.25, 0.25, 0}, (PetscReal[]){1.75, 0.75, 0});
  b.body[0].velocity[0] = 5;
  b.c.grid.outside = OUTSIDE_REMOVE;
  bench_dynamic(&b, 0.1, 4e-3);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal worst = worst_balance(m);
  const Energies e = energies(m);
  CHECK(e.kinetic > 0 && e.kinetic < 0.6 * e.start, "half of the block should be gone");
  CHECK_CLOSE(e.kinetic + e.transfer + e.outside, e.start, 1e-9 * e.start);
  CHECK_CLOSE(e.transfer, 0, 1e-9 * e.start);
  CHECK(worst < 1e-9, "imbalance %g", (double)worst);
  CALL(ModelDestroy(&m));
}

/* All ranks together against each alone. */
static void test_ranks_agree(void **state)
{
  static const char *const kinds[] = {"energy: dissipated", "energy: external", "energy: damped", "energy: transfer",
                                      "energy: balance",    "surface: front",   "surface: slope", "run_out_time"};
  Bench b;
  PetscReal value[2];
  (void)state;
  for (int fem = 0; fem < 2; ++fem) {
    plastic(&b);
    b.c.analysis.damping = 2;
    b.c.n_measures = 1;
    b.measure[0] = (MeasureSpec){.name = "stop", .kind = "run_out_time", .maximum = PETSC_TRUE, .speed = 3};
    Model *all = thrown(&b, fem ? "fem" : "mpm", 2e-3), *alone;
    Diag *diag;
    CALL(DiagCreate(&diag));
    CALL(ModelCreate(PETSC_COMM_SELF, &b.c, diag, &alone));
    CALL(DiagDestroy(&diag));
    for (int s = 0; s < 20; ++s) {
      model_step(all, 1);
      model_step(alone, 1);
    }
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
      value[0] = model_sum(all, kinds[k], 0);
      value[1] = model_sum(alone, kinds[k], 0);
      CHECK_CLOSE(value[0], value[1], 1e-7 * (1e-3 + PetscAbsReal(value[1])));
    }
    CHECK(value[1] > 0, "the front did not move");
    CALL(ModelDestroy(&all));
    CALL(ModelDestroy(&alone));
  }
}

/* Give the points of triangles a pressure: 0 uniform, 1 linear, 2 of both signs by turns. */
static PetscReal roughness(int kind, PetscInt cells_per_side)
{
  Bench b;
  bench_init(&b, "fem", CELL_TRIANGLE, cells_per_side);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7); /* statics wants it held */
  b.body[0].points_per_cell = 1;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal x = point_real(m->points, POINT_X, p)[0];
    const PetscReal turn = m->grid->global_cell[m->points->cell[p]] % 2 ? 1 : -1;
    const PetscReal pressure = kind == 0 ? 7 : kind == 1 ? 7 * x : 7 * turn;
    point_set_tau(m->points, p, (PetscReal[]){-pressure - 2, -pressure + 3, -pressure - 1, 5, 0, 0});
  }
  const PetscReal value = model_sum(m, "roughness: pressure", 0);
  CALL(ModelDestroy(&m));
  return value;
}

/* The oscillation that triangles of equal order leave free: 1, -1, 0 at the nodes of each, nothing
 * at their centres. */
static PetscReal nodal_roughness(PetscReal constant, PetscReal amplitude)
{
  Bench b;
  bench_init(&b, "fem", CELL_TRIANGLE, 6);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7); /* statics wants it held */
  b.c.formulation = (char *)"mixed";
  b.body[0].points_per_cell = 1;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i) {
    const PetscInt colour = (PetscInt)(6 * (m->grid->x[2 * i] + m->grid->x[2 * i + 1]) + 0.5) % 3;
    m->nodes->scaled_pressure[i] = constant + amplitude * (PetscReal)(colour - 1);
  }
  const PetscReal value = model_sum(m, "roughness: pressure", 0);
  CALL(ModelDestroy(&m));
  return value;
}

static void test_roughness(void **state)
{
  (void)state;
  CHECK_CLOSE(roughness(0, 4), 0, 1e-14);
  CHECK(roughness(1, 4) < 0.1, "a linear pressure is smooth");
  CHECK(roughness(1, 8) < 0.5 * roughness(1, 4), "and smoother on finer cells");
  /* inside, six triangles about a node cancel; at the rim each node sees two of one sign and one of
   * the other */
  CHECK_CLOSE(roughness(2, 8), 1, 0.05);
  CHECK_CLOSE(nodal_roughness(0, 3), 1, 1e-14);
  CHECK_CLOSE(nodal_roughness(3, 0), 0, 1e-14);
  CHECK(nodal_roughness(3, 0.1) < 0.05, "a ripple on a large pressure");
  CHECK_CLOSE(roughness(2, 16), 1, 0.5 * PetscAbsReal(roughness(2, 8) - 1));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_inner_extent),
    cmocka_unit_test(test_mirrored_extent),
    cmocka_unit_test(test_advance),
    cmocka_unit_test(test_inner_extent_of_rings),
    cmocka_unit_test(test_run_out_time),
    cmocka_unit_test(test_volume_ratio),
    cmocka_unit_test(test_elastic_balance),
    cmocka_unit_test(test_plastic_balance),
    cmocka_unit_test(test_shear_dissipation),
    cmocka_unit_test(test_static_work),
    cmocka_unit_test(test_impact_is_told),
    cmocka_unit_test(test_removed_points),
    cmocka_unit_test(test_ranks_agree),
    cmocka_unit_test(test_roughness),
    cmocka_unit_test(test_surface_of_a_triangle),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
