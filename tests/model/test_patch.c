/* Patch tests: a uniform deformation prescribed on the boundary, or a uniform traction, makes a
 * uniform stress in every cell type, on regular and distorted meshes, in fem and mpm. */
#include "case_builder.h"

/* x(t) = F(t) X with F(t) = 1 + t (F - 1). */
static const PetscReal final_F[2][9] = {{1.15, 0.18, 0, -0.07, 0.88, 0, 0, 0, 1},
                                        {1.12, 0.15, -0.06, -0.08, 0.9, 0.11, 0.05, -0.09, 1.2}};

static const char *formulation = "displacement"; /* of all that follows */

static void gradient_at(PetscInt dim, PetscReal t, PetscReal F[9])
{
  for (int i = 0; i < 9; ++i) F[i] = (i % 4 == 0) + t * (final_F[dim - 2][i] - (i % 4 == 0));
}

static void affine_motion(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  const PetscInt dim = *(const PetscInt *)context;
  PetscReal F0[9], F1[9];
  gradient_at(dim, t0, F0);
  gradient_at(dim, t1, F1);
  affine_increment(dim, F0, F1, x, increment);
}

/* Uniform F and stress at all points, and points where the motion takes them. */
static void check_uniform(const Model *m, const PetscReal F[9], PetscReal tolerance)
{
  PetscReal expected[6], worst[3] = {0, 0, 0};
  rubber_stress(F, expected);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), *u = point_real(m->points, POINT_U, p);
    PetscReal f[9], sigma[6];
    point_F(m->points, p, f);
    CALL(ModelPointStress(m, p, sigma));
    for (int i = 0; i < 9; ++i) worst[0] = PetscMax(worst[0], PetscAbsReal(f[i] - F[i]));
    for (int i = 0; i < 6; ++i) worst[1] = PetscMax(worst[1], PetscAbsReal(sigma[i] - expected[i]) / 1e6);
    for (PetscInt i = 0; i < m->dim; ++i) {
      PetscReal at = 0;
      for (PetscInt j = 0; j < m->dim; ++j) at += F[3 * i + j] * (x[j] - u[j]);
      worst[2] = PetscMax(worst[2], PetscAbsReal(at - x[i]));
    }
  }
  CHECK(worst[0] <= tolerance, "F is off by %g", (double)worst[0]);
  CHECK(worst[1] <= tolerance, "the stress is off by %g E", (double)worst[1]);
  CHECK(worst[2] <= tolerance, "points are off by %g m", (double)worst[2]);
}

static void fix_all_sides(Bench *b)
{
  for (int d = 0; d < kinematics_dim(b->c.kinematics); ++d) {
    bench_motion(b, d, 0, MOTION_FIXED, 7);
    bench_motion(b, d, 1, MOTION_FIXED, 7);
  }
}

/* The body is a unit square or cube, in fem on a grid of its own, in mpm inside a larger one. */
static void body_bench(Bench *b, const char *method, CellType cell, Diagonal diagonal, PetscReal size,
                       PetscBool distorted, PetscInt halved)
{
  const PetscReal below = !strcmp(method, "mpm") ? -0.5 : 0, above = 1 - below, planes[] = {below, 0, 1, above};
  bench_init(b, method, cell, 0);
  bench_grid(b, (PetscReal[]){below, below, below}, (PetscReal[]){above, above, above}, size);
  b->c.formulation = (char *)formulation;
  b->c.grid.diagonal = diagonal;
  b->body[0].weights = WEIGHTS_GAUSS;
  b->halved = halved;
  if (distorted) bench_distort(b, 0.2, 4, planes);
}

