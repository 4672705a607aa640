/* Measures of powders, against geometry: content of shapes and its rate, free surface, centre of
 * mass. */
#include "case_builder.h"
#include "model/measure/measure.h"

static PetscReal measure(Model *m, const MeasureSpec *spec, PetscInt index)
{
  PetscReal value;
  CALL(ModelMeasure(m, spec, index, &value));
  return value;
}

/* A square of 2 m about the origin full of points; statics wants it held. */
static Model *square(Bench *b, PetscInt points_per_cell, PetscInt n)
{
  bench_init(b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){-1, -1, 0}, (PetscReal[]){1, 1, 0}, 2. / (PetscReal)n);
  bench_box(b, 0, (PetscReal[]){-1, -1, 0}, (PetscReal[]){1, 1, 0});
  b->body[0].points_per_cell = points_per_cell;
  b->body[0].weights = WEIGHTS_EQUAL;
  bench_motion(b, -1, 0, MOTION_FIXED, 3);
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Area left of x = e: exact within a 31st of a column of points wherever e is, and the two sides of
 * any line make the whole. */
static void test_half_planes(void **state)
{
  Bench b;
  (void)state;
  Model *m = square(&b, 9, 20);
  const PetscReal column = 2. / 60;
  for (int k = 0; k < 41; ++k) {
    const PetscReal e = -0.5 + 0.0271 * k, angle = 0.15 * k;
    MeasureSpec left = {.kind = "volume", .word = "undeformed", .has_in = PETSC_TRUE};
    left.in = (Shape){.kind = SHAPE_HALF_SPACE, .point = {e}, .normal = {1}};
    CHECK_CLOSE(measure(m, &left, 0), 2 * (1 + e), 2 * column * 0.2);
    left.in.normal[0] = PetscCosReal(angle), left.in.normal[1] = PetscSinReal(angle);
    MeasureSpec right = left;
    for (int d = 0; d < 2; ++d) right.in.normal[d] *= -1;
    CHECK_CLOSE(measure(m, &left, 0) + measure(m, &right, 0), 4, 1e-12);
  }
  CALL(ModelDestroy(&m));
}

/* What lies in a disc or a ball off the middle of a symmetric body is what lies in its image, in mirrors and where axes
 * are changed. */
static void test_images(void **state)
{
  (void)state;
  for (int dim = 2; dim <= 3; ++dim) {
    Bench b;
    bench_init(&b, "mpm", dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){-1, -1, -1}, (PetscReal[]){1, 1, 1}, 0.2);
    bench_box(&b, 0, (PetscReal[]){-1, -1, -1}, (PetscReal[]){1, 1, 1});
    bench_motion(&b, -1, 0, MOTION_FIXED, 7);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    PetscReal first = 0;
    for (int image = 0; image < 6 << dim; ++image) {
      static const int order[6][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
      const PetscReal centre[3] = {0.113, -0.077, 0.051};
      MeasureSpec in = {.kind = "volume", .word = "undeformed", .has_in = PETSC_TRUE};
      if (dim == 2 && image % 6 > 1) continue; /* others move z */
      in.in = (Shape){.kind = SHAPE_BALL, .radius = 0.63};
      for (int d = 0; d < dim; ++d) in.in.centre[order[image % 6][d]] = (image / 6 >> d & 1 ? -1 : 1) * centre[d];
      const PetscReal volume = measure(m, &in, 0);
      if (!image) first = volume;
      CHECK_CLOSE(volume, first, 1e-12);
    }
    CALL(ModelDestroy(&m));
  }
}

