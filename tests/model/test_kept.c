/* Tangents that stay for several iterations: how many are made, and that the answer is the same. */
#include "case_builder.h"

static const char *const basis_of[] = {"gimp", "bspline"};

/* A block of rubber, off the lines of the grid, falls on a floor; `residual`: where Newton ends. */
static Model *falling(Bench *b, int basis, PetscInt dim, PetscReal residual)
{
  bench_init(b, "mpm", dim == 2 ? CELL_QUADRILATERAL : CELL_HEXAHEDRON, 0);
  b->c.basis.kind = basis_of[basis];
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.2, 1.2, 1.2}, 0.2);
  bench_box(b, 0, (PetscReal[]){0.33, dim == 2 ? 0.07 : 0.33, dim == 2 ? 0 : 0.07},
            (PetscReal[]){0.87, dim == 2 ? 0.61 : 0.87, dim == 2 ? 0 : 0.61});
  bench_dynamic(b, 1, 2e-3);
  bench_motion(b, dim - 1, 0, MOTION_FIXED, (1 << dim) - 1);
  b->body[0].velocity[dim - 1] = -5;
  b->c.newton = (NewtonSpec){.residual = residual, .max_iterations = 25, .ease = 6};
  return bench_model(b, PETSC_COMM_WORLD);
}

/* From the second step on one tangent is enough where points see nodes of their own, and what comes out does not
 * depend on it. */
static void test_wide(void **state)
{
  (void)state;
  for (int basis = 0; basis < 2; ++basis)
    for (PetscInt dim = 2; dim < 4; ++dim) {
      PetscReal energy[2], transfer[2];
      for (int fine = 0; fine < 2; ++fine) {
        Bench b;
        Model *m = falling(&b, basis, dim, fine ? 1e-13 : 1e-8);
        PetscInt iterations = 0, tangents = 0;
        for (int step = 0; step < 12; ++step) {
          const StepReport r = model_step(m, 1);
          CHECK(r.newton.converged && r.cuts == 0, "%s, step %d: %s", basis_of[basis], step, r.newton.reason);
          if (step == 0) continue;
          iterations += r.newton.iterations;
          tangents += r.newton.tangents;
        }
        PetscPrintf(PETSC_COMM_WORLD, "%s, %d axes, to %g: %d iterations, %d tangents in 11 steps\n", basis_of[basis],
                    (int)dim, fine ? 1e-13 : 1e-8, (int)iterations, (int)tangents);
        CHECK(iterations >= 22 && iterations <= (fine ? 66 : 38), "%d iterations", (int)iterations);
        CHECK(tangents <= (fine ? 22 : 13), "%d tangents", (int)tangents);
        energy[fine] = m->external_work + m->start_energy, transfer[fine] = m->transfer_energy;
        CALL(ModelDestroy(&m));
      }
      CHECK_CLOSE(energy[0], energy[1], 1e-7 * fabs(energy[1]));
      CHECK_CLOSE(transfer[0], transfer[1], 1e-7 * fabs(energy[1]));
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_wide)};
  return run_model_tests(argc, argv, tests);
}