static void patch_of(const char *method, CellType cell, Diagonal diagonal, PetscReal size, PetscBool distorted,
                     PetscInt halved)
{
  Bench b;
  const PetscBool fem = strcmp(method, "mpm") != 0;
  PetscReal F[9], *X;
  body_bench(&b, method, cell, diagonal, size, distorted, halved);
  PetscInt dim = kinematics_dim(b.c.kinematics);
  if (fem) b.c.analysis.step = b.c.analysis.largest = 0.5;
  fix_all_sides(&b);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = affine_motion;
  m->boundary->field_context = &dim;
  CALL(PetscMalloc1(m->grid->n_nodes * dim, &X));
  CALL(PetscArraycpy(X, m->grid->x, m->grid->n_nodes * dim));
  PetscReal cuts = 0;
  while (m->time < 1 - 1e-9) cuts += model_step(m, 1 - m->time).cuts;
  CHECK(cuts == 0, "the step was halved");
  gradient_at(dim, 1, F);
  check_uniform(m, F, 1e-12);
  PetscReal worst = 0;
  for (PetscInt i = 0; fem && i < m->grid->n_nodes * dim; ++i) {
    PetscReal x = 0;
    for (PetscInt j = 0; j < dim; ++j) x += F[3 * (i % dim) + j] * X[i / dim * dim + j];
    worst = PetscMax(worst, PetscAbsReal(x - m->grid->x[i]));
  }
  CHECK(worst <= 1e-12, "nodes are off by %g m", (double)worst);
  CALL(PetscFree(X));
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void patch(const char *method, CellType cell, Diagonal diagonal, PetscReal size, PetscBool distorted)
{
  patch_of(method, cell, diagonal, size, distorted, 0);
}

static void patch_all(CellType cell, PetscReal size)
{
  static const char *const method[] = {"fem", "mpm"};
  for (int k = 0; k < 2; ++k)
    for (int distorted = 0; distorted < 2; ++distorted)
      patch(method[k], cell, DIAGONAL_RIGHT, size, (PetscBool)distorted);
}

static void test_triangles(void **state)
{
  (void)state;
  patch_all(CELL_TRIANGLE, 0.25);
  for (Diagonal d = DIAGONAL_LEFT; d <= DIAGONAL_CROSSED; ++d) {
    patch("fem", CELL_TRIANGLE, d, 0.25, PETSC_FALSE);
    patch("mpm", CELL_TRIANGLE, d, 0.25, PETSC_FALSE);
    patch("fem", CELL_TRIANGLE, d, 0.25, PETSC_TRUE);
  }
}

static void test_quadrilaterals(void **state)
{
  (void)state;
  patch_all(CELL_QUADRILATERAL, 0.25);
}

/* Some quadrilaterals are two triangles each. */
static void test_mixed_cells(void **state)
{
  (void)state;
  for (PetscInt halved = 2; halved <= 5; halved += 3) {
    patch_of("fem", CELL_QUADRILATERAL, DIAGONAL_RIGHT, 0.25, PETSC_TRUE, halved);
    patch_of("mpm", CELL_QUADRILATERAL, DIAGONAL_RIGHT, 0.25, PETSC_TRUE, halved);
  }
}

static void test_tetrahedra(void **state)
{
  (void)state;
  patch_all(CELL_TETRAHEDRON, 0.5);
}

static void test_hexahedra(void **state)
{
  (void)state;
  patch_all(CELL_HEXAHEDRON, 0.5);
}

/* Stretch of a bar pulled by the dead traction T along x, free at its other sides: P_xx = T, the
 * rest of P vanishes. Two unknowns (along, across), Newton with differences. In plane strain one
 * side is held. */
static void uniaxial(PetscInt dim, PetscReal T, PetscReal F[9])
{
  PetscReal s[2] = {1, 1}, sigma[6], r[2], k[2][2];
  for (int i = 0; i < 9; ++i) F[i] = i % 4 == 0;
  for (int it = 0; it < 30; ++it) {
    for (int c = -1; c < 2; ++c) {
      const PetscReal h = 1e-6, a = s[0] + (c == 0 ? h : 0), l = s[1] + (c == 1 ? h : 0);
      F[0] = a, F[4] = l, F[8] = dim == 3 ? l : 1;
      rubber_stress(F, sigma);
      const PetscReal now[2] = {sigma[0] * F[4] * F[8] - T, sigma[1] * F[0] * F[8]};
      for (int i = 0; i < 2; ++i) {
        if (c < 0) r[i] = now[i];
        else k[i][c] = (now[i] - r[i]) / h;
      }
    }
    const PetscReal det = k[0][0] * k[1][1] - k[0][1] * k[1][0];
    s[0] -= (k[1][1] * r[0] - k[0][1] * r[1]) / det;
    s[1] -= (k[0][0] * r[1] - k[1][0] * r[0]) / det;
  }
  F[0] = s[0], F[4] = s[1], F[8] = dim == 3 ? s[1] : 1;
}

/* Rollers on the low sides, a dead traction on x = 1: on faces of the grid (pushing, so that points
 * stay inside) or carried by the body (pulling). */
static void traction(const char *method, CellType cell, PetscBool carried, PetscBool distorted, PetscInt halved)
{
  Bench b;
  PetscReal F[9];
  const PetscBool is_3d = cell >= CELL_TETRAHEDRON;
  const PetscReal T = carried ? 2e5 : -2e5, x_end = carried ? 1.5 : 1, planes[] = {0, 1, x_end, 1.5},
                  size = is_3d ? 0.5 : 0.25;
  bench_init(&b, method, cell, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){x_end, 1.5, 1.5}, size);
  b.c.formulation = (char *)formulation;
  b.body[0].weights = WEIGHTS_GAUSS;
  b.halved = halved;
  if (distorted) bench_distort(&b, 0.2, 4, planes);
  for (int d = 0; d < (is_3d ? 3 : 2); ++d) bench_motion(&b, d, 0, MOTION_FIXED, 1u << d);
  bench_traction(&b, 0, 1, carried ? "body" : NULL, T, 0, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const StepReport r = model_step(m, 1);
  CHECK(r.cuts == 0, "the step was halved");
  uniaxial(m->dim, T, F);
  check_uniform(m, F, 1e-11);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_traction(void **state)
{
  static const char *const method[] = {"fem", "mpm"};
  (void)state;
  for (int k = 0; k < 2; ++k)
    for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
      for (int carried = 0; carried < 2; ++carried)
        for (int distorted = 0; distorted < 2; ++distorted) traction(method[k], cell, carried != 0, distorted != 0, 0);
  for (int k = 0; k < 2; ++k)
    for (int carried = 0; carried < 2; ++carried) traction(method[k], CELL_QUADRILATERAL, carried != 0, PETSC_TRUE, 3);
}

/* The same where cells share their volume. */
static void test_shared_volume(void **state)
{
  formulation = "mean-dilatation";
  test_quadrilaterals(state);
  test_hexahedra(state);
  test_mixed_cells(state);
  test_traction(state);
  formulation = "displacement";
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_triangles),     cmocka_unit_test(test_quadrilaterals), cmocka_unit_test(test_tetrahedra),
    cmocka_unit_test(test_hexahedra),     cmocka_unit_test(test_mixed_cells),    cmocka_unit_test(test_traction),
    cmocka_unit_test(test_shared_volume),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
