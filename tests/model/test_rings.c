/* Bodies of revolution beyond cylinders at rest: the sphere, whose pole and equator must agree;
 * motion (breathing, free flight), weight, clouds. */
#include "axisymmetric.h"

static NamedValue sand_constants[] = {
  {"young", 1e6}, {"poisson", 0.3}, {"friction_angle", 31}, {"dilatancy_angle", 1}, {"cohesion", 0}};

/* --- O5: a thick sphere, 1 to 2 m, half of it above y = 0 --- */
typedef struct {
  PetscReal radius; /* of the inner surface, at the end */
} Inflation;

static const Shape upper_half = {.kind = SHAPE_HALF_SPACE, .normal = {0, -1}};

/* Squares of the box [1, 2] x [0, 1] become cells of a quarter ring. */
static void bend(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  const PetscReal radius = x[0], angle = x[1] * PETSC_PI / 2;
  (void)context, (void)dim, (void)size;
  x[0] = x[1] == 1 ? 0 : radius * PetscCosReal(angle);
  x[1] = radius * PetscSinReal(angle);
}

static void inflate(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  const PetscReal growth = ((const Inflation *)context)->radius - 1, size = PetscSqrtReal(x[0] * x[0] + x[1] * x[1]);
  const PetscBool inner = PetscAbsReal(size - 1 - t0 * growth) < 1e-6;
  for (int d = 0; d < 2; ++d) increment[d] = inner ? (t1 - t0) * growth * x[d] / size : 0;
}

/* Inflate it, n cells through the wall: outer radius at equator and pole, and the nominal stress
 * inside from the axial force on the half. */
static void inflated(PetscInt n, PetscReal radius, PetscReal outer[2], PetscReal *stress)
{
  Bench b;
  Inflation inflation = {radius};
  tube(&b, "fem", CELL_QUADRILATERAL, 1, 2, 1, n);
  b.c.grid.counts[1] = 2 * n;
  b.body[0].shape = upper_half;
  bench_mesh(&b, bend, NULL);
  tube_moved(&b, 1, 0, 1, 0);
  for (int at_equator = 0; at_equator < 2; ++at_equator) {
    MotionSpec *motion = bench_motion(&b, -1, 0, MOTION_FIXED, at_equator ? 1 : 3);
    motion->on.has[1] = motion->on.has_shape = PETSC_TRUE;
    motion->on.min[1] = at_equator ? 0 : 1e-3;
    motion->on.max[1] = at_equator ? 0 : 1;
    motion->on.shape = (Shape){.kind = SHAPE_BALL, .radius = 1};
  }
  b.c.analysis.step = b.c.analysis.largest = 0.25;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = inflate;
  m->boundary->field_context = &inflation;
  PetscReal *X = node_places(m);
  run_through(m);
  outer[0] = moved_to(m, X, 2, 0, 0);
  outer[1] = moved_to(m, X, 0, 2, 1);
  *stress = -reaction(m, 1, 1) / PETSC_PI;
  CALL(PetscFree(X));
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_sphere(void **state)
{
  static const PetscReal radius[] = {1.1, 1.5}, outer[] = {2.039401210, 2.234704681},
                         stress[] = {-124059.341, -606244.208};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    PetscReal at[2][2], P[2], error[2][3];
    for (int fine = 0; fine < 2; ++fine) {
      inflated(fine ? 16 : 8, radius[k], at[fine], &P[fine]);
      for (int side = 0; side < 2; ++side) error[fine][side] = at[fine][side] - outer[k];
      error[fine][2] = P[fine] / stress[k] - 1;
    }
    PetscPrintf(PETSC_COMM_WORLD, "sphere %g: equator %g order %.2f, pole %g order %.2f, stress %g order %.2f\n",
                (double)radius[k], (double)error[1][0], (double)order_of(error[0][0], error[1][0]), (double)error[1][1],
                (double)order_of(error[0][1], error[1][1]), (double)error[1][2],
                (double)order_of(error[0][2], error[1][2]));
    for (int i = 0; i < 3; ++i) {
      CHECK(PetscAbsReal(error[1][i]) < (i == 2 ? 1e-2 : 5e-4), "off by %g", (double)error[1][i]);
      CHECK(order_of(error[0][i], error[1][i]) > (i == 1 ? 1.6 : 1.85), "order %g",
            (double)order_of(error[0][i], error[1][i]));
    }
  }
}