/* Mass of a disc, its momentum and energy in a body that moves with (3, 4) m/s; a body by name. */
static void test_disc(void **state)
{
  const PetscReal area = PETSC_PI * 0.7 * 0.7;
  Bench b;
  (void)state;
  Model *m = square(&b, 4, 20);
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (int d = 0; d < 2; ++d) point_real(m->points, POINT_V, p)[d] = 3 + d;
  const Shape disc = {.kind = SHAPE_BALL, .centre = {0.11, -0.07}, .radius = 0.7};
  const MeasureSpec mass = {.kind = "mass", .word = "total", .has_in = PETSC_TRUE, .in = disc, .body = "body"},
                    momentum = {.kind = "momentum", .component = 1, .has_in = PETSC_TRUE, .in = disc},
                    energy = {.kind = "energy", .word = "kinetic", .has_in = PETSC_TRUE, .in = disc};
  const PetscReal kg = measure(m, &mass, 0);
  CHECK_CLOSE(kg, 1000 * area, 2e-3 * 1000 * area);
  CHECK_CLOSE(measure(m, &momentum, 0), 4 * kg, 1e-9 * kg);
  CHECK_CLOSE(measure(m, &energy, 0), 12.5 * kg, 1e-9 * kg);
  CALL(ModelDestroy(&m));
}

/* Full circles: a ball about the axis in a cylinder; in space the same ball. Current volume follows
 * J. */
static void test_balls(void **state)
{
  const PetscReal ball = 4. / 3 * PETSC_PI * 0.6 * 0.6 * 0.6;
  (void)state;
  for (int space = 0; space < 2; ++space) {
    Bench b;
    bench_init(&b, "mpm", space ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 0);
    if (!space) b.c.kinematics = &kinematics_axisymmetric;
    bench_grid(&b, (PetscReal[]){space ? -1 : 0, -1, -1}, (PetscReal[]){1, 1, 1}, 0.1);
    bench_box(&b, 0, b.c.grid.min, b.c.grid.max);
    b.body[0].weights = WEIGHTS_GAUSS;
    bench_motion(&b, -1, 0, MOTION_FIXED, 7);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    MeasureSpec volume = {.kind = "volume", .word = "undeformed", .has_in = PETSC_TRUE};
    volume.in = (Shape){.kind = SHAPE_BALL, .radius = 0.6};
    CHECK_CLOSE(measure(m, &volume, 0), ball, 5e-3 * ball);
    for (PetscInt p = 0; p < m->points->n; ++p) m->points->real[POINT_J][p] = 1.25;
    MeasureSpec now = {.kind = "volume", .word = "current", .has_in = PETSC_TRUE, .in = volume.in};
    CHECK_CLOSE(measure(m, &now, 0), 1.25 * measure(m, &volume, 0), 1e-12);
    CALL(ModelDestroy(&m));
  }
}

/* A block falls through a plane: the mass above it goes at the rate density x width x speed. A line
 * of least squares through a parabola has the slope of its middle. */
static void test_rate(void **state)
{
  const PetscReal g = 10, width = 0.6, kg_per_m = 1000 * width;
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 2, 0}, 0.05);
  bench_box(&b, 0, (PetscReal[]){0.2, 1.2, 0}, (PetscReal[]){0.2 + width, 1.8, 0});
  bench_dynamic(&b, 0.35, 1e-3);
  b.c.gravity[1] = -g;
  const Shape above = {.kind = SHAPE_HALF_SPACE, .point = {0, 1.19}, .normal = {0, -1}};
  for (int k = 0; k < 4; ++k)
    b.measure[k] = (MeasureSpec){.name = "flow",
                                 .kind = "mass",
                                 .word = "total",
                                 .has_in = PETSC_TRUE,
                                 .in = above,
                                 .has_rate = k < 3,
                                 .has_mean = k == 3,
                                 .window = {k < 2 ? 0.08 : 0.15, k < 2 ? 0.08 : 0.25}};
  b.measure[1].has_in = PETSC_FALSE; /* of all: nothing is lost */
  b.c.n_measures = 4;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CHECK(PetscIsNanReal(measure(m, &b.measure[0], 0)), "one value has a rate");
  PetscReal noise = 0;
  while (m->time < 0.3 - 1e-9) {
    model_step(m, 0.3 - m->time);
    if (m->time < 0.15) continue; /* five rows of points in a window, and more */
    noise = PetscMax(noise, PetscAbsReal(measure(m, &b.measure[0], 0) / (kg_per_m * g * (m->time - 0.04)) + 1));
  }
  PetscPrintf(PETSC_COMM_WORLD, "rate through a plane over 0.08 s: within %.2g, over 0.1 s: off by %.2g\n",
              (double)noise, (double)(measure(m, &b.measure[2], 2) / (kg_per_m * g * 0.2) + 1));
  CHECK(noise < 0.04, "%g", (double)noise);
  CHECK_CLOSE(measure(m, &b.measure[2], 2), -kg_per_m * g * 0.2, 0.01 * kg_per_m * g * 0.2);
  CHECK_CLOSE(measure(m, &b.measure[1], 1), 0, 1e-9);
  /* of 0.61 m - g t^2 / 2 from 0.15 to 0.25 s */
  CHECK_CLOSE(measure(m, &b.measure[3], 3), kg_per_m * (0.61 - g / 2 * 0.0408333), 0.005 * kg_per_m);
  CALL(ModelDestroy(&m));
}

