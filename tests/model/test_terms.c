/* Energies and motions term by term against closed forms. The balance alone says little: what
 * nobody accounts for becomes transfer. */
#include "case_builder.h"

static const BasisSpec lme = {.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
static const BasisSpec mls = {
  .kind = "mls", .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};

typedef struct {
  const char *method;
  CellType cell;
  const BasisSpec *basis;
} Kind;

static const Kind kinds[] = {
  {"mpm", CELL_TRIANGLE, NULL},      {"mpm", CELL_QUADRILATERAL, NULL}, {"mpm", CELL_TETRAHEDRON, NULL},
  {"mpm", CELL_HEXAHEDRON, NULL},    {"fem", CELL_QUADRILATERAL, NULL}, {"fem", CELL_TETRAHEDRON, NULL},
  {"gmm", CELL_QUADRILATERAL, &lme}, {"gmm", CELL_HEXAHEDRON, &lme},    {"gmm", CELL_QUADRILATERAL, &mls}};
#define N_KINDS (sizeof kinds / sizeof *kinds)

/* A block of 0.5 m in a wide empty grid, nothing held. */
static void free_block(Bench *b, const Kind *kind, PetscReal dt)
{
  bench_init(b, kind->method, kind->cell, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 2, 2}, kind->cell >= CELL_TETRAHEDRON ? 0.25 : 0.125);
  bench_box(b, 0, (PetscReal[]){0.75, 0.75, 0.75}, (PetscReal[]){1.25, 1.25, 1.25});
  bench_dynamic(b, 1, dt);
  if (kind->basis) b->c.basis = *kind->basis;
}

static PetscReal fastest_off(const Model *m, PetscReal vx, PetscReal vy)
{
  PetscReal worst = 0;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *v = point_real(m->points, POINT_V, p);
    worst = PetscMax(worst, PetscMax(PetscAbsReal(v[0] - vx), PetscAbsReal(v[1] - vy)));
  }
  return model_max(m, worst);
}

/* Without a force v falls as exp(-alpha t) and the kinetic energy with its square; all of it is
 * counted as damped. The trapezoidal rule makes (1 - a) / (1 + a) of exp(-2 a), a = alpha dt / 2:
 * off by a^3 / 1.5 a step. The first step starts without acceleration. */
static void decay(const Kind *kind)
{
  const PetscReal alpha = 4, dt = 0.005, v[2] = {0.8, -0.4};
  Bench b;
  Energies first, now;
  free_block(&b, kind, dt);
  b.body[0].velocity[0] = v[0];
  b.body[0].velocity[1] = v[1];
  b.c.analysis.damping = alpha;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  model_step(m, dt);
  CALL(ModelEnergies(m, &first));
  const PetscReal start = first.kinetic / (0.5 * model_sum(m, "mass: total", 0) * (v[0] * v[0] + v[1] * v[1]));
  CHECK_CLOSE(start, exp(-2 * alpha * dt), 1.2 * alpha * dt);
  for (int step = 1; step <= 60; ++step) {
    const PetscReal left = exp(-alpha * step * dt);
    model_step(m, dt);
    CALL(ModelEnergies(m, &now));
    CHECK(fastest_off(m, v[0] * PetscSqrtReal(start) * left, v[1] * PetscSqrtReal(start) * left) <= 1e-4 * left,
          "%s, cell %d: velocities after %d steps", kind->method, (int)kind->cell, step);
    CHECK_CLOSE(now.kinetic, first.kinetic * left * left, 1e-4 * now.kinetic);
    CHECK_CLOSE(now.damped - first.damped, first.kinetic - now.kinetic, 1e-9 * first.kinetic);
    CHECK_CLOSE(now.transfer - first.transfer, 0, 1e-9 * first.kinetic);
    CHECK_CLOSE(now.elastic, 0, 1e-9 * first.kinetic);
  }
  CALL(ModelDestroy(&m));
}

static void test_decay(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_KINDS; ++k) decay(&kinds[k]);
}

/* A fall through something that damps: v = g (1 - exp(-alpha t)) / alpha; gravity's work is what
 * moves and what was damped. */
