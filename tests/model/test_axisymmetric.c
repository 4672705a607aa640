/* Bodies of revolution at rest: uniform states, whose forces are known in closed form, in every
 * method and cell; cylinders and spheres under pressure against Lame and against the radial
 * equation integrated by itself. Numbers of the latter: an integration of the ordinary differential
 * equation of the neo-Hookean law to 1e-11, and a finite element program in another language. */
#include "axisymmetric.h"

/* --- uniform states --- */

/* u = (0.1 r, -0.2 z). */
static void squeeze(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  const PetscReal F0[9] = {1 + 0.1 * t0, 0, 0, 0, 1 - 0.2 * t0}, F1[9] = {1 + 0.1 * t1, 0, 0, 0, 1 - 0.2 * t1};
  (void)context;
  for (int d = 0; d < 2; ++d) increment[d] = (F1[4 * d] / F0[4 * d] - 1) * x[d];
}

static void check_squeezed(const Model *m, PetscReal tolerance)
{
  const PetscReal F[9] = {1.1, 0, 0, 0, 0.8, 0, 0, 0, 1.1}, J = 0.968;
  const PetscReal tau[6] = {62005.851, -157224.918, 62005.851};
  PetscReal expected[6];
  rubber_stress(F, expected);
  for (int k = 0; k < 6; ++k) CHECK_CLOSE(J * expected[k], tau[k], 1e-3);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal f[9], sigma[6];
    point_F(m->points, p, f);
    CALL(ModelPointStress(m, p, sigma));
    for (int i = 0; i < 9; ++i) CHECK_CLOSE(f[i], F[i], tolerance);
    for (int i = 0; i < 6; ++i) CHECK_CLOSE(sigma[i], expected[i], 1e6 * tolerance);
    CHECK_CLOSE(*point_real(m->points, POINT_J, p), J, tolerance);
  }
}

static const char *formulation = "displacement"; /* of the next test */