/* Lame's solution: 1000 Pa inside move the inner surface by 0.8 mm and the outer by 0.3 mm. Here a
 * thousandth of that, in which nothing is left of finite strains. */
static void test_small_sphere(void **state)
{
  PetscReal error[2][3];
  (void)state;
  for (int fine = 0; fine < 2; ++fine) {
    PetscReal at[2], P;
    inflated(fine ? 16 : 8, 1 + 0.8e-6, at, &P);
    for (int side = 0; side < 2; ++side) error[fine][side] = (at[side] - 2) / 0.3e-6 - 1;
    error[fine][2] = P / -1 - 1;
  }
  for (int i = 0; i < 3; ++i) {
    PetscPrintf(PETSC_COMM_WORLD, "small sphere, number %d: off by %g, order %.2f\n", i, (double)error[1][i],
                (double)order_of(error[0][i], error[1][i]));
    CHECK(PetscAbsReal(error[1][i]) < 1e-2, "off by %g", (double)error[1][i]);
    CHECK(order_of(error[0][i], error[1][i]) > (i == 1 ? 1.6 : 1.85), "order %g",
          (double)order_of(error[0][i], error[1][i]));
  }
}

/* --- O9: breathing --- */
typedef PetscReal (*Mode)(PetscReal x);

static PetscReal cylinder_mode(PetscReal x) { return j1(x); }
static PetscReal sphere_mode(PetscReal x) { return PetscSinReal(x) / (x * x) - PetscCosReal(x) / x; }

/* The part of a mode in the motion, with the mass as weight: other modes are across it. k: wave number,
 * 1/m. */
static PetscReal part_of_mode(const Model *m, Mode mode, PetscReal k)
{
  PetscReal sum = 0, all;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), *v = point_real(m->points, POINT_V, p);
    const PetscReal y = mode == sphere_mode ? x[1] : 0, r = PetscSqrtReal(x[0] * x[0] + y * y);
    sum += m->points->real[POINT_MASS][p] * mode(k * r) * (v[0] * x[0] + v[1] * y) / r;
  }
  CALL(MPI_Allreduce(&sum, &all, 1, MPIU_REAL, MPIU_SUM, m->comm));
  return all;
}

/* Start with the velocities of a mode, and see when it passes zero for the first and the third time: a
 * period. Returns omega R sqrt(rho / E) over what it must be, less 1. */
static PetscReal frequency_error(Bench *b, Mode mode, PetscReal nu, PetscReal omega)
{
  const PetscReal period = 2 * PETSC_PI / (omega * PetscSqrtReal(1e3));
  const PetscReal k = omega / PetscSqrtReal((1 - nu) / ((1 + nu) * (1 - 2 * nu)));
  PetscReal before, after, first = 0, start = 0, zero = 0;
  PetscInt crossings = 0;
  b->constants[1].value = nu;
  bench_dynamic(b, 2 * period, period / 200);
  b->c.linear = LINEAR_AUTO;
  b->c.newton.residual = 1e-9;
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  for (PetscInt node = 0; node < m->grid->n_nodes; ++node) {
    const PetscReal *x = m->grid->x + 2 * node, y = mode == sphere_mode ? x[1] : 0;
    const PetscReal r = PetscSqrtReal(x[0] * x[0] + y * y), speed = r > 0 ? 1e-4 * omega * mode(k * r) / r : 0;
    m->nodes->v[2 * node] = speed * x[0];
    m->nodes->v[2 * node + 1] = speed * y;
  }
  model_step(m, 1);
  before = part_of_mode(m, mode, k);
  start = model_sum(m, "energy: kinetic", 0) + model_sum(m, "energy: elastic", 0);
  while (crossings < 3) {
    const StepReport r = model_step(m, 1);
    after = part_of_mode(m, mode, k);
    if (before * after < 0) {
      zero = m->time - r.dt * after / (after - before);
      if (crossings++ == 0) first = zero;
    }
    before = after;
  }
  const PetscReal energy = model_sum(m, "energy: kinetic", 0) + model_sum(m, "energy: elastic", 0);
  CHECK_CLOSE(energy / start, 1, 1e-4);
  CALL(ModelDestroy(&m));
  return 2 * PETSC_PI / (zero - first) / PetscSqrtReal(1e3) / omega - 1;
}

