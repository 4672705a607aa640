/* A step is accepted only in equilibrium, and only in the one that follows from the last state:
 * bodies that nothing holds, linear solvers that do nothing, tangents without a pivot, and
 * equilibria that a body would have to leap to. */
#include <string.h>
#include "case_builder.h"
#include "model/model_private.h"

static const char *const names[] = {"fem", "mpm", "gmm"};
static const BasisSpec lme = {.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};

/* Two blocks on one grid, one on the floor; `apart` lies between them. */
static void two_blocks(Bench *b, const char *method, PetscReal apart)
{
  bench_init(b, method, CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 3, 0}, 0.25);
  if (!strcmp(method, "gmm")) b->c.basis = lme;
  b->body[1] = b->body[0];
  b->body[1].name = "upper";
  b->c.n_bodies = 2;
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
  bench_box(b, 1, (PetscReal[]){0, 1 + apart, 0}, (PetscReal[]){1, 2 + apart, 0});
}

/* In statics a body is held by a boundary or by another body that is; the message names body and
 * directions. Motion needs no hold. */
static void test_held(void **state)
{
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Bench b;
    two_blocks(&b, names[k], 0);
    bench_refused(&b, PETSC_COMM_WORLD, "bodies[0]", "nothing holds 'body' in x and y");
    two_blocks(&b, names[k], 0);
    bench_motion(&b, 1, 0, MOTION_FIXED, 2);
    bench_refused(&b, PETSC_COMM_WORLD, "bodies[1]", "nothing holds 'upper' in x: ");
    two_blocks(&b, names[k], 0.75);
    bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    bench_refused(&b, PETSC_COMM_WORLD, "bodies[1]", "nothing holds 'upper' in x and y");
    two_blocks(&b, names[k], 0);
    bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CALL(ModelDestroy(&m));
    two_blocks(&b, names[k], 0);
    bench_dynamic(&b, 1, 0.01);
    m = bench_model(&b, PETSC_COMM_WORLD);
    CALL(ModelDestroy(&m));
  }
}

/* A hinge on one node: held in x and y, but free to turn, so that the first tangent has no last
 * pivot. Whatever the solver makes of it, no step is accepted whose residual was not brought
 * down. */
static void test_hinge(void **state)
{
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Bench b;
    StepReport report;
    bench_init(&b, names[k], CELL_QUADRILATERAL, 4);
    bench_grid(&b, (PetscReal[]){-2, -2, 0}, (PetscReal[]){3, 3, 0}, 0.25);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
    if (!strcmp(names[k], "gmm")) b.c.basis = lme;
    b.c.gravity[1] = -9.81;
    b.c.newton = (NewtonSpec){.residual = 1e-8, .increment = 1e-10, .max_iterations = 25, .ease = 6};
    b.c.analysis.smallest = 0.1;
    MotionSpec *hinge = bench_motion(&b, 0, 0, MOTION_FIXED, 3);
    hinge->on.has[1] = PETSC_TRUE;
    hinge->on.min[1] = hinge->on.max[1] = 0;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CALL(ModelStep(m, 1, &report));
    const PetscInt last = PetscMin(report.newton.iterations, NEWTON_HISTORY - 1);
    CHECK(report.outcome != STEP_ACCEPTED || report.newton.residual[last] <= 1e-5, "%s: residual %g", names[k],
          (double)report.newton.residual[last]);
    CALL(ModelDestroy(&m));
  }
}

/* A linear solver that returns nothing: increments vanish at once, the residual stays. */
static void test_useless_solver(void **state)
{
  const char *const options[][2] = {{"-ksp_type", "gmres"}, {"-pc_type", "jacobi"}, {"-ksp_rtol", "1"}};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Bench b;
    StepReport report;
    bench_init(&b, names[k], CELL_QUADRILATERAL, 4);
    if (!strcmp(names[k], "gmm")) b.c.basis = lme;
    b.c.gravity[1] = -9.81;
    b.c.analysis.smallest = 0.4;
    bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    for (int o = 0; o < 3; ++o) CALL(PetscOptionsSetValue(NULL, options[o][0], options[o][1]));
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CALL(ModelStep(m, 1, &report));
    CHECK(report.outcome == STEP_TOO_SMALL, "%s: accepted with residual %g", names[k],
          (double)report.newton.residual[report.newton.iterations]);
    CHECK(strstr(report.reason, "the linear solver does nothing"), "%s", report.reason);
    for (int o = 0; o < 3; ++o) CALL(PetscOptionsClearValue(NULL, options[o][0]));
    CALL(ModelDestroy(&m));
  }
}