static void fall(const Kind *kind)
{
  const PetscReal alpha = 3, g = -10, dt = 0.004;
  Bench b;
  Energies e;
  free_block(&b, kind, dt);
  b.c.gravity[1] = g;
  b.c.analysis.damping = alpha;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal mass = model_sum(m, "mass: total", 0);
  for (int step = 1; step <= 50; ++step) {
    const PetscReal t = step * dt, gone = 1 - exp(-alpha * t), v = g / alpha * gone,
                    fallen = g / alpha * (t - gone / alpha);
    model_step(m, dt);
    CALL(ModelEnergies(m, &e));
    CHECK(fastest_off(m, 0, v) <= 2e-4 * -g * t, "%s, cell %d: velocities at %g s", kind->method, (int)kind->cell,
          (double)t);
    CHECK_CLOSE(e.damped, e.external - e.kinetic, 1e-9 * e.external);
    CHECK_CLOSE(e.transfer, 0, 1e-9 * e.external);
    /* the start, without damping, is off by alpha dt / 2 of so short a time */
    if (step < 20) continue;
    CHECK_CLOSE(e.kinetic, 0.5 * mass * v * v, 1e-3 * mass * g * fallen);
    CHECK_CLOSE(e.external, mass * g * fallen, 1e-3 * mass * g * fallen);
  }
  CALL(ModelDestroy(&m));
}

static void test_damped_fall(void **state)
{
  (void)state;
  for (size_t k = 0; k < N_KINDS; ++k) fall(&kinds[k]);
}

/* Velocities that no node sees: each point of a cell of nine has its own. Without stiffness damping
 * is all that acts on them, and takes them as fast as those that nodes see. */
static void test_unseen_decay(void **state)
{
  const PetscReal alpha = 4, dt = 0.005;
  Bench b;
  Energies first, now;
  Random random = {5};
  (void)state;
  free_block(&b, &kinds[1], dt);
  b.constants[0].value = 1e-6;
  b.body[0].points_per_cell = 9;
  b.c.analysis.damping = alpha;
  b.c.newton.residual = 1e-9;
  b.c.newton.residual_absolute = 1e-12;
  Model *m = bench_model(&b, PETSC_COMM_SELF);
  for (PetscInt i = 0; i < 2 * m->points->n; ++i) m->points->real[POINT_V][i] = random_real(&random, -1e-5, 1e-5);
  CALL(m->method->initialise(m->space));
  model_step(m, dt);
  CALL(ModelEnergies(m, &first));
  for (int step = 0; step < 60; ++step) model_step(m, dt);
  CALL(ModelEnergies(m, &now));
  PetscPrintf(PETSC_COMM_WORLD,
              "of the kinetic energy %.4g is left, %.4g by exp(-2 alpha t); damped %.4g of what is gone\n",
              (double)(now.kinetic / first.kinetic), exp(-2 * alpha * 60 * dt),
              (double)((now.damped - first.damped) / (first.kinetic - now.kinetic)));
  CHECK_CLOSE(now.kinetic / first.kinetic, exp(-2 * alpha * 60 * dt), 0.05 * exp(-2 * alpha * 60 * dt));
  CHECK_CLOSE(now.damped - first.damped, first.kinetic - now.kinetic, 0.05 * first.kinetic);
  CALL(ModelDestroy(&m));
}

/* A rigid block under a force that swings: without Rayleigh damping its acceleration a lags behind
 * the force by Bossak's weights, and transfer is the work of what the start of each step leaves out
 * of balance, m (b - a) du / 2 (docs/theory.md, "Energy"). */
static void swing(void *context, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *b)
{
  (void)context;
  (void)X;
  (void)x;
  for (PetscInt p = 0; p < n; ++p, b += 3) {
    b[0] = 3 * cos(20 * t);
    b[1] = -2 * sin(30 * t + 1);
  }
}

