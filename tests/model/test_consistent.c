/* Transfer `consistent`, seen from outside: nodes reproduce any linear motion of the points, also
 * where cells are not full; the momentum of the nodes by the mass matrix, written down again here, is
 * that of the points; the impulse of prescribed nodes is all that these take. */
#include "case_builder.h"
#include "method/transfer/mass.h"

enum { CELLS = 6, SIDE = CELLS + 1 };

static PetscReal hat(PetscReal x, PetscReal node) { return PetscMax(0, 1 - PetscAbsReal(x - node) * CELLS); }

/* Of a quadrilateral's node at the point x, CELLS cells along a side of 1 m. */
static PetscReal shape_at(const PetscReal *node, const PetscReal *x) { return hat(x[0], node[0]) * hat(x[1], node[1]); }

static PetscReal sum_over(const Model *m, PetscReal part)
{
  CALL(MPI_Allreduce(MPI_IN_PLACE, &part, 1, MPIU_REAL, MPI_SUM, m->comm));
  return part;
}

static Model *block(Bench *b, CellType cell, PetscBool held, PetscBool yields)
{
  static NamedValue grains[4] = {{"young", 1e5}, {"poisson", 0.3}, {"friction_angle", 30}, {"cohesion", 0}};
  bench_init(b, "mpm", cell, CELLS);
  if (yields) b->material.law = "mohr-coulomb", b->material.parameters = grains, b->material.n_parameters = 4;
  bench_box(b, 0, (PetscReal[]){1. / 3, 0, 1. / 6}, (PetscReal[]){5. / 6, 5. / 6, 2. / 3});
  bench_dynamic(b, 1, 1e-3);
  b->c.analysis.transfer = (char *)"consistent";
  b->c.stabilisation = (StabilisationSpec){.stiffness = 1e-6, .mass = 1, .inertia = 0.05};
  if (held) bench_motion(b, 1, 0, MOTION_FIXED, 3);
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Two motions that are linear in x. */
static PetscReal linear_at(PetscInt motion, PetscInt d, const PetscReal *x, PetscInt dim)
{
  PetscReal sum = 0.3 * (PetscReal)(d + 1);
  for (PetscInt j = 0; j < dim; ++j) sum += (motion ? 7 : 1) * sin(1 + (PetscReal)(3 * d + j)) * x[j];
  return sum;
}

/* Masses of their own, and cells half empty. */
static void set_masses(Model *m)
{
  for (PetscInt p = 0; p < m->points->n; ++p) {
    Random random = {(uint64_t)m->points->id[p] + 3};
    m->points->real[POINT_MASS][p] *= random_real(&random, 0.5, 1.5);
    m->points->real[POINT_J][p] = random_real(&random, 0.3, 0.9);
  }
}

static void set_linear(Model *m)
{
  const PetscReal none[3] = {0, 0, 0};
  set_masses(m);
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt k = 0; k < 2; ++k)
      for (PetscInt d = 0; d < m->dim; ++d) {
        PetscReal *slope = point_real(m->points, POINT_SLOPE, p) + (k * m->dim + d) * m->dim;
        point_real(m->points, k ? POINT_A : POINT_V, p)[d] = linear_at(k, d, point_real(m->points, POINT_X, p), m->dim);
        for (PetscInt j = 0; j < m->dim; ++j) {
          const PetscReal one[3] = {j == 0, j == 1, j == 2};
          slope[j] = linear_at(k, d, one, m->dim) - linear_at(k, d, none, m->dim);
        }
      }
}

/* To the tolerance of the solve, 1e-6 of the motion, over the least eigenvalue, some per cent. */
static void test_linear(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
    Bench b;
    Model *m = block(&b, cell, PETSC_FALSE, PETSC_FALSE);
    set_linear(m);
    CALL(m->method->initialise(m->space));
    for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) {
      const PetscReal *x = m->grid->x + i / m->dim * m->dim;
      if (!m->nodes->touched[i / m->dim]) continue;
      CHECK_CLOSE(m->nodes->v[i], linear_at(0, i % m->dim, x, m->dim), 1e-4);
      CHECK_CLOSE(m->nodes->a[i], linear_at(1, i % m->dim, x, m->dim), 1e-3);
    }
    CALL(ModelDestroy(&m));
  }
}