typedef struct {
  PetscReal nu, omega; /* omega R sqrt(rho / E): roots of k J0(kR) R = ((1-2nu)/(1-nu)) J1(kR), of the sphere's */
  PetscReal within;    /* of the finer mesh */
} Breath;

static void check_breath(const char *body, const Breath *breath, const PetscReal error[2], PetscReal order)
{
  PetscPrintf(PETSC_COMM_WORLD, "%s, nu %g: %g off by %g and %g\n", body, (double)breath->nu, (double)breath->omega,
              (double)error[0], (double)error[1]);
  CHECK(PetscAbsReal(error[1]) < breath->within, "off by %g", (double)error[1]);
  CHECK(order_of(error[0], error[1]) > order, "order %g", (double)order_of(error[0], error[1]));
}

static void test_breathing_cylinder(void **state)
{
  static const Breath breaths[] = {
    {0.3, 2.4663762, 5e-4}, {0, 1.8411838, 5e-4}, {0.45, 4.5290757, 5e-4}, {0.3, 6.2814104, 5e-3}};
  (void)state;
  for (size_t i = 0; i < sizeof breaths / sizeof breaths[0]; ++i) {
    PetscReal error[2];
    for (int fine = 0; fine < 2; ++fine) {
      const PetscInt n = fine ? 16 : 8;
      Bench b;
      tube(&b, "fem", CELL_QUADRILATERAL, 0, 1, 1. / (PetscReal)n, n);
      tube_moved(&b, 1, 0, 1, 0);
      tube_moved(&b, 1, 1. / (PetscReal)n, 1, 0);
      error[fine] = frequency_error(&b, cylinder_mode, breaths[i].nu, breaths[i].omega);
    }
    check_breath("cylinder", &breaths[i], error, 1.85);
  }
}

/* Squares about the origin become circles. */
static void round_off_corners(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  const PetscReal side = PetscMax(x[0], x[1]), length = PetscSqrtReal(x[0] * x[0] + x[1] * x[1]);
  (void)context, (void)dim, (void)size;
  for (int d = 0; d < 2 && length > 0; ++d) x[d] *= side / length;
}

static void test_breathing_sphere(void **state)
{
  static const Breath breaths[] = {{0.3, 3.0980865, 5e-3}, {0.25, 2.8081014, 5e-3}};
  (void)state;
  for (size_t i = 0; i < sizeof breaths / sizeof breaths[0]; ++i) {
    PetscReal error[2];
    for (int fine = 0; fine < 2; ++fine) {
      Bench b;
      tube(&b, "fem", CELL_TRIANGLE, 0, 1, 1, fine ? 16 : 8);
      b.body[0].shape = upper_half;
      bench_mesh(&b, round_off_corners, NULL);
      tube_moved(&b, 1, 0, 1, 0);
      error[fine] = frequency_error(&b, sphere_mode, breaths[i].nu, breaths[i].omega);
      bench_end(&b);
    }
    check_breath("sphere", &breaths[i], error, 1.8);
  }
}

/* --- O10: weight --- */
static void fill(Bench *b, const char *method, CellType cell, PetscInt n, PetscReal g)
{
  tube(b, method, cell, 0, 0.5, 1, n);
  tube_moved(b, 1, 0, 1, 0);
  tube_moved(b, 0, 0.5, 0, 0);
  b->c.gravity[1] = -g;
}