#define HEIGHT 50.0
#define WEIGHT 800.0 /* N/m3 */
#define SHEAR 5000.0 /* Pa; Poisson's ratio 0 */

/* How far the top of a column sinks under `share` of its weight: shear (l - 1/l) = -weight (height
 * - Y), integrated. */
static PetscReal sinks(PetscReal share)
{
  const PetscReal q = share * WEIGHT * HEIGHT / SHEAR;
  return HEIGHT * (1 - (-q * q / 4 + q * PetscSqrtReal(q * q + 4) / 4 + asinh(q / 2)) / q);
}

static Model *soft_column(Bench *b, PetscReal gamma)
{
  const PetscReal h = HEIGHT / 16;
  bench_init(b, "gmm", CELL_QUADRILATERAL, 0);
  b->constants[0].value = 2 * SHEAR;
  b->constants[1].value = 0;
  b->material.density = WEIGHT / 9.81;
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){h, HEIGHT, 0}, h);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){h, HEIGHT, 0});
  b->c.basis = lme;
  b->c.basis.gamma = gamma;
  b->c.gravity[1] = -9.81;
  b->c.newton = (NewtonSpec){.residual = 1e-8, .increment = 1e-10, .max_iterations = 25, .ease = 6};
  b->c.analysis.step = b->c.analysis.largest = 0.1;
  bench_motion(b, 1, 0, MOTION_FIXED, 3);
  bench_motion(b, 0, 0, MOTION_FIXED, 1);
  bench_motion(b, 0, h, MOTION_FIXED, 1);
  bench_tracer(b, "displacement", 1, h / 2, HEIGHT, 0);
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Under seven tenths of its weight the foot of the column is pressed to a fifth, where shape
 * functions as wide as the first cells no longer see single nodes, and another equilibrium lies 400
 * m below the floor. All that is accepted is the column's own. */
static void test_leap(void **state)
{
  PetscReal top;
  StepReport report = {.outcome = STEP_ACCEPTED};
  (void)state;
  for (int narrow = 0; narrow < 2; ++narrow) {
    Bench b;
    Model *m = soft_column(&b, narrow ? 8 : 1.8);
    do {
      CALL(ModelStep(m, 1 - m->time, &report));
      CALL(ModelMeasure(m, &b.measure[0], 0, &top));
      PetscPrintf(PETSC_COMM_WORLD, "gamma %g, t = %.3g: top at %.5g m, exact %.5g%s%s\n", (double)b.c.basis.gamma,
                  (double)m->time, (double)top, (double)-sinks(m->time), report.outcome == STEP_ACCEPTED ? "" : "; ",
                  report.outcome == STEP_ACCEPTED ? "" : report.reason);
      CHECK_CLOSE(top, -sinks(m->time), 0.005 * sinks(m->time));
    } while (report.outcome == STEP_ACCEPTED && m->time < 1 - 1e-9);
    CHECK(m->time >= (narrow ? 1 - 1e-9 : 0.5), "it ended at %g: %s", (double)m->time, report.reason);
    CALL(ModelDestroy(&m));
  }
}

/* A step in which the block is drawn out to four times its length is one of statics, for rubber and for sand, but none
 * of what moves in time. */
static void test_in_time(void **state)
{
  static NamedValue grains[4] = {{"young", 1e5}, {"poisson", 0.3}, {"friction_angle", 30}, {"cohesion", 1e3}};
  (void)state;
  for (int k = 0; k < 4; ++k) {
    const PetscBool yields = k % 2 > 0, moves = k / 2 > 0;
    StepReport report = {.newton.converged = PETSC_TRUE};
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
    if (yields) b.material.law = "mohr-coulomb", b.material.parameters = grains, b.material.n_parameters = 4;
    if (moves) bench_dynamic(&b, 1, 0.01);
    bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CALL(ModelStep(m, moves ? 0.01 : 1, &report));
    CALL(ModelInitialise(m));
    for (PetscInt i = 0; i < m->grid->n_nodes * 2; ++i) m->nodes->du[i] = i % 2 ? 3 * m->grid->x[i] : 0;
    CALL(JudgeStep(m, &report));
    CHECK(report.newton.converged == !moves, "law %d, dynamics %d", yields, moves);
    if (moves) assert_non_null(strstr(report.newton.reason, "stretched 4 times in one step"));
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_held), cmocka_unit_test(test_hinge),
                                     cmocka_unit_test(test_useless_solver), cmocka_unit_test(test_leap),
                                     cmocka_unit_test(test_in_time)};
  return run_model_tests(argc, argv, tests);
}
