/* The state before the first step: a stress that formulas give, one beyond the strength, and the
 * equilibrium that is sought from it while time stands still. */
#include <string.h>
#include "case_builder.h"

static PetscReal start[1] = {0}, whole[1] = {1}; /* gravity acts from the start */
static PetscReal hill[] = {0, 0, 30, 0, 30, 10, 20, 10, 10, 20, 0, 20};

/* 30 m x 20 m whose toe is 10 m high, with K0 = 0.5. */
static void slope(Bench *b, const char *method, const char *formulation, CellType cell, PetscReal h)
{
  bench_init(b, method, cell, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){30, 22, 0}, h);
  b->constants[0].value = 1e8;
  b->material.density = 2000;
  b->c.formulation = (char *)formulation;
  b->c.mixed.stabilisation = 2;
  b->c.newton.residual = 1e-9;
  b->c.gravity[1] = -10;
  b->c.gravity_amplitude = (Amplitude){.n = 1, .time = start, .value = whole};
  b->body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 6, .vertices = hill};
  b->body[0].has_k0 = PETSC_TRUE;
  b->body[0].k0 = 0.5;
  b->c.initial = (InitialSpec){.equilibrium = EQUILIBRIUM_DIRECT, .reset = PETSC_TRUE};
  bench_motion(b, 1, 0, MOTION_FIXED, 3);
  for (int side = 0; side < 2; ++side) bench_motion(b, 0, 30 * side, MOTION_FIXED, 1);
}

static Model *equilibrium(Bench *b, StepReport *report)
{
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  CALL(ModelEquilibrate(m, report));
  return m;
}

/* What was lacking is known from outside: columns carry themselves, and K0 times their weight ends at the
 * incline unbalanced. It is gone after, nothing has moved, and the next step finds nothing to do. */
static void test_slope(void **state)
{
  static const char *const formulation[] = {"displacement", "mixed", "mean-dilatation"};
  static const char *const method[] = {"fem", "mpm"};
  StepReport report;
  Bench b;
  (void)state;
  for (int k = 0; k < 2; ++k)
    for (int f = 0; f < 3; ++f) {
      slope(&b, method[k], formulation[f], f == 1 ? CELL_TRIANGLE : CELL_QUADRILATERAL, 2);
      Model *m = equilibrium(&b, &report);
      CHECK(report.outcome == STEP_ACCEPTED, "%s %s", method[k], formulation[f]);
      CHECK(m->initial.lacked > 0.01 && m->initial.lacked < 1, "%g", (double)m->initial.lacked);
      CHECK(m->initial.left <= 1e-9, "%s %s left %g", method[k], formulation[f], (double)m->initial.left);
      CHECK_CLOSE(m->time, 0, 0);
      for (PetscInt p = 0; p < m->points->n; ++p) {
        CHECK_CLOSE(point_real(m->points, POINT_U, p)[1], 0, 0);
        CHECK_CLOSE(m->points->real[POINT_MASS][p],
                    2000 * m->points->real[POINT_J][p] * m->points->real[POINT_VOLUME][p], 1e-8);
      }
      CALL(ModelStep(m, 1, &report));
      CHECK(report.outcome == STEP_ACCEPTED, "first step");
      CHECK(f == 1 || report.newton.iterations == 0, "%s %s: %d iterations", method[k], formulation[f],
            (int)report.newton.iterations);
      CALL(ModelDestroy(&m));
    }
}

/* Domains are as they were seeded, whatever J the stress brings: one that grew by it would reach nodes
 * above the surface, whose forces no motion of theirs brings to rest. */
static void test_domains(void **state)
{
  StepReport report;
  Bench b;
  (void)state;
  slope(&b, "mpm", "displacement", CELL_QUADRILATERAL, 2);
  b.body[0].fill = FILL_CELLS; /* all alike */
  b.c.basis = (BasisSpec){.kind = "gimp"};
  b.c.stabilisation.stiffness = 0;
  Model *m = equilibrium(&b, &report);
  CHECK(report.outcome == STEP_ACCEPTED, "it stands");
  CHECK(m->initial.left <= 1e-9, "left %g", (double)m->initial.left);
  CHECK(m->initial.parts <= 6, "%g rounds", (double)m->initial.parts);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal stretch = PetscPowReal(m->points->real[POINT_J][p], 1.0 / 3.0);
    for (int d = 0; d < 2; ++d) CHECK_CLOSE(stretch * point_real(m->points, POINT_DOMAIN, p)[d], 0.5, 1e-12);
  }
  CALL(ModelDestroy(&m));
}