static void test_bossak_inertia(void **state)
{
  const PetscReal alpha = -0.2, dt = 0.01;
  (void)state;
  for (int k = 0; k < 4; ++k) {
    Bench b;
    Energies e;
    PetscReal expected = 0, work = 0, size = 0, force[2][3];
    free_block(&b, &kinds[k], dt);
    b.body[0].velocity[0] = 0.5;
    b.c.analysis.bossak = alpha;
    b.c.analysis.beta = PetscSqr(1 - alpha) / 4;
    b.c.analysis.gamma = 0.5 - alpha;
    Model *m = bench_model(&b, PETSC_COMM_SELF);
    const PetscReal mass = model_sum(m, "mass: total", 0);
    CALL(ModelSetBodyForce(m, swing, NULL));
    for (int step = 0; step < 40; ++step) {
      PetscReal a[2], u[2];
      for (int d = 0; d < 2; ++d) a[d] = m->points->real[POINT_A][d], u[d] = m->points->real[POINT_U][d];
      swing(NULL, 1, NULL, NULL, m->time, force[0]);
      const PetscInt64 id = m->points->id[0];
      model_step(m, dt);
      swing(NULL, 1, NULL, NULL, m->time, force[1]);
      PetscInt p = 0;
      while (m->points->id[p] != id) ++p;
      for (int d = 0; d < 2; ++d) {
        const PetscReal du = point_real(m->points, POINT_U, p)[d] - u[d];
        expected += 0.5 * mass * (force[0][d] - a[d]) * du;
        size += 0.5 * mass * PetscAbsReal(force[0][d] - a[d]) * PetscAbsReal(du);
        work += 0.5 * mass * (force[0][d] + force[1][d]) * du;
      }
    }
    CALL(ModelEnergies(m, &e));
    CHECK_CLOSE(e.external, work, 1e-9 * PetscAbsReal(work));
    CHECK_CLOSE(e.transfer, expected, 1e-6 * size);
    CHECK(size > 1e-3 * PetscAbsReal(work), "the force hardly changes");
    CALL(ModelDestroy(&m));
  }
}

/* Every law with its stiffness: a small uniform strain stores K e^2 / 2 + G dev : dev, by either
 * formulation, and nothing dissipates. */
typedef struct {
  const char *law, *formulation;
  PetscReal poisson;
} Elastic;

static void store(const Kind *kind, const Elastic *e)
{
  static NamedValue constants[5];
  const PetscReal young = 1e6, shear = young / (2 * (1 + e->poisson)), bulk = young / (3 * (1 - 2 * e->poisson));
  const PetscReal strain[3] = {2e-4, -5e-4, 0};
  const PetscReal mean = (strain[0] + strain[1]) / 3, volume = strain[0] + strain[1];
  PetscReal deviator = 0;
  Bench b;
  Energies energy;
  for (int d = 0; d < 3; ++d) deviator += PetscSqr(strain[d] - mean);
  bench_init(&b, kind->method, kind->cell, kind->cell >= CELL_TETRAHEDRON ? 2 : 4);
  if (kind->basis) b.c.basis = *kind->basis;
  constants[0] = (NamedValue){"young", young};
  constants[1] = (NamedValue){"poisson", e->poisson};
  b.material.law = (char *)e->law;
  b.material.parameters = constants;
  b.material.n_parameters = 2;
  if (!strcmp(e->law, "j2")) constants[b.material.n_parameters++] = (NamedValue){"yield_stress", 1e5};
  if (!strcmp(e->law, "mohr-coulomb")) {
    constants[b.material.n_parameters++] = (NamedValue){"friction_angle", 20};
    constants[b.material.n_parameters++] = (NamedValue){"dilatancy_angle", 0};
    constants[b.material.n_parameters++] = (NamedValue){"cohesion", 1e5};
  }
  b.c.formulation = (char *)e->formulation;
  b.c.mixed.stabilisation = 0.5;
  b.c.newton.increment = 0;
  for (int d = 0; d < 2; ++d) {
    bench_motion(&b, d, 0, MOTION_FIXED, 1u << d);
    bench_motion(&b, d, 1, MOTION_DISPLACEMENT, 1u << d)->value[d] = strain[d];
  }
  if (kind->cell >= CELL_TETRAHEDRON)
    for (int s = 0; s < 2; ++s) bench_motion(&b, 2, s, MOTION_FIXED, 4);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  model_step(m, 1);
  CALL(ModelEnergies(m, &energy));
  const PetscReal stored = 0.5 * bulk * volume * volume + shear * deviator;
  CHECK(PetscAbsReal(energy.elastic - stored) <= 2e-3 * stored, "%s %s %s: %g J stored, not %g", kind->method, e->law,
        e->formulation, (double)energy.elastic, (double)stored);
  CHECK_CLOSE(energy.boundary, stored, 2e-3 * stored);
  CHECK_CLOSE(energy.dissipated, 0, 2e-3 * stored);
  CHECK_CLOSE(energy.transfer, 0, 2e-3 * stored);
  CALL(ModelDestroy(&m));
}

