/* Linear solvers of statics: the mixed formulation's iterative one against the direct one, and on several
 * ranks against one; multigrid of displacements. */
#include "case_builder.h"
#include "solve/system/linear.h"
#include "solve/system/rigid_motions.h"
#include "model/model_private.h"

typedef struct {
  const char *law;
  PetscInt n;
  NamedValue value[4];
} Solid;

#define N(name, number)  \
  {                      \
    (char *)name, number \
  }
static const Solid nearly = {"neo-hookean-split", 2, {N("young", 1e6), N("poisson", 0.4999)}},
                   exactly = {"neo-hookean-split-log", 2, {N("young", 1e6), N("poisson", 0.5)}},
                   metal = {
                     "j2", 4, {N("young", 1e6), N("poisson", 0.4999), N("yield_stress", 3e4), N("hardening", 1e5)}};

static void use_solid(Bench *b, const Solid *solid)
{
  b->c.formulation = (char *)"mixed";
  b->c.mixed.stabilisation = 8;
  b->material.law = (char *)solid->law;
  b->material.n_parameters = solid->n;
  b->material.parameters = (NamedValue *)solid->value;
}

/* The iterative solver gives the direct one's answer, in statics and dynamics, with few
 * iterations. */
static void solvers(const char *method, CellType cell, PetscInt cells_per_side, const Solid *solid, PetscBool dynamic)
{
  Model *m[2];
  Bench b[2];
  for (int k = 0; k < 2; ++k) {
    bench_init(&b[k], method, cell, cells_per_side);
    use_solid(&b[k], solid);
    b[k].c.newton.residual = 1e-10;
    b[k].c.linear = k ? LINEAR_ITERATIVE : LINEAR_DIRECT;
    b[k].c.gravity[1] = -50;
    if (dynamic) bench_dynamic(&b[k], 0.01, 0.002);
    bench_motion(&b[k], 1, 0, MOTION_FIXED, 7);
    m[k] = bench_model(&b[k], PETSC_COMM_WORLD);
    for (int step = 0; step < (dynamic ? 3 : 1); ++step) {
      const StepReport r = model_step(m[k], 1);
      CHECK(r.cuts == 0, "the step was halved");
      if (k) CHECK(strstr(newton_linear_name(m[k]->newton), "GMRES"), "%s", newton_linear_name(m[k]->newton));
      CHECK(r.newton.linear_iterations <= 60 * r.newton.iterations, "%d linear iterations in %d of Newton",
            (int)r.newton.linear_iterations, (int)r.newton.iterations);
    }
  }
  PetscReal off = 0;
  for (PetscInt p = 0; p < m[0]->points->n * m[0]->dim; ++p)
    off = PetscMax(off, PetscAbsReal(m[0]->points->real[POINT_U][p] - m[1]->points->real[POINT_U][p]));
  CHECK(off <= 1e-8, "displacements differ by %g m", (double)off);
  for (int k = 0; k < 2; ++k) CALL(ModelDestroy(&m[k]));
}

/* The preconditioner gets hardly worse where the body is cut between ranks. */
static void test_solver_ranks(void **state)
{
  PetscInt linear[2];
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    bench_init(&b, "fem", CELL_TETRAHEDRON, 8);
    use_solid(&b, &nearly);
    b.c.linear = LINEAR_ITERATIVE;
    b.c.gravity[1] = -50;
    bench_motion(&b, 1, 0, MOTION_FIXED, 7);
    Model *m = bench_model(&b, k ? PETSC_COMM_WORLD : PETSC_COMM_SELF);
    const StepReport r = model_step(m, 1);
    CHECK(r.cuts == 0, "the step was halved");
    linear[k] = (r.newton.linear_iterations + r.newton.iterations - 1) / r.newton.iterations;
    CALL(ModelDestroy(&m));
  }
  CHECK(linear[0] <= 45, "%d linear iterations", (int)linear[0]);
  CHECK(linear[1] <= linear[0] + linear[0] / 4, "%d linear iterations instead of %d", (int)linear[1], (int)linear[0]);
}

/* Displacements alone, on triangles around centres, where a box has no coarse nodes: algebraic multigrid. */
static void test_multigrid(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_TRIANGLE, 0);
  bench_grid(&b, (PetscReal[]){0, -0.5, 0}, (PetscReal[]){4.25, 1.25, 0}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 0});
  b.c.grid.diagonal = DIAGONAL_CROSSED;
  b.c.linear = LINEAR_ITERATIVE;
  b.c.gravity[1] = -1e-3;
  bench_motion(&b, 0, 0, MOTION_FIXED, 3);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const StepReport r = model_step(m, 1);
  const PetscInt linear = (r.newton.linear_iterations + r.newton.iterations - 1) / r.newton.iterations;
  CHECK(strstr(newton_linear_name(m->newton), "algebraic multigrid"), "%s", newton_linear_name(m->newton));
  CHECK(r.cuts == 0 && linear <= 12, "%d linear iterations a solve", (int)linear);
  CALL(ModelDestroy(&m));
}