/* O1. Everything around the body is prescribed, its inside must follow; the axis is not. */
static void squeezed(const char *method, CellType cell, PointWeights weights, PetscBool distorted, PetscInt halved)
{
  Bench b;
  const PetscReal planes[] = {0, 1, 1.5};
  tube(&b, method, cell, 0, strcmp(method, "mpm") ? 1 : 1.5, 1, strcmp(method, "mpm") ? 4 : 6);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
  b.c.formulation = (char *)formulation;
  b.body[0].weights = weights;
  b.halved = halved;
  if (distorted) bench_distort(&b, 0.2, 3, planes);
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  bench_motion(&b, 1, 1, MOTION_FIXED, 3);
  bench_motion(&b, 0, 1, MOTION_FIXED, 3);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = squeeze;
  PetscReal volume = 0, all;
  for (PetscInt p = 0; p < m->points->n; ++p) volume += *point_real(m->points, POINT_VOLUME, p);
  CALL(MPI_Allreduce(&volume, &all, 1, MPIU_REAL, MPIU_SUM, m->comm));
  CHECK_CLOSE(all, PETSC_PI, 1e-13);
  run_through(m);
  check_squeezed(m, 1e-12);
  CHECK_CLOSE(reaction(m, 1, 1), -617420.810, 1e-3);
  CHECK_CLOSE(reaction(m, 0, 1), 617420.810, 1e-3);
  CHECK_CLOSE(reaction(m, 2, 0), 354176.592, 1e-3);
  CHECK_CLOSE(model_sum(m, "energy: balance", 0), 0, 1e-12);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_uniform(void **state)
{
  static const char *const method[] = {"fem", "mpm"};
  (void)state;
  for (int k = 0; k < 2; ++k)
    for (int distorted = 0; distorted < 2; ++distorted) {
      squeezed(method[k], CELL_QUADRILATERAL, WEIGHTS_AUTO, (PetscBool)distorted, 0);
      squeezed(method[k], CELL_TRIANGLE, WEIGHTS_AUTO, (PetscBool)distorted, 0);
      squeezed(method[k], CELL_TRIANGLE, WEIGHTS_EQUAL, (PetscBool)distorted, 0);
      squeezed(method[k], CELL_QUADRILATERAL, WEIGHTS_AUTO, (PetscBool)distorted, 3);
    }
  squeezed("mpm", CELL_QUADRILATERAL, WEIGHTS_EQUAL, PETSC_FALSE, 0);
}

static void test_uniform_shared(void **state)
{
  formulation = "mean-dilatation";
  test_uniform(state);
  formulation = "displacement";
}

/* Moved along the axis nothing strains. */
static void test_axial_shift(void **state)
{
  Bench b;
  (void)state;
  tube(&b, "fem", CELL_TRIANGLE, 0, 1, 1, 4);
  tube_moved(&b, 1, 0, 1, 0.3);
  tube_moved(&b, 1, 1, 1, 0.3);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  run_through(m);
  CHECK_CLOSE(model_sum(m, "energy: elastic", 0), 0, 1e-9);
  CHECK_CLOSE(reaction(m, 1, 1), 0, 1e-7);
  CALL(ModelDestroy(&m));
}

/* Moved outwards a ring strains by u / R, and by nothing else. */
static void test_radial_shift(void **state)
{
  Bench b;
  LawStatus status;
  (void)state;
  tube(&b, "fem", CELL_TRIANGLE, 1, 2, 1, 4);
  tube_moved(&b, 1, 0, 1, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i) m->nodes->du[2 * i] = 0.1;
  const WeakFormInput in = {.kinematics = b.c.kinematics,
                            .points = m->points,
                            .support = m->space->support,
                            .materials = m->materials,
                            .du = m->nodes->du};
  CALL(m->formulation->commit(&in, m->points, &status));
  CHECK(status == LAW_OK, "status %d", (int)status);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal F[9];
    point_F(m->points, p, F);
    for (int k = 0; k < 8; ++k) CHECK_CLOSE(F[k], k % 4 == 0, 1e-14);
    CHECK_CLOSE(F[8], 1 + 0.1 / *point_real(m->points, POINT_X, p), 1e-14);
  }
  CALL(ModelDestroy(&m));
}

/* A ring that would pass its axis is inverted, though det F of all three would be positive where
 * the section turns inside out, too. */
static void test_inverted(void **state)
{
  (void)state;
  for (int section = 0; section < 2; ++section) {
    Bench b;
    LawStatus status;
    tube(&b, "fem", CELL_TRIANGLE, 1, 2, 1, 4);
    tube_moved(&b, 1, 0, 1, 0);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt i = 0; i < m->grid->n_nodes; ++i)
      m->nodes->du[2 * i] = section ? -2 * m->grid->x[2 * i] : -2.5; /* x -> -x, or x - 2.5 */
    const WeakFormInput in = {.kinematics = b.c.kinematics,
                              .points = m->points,
                              .support = m->space->support,
                              .materials = m->materials,
                              .du = m->nodes->du};
    CALL(m->formulation->commit(&in, m->points, &status));
    CHECK(!m->points->n || status == LAW_INVERTED, "status %d", (int)status);
    CALL(ModelDestroy(&m));
  }
}

/* --- O2: compression along the axis --- */
static Model *compressed(Bench *b, PetscReal stretch, PetscInt steps, PetscBool free)
{
  b->c.analysis.step = b->c.analysis.largest = 1 / (PetscReal)steps;
  tube_moved(b, 1, 0, 1, 0);
  tube_moved(b, 1, 1, 1, stretch - 1);
  if (!free) tube_moved(b, 0, 1, 0, 0);
  return bench_model(b, PETSC_COMM_WORLD);
}

