/* The material point method with functions averaged over the points' domains (basis gimp), from the
 * case to the stress: uniform strain, a free end anywhere, rings, a column under its weight. */
#include "axisymmetric.h"

static const char *const forms[] = {"displacement", "mixed"};

/* x(t) = F(t) X with F(t) = 1 + t (F - 1); the unit square and cube stay within themselves. */
static const PetscReal final_F[2][9] = {{0.8, 0.14, 0, 0.07, 0.88, 0, 0, 0, 1},
                                        {0.75, 0.15, 0.06, 0.08, 0.8, 0.11, 0.05, 0.09, 0.7}};

static void gradient_at(PetscInt dim, PetscReal t, PetscReal F[9])
{
  for (int i = 0; i < 9; ++i) F[i] = (i % 4 == 0) + t * (final_F[dim - 2][i] - (i % 4 == 0));
}

static void affine_motion(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  PetscReal F0[9], F1[9];
  gradient_at(*(const PetscInt *)context, t0, F0);
  gradient_at(*(const PetscInt *)context, t1, F1);
  affine_increment(*(const PetscInt *)context, F0, F1, x, increment);
}

/* F, stress and place of all points are those of x = F X. */
static void check_uniform(const Model *m, const PetscReal F[9], PetscReal tolerance)
{
  PetscReal expected[6], sigma[6], f[9];
  rubber_stress(F, expected);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), *u = point_real(m->points, POINT_U, p);
    point_F(m->points, p, f);
    CALL(ModelPointStress(m, p, sigma));
    for (int i = 0; i < 9; ++i) CHECK_CLOSE(f[i], F[i], tolerance);
    for (int i = 0; i < 6; ++i) CHECK_CLOSE(sigma[i] / 1e6, expected[i] / 1e6, tolerance);
    for (PetscInt i = 0; i < m->dim; ++i) {
      PetscReal at = 0;
      for (PetscInt j = 0; j < m->dim; ++j) at += F[3 * i + j] * (x[j] - u[j]);
      CHECK_CLOSE(x[i], at, tolerance);
    }
  }
}

/* A body fills the grid, whose sides take the linear field: nodes inside are free. In the first step
 * domains cover the body once, so that a uniform stress is balanced to the last digit. */
static void filled(const char *formulation, CellType cell, PetscReal size, PetscReal grading, PetscInt points_per_cell)
{
  Bench b;
  PetscReal F[9];
  PetscInt dim = cell == CELL_HEXAHEDRON ? 3 : 2;
  bench_init(&b, "mpm", cell, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 1}, size);
  b.c.grid.grading[0] = grading;
  b.body[0].points_per_cell = points_per_cell;
  b.c.basis.kind = "gimp";
  b.c.formulation = (char *)formulation;
  bench_motion(&b, -1, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = affine_motion;
  m->boundary->field_context = &dim;
  gradient_at(dim, 1, F);
  CHECK(model_step(m, 1).cuts == 0, "the step was halved");
  check_uniform(m, F, 1e-12);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_filled(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    filled(forms[k], CELL_QUADRILATERAL, 0.125, 1, 4);
    filled(forms[k], CELL_QUADRILATERAL, 0.125, 3, 9);
    filled(forms[k], CELL_HEXAHEDRON, 0.25, 1, 8);
  }
}

/* A body of sixteen cells pressed to a quarter of its length in steps: its free end crosses cells
 * and ends anywhere in one. */
static PetscReal length_at(PetscReal t) { return 1 / (1 + 3 * t); }

static void press(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  (void)context;
  increment[0] = (length_at(t1) / length_at(t0) - 1) * x[0];
  increment[1] = 0;
}

static void pressed(const char *formulation)
{
  const PetscReal F[9] = {0.25, 0, 0, 0, 1, 0, 0, 0, 1};
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 1);
  bench_grid(&b, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){17, 4, 0}, 1);
  bench_box(&b, 0, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){16, 4, 0});
  b.c.basis.kind = "gimp";
  b.c.formulation = (char *)formulation;
  b.c.analysis.step = b.c.analysis.largest = 1.0 / 3;
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  bench_motion(&b, 1, 4, MOTION_FIXED, 2);
  bench_motion(&b, 0, 16, MOTION_FIXED, 3)->on.min[0] = 3.5;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = press;
  while (m->time < 1 - 1e-9) CHECK(model_step(m, 1 - m->time).cuts == 0, "the step was halved");
  CHECK(m->step == 3, "%d steps", (int)m->step);
  check_uniform(m, F, 1e-12);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_pressed(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) pressed(forms[k]);
}

/* A cylinder pressed from all sides: rings weigh their domains by the radius, so that the nodes inside
 * are balanced. */
static void squeeze(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  (void)context;
  increment[0] = -0.1 * (t1 - t0) * x[0];
  increment[1] = -0.2 * (t1 - t0) * x[1];
}

static void rings(const char *formulation)
{
  const PetscReal F[9] = {0.9, 0, 0, 0, 0.8, 0, 0, 0, 0.9};
  Bench b;
  tube(&b, "mpm", CELL_QUADRILATERAL, 0, 1, 1, 6);
  b.c.basis.kind = "gimp";
  b.c.formulation = (char *)formulation;
  bench_motion(&b, -1, 0, MOTION_FIXED, 3);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = squeeze;
  (void)run_through(m);
  check_uniform(m, F, 1e-12);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_rings(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) rings(forms[k]);
}