/* Turn all points about the origin, so that they are on no line of any grid. */
static void turn_points(Model *m, PetscReal angle)
{
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal *x = point_real(m->points, POINT_X, p), old[2] = {x[0], x[1]};
    x[0] = c * old[0] - s * old[1];
    x[1] = s * old[0] + c * old[1];
  }
}

/* Leave of the points what is in the drum, below a chord that falls towards +x by `angle` at the
 * distance `below` its centre; of points at the edge a part, so that the lattice makes no stairs. */
static void fill_drum(Model *m, PetscReal radius, PetscReal angle, PetscReal below)
{
  PetscBool *drop;
  CALL(PetscMalloc1(m->points->n, &drop));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), side = PetscSqrtReal(m->points->real[POINT_VOLUME][p]);
    PetscInt inside = 0;
    for (int k = 0; k < 49; ++k) {
      const PetscReal at[2] = {x[0] + side * ((k % 7 + 0.5) / 7 - 0.5), x[1] + side * ((k / 7 + 0.5) / 7 - 0.5)};
      inside += at[0] * at[0] + at[1] * at[1] <= radius * radius &&
                at[0] * PetscSinReal(angle) + at[1] * PetscCosReal(angle) <= -below;
    }
    drop[p] = inside == 0;
    m->points->real[POINT_J][p] *= inside / 49.;
    m->points->real[POINT_MASS][p] *= inside / 49.;
  }
  CALL(PointsCompact(m->points, drop));
  CALL(PetscFree(drop));
}

/* A drum as full as that of a powder analyser, at all inclinations up to overhanging ones, two
 * seedings. */
static void test_inclination(void **state)
{
  PetscReal worst = 0, worst_mass = 0, rough = 0;
  (void)state;
  for (int k = -8; k <= 40; ++k) {
    const PetscReal angle = 2.5 * k, radian = angle * PETSC_PI / 180;
    Bench b;
    Model *m = square(&b, k % 2 ? 9 : 4, k % 2 ? 33 : 48);
    turn_points(m, 0.37 * k);
    fill_drum(m, 0.97 / PetscSqrtReal(2), radian, 0.15);
    /* beyond 80 deg what is steep is found from the centre of mass alone */
    const MeasureSpec surface = {.kind = "free_surface", .word = "inclination", .has_about = k > 32},
                      deviation = {.kind = "free_surface", .word = "deviation", .has_about = k > 32},
                      mass = {.kind = "centre_of_mass", .word = "angle", .has_about = PETSC_TRUE},
                      height = {.kind = "centre_of_mass", .word = "height", .has_about = PETSC_TRUE};
    /* of a segment of the circle, 0.15 below its centre */
    const PetscReal radius = 0.97 / PetscSqrtReal(2), half = PetscSqrtReal(radius * radius - 0.15 * 0.15);
    const PetscReal area = radius * radius * PetscAcosReal(0.15 / radius) - 0.15 * half;
    CHECK_CLOSE(measure(m, &height, 0), -2 * half * half * half / (3 * area) * PetscCosReal(radian), 0.002);
    worst = PetscMax(worst, PetscAbsReal(measure(m, &surface, 0) - angle));
    worst_mass = PetscMax(worst_mass, PetscAbsReal(measure(m, &mass, 0) - angle));
    rough = PetscMax(rough, measure(m, &deviation, 0));
    CALL(ModelDestroy(&m));
  }
  PetscPrintf(PETSC_COMM_WORLD,
              "inclinations -20 to 100 deg: surface within %.2g, centre of mass %.2g deg, deviation %.2g m\n",
              (double)worst, (double)worst_mass, (double)rough);
  CHECK(worst < 0.2, "%g deg", (double)worst);
  CHECK(worst_mass < 0.2, "%g deg", (double)worst_mass);
  CHECK(rough < 0.003, "%g m", (double)rough);
}