static void test_compression(void **state)
{
  static const struct {
    PetscReal stretch, across, force;
  } free[] = {{0.8, 1.0673383693, -753999.145}, {0.5, 1.2107673905, -2938495.15}, {1.5, 0.8801745918, 1188402.22}};
  (void)state;
  for (int k = 0; k < 3; ++k)
    for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell) {
      Bench b;
      tube(&b, "fem", cell, 0, 1, 1, 3);
      Model *m = compressed(&b, free[k].stretch, 4, PETSC_TRUE);
      PetscReal *X = node_places(m);
      run_through(m);
      CHECK_CLOSE(reaction(m, 1, 1), free[k].force, 1e-8 * PetscAbsReal(free[k].force));
      CHECK_CLOSE(moved_to(m, X, 1, 1, 0), free[k].across, 1e-9);
      CALL(PetscFree(X));
      CALL(ModelDestroy(&m));
    }
  Bench b;
  tube(&b, "fem", CELL_QUADRILATERAL, 0, 1, 1, 3);
  Model *m = compressed(&b, 0.8, 2, PETSC_FALSE);
  run_through(m);
  CHECK_CLOSE(reaction(m, 1, 1), -1049284.89, 0.01);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal tau[6];
    point_tau(m->points, p, tau);
    CHECK_CLOSE(tau[1], -267198.203, 1e-3);
    CHECK_CLOSE(tau[0], -128736.664, 1e-3);
    CHECK_CLOSE(tau[2], -128736.664, 1e-3);
  }
  CALL(ModelDestroy(&m));
}

/* Mohr-Coulomb on its edge: the strength stays, and the section grows as the dilatancy says. */
static void test_grains(void **state)
{
  static NamedValue soil[] = {
    {"young", 1e6}, {"poisson", 0.3}, {"friction_angle", 30}, {"dilatancy_angle", 10}, {"cohesion", 1000}};
  const PetscReal sine = PetscSinReal(PETSC_PI / 18), m_psi = (1 + sine) / (1 - sine), q = -2000 * PetscSqrtReal(3);
  static const struct {
    PetscReal stretch, across, force;
  } expected[] = {{0.99, 1.0057327, -10992.723}, {0.9, 1.0761607, -12091.996}, {0.8, 1.1700448, -13603.495}};
  (void)state;
  for (int k = 0; k < 3; ++k)
    for (int steps = 1; steps <= 20; steps += 19) {
      const PetscReal stretch = expected[k].stretch;
      const PetscReal across = PetscExpReal(-0.3 * q / 1e6 - m_psi / 2 * (PetscLogReal(stretch) - q / 1e6));
      Bench b;
      tube(&b, "fem", CELL_QUADRILATERAL, 0, 1, 1, 3);
      b.material =
        (MaterialSpec){.name = "rubber", .law = "mohr-coulomb", .density = 1000, .n_parameters = 5, .parameters = soil};
      Model *m = compressed(&b, stretch, steps, PETSC_TRUE);
      PetscReal *X = node_places(m);
      run_through(m);
      CHECK_CLOSE(across, expected[k].across, 1e-7);
      CHECK_CLOSE(reaction(m, 1, 1), expected[k].force, 1e-7 * PetscAbsReal(expected[k].force));
      CHECK_CLOSE(moved_to(m, X, 1, 1, 0), across, 1e-9);
      CALL(PetscFree(X));
      CALL(ModelDestroy(&m));
    }
}

/* --- thick walls --- */

/* A long tube, 1 to 2 m, in n cells over its wall. */
static Model *thick(Bench *b, CellType cell, PetscInt n, PetscReal radius, PetscReal pressure)
{
  tube(b, "fem", cell, 1, 2, 1. / (PetscReal)n, n);
  tube_moved(b, 1, 0, 1, 0);
  tube_moved(b, 1, 1. / (PetscReal)n, 1, 0);
  b->c.grid.diagonal = DIAGONAL_CROSSED;
  if (pressure != 0) tube_pressed(b, 1, pressure);
  else tube_moved(b, 0, 1, 0, radius - 1);
  b->c.newton.max_iterations = 40;
  return bench_model(b, PETSC_COMM_WORLD);
}