/* Far from large strains: a thousandth of gravity. */
static void test_fill(void **state)
{
  static const char *const method[] = {"fem", "mpm"};
  const PetscReal g = 9.81e-3, modulus = 1e6 * 0.7 / (1.3 * 0.4);
  (void)state;
  for (int k = 0; k < 2; ++k)
    for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell) {
      Bench b;
      fill(&b, method[k], cell, 4, g);
      MeasureSpec *top = bench_tracer(&b, "displacement", 1, 0.25, 1, 0);
      PetscReal moved;
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      run_through(m);
      CALL(ModelMeasure(m, top, 0, &moved));
      CHECK_CLOSE(reaction(m, 0, 1), 7.704756, 1e-6);
      CHECK_CLOSE(reaction(m, 1, 0), -6.60408, 2e-5 + (cell == CELL_TRIANGLE ? 0.02 : 0));
      /* triangles do not share the weight of a layer evenly among its nodes */
      CHECK_CLOSE(moved / (1000 * g / (2 * modulus)), -1, cell == CELL_TRIANGLE ? 5e-3 : 2e-5);
      CALL(ModelDestroy(&m));
    }
}

/* With k0 it is at rest from the start, elastic or grains. */
static void test_geostatic(void **state)
{
  static const char *const method[] = {"fem", "mpm"};
  (void)state;
  for (int k = 0; k < 2; ++k)
    for (int grains = 0; grains < 2; ++grains) {
      Bench b;
      fill(&b, method[k], CELL_QUADRILATERAL, 4, 9.81);
      if (grains)
        b.material = (MaterialSpec){
          .name = "rubber", .law = "mohr-coulomb", .density = 1000, .n_parameters = 5, .parameters = sand_constants};
      b.body[0].has_k0 = PETSC_TRUE;
      b.body[0].k0 = 0.3 / 0.7;
      bench_dynamic(&b, 0.05, 0.005);
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      run_through(m);
      PetscReal moved = 0;
      for (PetscInt p = 0; p < m->points->n; ++p)
        for (int d = 0; d < 2; ++d) moved = PetscMax(moved, PetscAbsReal(point_real(m->points, POINT_U, p)[d]));
      CHECK(model_max(m, moved) < 1e-11, "%s %d: moved by %g", method[k], grains, (double)model_max(m, moved));
      CHECK_CLOSE(reaction(m, 0, 1), 7704.756, 1e-3);
      CHECK_CLOSE(reaction(m, 1, 0), -6604.08, 1e-2);
      CALL(ModelDestroy(&m));
    }
}

/* --- O11: grains that fly apart feel nothing --- */

/* Mass times radial velocity, and present volume, of all points. */
static void sum_flight(const Model *m, PetscReal sum[2])
{
  PetscReal local[2] = {0, 0};
  for (PetscInt p = 0; p < m->points->n; ++p) {
    local[0] += m->points->real[POINT_MASS][p] * *point_real(m->points, POINT_V, p);
    local[1] += m->points->real[POINT_VOLUME][p] * m->points->real[POINT_J][p];
  }
  CALL(MPI_Allreduce(local, sum, 2, MPIU_REAL, MPIU_SUM, m->comm));
}

/* mpm gathers a velocity at nodes that is not quite the linear one of the points: there what holds
 * for each point of fem holds for their sums, and nearly for each. */