/* The surface above stations of a bed with a straight slope; rain above it is not its surface. */
static void test_elevation(void **state)
{
  Bench b;
  (void)state;
  Model *m = square(&b, 9, 40);
  turn_points(m, 0.3);
  fill_drum(m, 0.95, 0.5, 0.1);
  for (int rain = 0; rain < 2; ++rain) {
    for (PetscReal x = -0.6; x < 0.61; x += 0.1) {
      const MeasureSpec top = {.kind = "free_surface", .word = "elevation", .has_at = PETSC_TRUE, .at = x};
      CHECK_CLOSE(measure(m, &top, 0), (-0.1 - x * PetscSinReal(0.5)) / PetscCosReal(0.5), 0.01);
    }
    const MeasureSpec surface = {.kind = "free_surface", .word = "inclination", .middle = 0.7};
    CHECK_CLOSE(measure(m, &surface, 0), 0.5 * 180 / PETSC_PI, 0.3);
    for (PetscInt p = 0; p < m->points->n; ++p)
      if (m->points->id[p] % 37 == 0)
        point_real(m->points, POINT_X, p)[1] = 0.9 - 0.01 * (PetscReal)(m->points->id[p] % 13);
  }
  CALL(ModelDestroy(&m));
}

/* The row of a push of test_avalanches. Velocities are means of steps. */
static void check_push(const PetscReal *event, PetscReal begin, PetscReal moved, PetscReal dt)
{
  const PetscReal way = 0.06 - 0.01 * 0.283 * 0.283;
  CHECK_CLOSE(event[0], begin + 0.00283, 1.5 * dt + 1e-9);
  CHECK_CLOSE(event[1], begin + 0.07 - 0.00283, 1.5 * dt + 1e-9);
  CHECK_CLOSE(event[6], moved, 1e-6);
  CHECK_CLOSE(event[7], 1000 * way, 1000 * 2 * dt);
  CHECK_CLOSE(event[8], 250, 1);
}

/* A block of 500 kg is pushed along x twice: all its nodes have v = 1 m/s for 0.05 s, with ramps of
 * 0.01 s. Its energy passes 20 J on the way up and down at v = 0.283; gravity of 2 m/s2 along x does 1000 N
 * times the way. Motion that a container shares is none. */
