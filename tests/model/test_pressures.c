/* Pressures that follow the surface: a body pressed from all sides shrinks as its law says and takes p dV, the
 * tangent is the derivative of the force, and a free body stays where it is however far it has turned. Loads that vary
 * from place to place are the integrals of their formulas. */
#include "case_builder.h"
#include "model/model_private.h"

static PetscReal one_time[] = {0}, one_value[] = {1};

static LoadSpec *bench_pressure(Bench *b, int axis, PetscReal at, const char *body, PetscReal value)
{
  LoadSpec *load = bench_traction(b, axis, at, body, value, 0, 0);
  load->kind = LOAD_PRESSURE;
  return load;
}

typedef struct {
  const char *method, *basis;
  CellType cell;
  const Kinematics *kinematics;
  PetscBool on_body;
} Block;

/* Stretch of the neo-Hookean law under p from all sides, in `dim` directions. */
static PetscReal stretch_of(PetscReal p, PetscInt dim)
{
  const PetscReal E = 1e6, nu = 0.3, mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  PetscReal low = 0.3, high = 1;
  for (int k = 0; k < 100; ++k) {
    const PetscReal a = 0.5 * (low + high), J = PetscPowReal(a, (PetscReal)dim);
    if ((lambda * PetscLogReal(J) + mu * (a * a - 1)) / J < -p) low = a;
    else high = a;
  }
  return low;
}

/* Planes of symmetry at 0, p on the other sides; in rings all directions shrink alike. */
static void shrink(const Block *r)
{
  const PetscInt dim = r->kinematics->dim, directions = r->kinematics->hoop ? 3 : dim;
  const PetscReal p = 4e5, a = stretch_of(p, directions);
  Bench b;
  Energies e;
  PetscReal off = 0;
  bench_init(&b, r->method, r->cell, 4);
  b.c.kinematics = r->kinematics;
  b.c.basis.kind = r->basis;
  for (int d = 0; d < dim; ++d) {
    bench_motion(&b, d, 0, MOTION_FIXED, 1u << d);
    bench_pressure(&b, d, 1, r->on_body ? "body" : NULL, p)->amplitude =
      (Amplitude){.n = 1, .time = one_time, .value = one_value};
  }
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, r->cell == CELL_HEXAHEDRON ? 0.5 : 1);
  for (PetscInt q = 0; q < m->points->n; ++q)
    for (PetscInt d = 0; d < dim; ++d) {
      const PetscReal x = point_real(m->points, POINT_X, q)[d], u = point_real(m->points, POINT_U, q)[d];
      off = PetscMax(off, PetscAbsReal(x - a * (x - u)));
    }
  CALL(ModelEnergies(m, &e));
  const PetscReal size = r->kinematics->hoop ? PETSC_PI : 1,
                  lost = p * size * (1 - PetscPowReal(a, (PetscReal)directions));
  off = model_max(m, off);
  PetscPrintf(PETSC_COMM_WORLD,
              "%s %s %s cell %d: off %.2g m, stretch %.6g, work %.9g of %.9g J, %d steps of %d iterations\n", r->method,
              r->basis, r->kinematics->name, (int)r->cell, (double)off, (double)a, (double)e.external, (double)lost,
              (int)m->step, (int)m->total_iterations);
  CHECK(off < 1e-9, "off by %g m", (double)off);
  if (directions == 2) CHECK_CLOSE(e.external, lost, 1e-8 * lost); /* areas are linear in the increments */
  CHECK(m->total_iterations <= 10 * m->step, "%d iterations", (int)m->total_iterations);
  CALL(ModelDestroy(&m));
}

static void test_shrinks(void **state)
{
  const Kinematics *plane = &kinematics_plane_strain, *space = &kinematics_3d, *ring = &kinematics_axisymmetric;
  const Block blocks[] = {
    {"fem", "cell", CELL_QUADRILATERAL, plane, PETSC_FALSE}, {"fem", "cell", CELL_TRIANGLE, plane, PETSC_TRUE},
    {"mpm", "cell", CELL_QUADRILATERAL, plane, PETSC_TRUE},  {"mpm", "cell", CELL_QUADRILATERAL, plane, PETSC_FALSE},
    {"fem", "cell", CELL_QUADRILATERAL, ring, PETSC_FALSE},  {"fem", "cell", CELL_HEXAHEDRON, space, PETSC_FALSE},
    {"fem", "cell", CELL_TETRAHEDRON, space, PETSC_TRUE},    {"mpm", "gimp", CELL_QUADRILATERAL, plane, PETSC_TRUE},
    {"mpm", "gimp", CELL_QUADRILATERAL, ring, PETSC_FALSE},  {"mpm", "gimp", CELL_HEXAHEDRON, space, PETSC_TRUE},
  };
  (void)state;
  EACH_OF (k, blocks) shrink(&blocks[k]);
}

