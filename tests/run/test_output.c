/* Fields of the files in numbers, from states made by hand. */
#include "../model/case_builder.h"
#include "case/fields.h"
#include "run/output/output.h"

static PetscReal *field_of(const Model *m, const char *name, PetscInt components)
{
  const OutputField *field = output_field_find(name);
  PetscReal *data;
  CHECK(field && field->points && field->components == components, "%s", name);
  CALL(PetscCalloc1(m->points->n * components + 1, &data));
  CALL(OutputPointField(m, field, data));
  return data;
}

/* One number a point. */
static void check_scalar(const Model *m, const char *name, PetscReal expected)
{
  PetscReal *data = field_of(m, name, 1);
  for (PetscInt p = 0; p < m->points->n; ++p)
    CHECK(PetscAbsReal(data[p] - expected) <= 1e-12 * PetscAbsReal(expected), "%s is %.15g, not %.15g", name,
          (double)data[p], (double)expected);
  CALL(PetscFree(data));
}

/* Vectors have three components in files, the last of a plane case is zero. */
static void check_vector(const Model *m, const char *name, PetscReal scale)
{
  PetscReal *data = field_of(m, name, 3);
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt d = 0; d < 3; ++d) CHECK_CLOSE(data[3 * p + d], d < m->dim ? scale * (1 + d) : 0, 1e-15);
  CALL(PetscFree(data));
}

static void check_fields(CellType cell)
{
  const PetscReal J = 1.6, tau[2][6] = {{16, 32, 64, 8, 0, 0}, {16, 32, 64, 8, 24, 40}};
  Bench b;
  bench_init(&b, "mpm", cell, 2);
  bench_dynamic(&b, 1, 0.01);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal *t = tau[m->dim - 2], volume = 1 / (m->dim == 2 ? 16. : 64.), F[9] = {2, 0.5, 0, 0, 0.8, 0, 0, 0, 1};
  for (PetscInt p = 0; p < m->points->n; ++p) {
    point_set_tau(m->points, p, t);
    point_set_F(m->points, p, F);
    m->points->real[POINT_J][p] = J;
    for (PetscInt d = 0; d < m->dim; ++d) {
      point_real(m->points, POINT_U, p)[d] = 1 + d;
      point_real(m->points, POINT_V, p)[d] = 10 * (1 + d);
      point_real(m->points, POINT_A, p)[d] = 100 * (1 + d);
    }
  }
  check_vector(m, "displacement", 1);
  check_vector(m, "velocity", 10);
  check_vector(m, "acceleration", 100);
  check_scalar(m, "mass", 1000 * volume);
  check_scalar(m, "volume", J * volume);
  check_scalar(m, "density", 1000 / J);
  check_scalar(m, "pressure", -(16. + 32 + 64) / 3 / J);
  /* sqrt(3/2) of the norm of the deviator */
  PetscReal norm2 = 0;
  for (int k = 0; k < 6; ++k) norm2 += (k < 3 ? 1 : 2) * PetscSqr(t[k] - (k < 3 ? (16. + 32 + 64) / 3 : 0));
  check_scalar(m, "mises", PetscSqrtReal(1.5 * norm2) / J);
  check_scalar(m, "volume_strain", log(J));
  PetscReal *stress = field_of(m, "stress", 6), *gradient = field_of(m, "deformation_gradient", 9);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    for (int k = 0; k < 6; ++k) CHECK_CLOSE(stress[6 * p + k], t[k] / J, 1e-13);
    for (int k = 0; k < 9; ++k) CHECK_CLOSE(gradient[9 * p + k], F[k], 1e-15);
  }
  CALL(PetscFree(stress));
  CALL(PetscFree(gradient));
  CALL(ModelDestroy(&m));
}

static void test_fields(void **state)
{
  (void)state;
  check_fields(CELL_QUADRILATERAL);
  check_fields(CELL_HEXAHEDRON);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_fields)};
  return run_model_tests(argc, argv, tests);
}
