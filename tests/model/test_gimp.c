/* The material point method with functions averaged over the points' domains (basis gimp) and with quadratic
 * splines (bspline), from the case to the stress: uniform strain, a free end anywhere, rings, a line of held nodes
 * inside, a column under its weight. */
#include "smooth.h"

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

/* A body fills the grid, whose sides take the linear field: nodes inside are free. In the first step
 * domains cover the body once, so that a uniform stress is balanced to the last digit. */
static void filled(const char *basis, const char *formulation, CellType cell, PetscReal size, PetscReal grading,
                   PetscInt points_per_cell)
{
  Bench b;
  PetscReal F[9];
  PetscInt dim = cell == CELL_HEXAHEDRON ? 3 : 2;
  bench_init(&b, "mpm", cell, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 1}, size);
  b.c.grid.grading[0] = grading;
  b.body[0].points_per_cell = points_per_cell;
  b.c.basis.kind = basis;
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
    filled("gimp", forms[k], CELL_QUADRILATERAL, 0.125, 1, 4);
    filled("gimp", forms[k], CELL_QUADRILATERAL, 0.125, 3, 9);
    filled("gimp", forms[k], CELL_HEXAHEDRON, 0.25, 1, 8);
    filled("bspline", forms[k], CELL_QUADRILATERAL, 0.125, 1, 4);
    filled("bspline", forms[k], CELL_QUADRILATERAL, 0.125, 1, 9);
    filled("bspline", forms[k], CELL_HEXAHEDRON, 0.25, 1, 8);
  }
}

static void test_pressed(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) pressed_body(forms[k], "gimp", 4, 17, 1e-12);
  for (int k = 0; k < 2; ++k) pressed_body(forms[k], "bspline", 4, 17, 1e-12);
}

/* A cylinder pressed from all sides: rings weigh their domains by the radius, so that the nodes inside
 * are balanced. */
static void squeeze(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  (void)context;
  increment[0] = -0.1 * (t1 - t0) * x[0];
  increment[1] = -0.2 * (t1 - t0) * x[1];
}

static void rings(const char *basis, const char *formulation)
{
  const PetscReal F[9] = {0.9, 0, 0, 0, 0.8, 0, 0, 0, 0.9};
  Bench b;
  tube(&b, "mpm", CELL_QUADRILATERAL, 0, 1, 1, 6);
  b.c.basis.kind = basis;
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
  for (int k = 0; k < 2; ++k) rings("gimp", forms[k]), rings("bspline", forms[k]);
}

/* An independent program in one dimension has 4.7e-3, 5.7e-4, 2.7e-4, and with linear functions 7 to
 * 8 % at all. */
static void test_column(void **state)
{
  const PetscInt n[] = {16, 64, 128};
  const PetscReal independent[] = {4.7e-3, 5.7e-4, 2.7e-4}, digit[] = {1e-4, 1e-5, 5e-6};
  (void)state;
  CHECK(settled_column(forms[0], "cell", 16, 0) > 0.05, "linear functions have learnt something");
  const int finest = ranks_of_world() > 1 ? 2 : 3; /* how the error falls is told by one rank */
  for (int k = 0; k < finest; ++k) {
    CHECK_CLOSE(settled_column(forms[0], "gimp", n[k], 0), independent[k], digit[k]);
    for (int form = 0; form < (k < 2 ? 2 : 1); ++form)
      CHECK(settled_column(forms[form], "gimp", n[k], 0.01) < independent[k] + digit[k], "off in the %s form",
            forms[form]);
  }
}

/* Where forces balance in the middle of a step, prescribed nodes, four of a single cell, are at
 * its end where they should be, and the body with them. */
static void test_middle(void **state)
{
  PetscReal F[9];
  PetscInt dim = 2;
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 1);
  bench_dynamic(&b, 1, 0.1);
  b.c.basis.kind = "gimp";
  b.c.analysis.scheme = (char *)"midpoint";
  b.c.analysis.transfer = (char *)"consistent";
  bench_motion(&b, -1, 0, MOTION_FIXED, 3);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = affine_motion;
  m->boundary->field_context = &dim;
  gradient_at(2, 1, F);
  while (m->time < 1 - 1e-9) CHECK(model_step(m, 1 - m->time).cuts == 0, "the step was halved");
  check_uniform(m, F, 1e-12);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