/* Where a law yields, nodes hear of gradients of the velocity alone: those of points that do not accelerate give
 * nobody an acceleration. */
static void test_yields(void **state)
{
  (void)state;
  for (PetscBool yields = PETSC_FALSE; yields <= PETSC_TRUE; ++yields) {
    Bench b;
    Model *m = block(&b, CELL_QUADRILATERAL, PETSC_FALSE, yields);
    PetscReal velocity = 0, acceleration = 0;
    set_linear(m);
    for (PetscInt p = 0; p < m->points->n; ++p)
      for (PetscInt d = 0; d < 2; ++d) point_real(m->points, POINT_V, p)[d] = point_real(m->points, POINT_A, p)[d] = 0;
    CALL(m->method->initialise(m->space));
    for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) {
      velocity += PetscAbsReal(m->nodes->v[i]);
      acceleration += PetscAbsReal(m->nodes->a[i]);
    }
    assert_true(sum_over(m, velocity) > 1);
    if (yields) assert_true(sum_over(m, acceleration) == 0);
    else assert_true(sum_over(m, acceleration) > 1);
    CALL(ModelDestroy(&m));
  }
}

/* What nodes do not change stays with the points, be it seen or not: with all of the mass lumped their gradients are
 * what they were, although nodes see but means of them. */
static void test_unseen(void **state)
{
  (void)state;
  Bench b;
  Model *m = block(&b, CELL_QUADRILATERAL, PETSC_FALSE, PETSC_FALSE);
  PetscReal *before, seen = 0;
  StepReport report;
  CALL(ModelDestroy(&m));
  b.c.analysis.mass = MASS_LUMPED;
  b.c.analysis.step = b.c.analysis.largest = 1e-9;
  m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscInt n = m->points->n;
  CALL(PetscMalloc1(4 * n, &before));
  for (PetscInt p = 0; p < n; ++p) {
    Random random = {(uint64_t)m->points->id[p] + 5};
    for (PetscInt k = 0; k < 4; ++k) point_real(m->points, POINT_SLOPE, p)[k] = random_real(&random, -1, 1);
    CALL(PetscArraycpy(before + 4 * p, point_real(m->points, POINT_SLOPE, p), 4));
  }
  m->space->present = PETSC_FALSE; /* nodes are told again */
  CALL(ModelStep(m, 1e-9, &report));
  assert_int_equal(report.outcome, STEP_ACCEPTED);
  for (PetscInt i = 0; i < m->grid->n_nodes * 2; ++i) seen += PetscAbsReal(m->nodes->v[i]);
  assert_true(sum_over(m, seen) > 1e-2);
  assert_int_equal(m->points->n, n);
  for (PetscInt p = 0; p < n; ++p)
    for (PetscInt k = 0; k < 4; ++k) CHECK_CLOSE(point_real(m->points, POINT_SLOPE, p)[k], before[4 * p + k], 1e-5);
  CALL(PetscFree(before));
  CALL(ModelDestroy(&m));
}