static void fly(const char *method, PetscBool each)
{
  Bench b;
  PetscReal before[2], after[2], tau[6];
  tube(&b, method, CELL_QUADRILATERAL, 0, each ? 1 : 2, 1, each ? 8 : 16);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
  b.material = (MaterialSpec){
    .name = "rubber", .law = "mohr-coulomb", .density = 1000, .n_parameters = 5, .parameters = sand_constants};
  bench_dynamic(&b, 0.5, 0.02);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) *point_real(m->points, POINT_V, p) = *point_real(m->points, POINT_X, p);
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i) m->nodes->v[2 * i] = m->grid->x[2 * i];
  m->space->present = each; /* mpm gathers anew */
  sum_flight(m, before);
  run_through(m);
  sum_flight(m, after);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), *u = point_real(m->points, POINT_U, p);
    const PetscReal R = x[0] - u[0];
    point_tau(m->points, p, tau);
    for (int k = 0; k < 6; ++k) CHECK_CLOSE(tau[k], 0, 1e-6);
    CHECK_CLOSE(x[0], 1.5 * R, each ? 1e-9 : 0.02);
    CHECK_CLOSE(*point_real(m->points, POINT_V, p), R, each ? 1e-9 : 0.05);
    CHECK_CLOSE(u[1], 0, 1e-9);
    if (each) CHECK_CLOSE(*point_real(m->points, POINT_J, p), 2.25, 1e-9);
  }
  CHECK_CLOSE(after[0] / before[0], 1, each ? 1e-9 : 2e-3);
  CHECK_CLOSE(after[1] / before[1], 2.25, each ? 1e-9 : 0.08);
  CALL(ModelDestroy(&m));
}

static void test_flight(void **state)
{
  (void)state;
  fly("fem", PETSC_TRUE);
  fly("mpm", PETSC_FALSE);
}

/* --- Newton's method, in every law --- */

/* One step: a ring on a floor that holds its foot is pressed down at its top, by a strain of some
 * per cent that differs from place to place. Once the residual is small each iteration squares
 * it. */
static void test_quadratic(void **state)
{
  static NamedValue split[] = {{"young", 1e6}, {"poisson", 0.3}},
                    metal[] = {{"young", 1e6}, {"poisson", 0.3}, {"yield_stress", 2e4}, {"hardening", 1e5}},
                    soil[] = {{"young", 1e6},
                              {"poisson", 0.3},
                              {"friction_angle", 30},
                              {"dilatancy_angle", 10},
                              {"cohesion", 8e3}};
  static const struct {
    const char *law;
    NamedValue *parameters;
    PetscInt n;
  } cases[] = {
    {"neo-hookean", split, 2}, {"neo-hookean-split", split, 2}, {"neo-hookean-split-log", split, 2}, {"j2", metal, 4},
    {"j2-log", metal, 4},      {"mohr-coulomb", soil, 5}};
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    Bench b;
    tube(&b, "fem", CELL_QUADRILATERAL, 0, 1, 1, 6);
    b.material = (MaterialSpec){.name = "rubber",
                                .law = (char *)cases[k].law,
                                .density = 1000,
                                .n_parameters = cases[k].n,
                                .parameters = cases[k].parameters};
    bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    tube_moved(&b, 1, 1, 1, -0.05);
    b.c.newton.residual = 1e-13;
    b.c.newton.increment = 0;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const StepReport r = model_step(m, 1);
    PetscInt squared = 0;
    PetscPrintf(PETSC_COMM_WORLD, "%s:", cases[k].law);
    for (PetscInt i = 0; i <= r.newton.iterations; ++i) {
      const PetscReal now = r.newton.residual[i], next = i < r.newton.iterations ? r.newton.residual[i + 1] : 1;
      PetscPrintf(PETSC_COMM_WORLD, " %.1e", (double)now);
      squared += now < 1e-2 && now > 1e-7 && next <= PetscMax(30 * now * now, 1e-13);
    }
    PetscPrintf(PETSC_COMM_WORLD, "\n");
    CHECK(r.cuts == 0, "the step was halved");
    CHECK(squared >= 1, "%s: not quadratic", cases[k].law);
    CALL(ModelDestroy(&m));
  }
}

/* --- O15: a ring in space --- */

/* The box [1, 2] x [0, h] x [0, 1] becomes a quarter of a tube about y. */
static void turn(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  const PetscReal radius = x[0], angle = x[2] * PETSC_PI / 2;
  (void)context, (void)dim, (void)size;
  x[0] = x[2] == 1 ? 0 : radius * PetscCosReal(angle);
  x[2] = radius * PetscSinReal(angle);
}