/* A matrix in space, of a body that leaves cells empty, to eight digits: 8 iterations with the rigid motions that
 * Newton's method has told it, 24 without. */
static void test_empty_cells(void **state)
{
  MatNullSpace rigid;
  PetscInt linear;
  KSP ksp;
  PC pc;
  Vec x, f;
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_HEXAHEDRON, 0);
  bench_grid(&b, (PetscReal[]){0, -0.5, -0.25}, (PetscReal[]){4.25, 1.25, 1.25}, 0.25);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1});
  b.c.linear = LINEAR_ITERATIVE;
  b.c.gravity[1] = -1e-3;
  bench_motion(&b, 0, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  model_step(m, 1);
  CALL(SystemUse(m->system, SYSTEM_ASSEMBLED, PETSC_TRUE));
  CALL(SystemToMatrix(m->system));
  CALL(RigidMotions(m->system, m->grid, &rigid));
  CALL(MatSetNearNullSpace(m->system->matrix, rigid));
  CALL(MatNullSpaceDestroy(&rigid));
  CALL(KSPCreate(PETSC_COMM_WORLD, &ksp));
  CALL(KSPSetType(ksp, KSPCG));
  CALL(KSPSetOperators(ksp, m->system->matrix, m->system->matrix));
  CALL(KSPSetTolerances(ksp, 1e-8, PETSC_DEFAULT, PETSC_DEFAULT, 200));
  CALL(KSPGetPC(ksp, &pc));
  CALL(LinearMultigrid(pc));
  CALL(MatCreateVecs(m->system->matrix, &x, &f));
  CALL(VecSetRandom(f, NULL));
  CALL(KSPSolve(ksp, f, x));
  CALL(KSPGetIterationNumber(ksp, &linear));
  CHECK(linear <= 12, "%d linear iterations", (int)linear);
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&f));
  CALL(KSPDestroy(&ksp));
  CALL(ModelDestroy(&m));
}

/* A beam that bends by a third of its length: directions that are as exact as Newton's method needs, and one set-up
 * of multigrid for all of them, take no more iterations of it than a factorisation and give its answer. */
static void test_forcing(void **state)
{
  Model *m[2];
  Bench b[2];
  StepReport r[2];
  PetscReal own[2] = {0, 0}, all[2];
  (void)state;
  for (int k = 0; k < 2; ++k) {
    bench_init(&b[k], "fem", CELL_HEXAHEDRON, 0);
    bench_grid(&b[k], (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1}, 0.25);
    bench_box(&b[k], 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1});
    b[k].c.linear = k ? LINEAR_ITERATIVE : LINEAR_DIRECT;
    b[k].c.gravity[1] = -3;
    bench_motion(&b[k], 0, 0, MOTION_FIXED, 7);
    m[k] = bench_model(&b[k], PETSC_COMM_WORLD);
    r[k] = model_step(m[k], 1);
    CHECK(r[k].cuts == 0, "the step was halved");
  }
  for (PetscInt p = 0; p < m[0]->points->n * 3; ++p) {
    own[0] = PetscMax(own[0], PetscAbsReal(m[0]->points->real[POINT_U][p] - m[1]->points->real[POINT_U][p]));
    own[1] = PetscMax(own[1], PetscAbsReal(m[0]->points->real[POINT_U][p]));
  }
  CALL(MPI_Allreduce(own, all, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  CHECK(all[1] > 0.5 && all[0] <= 1e-6 * all[1], "displacements of %g m differ by %g m", (double)all[1],
        (double)all[0]);
  CHECK(r[1].newton.iterations == r[0].newton.iterations, "%d iterations for %d", (int)r[1].newton.iterations,
        (int)r[0].newton.iterations);
  CHECK(r[1].newton.linear_iterations <= 14 * r[1].newton.iterations, "%d linear iterations",
        (int)r[1].newton.linear_iterations);
  for (int k = 0; k < 2; ++k) CALL(ModelDestroy(&m[k]));
}

static void test_solvers(void **state)
{
  (void)state;
  solvers("fem", CELL_TETRAHEDRON, 4, &exactly, PETSC_FALSE);
  solvers("fem", CELL_HEXAHEDRON, 4, &nearly, PETSC_FALSE);
  solvers("mpm", CELL_TRIANGLE, 8, &metal, PETSC_TRUE);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_solvers), cmocka_unit_test(test_solver_ranks),
                                     cmocka_unit_test(test_multigrid), cmocka_unit_test(test_empty_cells),
                                     cmocka_unit_test(test_forcing)};
  return run_model_tests_in_turns(argc, argv, tests);
}