/* sum_p N_I m (sum_J N_J v_J) of full cells, against sum_p N_I m v_p; and its sum over all nodes. */
static void test_momentum(void **state)
{
  Bench b;
  (void)state;
  Model *m = block(&b, CELL_QUADRILATERAL, PETSC_FALSE, PETSC_FALSE);
  PetscReal sum[2] = {0, 0}, points[2] = {0, 0}, mass = 0;
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt d = 0; d < 2; ++d) {
      Random random = {(uint64_t)(2 * m->points->id[p] + d)};
      const PetscReal v = random_real(&random, -1, 1);
      point_real(m->points, POINT_V, p)[d] = v;
      points[d] += m->points->real[POINT_MASS][p] * v;
      mass += m->points->real[POINT_MASS][p] / 2;
    }
  CALL(m->method->initialise(m->space));
  PetscReal gap[SIDE * SIDE][2] = {{0}};
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p);
    PetscReal v[2] = {0, 0};
    for (PetscInt i = 0; i < m->grid->n_nodes; ++i)
      for (PetscInt d = 0; d < 2; ++d) v[d] += shape_at(m->grid->x + 2 * i, x) * m->nodes->v[2 * i + d];
    for (PetscInt k = 0; k < SIDE * SIDE; ++k) {
      const PetscReal at[2] = {(PetscReal)(k % SIDE) / CELLS, (PetscReal)(k / SIDE) / CELLS};
      for (PetscInt d = 0; d < 2; ++d)
        gap[k][d] += shape_at(at, x) * m->points->real[POINT_MASS][p] * (v[d] - point_real(m->points, POINT_V, p)[d]);
    }
  }
  for (PetscInt i = 0; i < m->grid->n_owned * 2; ++i) sum[i % 2] += m->nodes->mass[i / 2] * m->nodes->v[i];
  CALL(MPI_Allreduce(MPI_IN_PLACE, gap, SIDE * SIDE * 2, MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt d = 0; d < 2; ++d) CHECK_CLOSE(sum_over(m, sum[d]), sum_over(m, points[d]), 1e-12 * sum_over(m, mass));
  for (PetscInt k = 0; k < SIDE * SIDE * 2; ++k) CHECK_CLOSE(gap[k / 2][k % 2], 0, 1e-5 * sum_over(m, mass));
  CALL(ModelDestroy(&m));
}

/* Two bodies that cannot have it: nodes of fem keep their motion, and the floor that takes nothing is
 * the thesis's. */
static void test_refused(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 4);
  bench_dynamic(&b, 1, 1e-3);
  b.c.analysis.transfer = (char *)"consistent";
  bench_refused(&b, PETSC_COMM_WORLD, "analysis.transfer", "only mpm takes it from points");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_dynamic(&b, 1, 1e-3);
  b.c.analysis.transfer = (char *)"consistent";
  b.c.analysis.keep_velocity = PETSC_TRUE;
  bench_refused(&b, PETSC_COMM_WORLD, "analysis.keep_velocity", "transfer consistent knows no such floor");
  bench_init(&b, "fem", CELL_QUADRILATERAL, 4);
  bench_dynamic(&b, 1, 1e-3);
  b.c.analysis.scheme = (char *)"midpoint";
  bench_refused(&b, PETSC_COMM_WORLD, "analysis.scheme", "is for method mpm");
  bench_init(&b, "mpm", CELL_TRIANGLE, 4);
  bench_dynamic(&b, 1, 1e-3);
  b.c.analysis.scheme = (char *)"midpoint";
  b.c.formulation = "mixed";
  bench_refused(&b, PETSC_COMM_WORLD, "analysis.scheme", "displacements alone");
}

/* The mass matrix summed up row by row, as long solves do, is that of the sums over points of their first products:
 * lumped and tied as cells are full. */