static void inflate_quarter(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  const PetscReal growth = ((const Inflation *)context)->radius - 1, size = PetscSqrtReal(x[0] * x[0] + x[2] * x[2]);
  const PetscBool inner = PetscAbsReal(size - 1 - t0 * growth) < 1e-6;
  for (int d = 0; d < 3; ++d) increment[d] = inner && d != 1 ? (t1 - t0) * growth * x[d] / size : 0;
}

/* Outer radius of the tube inflated to 1.5, as a quarter in space of n cells through the wall. */
static PetscReal quarter(PetscInt n)
{
  Bench b;
  Inflation inflation = {1.5};
  const PetscReal height = 1. / (PetscReal)n;
  bench_init(&b, "fem", CELL_HEXAHEDRON, n);
  bench_grid(&b, (PetscReal[]){1, 0, 0}, (PetscReal[]){2, height, 1}, height);
  b.c.grid.counts[2] = 2 * n;
  b.body[0].shape = upper_half;
  bench_mesh(&b, turn, NULL);
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  bench_motion(&b, 1, height, MOTION_FIXED, 2);
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_motion(&b, 2, 0, MOTION_FIXED, 4);
  MotionSpec *inner = bench_motion(&b, -1, 0, MOTION_FIXED, 5); /* a ball just beyond the inner edge */
  inner->on.has_shape = PETSC_TRUE;
  inner->on.shape = (Shape){.kind = SHAPE_BALL, .radius = PetscSqrtReal(1 + height * height)};
  b.c.analysis.step = b.c.analysis.largest = 0.25;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = inflate_quarter;
  m->boundary->field_context = &inflation;
  run_through(m);
  PetscReal outer = 0;
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i)
    if (PetscAbsReal(m->grid->x[3 * i + 2]) < 1e-9) outer = PetscMax(outer, m->grid->x[3 * i]);
  outer = model_max(m, outer);
  CALL(ModelDestroy(&m));
  bench_end(&b);
  return outer;
}

/* Both tend to the same, with order 2. */
static void test_space(void **state)
{
  PetscReal error[2];
  (void)state;
  for (int fine = 0; fine < 2; ++fine) error[fine] = quarter(fine ? 8 : 4) - 2.345244168;
  PetscPrintf(PETSC_COMM_WORLD, "in space: off by %g and %g\n", (double)error[0], (double)error[1]);
  CHECK(PetscAbsReal(error[1]) < 1e-2, "off by %g", (double)error[1]);
  CHECK(order_of(error[0], error[1]) > 1.8, "order %g", (double)order_of(error[0], error[1]));
}

/* --- the free surface: a cylinder is as high on the axis as at its rim, however many points share a cell --- */
static void flat_top(const char *basis, PetscInt points, PetscReal top, PetscReal from)
{
  Bench b;
  tube(&b, "mpm", CELL_QUADRILATERAL, from, from + 1, 1, 8);
  bench_box(&b, 0, (PetscReal[]){from, 0, 0}, (PetscReal[]){from + 1, top, 0});
  b.body[0].points_per_cell = points;
  b.c.basis.kind = basis;
  tube_moved(&b, 1, 0, 1, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int k = 0; k <= 16; ++k) {
    PetscReal height;
    const MeasureSpec measure = {.kind = "surface", .word = "height", .at = from + k / 16., .has_at = PETSC_TRUE};
    CALL(ModelMeasure(m, &measure, 0, &height));
    CHECK_CLOSE(height, top, 1e-13);
  }
  CHECK_CLOSE(model_sum(m, "surface: front", 0), from + 1, 1e-12);
  CHECK_CLOSE(model_sum(m, "surface: slope", 0), 0, 1e-9);
  CALL(ModelDestroy(&m));
}

static void test_surface(void **state)
{
  (void)state;
  for (int from = 0; from < 2; ++from) {
    flat_top("cell", 4, 0.5, from);
    flat_top("cell", 4, 0.47, from); /* cells that the shape cuts */
    flat_top("gimp", 4, 0.5, from);
    flat_top("gimp", 9, 0.47, from);
    flat_top("bspline", 4, 0.47, from);
  }
}