static void test_avalanches(void **state)
{
  PetscReal time[] = {0, 0.02, 0.03, 0.08, 0.09, 0.2, 0.21, 0.26, 0.27}, value[] = {0, 0, 1, 1, 0, 0, 1, 1, 0};
  const PetscReal dt = 1e-3;
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 0}, 0.25);
  bench_box(&b, 0, (PetscReal[]){0.5, 0, 0}, (PetscReal[]){1, 0.5, 0});
  b.material.density = 2000;
  b.c.gravity[0] = 2;
  bench_dynamic(&b, 0.4, dt);
  MotionSpec *motion = bench_motion(&b, 1, 0, MOTION_VELOCITY, 3);
  motion->on.min[1] = -1, motion->on.max[1] = 2;
  motion->value[0] = 1;
  motion->amplitude = (Amplitude){.n = 9, .time = time, .value = value};
  const AvalancheSpec slides = {.kinetic = 60, .ends = 1. / 3, .calm = 0.02, .carried = 0.05};
  b.c.n_measures = 6;
  for (int k = 0; k < 6; ++k)
    b.measure[k] = (MeasureSpec){
      .name = "slides", .kind = k == 3 ? "agitation" : "avalanches", .word = "number", .avalanche = slides};
  b.measure[1].avalanche.from = 0.15;   /* the second alone */
  b.measure[1].avalanche.carried = 0.1; /* nothing comes so far */
  b.measure[2].avalanche = (AvalancheSpec){.has_container = PETSC_TRUE, .times = 0.01, .ends = 0.5, .creep = 0.1};
  b.measure[3].avalanche.has_container = PETSC_TRUE;
  b.measure[4].word = "after";
  b.measure[5].avalanche.least = 501; /* more than there is */
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.15) model_step(m, 0.15 - m->time);
  CHECK(measure(m, &b.measure[0], 0) == 1 && measure(m, &b.measure[1], 1) == 0, "events at 0.15 s");
  while (m->time < 0.24) {
    model_step(m, 0.24 - m->time);
    CHECK(m->time < 0.208 || m->time > 0.239 || measure_under_way(m, 0, &(PetscReal){0}), "no event at %g",
          (double)m->time);
    const PetscReal agitation = measure(m, &b.measure[3], 3);
    CHECK(PetscIsNanReal(agitation) || agitation < 1e-2, "agitation %g", (double)agitation);
  }
  while (m->time < 0.4 - 1e-9) model_step(m, 0.4 - m->time);
  CHECK(measure_n_events(m, 5) == 0, "an event of 500 kg counts, though 501 are asked for");
  CHECK(measure_n_events(m, 0) == 2 && measure_n_events(m, 1) == 1 && measure_n_events(m, 2) == 0,
        "%d, %d, %d events at the end", (int)measure_n_events(m, 0), (int)measure_n_events(m, 1),
        (int)measure_n_events(m, 2));
  for (int k = 0; k < 2; ++k) ((PetscReal *)measure_event(m, 4, k))[3] = 36 + 4 * k;
  CHECK_CLOSE(measure(m, &b.measure[4], 4), 38, 1e-12);
  check_push(measure_event(m, 0, 0), 0.02, 500, dt);
  check_push(measure_event(m, 0, 1), 0.2, 500, dt);
  check_push(measure_event(m, 1, 0), 0.2, 0, dt);
  CALL(ModelDestroy(&m));
}

/* What no point can ever reach is a mistake. */
static void test_nowhere(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  b.c.n_measures = 1;
  b.measure[0] = (MeasureSpec){.name = "far", .kind = "mass", .word = "total", .has_in = PETSC_TRUE};
  b.measure[0].in = (Shape){.kind = SHAPE_BOX, .min = {0, 1.5}, .max = {1, 2}};
  bench_refused(&b, PETSC_COMM_WORLD, "measures.far.in", "outside the grid");
  b.measure[0] =
    (MeasureSpec){.name = "far", .kind = "free_surface", .word = "elevation", .has_at = PETSC_TRUE, .at = -1};
  bench_refused(&b, PETSC_COMM_WORLD, "measures.far.at", "outside the grid");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_half_planes), cmocka_unit_test(test_images),     cmocka_unit_test(test_disc),
    cmocka_unit_test(test_balls),       cmocka_unit_test(test_rate),       cmocka_unit_test(test_inclination),
    cmocka_unit_test(test_elevation),   cmocka_unit_test(test_avalanches), cmocka_unit_test(test_nowhere)};
  return run_model_tests_in_turns(argc, argv, tests);
}