/* From no stress at all, in dynamics: all of the weight is lacking, the body settles, and then rests. */
static void test_gravity_loading(void **state)
{
  StepReport report;
  PetscReal fastest = 0, settled = 0;
  Bench b;
  (void)state;
  for (int keeps = 0; keeps < 2; ++keeps) {
    slope(&b, "mpm", "mean-dilatation", CELL_QUADRILATERAL, 2);
    b.body[0].has_k0 = PETSC_FALSE;
    b.c.initial = (InitialSpec){.equilibrium = EQUILIBRIUM_ELASTIC_FIRST, .reset = keeps};
    bench_dynamic(&b, 1, 0.01);
    Model *m = equilibrium(&b, &report);
    CHECK(report.outcome == STEP_ACCEPTED, "it stands");
    CHECK_CLOSE(m->initial.lacked, 1, 1e-12);
    for (PetscInt p = 0; p < m->points->n; ++p) settled = PetscMin(settled, point_real(m->points, POINT_U, p)[1]);
    for (int k = 0; k < 5; ++k) CALL(ModelStep(m, 0.01, &report));
    for (PetscInt p = 0; p < m->points->n; ++p)
      fastest = PetscMax(fastest, PetscAbsReal(point_real(m->points, POINT_V, p)[1]));
    CHECK(fastest < 1e-6, "%g m/s", (double)fastest);
    if (m->points->n && !keeps) CHECK(settled < -1e-3, "settled %g m", (double)settled);
    CALL(ModelDestroy(&m));
  }
}

/* sigma_yy = -18 kN/m3 times the depth, below the surface of another body; a third of it and a shear across. */
static void test_formulas(void **state)
{
  static char *text[6] = {"weight / -3", "-18e3 * depth", "0", "1e3 * x * (y - 1)", NULL, NULL};
  PetscReal sigma[6];
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 8);
  b.body[0].has_stress = PETSC_TRUE;
  for (int k = 0; k < 6; ++k) b.body[0].stress[k] = text[k];
  b.c.gravity[1] = -10;
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  b.c.gravity_amplitude = (Amplitude){.n = 1, .time = start, .value = whole};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p);
    CALL(ModelPointStress(m, p, sigma));
    CHECK_CLOSE(sigma[0], -1e4 / 3 * (1 - x[1]), 1e-6);
    CHECK_CLOSE(sigma[1], -18e3 * (1 - x[1]), 1e-6);
    CHECK_CLOSE(sigma[3], 1e3 * x[0] * (x[1] - 1), 1e-6);
  }
  CALL(ModelDestroy(&m));
  b.body[0].stress[1] = "-18e3 * deep";
  bench_refused(&b, PETSC_COMM_WORLD, "bodies[0].stress.yy", "there is no 'deep'");
}

/* Without friction and cohesion enough for 5 kPa of difference: K0 = 0 is beyond it deeper than half a
 * metre, and what is left there differs by twice the cohesion. */
static void test_beyond(void **state)
{
  static NamedValue constants[4] = {{"young", 1e7}, {"poisson", 0.3}, {"friction_angle", 0}, {"cohesion", 2.5e3}};
  PetscReal sigma[6];
  PetscInt beyond = 0, sum;
  Bench b;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 8);
  b.material.law = "mohr-coulomb";
  b.material.parameters = constants;
  b.material.n_parameters = 4;
  b.body[0].has_k0 = PETSC_TRUE;
  b.c.gravity[1] = -10;
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  b.c.gravity_amplitude = (Amplitude){.n = 1, .time = start, .value = whole};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal weight = 1e4 * (1 - point_real(m->points, POINT_X, p)[1]);
    CALL(ModelPointStress(m, p, sigma));
    beyond += weight > 5e3;
    CHECK_CLOSE(sigma[0] - sigma[1], PetscMin(weight, 5e3 / m->points->real[POINT_J][p]), 1e-3);
    CHECK_CLOSE(sigma[0] + sigma[1] + sigma[2], -weight, 20); /* the return keeps the mean, but for J */
  }
  MPI_Allreduce(&beyond, &sum, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
  CHECK_CLOSE(m->initial.beyond, (PetscReal)sum, 0);
  CALL(ModelDestroy(&m));
}

/* What is bonded bears the stress as it is given: nothing is lacking, and nothing moves. */
static void test_bonded(void **state)
{
  WallSpec floor = {.name = (char *)"floor", .contact = CONTACT_BONDED};
  StepReport report;
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, -0.5, 0}, (PetscReal[]){1, 1.5, 0}, 0.25);
  b.c.basis = (BasisSpec){.kind = "gimp"};
  floor.shape = (Shape){.kind = SHAPE_HALF_SPACE, .normal = {0, 1, 0}};
  b.c.n_walls = 1, b.c.walls = &floor;
  for (int side = 0; side < 2; ++side) bench_motion(&b, 0, side, MOTION_FIXED, 1);
  b.c.gravity[1] = -10;
  b.c.gravity_amplitude = (Amplitude){.n = 1, .time = start, .value = whole};
  b.body[0].has_k0 = PETSC_TRUE;
  b.body[0].k0 = 0.5;
  b.c.initial = (InitialSpec){.equilibrium = EQUILIBRIUM_DIRECT, .reset = PETSC_TRUE};
  Model *m = equilibrium(&b, &report);
  CHECK(report.outcome == STEP_ACCEPTED, "it stands");
  CHECK(m->initial.lacked <= 1e-11, "lacked %g", (double)m->initial.lacked);
  CHECK(m->initial.left <= 1e-11, "left %g", (double)m->initial.left);
  CHECK_CLOSE(m->initial.moved, 0, 1e-12);
  CALL(ModelDestroy(&m));
}