/* O3, Lame. The finite strain of p = 1 Pa is 1e-6. */
static void test_lame(void **state)
{
  static const PetscReal at[] = {1, 1.5, 2}, u[] = {1.906667e-6, 1.415556e-6, 1.213333e-6};
  (void)state;
  PetscReal error[2][3];
  for (int fine = 0; fine < 2; ++fine) {
    Bench b;
    Model *m = thick(&b, CELL_QUADRILATERAL, fine ? 16 : 8, 1, 1);
    PetscReal *X = node_places(m);
    run_through(m);
    for (int k = 0; k < 3; ++k) error[fine][k] = (moved_to(m, X, at[k], 0, 0) - at[k]) / u[k] - 1;
    CALL(PetscFree(X));
    CALL(ModelDestroy(&m));
  }
  for (int k = 0; k < 3; ++k) {
    CHECK(PetscAbsReal(error[1][k]) < 2e-3, "u(%g) is off by %g", (double)at[k], (double)error[1][k]);
    CHECK(order_of(error[0][k], error[1][k]) > 1.9, "order %g", (double)order_of(error[0][k], error[1][k]));
  }
}

/* O4. At r(a) = 1.5 another program's cells of the same size gave the same numbers. */
static void test_thick_tube(void **state)
{
  static const PetscReal twin[] = {1.89597144, 1.89575754}, force[] = {231122.56, 230308.43};
  PetscReal error[2];
  (void)state;
  for (int fine = 0; fine < 2; ++fine) {
    Bench b;
    Model *m = thick(&b, CELL_QUADRILATERAL, fine ? 8 : 4, 1.5, 0);
    PetscReal *X = node_places(m);
    run_through(m);
    const PetscReal r = moved_to(m, X, 1.5, 0, 0), P = -reaction(m, 2, 0) / (2 * PETSC_PI * b.c.grid.max[1]);
    CHECK_CLOSE(r, twin[fine], 6e-9);
    CHECK_CLOSE(-P, force[fine], 6e-3);
    error[fine] = r - 1.895685584;
    CALL(PetscFree(X));
    CALL(ModelDestroy(&m));
  }
  CHECK(order_of(error[0], error[1]) > 1.95, "order %g", (double)order_of(error[0], error[1]));
}

/* A dead pressure inside, up to a tenth of Young's modulus. */
static void test_pressed_tube(void **state)
{
  static const PetscReal pressure[] = {1e3, 1e4, 5e4, 1e5};
  static const PetscReal u[][2] = {{0.0019078264, 0.0012145264},
                                   {0.0191826844, 0.0122529325},
                                   {0.0982375987, 0.0636874364},
                                   {0.2022947348, 0.1335559415}};
  (void)state;
  for (int k = 0; k < 4; ++k)
    for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell) {
      PetscReal error[2][2];
      for (int fine = 0; fine < 2; ++fine) {
        Bench b;
        Model *m = thick(&b, cell, fine ? 16 : 8, 1, pressure[k]);
        PetscReal *X = node_places(m);
        run_through(m);
        for (int side = 0; side < 2; ++side)
          error[fine][side] = (moved_to(m, X, 1 + side, 0, 0) - 1 - side) / u[k][side] - 1;
        CALL(PetscFree(X));
        CALL(ModelDestroy(&m));
      }
      for (int side = 0; side < 2; ++side) {
        CHECK(PetscAbsReal(error[1][side]) < 3e-3, "%g Pa: off by %g", (double)pressure[k], (double)error[1][side]);
        CHECK(order_of(error[0][side], error[1][side]) > 1.9, "%g Pa: order %g", (double)pressure[k],
              (double)order_of(error[0][side], error[1][side]));
      }
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_uniform),     cmocka_unit_test(test_uniform_shared),
                                     cmocka_unit_test(test_axial_shift), cmocka_unit_test(test_radial_shift),
                                     cmocka_unit_test(test_inverted),    cmocka_unit_test(test_compression),
                                     cmocka_unit_test(test_grains),      cmocka_unit_test(test_lame),
                                     cmocka_unit_test(test_thick_tube),  cmocka_unit_test(test_pressed_tube)};
  return run_model_tests_in_turns(argc, argv, tests);
}