/* A column of 50 m that settles under its weight in 40 static steps: in uniaxial strain the vertical
 * stress is the weight above, sigma_yy = -rho0 g (l0 - Y). Returns how far points are off in the
 * mean, over rho0 g l0. */
static PetscReal column(const char *formulation, const char *basis, PetscInt n, PetscReal curvature)
{
  const PetscReal l0 = 50, h = l0 / (PetscReal)n, weight = 800;
  PetscReal local[2] = {0, 0}, sum[2], sigma[6], ratio[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL};
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 1);
  bench_grid(&b, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){h, l0 + h, 0}, h);
  bench_box(&b, 0, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){h, l0, 0});
  b.constants[0].value = 1e4;
  b.constants[1].value = 0;
  b.material.density = weight / 10;
  b.c.gravity[1] = -10;
  b.c.basis.kind = basis;
  b.c.formulation = (char *)formulation;
  b.c.stabilisation.curvature = curvature;
  b.c.newton.residual = 1e-9;
  b.c.analysis.step = b.c.analysis.largest = 1.0 / 40;
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_motion(&b, 0, h, MOTION_FIXED, 1);
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  (void)run_through(m);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal Y = point_real(m->points, POINT_X, p)[1] - point_real(m->points, POINT_U, p)[1];
    const PetscReal volume = m->points->real[POINT_VOLUME][p];
    CALL(ModelPointStress(m, p, sigma));
    local[0] += volume * PetscAbsReal(sigma[1] + weight * (l0 - Y)) / (weight * l0);
    local[1] += volume;
    ratio[0] = PetscMax(ratio[0], sigma[1] / (weight * (l0 - Y)));
    ratio[1] = PetscMax(ratio[1], -sigma[1] / (weight * (l0 - Y)));
  }
  CALL(MPI_Allreduce(MPI_IN_PLACE, ratio, 2, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  CHECK_CLOSE(model_sum(m, "overburden: lowest_ratio", 0), -ratio[0], 1e-12);
  CHECK_CLOSE(model_sum(m, "overburden: highest_ratio", 0), ratio[1], 1e-12);
  CALL(MPI_Allreduce(local, sum, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  CHECK_CLOSE(model_sum(m, "overburden: mean", 0), sum[0] / sum[1], 1e-14);
  CALL(ModelDestroy(&m));
  bench_end(&b);
  PetscPrintf(PETSC_COMM_WORLD, "column of %d cells with %s: stress off by %.3g\n", (int)n, basis,
              (double)(sum[0] / sum[1]));
  return sum[0] / sum[1];
}

/* An independent program in one dimension has 4.7e-3, 5.7e-4, 2.7e-4, and with linear functions 7 to
 * 8 % at all. */
static void test_column(void **state)
{
  const PetscInt n[] = {16, 64, 128};
  const PetscReal independent[] = {4.7e-3, 5.7e-4, 2.7e-4}, digit[] = {1e-4, 1e-5, 5e-6};
  (void)state;
  CHECK(column(forms[0], "cell", 16, 0) > 0.05, "linear functions have learnt something");
  for (int k = 0; k < 3; ++k) {
    CHECK_CLOSE(column(forms[0], "gimp", n[k], 0), independent[k], digit[k]);
    for (int form = 0; form < (k < 2 ? 2 : 1); ++form)
      CHECK(column(forms[form], "gimp", n[k], 0.01) < independent[k] + digit[k], "off in the %s form", forms[form]);
  }
}

/* A body that flies crosses cells and ranks without changing its velocity, and bears no stress. */
static void test_flight(void **state)
{
  PetscReal sigma[6];
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 12);
  bench_box(&b, 0, (PetscReal[3]){0.25, 0.25, 0}, (PetscReal[3]){0.5, 0.5, 0});
  bench_dynamic(&b, 0.1, 0.01);
  b.c.basis.kind = "gimp";
  b.body[0].velocity[0] = 3, b.body[0].velocity[1] = 2;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.1 - 1e-9) model_step(m, 0.1 - m->time);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    CHECK_CLOSE(point_real(m->points, POINT_U, p)[0], 0.3, 1e-12);
    CHECK_CLOSE(point_real(m->points, POINT_V, p)[1], 2, 1e-11);
    CALL(ModelPointStress(m, p, sigma));
    for (int i = 0; i < 6; ++i) CHECK_CLOSE(sigma[i] / 1e6, 0, 1e-12);
  }
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_refused(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_TRIANGLE, 2);
  b.c.basis.kind = "gimp";
  bench_refused(&b, PETSC_COMM_WORLD, "basis.gimp", "a box of quadrilaterals");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 3);
  b.c.basis.kind = "gimp";
  b.c.grid.grading[1] = 9;
  bench_refused(&b, PETSC_COMM_WORLD, "basis.gimp", "graded too steeply");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 3);
  b.c.basis.kind = "gimp";
  b.c.analysis.transfer = (char *)"consistent";
  bench_refused(&b, PETSC_COMM_WORLD, "analysis.transfer", "makes energy with basis gimp");
  bench_init(&b, "fem", CELL_QUADRILATERAL, 3);
  b.c.basis.kind = "gimp";
  bench_refused(&b, PETSC_COMM_WORLD, "basis", "method fem does not take the basis 'gimp'");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_filled), cmocka_unit_test(test_pressed), cmocka_unit_test(test_rings),
    cmocka_unit_test(test_column), cmocka_unit_test(test_flight),  cmocka_unit_test(test_refused),
  };
  return run_model_tests(argc, argv, tests);
}