#define PRESSURE 1e5

/* A square, or a disk of rings, on sides that slide, with one and a half times the pressure on its others. */
static void pressed(Bench *b, const char *method, const char *basis, const Kinematics *kinematics)
{
  static char stress[] = "-1.5e5";
  const PetscReal size = strcmp(method, "fem") ? 1.5 : 1;
  bench_init(b, method, CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){size, size, 0}, 0.25);
  b->c.kinematics = kinematics;
  b->c.basis.kind = (char *)basis;
  b->c.initial = (InitialSpec){.equilibrium = EQUILIBRIUM_DIRECT, .reset = PETSC_TRUE};
  b->body[0].has_stress = PETSC_TRUE;
  for (int k = 0; k < 3; ++k) b->body[0].stress[k] = stress;
  for (int axis = 0; axis < 2; ++axis) {
    bench_motion(b, axis, 0, MOTION_FIXED, 1U << axis);
    LoadSpec *load = bench_traction(b, axis, 1, "body", PRESSURE, 0, 0);
    load->kind = LOAD_PRESSURE;
    load->amplitude = (Amplitude){.n = 1, .time = start, .value = whole};
  }
}

/* A pressure acts on the surface that there is, not on that of the motion which was forgotten (2 % more). What moved is
 * material, not nodes outside of it, which splines have a cell away (a quarter more). */
static void test_pressed(void **state)
{
  static const struct {
    const char *method, *basis;
    const Kinematics *kinematics;
  } ways[] = {{"fem", "cell", &kinematics_plane_strain},
              {"mpm", "gimp", &kinematics_plane_strain},
              {"mpm", "gimp", &kinematics_axisymmetric},
              {"mpm", "bspline", &kinematics_plane_strain}};
  PetscReal sigma[6], moved = 0;
  StepReport report;
  Bench b;
  (void)state;
  for (int k = 0; k < 4; ++k) {
    pressed(&b, ways[k].method, ways[k].basis, ways[k].kinematics);
    Model *m = equilibrium(&b, &report);
    CHECK(report.outcome == STEP_ACCEPTED, "%s %s", ways[k].method, ways[k].basis);
    CALL(ModelStep(m, 1, &report));
    CHECK(report.outcome == STEP_ACCEPTED, "%s %s: first step", ways[k].method, ways[k].basis);
    for (PetscInt p = 0; p < m->points->n; ++p) {
      CALL(ModelPointStress(m, p, sigma));
      for (int c = 0; c < 2; ++c) CHECK_CLOSE(sigma[c], -PRESSURE, 1e-6 * PRESSURE);
    }
    if (k == 1) moved = m->initial.moved;
    if (k == 3) CHECK_CLOSE(m->initial.moved, moved, 1e-6 * moved);
    CALL(ModelDestroy(&m));
  }
}

/* The work of sliding begins with the equilibrium, as all accounts do. */
static void test_slides(void **state)
{
  WallSpec floor = {.name = (char *)"floor", .contact = CONTACT_FRICTION, .friction = 0.1};
  StepReport report;
  Bench b;
  (void)state;
  pressed(&b, "mpm", "gimp", &kinematics_plane_strain);
  floor.shape = (Shape){.kind = SHAPE_HALF_SPACE, .normal = {0, 1, 0}};
  b.c.n_walls = 1, b.c.walls = &floor;
  b.c.n_boundary = 1;
  Model *m = equilibrium(&b, &report);
  CHECK(report.outcome == STEP_ACCEPTED, "it stands");
  CHECK(m->initial.moved > 0.01, "moved %g m", (double)m->initial.moved);
  CHECK_CLOSE(m->contact->wall[0].friction, 0, 0);
  CALL(ModelDestroy(&m));
}

static void test_refused(void **state)
{
  Bench b;
  (void)state;
  slope(&b, "gmm", "displacement", CELL_QUADRILATERAL, 2);
  b.c.basis = (BasisSpec){.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  bench_refused(&b, PETSC_COMM_WORLD, "initial.equilibrium", "method gmm does not seek an equilibrium");
  slope(&b, "mpm", "displacement", CELL_QUADRILATERAL, 2);
  b.body[0].velocity[0] = 1;
  bench_refused(&b, PETSC_COMM_WORLD, "bodies[0]", "moves at the start");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_slope),    cmocka_unit_test(test_domains), cmocka_unit_test(test_gravity_loading),
    cmocka_unit_test(test_formulas), cmocka_unit_test(test_beyond),  cmocka_unit_test(test_bonded),
    cmocka_unit_test(test_pressed),  cmocka_unit_test(test_slides),  cmocka_unit_test(test_refused),
  };
  return run_model_tests(argc, argv, tests);
}