/* Forces of the pressures with increments du. */
static void push(Model *m, const PetscReal *du, System *system, PetscReal *force)
{
  const NodalScene scene = nodal_scene(m, m->time, du);
  const NodalOutput out = {.force = force, .system = system};
  CALL(PetscArrayzero(force, m->grid->n_nodes * m->dim));
  for (PetscInt k = 0; k < m->forces.n; ++k)
    if (!strcmp(m->forces.one[k].kind->name, "pressures"))
      CALL(m->forces.one[k].kind->assemble(m->forces.one[k].data, &scene, &out));
}

/* d force / d du by differences, at increments of the size of the cells. */
static void differences(const Block *r)
{
  Bench b;
  bench_init(&b, r->method, r->cell, 2);
  b.c.kinematics = r->kinematics;
  b.c.basis.kind = r->basis;
  for (int d = 0; d < r->kinematics->dim; ++d) {
    bench_motion(&b, d, 0, MOTION_FIXED, 1u << d);
    bench_pressure(&b, d, 1, NULL, 1e4);
  }
  Model *m = bench_model(&b, PETSC_COMM_SELF);
  model_step(m, 0.5);
  const PetscInt dim = m->dim, n = m->grid->n_nodes * dim;
  const PetscReal h = 1e-6;
  PetscReal *du, *low, *high, worst = 0, largest = 0;
  Random random = {3};
  CALL(PetscMalloc3(n, &du, n, &low, n, &high));
  for (PetscInt i = 0; i < n; ++i) du[i] = random_real(&random, -0.05, 0.05);
  CALL(SystemZero(m->system));
  push(m, du, m->system, low);
  for (PetscInt j = 0; j < n; ++j) {
    const PetscReal was = du[j];
    du[j] = was + h;
    push(m, du, NULL, high);
    du[j] = was - h;
    push(m, du, NULL, low);
    du[j] = was;
    for (PetscInt i = 0; i < n; ++i) {
      const PetscInt slot = system_pair(m->system, i / dim, j / dim);
      const PetscReal k = slot < 0 ? 0 : m->system->values[(slot * dim + i % dim) * dim + j % dim];
      worst = PetscMax(worst, PetscAbsReal((high[i] - low[i]) / (2 * h) - k));
      largest = PetscMax(largest, PetscAbsReal(k));
    }
  }
  CHECK(largest > 1 && worst < 1e-7 * largest, "%s: tangent off by %g of %g", r->kinematics->name, (double)worst,
        (double)largest);
  CALL(PetscFree3(du, low, high));
  CALL(ModelDestroy(&m));
}

static void test_tangent(void **state)
{
  const Block blocks[] = {
    {"fem", "cell", CELL_QUADRILATERAL, &kinematics_plane_strain, PETSC_FALSE},
    {"fem", "cell", CELL_QUADRILATERAL, &kinematics_axisymmetric, PETSC_FALSE},
    {"mpm", "cell", CELL_TRIANGLE, &kinematics_plane_strain, PETSC_FALSE},
    {"fem", "cell", CELL_HEXAHEDRON, &kinematics_3d, PETSC_FALSE},
    {"mpm", "gimp", CELL_QUADRILATERAL, &kinematics_plane_strain, PETSC_FALSE},
    {"mpm", "gimp", CELL_QUADRILATERAL, &kinematics_axisymmetric, PETSC_FALSE},
    {"mpm", "gimp", CELL_HEXAHEDRON, &kinematics_3d, PETSC_FALSE},
  };
  (void)state;
  EACH_OF (k, blocks) differences(&blocks[k]);
}

/* A free block that turns, under the same pressure on all of its surface: no resultant, no torque, once round. */
static void spin(const char *method, const char *basis)
{
  Bench b;
  const PetscReal rate = 6;
  bench_init(&b, method, CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 2, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0.75, 0.75, 0}, (PetscReal[]){1.25, 1.25, 0});
  b.c.basis = (BasisSpec){.kind = basis, .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  bench_dynamic(&b, 1, 8e-3);
  b.body[0].spin[2] = rate;
  b.body[0].spin_centre[0] = b.body[0].spin_centre[1] = 1;
  LoadSpec *load = bench_pressure(&b, 0, 0.75, "body", 2e4);
  load->on.max[0] = 1.25; /* all of it */
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.4) model_step(m, PETSC_MAX_REAL);
  const PetscReal mass = 250,
                  off = PetscMax(PetscAbsReal(model_sum(m, "momentum", 0)), PetscAbsReal(model_sum(m, "momentum", 1)));
  PetscPrintf(PETSC_COMM_WORLD, "%s %s turned by %g rad: momentum off %.2g of %g kg m/s\n", method, basis,
              (double)(rate * m->time), (double)off, (double)(mass * rate * 0.25));
  CHECK(off < 1e-9 * mass * rate * 0.25, "momentum %g", (double)off);
  CALL(ModelDestroy(&m));
}

static void test_turns(void **state)
{
  (void)state;
  spin("fem", "cell");
  spin("mpm", "cell");
  spin("mpm", "gimp");
  spin("gmm", "lme");
}

