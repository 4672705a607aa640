/* In its first step mpm with Gauss weights is fem: the same positions, deformations and stresses to
 * 1e-10. */
#include "case_builder.h"

/* Nothing accelerates yet: fem begins with accelerations by its mass matrix, mpm by the lumped mass. */
static void begin_unaccelerated(Model *m)
{
  CALL(PetscArrayzero(m->points->real[POINT_A], m->points->n * m->dim));
  CALL(PetscArrayzero(m->nodes->a, m->grid->n_nodes * m->dim));
}

static void compare(Bench *mpm, Bench *fem, PetscReal dt)
{
  static const PointReal fields[] = {POINT_X, POINT_U, POINT_V, POINT_A, POINT_F, POINT_STATE};
  Model *a = bench_model(mpm, PETSC_COMM_WORLD), *b = bench_model(fem, PETSC_COMM_SELF);
  PetscReal tip[2];
  begin_unaccelerated(a);
  begin_unaccelerated(b);
  model_step(a, dt);
  model_step(b, dt);
  for (size_t k = 0; k < sizeof fields / sizeof *fields; ++k) {
    const PetscReal off = points_difference(a, b, fields[k]), scale = fields[k] == POINT_A   ? 1 / (dt * dt)
                                                                      : fields[k] == POINT_V ? 1 / dt
                                                                                             : 1;
    CHECK(off <= 1e-10 * scale, "field %d is off by %g", (int)fields[k], (double)off);
  }
  CALL(ModelMeasure(a, &mpm->measure[0], 0, &tip[0]));
  CALL(ModelMeasure(b, &fem->measure[0], 0, &tip[1]));
  CHECK(PetscAbsReal(tip[1]) > 0.01, "nothing moved");
  CHECK_CLOSE(tip[0], tip[1], 1e-10 * PetscAbsReal(tip[1]));
  CALL(ModelDestroy(&a));
  CALL(ModelDestroy(&b));
}

static void prepare(Bench *b, const char *method, CellType cell, PetscBool dynamic)
{
  bench_init(b, method, cell, 0);
  bench_grid(b, (PetscReal[]){0, -1, 0}, (PetscReal[]){3, 1, 1}, 0.25);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 0.5, 0.5});
  b->body[0].weights = WEIGHTS_GAUSS;
  b->c.gravity[1] = -9.81;
  if (dynamic) {
    bench_dynamic(b, 1, 0.05);
    b->body[0].velocity[1] = -1;
  }
  bench_motion(b, 0, 0, MOTION_FIXED, 7);
  bench_traction(b, 0, 2, "body", 1000, 0, 0);
  bench_tracer(b, "displacement", 1, 2, 0.25, 0.25);
}

static void test_all_cells(void **state)
{
  Bench mpm, fem;
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
    for (int dynamic = 0; dynamic < 2; ++dynamic) {
      prepare(&mpm, "mpm", cell, (PetscBool)dynamic);
      prepare(&fem, "fem", cell, (PetscBool)dynamic);
      compare(&mpm, &fem, dynamic ? 0.05 : 1);
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_all_cells)};
  return run_model_tests(argc, argv, tests);
}
