/* Measures against closed forms of states that are made by hand. */
#include "case_builder.h"

/* A body that turns about its own centre while it flies: its spin is that of the body, wherever it
 * is; angular momentum is that about the origin. */
static void test_spin(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell) {
    const PetscBool is_3d = cell >= CELL_TETRAHEDRON;
    for (PetscInt axis = is_3d ? 0 : 2; axis < 3; ++axis) {
      Bench b;
      bench_init(&b, "mpm", cell, 8);
      bench_box(&b, 0, (PetscReal[]){0.5, 0.25, 0.125}, (PetscReal[]){1, 0.75, 0.5});
      bench_dynamic(&b, 1, 0.01);
      const PetscReal centre[3] = {0.75, 0.5, 0.3125}, velocity[3] = {2, -3, is_3d ? 5 : 0};
      for (int d = 0; d < 3; ++d) {
        b.body[0].spin_centre[d] = centre[d];
        b.body[0].velocity[d] = velocity[d];
      }
      b.body[0].spin[axis] = 7;
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      const PetscReal mass = model_sum(m, "mass: total", 0);
      const PetscInt i = (axis + 1) % 3, j = (axis + 2) % 3;
      PetscReal local = 0, inertia; /* of the points, about the centre */
      for (PetscInt p = 0; p < m->points->n; ++p) {
        const PetscReal *x = point_real(m->points, POINT_X, p);
        local += m->points->real[POINT_MASS][p] * (PetscSqr(x[i] - centre[i]) + PetscSqr(x[j] - centre[j]));
      }
      CALL(MPI_Allreduce(&local, &inertia, 1, MPIU_REAL, MPI_SUM, m->comm));
      CHECK_CLOSE(model_sum(m, "spin", axis), 7, 1e-9);
      CHECK_CLOSE(model_sum(m, "angular_momentum", axis),
                  7 * inertia + mass * (centre[i] * velocity[j] - centre[j] * velocity[i]), 1e-9 * mass);
      for (PetscInt d = 0; d < m->dim; ++d) CHECK_CLOSE(model_sum(m, "momentum", d), mass * velocity[d], 1e-9 * mass);
      CALL(ModelDestroy(&m));
    }
  }
}

/* Two boxes that turn as one about an axis that is none of their own: the spin is that of their motion. */
static void test_spin_of_any_shape(void **state)
{
  const PetscReal spin[3] = {1, -2, 3};
  (void)state;
  Bench b;
  bench_init(&b, "mpm", CELL_HEXAHEDRON, 4);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.75, 0.25, 0.5});
  b.body[1] = b.body[0];
  b.body[1].name = (char *)"other";
  bench_box(&b, 1, (PetscReal[]){0.75, 0, 0}, (PetscReal[]){1, 0.75, 0.25});
  b.c.n_bodies = 2;
  bench_dynamic(&b, 1, 0.01);
  for (int d = 0; d < 3; ++d)
    for (int k = 0; k < 2; ++k) b.body[k].spin[d] = spin[d], b.body[k].velocity[d] = 5 - d;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt d = 0; d < 3; ++d) CHECK_CLOSE(model_sum(m, "spin", d), spin[d], 1e-12);
  CALL(ModelDestroy(&m));
}

/* The height of a surface is that of its material: what has come apart is no higher, what is
 * pressed together is lower. */
static void test_surface(void **state)
{
  static const PetscReal J[] = {1, 2, 10, 0.5};
  (void)state;
  for (int k = 0; k < 4; ++k) {
    Bench b;
    PetscReal height, front;
    const MeasureSpec at = {.kind = "surface", .word = "height", .has_at = PETSC_TRUE, .at = 0.3},
                      end = {.kind = "surface", .word = "front"};
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 8);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.5, 0.75, 1});
    bench_dynamic(&b, 1, 0.01);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (PetscInt p = 0; p < m->points->n; ++p) m->points->real[POINT_J][p] = J[k];
    CALL(ModelMeasure(m, &at, 0, &height));
    CALL(ModelMeasure(m, &end, 0, &front));
    const PetscReal expected = 0.75 * PetscMin(1, J[k]);
    CHECK_CLOSE(height, expected, 1e-12);
    /* the station at the end has half of the height and the next one none: down to half a
     * spacing */
    CHECK_CLOSE(front, 0.5 + 0.125 * (expected / 2 - 0.0625) / (expected / 2), 1e-12);
    CALL(ModelDestroy(&m));
  }
}

/* Cauchy stress is Kirchhoff's over the present volume. */
static void test_stress(void **state)
{
  Bench b;
  PetscReal sigma[6];
  (void)state;
  bench_init(&b, "mpm", CELL_HEXAHEDRON, 2);
  bench_dynamic(&b, 1, 0.01);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal tau[6] = {1, 2, 3, 4, 5, 6};
    point_set_tau(m->points, p, tau);
    m->points->real[POINT_J][p] = 1.25;
    CALL(ModelPointStress(m, p, sigma));
    for (int k = 0; k < 6; ++k) CHECK_CLOSE(sigma[k], tau[k] / 1.25, 1e-15);
  }
  CALL(ModelDestroy(&m));
}

/* The mean over a body is by the volume that its material has: sum of tau V0 over sum of J V0. What
 * comes of measures is named in their list. */
static void test_mean_stress(void **state)
{
  MeasureSpec list[] = {{.name = "along", .kind = "stress", .word = "yy"},
                        {.name = "shear", .kind = "stress", .word = "xy", .has_in = PETSC_TRUE},
                        {.name = "both", .kind = "formula", .word = "2 * along + shear^2"}};
  PetscReal value[3];
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_dynamic(&b, 1, 0.01);
  list[1].in = b.body[0].shape;
  for (int d = 0; d < 3; ++d) list[1].in.min[d] -= 1, list[1].in.max[d] += 1; /* points that grew, too */
  b.c.measures = list;
  b.c.n_measures = 3;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscBool right = point_real(m->points, POINT_X, p)[0] > 0.5;
    const PetscReal tau[6] = {1, right ? 6 : 2, 3, 4, 5, 6};
    point_set_tau(m->points, p, tau);
    m->points->real[POINT_J][p] = right ? 1.5 : 0.5;
  }
  for (PetscInt k = 0; k < 3; ++k) CALL(ModelMeasure(m, &list[k], k, &value[k]));
  CHECK_CLOSE(value[0], (2 + 6) / (0.5 + 1.5), 1e-12);
  CHECK_CLOSE(value[1], 4, 1e-12);
  CHECK_CLOSE(value[2], 24, 1e-12);
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_spin), cmocka_unit_test(test_spin_of_any_shape),
                                     cmocka_unit_test(test_surface), cmocka_unit_test(test_stress),
                                     cmocka_unit_test(test_mean_stress)};
  return run_model_tests(argc, argv, tests);
}