/* --- clouds --- */
static const BasisSpec clouds[] = {
  {.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2},
  {.kind = "mls", .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2}};

/* The fill of O10, whose axis is held in either basis' way: the floor carries the weight, the top
 * settles. */
static void test_cloud(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    PetscReal off[2];
    for (int fine = 0; fine < 2; ++fine) {
      const PetscReal g = 9.81e-3, settled = 1000 * g * 1 / (2 * 1e6 * 0.7 / (1.3 * 0.4));
      PetscReal moved, axis = 0;
      Bench b;
      fill(&b, "gmm", CELL_QUADRILATERAL, fine ? 8 : 4, g);
      b.c.basis = clouds[k];
      b.c.newton.residual = 1e-9;
      MeasureSpec *top = bench_tracer(&b, "displacement", 1, 0.25, 1, 0);
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      run_through(m);
      CALL(ModelMeasure(m, top, 0, &moved));
      off[fine] = moved / settled + 1;
      CHECK_CLOSE(reaction(m, 0, 1), 7.704756, 1e-5);
      CHECK_CLOSE(reaction(m, 1, 0), -6.60408, 0.2);
      for (PetscInt i = 0; i < m->grid->n_nodes; ++i)
        if (m->grid->x[2 * i] < 1e-3) axis = PetscMax(axis, PetscAbsReal(m->grid->x[2 * i]));
      CHECK(model_max(m, axis) == 0, "a node left the axis by %g", (double)axis);
      CALL(ModelDestroy(&m));
    }
    PetscPrintf(PETSC_COMM_WORLD, "%s: settled %g and %g off\n", clouds[k].kind, (double)off[0], (double)off[1]);
    CHECK(PetscAbsReal(off[1]) < 0.02, "%s: off by %g", clouds[k].kind, (double)off[1]);
  }
}

/* A dead load that grows with the radius, or with the height, has its integral in rings of any width, and keeps it when
 * they are strained. */
static void test_varying(void **state)
{
  static const struct {
    const char *basis, *factor;
    PetscReal total; /* over 2 pi */
  } loads[] = {{"gimp", "X", 1. / 3}, {"gimp", "2 * X - 3 * Y", 2. / 3 - 3. / 2}, {"cell", "X", 1. / 3}};
  (void)state;
  EACH_OF (k, loads) {
    Bench b;
    tube(&b, "mpm", CELL_QUADRILATERAL, 0, 1, 1, 4);
    b.c.grid.max[1] = 1.25, b.c.grid.counts[1] = 5;
    b.c.basis.kind = loads[k].basis;
    tube_moved(&b, 0, 0, 0, 0);
    tube_moved(&b, 1, 0, 1, 0);
    LoadSpec *load = bench_traction(&b, 1, 1, "body", 0, -1e-2 * b.constants[0].value, 0);
    load->factor = (char *)loads[k].factor;
    b.c.analysis.step = b.c.analysis.largest = 0.5;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    run_through(m);
    const PetscReal total = 2 * PETSC_PI * loads[k].total * 1e-2 * b.constants[0].value;
    CHECK_CLOSE(reaction(m, 1, 1), total, 1e-8 * PetscAbsReal(total));
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_sphere),
                                     cmocka_unit_test(test_small_sphere),
                                     cmocka_unit_test(test_breathing_cylinder),
                                     cmocka_unit_test(test_breathing_sphere),
                                     cmocka_unit_test(test_fill),
                                     cmocka_unit_test(test_geostatic),
                                     cmocka_unit_test(test_flight),
                                     cmocka_unit_test(test_quadratic),
                                     cmocka_unit_test(test_space),
                                     cmocka_unit_test(test_surface),
                                     cmocka_unit_test(test_cloud),
                                     cmocka_unit_test(test_varying)};
  return run_model_tests_in_turns(argc, argv, tests);
}