static PetscReal reaction(Model *m, PetscInt component)
{
  const MeasureSpec measure = {.kind = "reaction", .component = component, .boundary = 0};
  PetscReal value;
  CALL(ModelMeasure(m, &measure, 0, &value));
  return value;
}

/* A stiff block held at x = 0 (in rings at their inner side), 1 m below the surface of a lake: its wall bears the
 * thrust of the water, and its buoyancy. */
static void sink(const Block *r)
{
  const PetscInt dim = r->kinematics->dim;
  const PetscReal weight = 9810, volume = r->kinematics->hoop ? PETSC_PI : 1;
  Bench b;
  bench_init(&b, r->method, r->cell, 4);
  b.c.kinematics = r->kinematics;
  b.c.basis = (BasisSpec){.kind = r->basis, .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  b.constants[0].value = 1e13;
  bench_motion(&b, 0, 0, MOTION_FIXED, 7);
  for (int k = 1; k < 2 * dim; ++k) {
    LoadSpec *load = bench_pressure(&b, k / 2, k % 2, r->on_body ? "body" : NULL, weight);
    load->amplitude = (Amplitude){.n = 1, .time = one_time, .value = one_value};
    load->factor = (char *)"max(0, 2 - y)";
  }
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  model_step(m, 1);
  const PetscReal thrust = reaction(m, 0), lift = reaction(m, 1);
  PetscPrintf(PETSC_COMM_WORLD, "%s %s %s: thrust %.9g of %g N, buoyancy %.9g of %.9g N\n", r->method, r->basis,
              r->kinematics->name, (double)thrust, 1.5 * weight, (double)-lift, (double)(weight * volume));
  if (!r->kinematics->hoop) CHECK_CLOSE(thrust, 1.5 * weight, 1e-7 * weight);
  CHECK_CLOSE(lift, -weight * volume, 1e-7 * weight);
  CALL(ModelDestroy(&m));
}

static void test_sinks(void **state)
{
  const Block blocks[] = {{"fem", "cell", CELL_QUADRILATERAL, &kinematics_plane_strain, PETSC_FALSE},
                          {"mpm", "gimp", CELL_QUADRILATERAL, &kinematics_plane_strain, PETSC_TRUE},
                          {"mpm", "cell", CELL_HEXAHEDRON, &kinematics_3d, PETSC_TRUE},
                          {"mpm", "cell", CELL_TRIANGLE, &kinematics_axisymmetric, PETSC_FALSE},
                          {"gmm", "lme", CELL_QUADRILATERAL, &kinematics_plane_strain, PETSC_TRUE}};
  (void)state;
  EACH_OF (k, blocks) sink(&blocks[k]);
}

/* Tractions and forces know where the material was, and the time. */
static void test_varies(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  for (int k = 0; k < 2; ++k) {
    LoadSpec *load = bench_traction(&b, 1, 1, k ? "body" : NULL, 300, 0, 0);
    load->amplitude = (Amplitude){.n = 1, .time = one_time, .value = one_value};
    load->factor = (char *)"X^2*t";
  }
  LoadSpec *point = &b.load[b.c.n_loads++];
  *point = (LoadSpec){.kind = LOAD_POINT, .at = {0.5, 0.75}, .value = {7, 0}, .factor = (char *)"X + 2*Y - 3*t"};
  point->amplitude = (Amplitude){.n = 1, .time = one_time, .value = one_value};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int k = 1; k <= 2; ++k) {
    model_step(m, 0.5);
    /* two of 300 t/3 N, and the point's */
    const PetscReal forces = 200 * 0.5 * k + 7 * (2 - 1.5 * k);
    PetscPrintf(PETSC_COMM_WORLD, "t = %g: %.12g of %g N\n", (double)m->time, (double)-reaction(m, 0), (double)forces);
    CHECK_CLOSE(reaction(m, 0), -forces, 1e-8 * forces);
  }
  CALL(ModelDestroy(&m));
}

static void test_no_number(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 2);
  bench_motion(&b, 0, 0, MOTION_FIXED, 3);
  bench_pressure(&b, 0, 1, NULL, 1)->factor = (char *)"sqrt(y - 0.5)";
  bench_refused(&b, PETSC_COMM_WORLD, "loads.pressures[0].factor", "is no number at (1, 0.");
}

static void test_nowhere(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 2);
  bench_motion(&b, 0, 0, MOTION_FIXED, 3);
  bench_pressure(&b, 0, 1, NULL, 1);
  bench_pressure(&b, 0, 3, NULL, 1);
  bench_refused(&b, PETSC_COMM_WORLD, "loads.pressures[1].on", "selects no face");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_shrinks), cmocka_unit_test(test_tangent), cmocka_unit_test(test_turns),
    cmocka_unit_test(test_sinks),   cmocka_unit_test(test_varies),  cmocka_unit_test(test_no_number),
    cmocka_unit_test(test_nowhere),
  };
  return run_model_group(argc, argv, tests, PETSC_STATIC_ARRAY_LENGTH(tests));
}