static void test_stored(void **state)
{
  static const Elastic elastic[] = {{"neo-hookean", "displacement", 0.3},
                                    {"neo-hookean-split", "displacement", 0.3},
                                    {"j2", "displacement", 0.3},
                                    {"mohr-coulomb", "displacement", 0.3},
                                    {"neo-hookean", "mixed", 0.3},
                                    {"neo-hookean-split", "mixed", 0.3},
                                    {"neo-hookean-split", "mixed", 0.499},
                                    {"j2", "mixed", 0.3},
                                    {"j2", "mixed", 0.499},
                                    {"mohr-coulomb", "mixed", 0.3}};
  static const Kind at[] = {
    {"mpm", CELL_QUADRILATERAL, NULL}, {"fem", CELL_TRIANGLE, NULL}, {"fem", CELL_HEXAHEDRON, NULL}};
  (void)state;
  for (size_t e = 0; e < sizeof elastic / sizeof *elastic; ++e)
    for (size_t k = 0; k < sizeof at / sizeof *at; ++k) store(&at[k], &elastic[e]);
  store(&kinds[6], &elastic[0]);
  store(&kinds[8], &elastic[2]);
}

/* A load so small beside the reactions of a squeezed block that they would hide it still moves it:
 * a hundred-thousandth of a load moves it by a hundred-thousandth. */
static PetscReal pushed(PetscReal load)
{
  static PetscReal time[] = {0, 0.5, 1}, squeeze[] = {0, 1, 1}, push[] = {0, 0, 1};
  PetscReal u[2];
  Bench b;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 4);
  b.c.newton.residual = 1e-8;
  b.c.newton.increment = 0;
  b.c.analysis.step = b.c.analysis.largest = 0.5;
  bench_motion(&b, 0, 0, MOTION_FIXED, 3);
  MotionSpec *wall = bench_motion(&b, 0, 1, MOTION_DISPLACEMENT, 3);
  wall->value[0] = -0.1;
  wall->amplitude = (Amplitude){.n = 3, .time = time, .value = squeeze};
  bench_traction(&b, 1, 1, NULL, 0, load, 0)->amplitude = (Amplitude){.n = 3, .time = time, .value = push};
  bench_tracer(&b, "displacement", 1, 0.5, 1, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int step = 0; step < 2; ++step) {
    model_step(m, 0.5);
    CALL(ModelMeasure(m, &b.measure[0], 0, &u[step]));
  }
  CALL(ModelDestroy(&m));
  return u[1] - u[0];
}

static void test_small_load(void **state)
{
  (void)state;
  const PetscReal large = pushed(10), small = pushed(1e-4);
  CHECK(large > 1e-6, "the load moves nothing: %g m", (double)large);
  CHECK_CLOSE(small, 1e-5 * large, 0.1e-5 * large); /* what is left of the squeeze is 3 % of it */
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_decay),        cmocka_unit_test(test_damped_fall),
                                     cmocka_unit_test(test_unseen_decay), cmocka_unit_test(test_bossak_inertia),
                                     cmocka_unit_test(test_stored),       cmocka_unit_test(test_small_load)};
  return run_model_tests(argc, argv, tests);
}