/* A body that flies crosses cells and ranks without changing its velocity, and bears no stress. */
static void flight(const char *basis)
{
  PetscReal sigma[6];
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 12);
  bench_box(&b, 0, (PetscReal[3]){0.25, 0.25, 0}, (PetscReal[3]){0.5, 0.5, 0});
  bench_dynamic(&b, 0.1, 0.01);
  b.c.basis.kind = basis;
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

static void test_flight(void **state)
{
  (void)state;
  flight("gimp");
  flight("bspline");
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
  b.c.basis.kind = "bspline";
  b.c.grid.grading[1] = 1.1;
  bench_refused(&b, PETSC_COMM_WORLD, "basis.bspline", "a box without grading");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 3);
  b.c.basis.kind = "gimp";
  b.c.analysis.transfer = (char *)"consistent";
  bench_dynamic(&b, 1, 1e-3);
  bench_refused(&b, PETSC_COMM_WORLD, "analysis.scheme", "takes scheme midpoint");
  bench_init(&b, "fem", CELL_QUADRILATERAL, 3);
  b.c.basis.kind = "gimp";
  bench_refused(&b, PETSC_COMM_WORLD, "basis", "method fem does not take the basis 'gimp'");
}

/* A column that a dead load on its end presses bears it alike everywhere, wherever between two lines the end stands:
 * splines are pushed by their own functions, also where the last node follows. */
static void test_loaded(void **state)
{
  const PetscReal ends[] = {0, 0.02, 0.1, 0.3, 0.6, 0.95}, h = 0.125;
  (void)state;
  for (int follows = 0; follows < 2; ++follows)
    EACH_OF (k, ends) {
      const PetscReal top = 1 + ends[k] * h;
      PetscReal sigma[6];
      Bench b;
      bench_init(&b, "mpm", CELL_QUADRILATERAL, 1);
      bench_grid(&b, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){h, 1 + 3 * h, 0}, h);
      bench_box(&b, 0, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){h, top, 0});
      b.c.basis.kind = "bspline";
      b.c.stabilisation.follow = follows ? 0.1 : 0.01;
      b.c.newton.residual = 1e-10;
      bench_motion(&b, 0, 0, MOTION_FIXED, 1);
      bench_motion(&b, 0, h, MOTION_FIXED, 1);
      bench_motion(&b, 1, 0, MOTION_FIXED, 2);
      bench_traction(&b, 1, top, "body", 0, -1e4, 0);
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      (void)run_through(m);
      for (PetscInt p = 0; p < m->points->n; ++p) {
        CALL(ModelPointStress(m, p, sigma));
        CHECK_CLOSE(sigma[1] / 1e4, -1, 1e-8);
      }
      CALL(ModelDestroy(&m));
      bench_end(&b);
    }
}

/* A column that hangs by its top and is pulled to 1.3 of its length in steps: its points come to stand anywhere in the
 * cells, and the stress is that of its load all the same. */
static void drawn(const char *basis)
{
  const PetscReal h = 0.25;
  PetscReal sigma[6];
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 1);
  bench_grid(&b, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){h, 1.75, 0}, h);
  bench_box(&b, 0, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){h, 1, 0});
  b.c.basis.kind = basis;
  b.c.newton.residual = 1e-10;
  b.c.analysis.step = b.c.analysis.largest = 1.0 / 16;
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_motion(&b, 0, h, MOTION_FIXED, 1);
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  bench_traction(&b, 1, 1, "body", 0, 3e5, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  (void)run_through(m);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    CALL(ModelPointStress(m, p, sigma));
    CHECK_CLOSE(sigma[1] / 3e5, 1, 1e-8);
    CHECK(point_real(m->points, POINT_F, p)[3] > 1.2, "hardly drawn");
  }
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_drawn(void **state)
{
  (void)state;
  drawn("gimp");
  drawn("bspline");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_filled), cmocka_unit_test(test_pressed), cmocka_unit_test(test_rings),
    cmocka_unit_test(test_column), cmocka_unit_test(test_flight),  cmocka_unit_test(test_refused),
    cmocka_unit_test(test_middle), cmocka_unit_test(test_loaded),  cmocka_unit_test(test_drawn),
  };
  return run_model_tests(argc, argv, tests);
}