static void test_rows(void **state)
{
  (void)state;
  const char *const bases[] = {"cell", "gimp", "bspline"};
  EACH_OF (k, bases) {
    PetscReal largest = 0, *by_points;
    MassSolve c;
    Bench b;
    Model *m;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, CELLS);
    bench_box(&b, 0, (PetscReal[]){1. / 3, 0, 0}, (PetscReal[]){0.8, 5. / 6, 0});
    bench_dynamic(&b, 1, 1e-3);
    b.c.basis.kind = bases[k], b.c.analysis.transfer = (char *)"consistent", b.c.analysis.scheme = (char *)"midpoint";
    b.c.stabilisation = (StabilisationSpec){.stiffness = 1e-6, .mass = 1, .inertia = 0.05};
    m = bench_model(&b, PETSC_COMM_WORLD);
    set_masses(m);
    CALL(m->method->initialise(m->space));
    CALL(MassSolveCreate(m->space, &c));
    for (PetscInt node = 0, i = 0; node < m->grid->n_nodes; ++node)
      for (PetscInt d = 0; d < c.width; ++d, ++i) c.x[i] = sin((PetscReal)(m->grid->global_node[node] + 7 * d));
    CALL(c.multiply(&c, c.x));
    CALL(PetscMalloc1(c.size, &by_points));
    CALL(PetscArraycpy(by_points, c.product, c.size));
    while (!c.rows) CALL(c.multiply(&c, c.x));
    for (PetscInt i = 0; i < m->grid->n_owned * c.width; ++i) largest = PetscMax(largest, PetscAbsReal(by_points[i]));
    for (PetscInt i = 0; i < m->grid->n_owned * c.width; ++i) CHECK_CLOSE(c.product[i], by_points[i], 1e-14 * largest);
    CHECK(sum_over(m, largest) > 0, "no mass");
    CALL(PetscFree(by_points));
    CALL(MassSolveDestroy(&c));
    CALL(ModelDestroy(&m));
  }
}

/* What turns freely is pulled by its own inertia alone, and the mean of that is known whatever its shape:
 * int tr sigma dV = int rho w^2 r^2 dV, twice its kinetic energy, however stiff it is beside what it turns by in a
 * step. */
static void test_spun(void **state)
{
  static const Kinematics *const kinds[] = {&kinematics_plane_strain, &kinematics_3d};
  const PetscReal half[2] = {-0.3, 0.3}, turn = 0.05; /* rad */
  (void)state;
  EACH_OF (k, kinds) {
    const PetscInt dim = kinds[k]->dim, steps = 20;
    PetscReal mean = 0, kinetic = 0;
    Bench b;
    bench_init(&b, "mpm", dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 0);
    b.c.kinematics = kinds[k];
    b.constants[0].value = 1e9, b.constants[1].value = 0.3;
    bench_grid(&b, (PetscReal[]){-0.6, -0.6, -0.6}, (PetscReal[]){0.6, 0.6, 0.6}, dim == 3 ? 0.2 : 0.1);
    bench_box(&b, 0, (PetscReal[]){half[0], half[0], half[0]}, (PetscReal[]){half[1], half[1], half[1]});
    b.body[0].spin[2] = dim == 3 ? 0.48 : 1;
    if (dim == 3) b.body[0].spin[0] = 0.6, b.body[0].spin[1] = 0.64;
    bench_dynamic(&b, (PetscReal)steps * turn, turn);
    b.c.basis.kind = "gimp", b.c.analysis.transfer = (char *)"consistent", b.c.analysis.scheme = (char *)"midpoint";
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt step = 0; step < steps; ++step) {
      PetscReal pull = 0, twice = 0;
      model_step(m, turn);
      for (PetscInt p = 0; p < m->points->n; ++p) {
        const PetscReal *tau = point_real(m->points, POINT_TAU, p), *v = point_real(m->points, POINT_V, p);
        for (PetscInt d = 0; d < dim; ++d) {
          pull += m->points->real[POINT_VOLUME][p] * tau[d];
          twice += m->points->real[POINT_MASS][p] * v[d] * v[d];
        }
      }
      mean += sum_over(m, pull) / (PetscReal)steps;
      kinetic += sum_over(m, twice) / (PetscReal)steps;
    }
    PetscPrintf(PETSC_COMM_WORLD, "%dD: %.6g J pull for %.6g\n", (int)dim, (double)mean, (double)kinetic);
    CHECK_CLOSE(mean, kinetic, 0.02 * kinetic);
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_linear),  cmocka_unit_test(test_yields),
                                     cmocka_unit_test(test_unseen),  cmocka_unit_test(test_momentum),
                                     cmocka_unit_test(test_refused), cmocka_unit_test(test_rows),
                                     cmocka_unit_test(test_spun)};
  return run_model_tests(argc, argv, tests);
}
