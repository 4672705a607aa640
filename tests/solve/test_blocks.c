/* The matrix as scaled blocks in single precision against PETSc's: products, solutions, rows that
 * ranks share, ranks without rows, prescribed dofs, right-hand sides of any size, what factors solve
 * where the iteration does not, and matrices that it must refuse. */
#include "made_system.h"
#include "solve/blocks/blocks.h"

static Mat matrix(Made *s, SystemForm form)
{
  CALL(SystemUse(s->system, form, s->symmetric));
  CALL(SystemToMatrix(s->system));
  return s->system->matrix;
}

/* most: iterations; memory: bytes for factors, 0: any */
static KSPConvergedReason solve_within(PetscInt most, PetscReal memory, Made *s, Vec b, Vec x, PetscInt *iterations)
{
  const LinearProblem problem = {.choice = LINEAR_ITERATIVE,
                                 .dim = s->grid->dim,
                                 .dynamic = PETSC_TRUE,
                                 .symmetric = s->symmetric,
                                 .unknowns = 100,
                                 .memory = memory};
  KSPConvergedReason reason;
  PetscBool direct;
  const char *what;
  KSP ksp;
  Mat A = matrix(s, SYSTEM_BLOCKS);
  CALL(KSPCreate(PETSC_COMM_WORLD, &ksp));
  CALL(LinearConfigure(ksp, &problem, &direct, &what));
  CHECK(!direct, "%s", what);
  CALL(KSPSetOperators(ksp, A, A));
  CALL(KSPSetTolerances(ksp, 1e-6, PETSC_DEFAULT, PETSC_DEFAULT, most));
  CALL(KSPSolve(ksp, b, x));
  CALL(KSPGetConvergedReason(ksp, &reason));
  CALL(KSPGetIterationNumber(ksp, iterations));
  CALL(KSPDestroy(&ksp));
  return reason;
}

static KSPConvergedReason solve(Made *s, Vec b, Vec x, PetscInt *iterations)
{
  return solve_within(PETSC_DEFAULT, 0, s, b, x, iterations);
}

static void check_products(Made *s)
{
  Vec x = random_vector(s, 1), y, z;
  CALL(VecDuplicate(x, &y));
  CALL(VecDuplicate(x, &z));
  CALL(MatMult(matrix(s, SYSTEM_ASSEMBLED), x, y));
  CALL(MatMult(matrix(s, SYSTEM_BLOCKS), x, z));
  CALL(VecAXPY(z, -1, y));
  CHECK(norm(z) <= 1e-6 * norm(y), "products differ by %g of %g", (double)norm(z), (double)norm(y));
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&y));
  CALL(VecDestroy(&z));
}

/* The residual of the assembled matrix is as small as asked for. */
static PetscInt check_solution(Made *s, PetscReal size)
{
  Vec b = random_vector(s, size), x, r;
  PetscInt iterations;
  CALL(VecDuplicate(b, &x));
  CALL(VecDuplicate(b, &r));
  const KSPConvergedReason reason = solve(s, b, x, &iterations);
  CHECK(reason == KSP_CONVERGED_RTOL, "reason %d", (int)reason);
  CALL(MatMult(matrix(s, SYSTEM_ASSEMBLED), x, r));
  CALL(VecAXPY(r, -1, b));
  CHECK(norm(r) <= 1e-5 * norm(b), "a residual of %g for %g", (double)norm(r), (double)norm(b));
  CALL(VecDestroy(&b));
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&r));
  return iterations;
}

static void test_products_and_solutions(void **state)
{
  (void)state;
  for (CellType type = CELL_TRIANGLE; type <= CELL_HEXAHEDRON; ++type)
    for (int symmetric = 0; symmetric < 2; ++symmetric)
      for (int narrow = 0; narrow < 2; ++narrow) {
        Made s;
        make(&s, type, symmetric, narrow ? 0.1 : 2, 2, 0);
        check_products(&s);
        const PetscInt iterations = check_solution(&s, 1);
        CHECK(iterations <= 25, "%d iterations", (int)iterations);
        drop(&s);
      }
}

/* What does not converge is solved by factors: as exactly as single precision holds the matrix, on all ranks. */
static void test_rescued(void **state)
{
  (void)state;
  for (CellType type = CELL_TRIANGLE; type <= CELL_HEXAHEDRON; ++type)
    for (int symmetric = 0; symmetric < 2; ++symmetric)
      for (int narrow = 0; narrow < 2; ++narrow) {
        Made s;
        PetscInt iterations;
        make(&s, type, symmetric, narrow ? 0.1 : 2, 2, 0);
        Vec b = random_vector(&s, 1), x, r;
        CALL(VecDuplicate(b, &x));
        CALL(VecDuplicate(b, &r));
        const KSPConvergedReason reason = solve_within(1, 0, &s, b, x, &iterations);
        CHECK(reason == KSP_CONVERGED_ITS && iterations == 1, "reason %d after %d", (int)reason, (int)iterations);
        CALL(MatMult(matrix(&s, SYSTEM_ASSEMBLED), x, r));
        CALL(VecAXPY(r, -1, b));
        CHECK(norm(r) <= 1e-5 * norm(b), "a residual of %g for %g", (double)norm(r), (double)norm(b));
        CALL(VecDestroy(&b));
        CALL(VecDestroy(&x));
        CALL(VecDestroy(&r));
        drop(&s);
      }
}

/* Squares of these would leave the range of single precision. */
static void test_any_size(void **state)
{
  (void)state;
  Made s;
  make(&s, CELL_QUADRILATERAL, PETSC_TRUE, 2, 2, 0);
  const PetscInt iterations = check_solution(&s, 1);
  CHECK(check_solution(&s, 1e-40) == iterations && check_solution(&s, 1e40) == iterations, "iterations differ");
  drop(&s);
}

static void test_zero(void **state)
{
  (void)state;
  Made s;
  PetscInt iterations;
  make(&s, CELL_TRIANGLE, PETSC_TRUE, 2, 2, 0);
  Vec b = random_vector(&s, 0), x = random_vector(&s, 1);
  CHECK(solve(&s, b, x, &iterations) > 0 && iterations == 0 && norm(x) == 0, "%d iterations, %g", (int)iterations,
        (double)norm(x));
  CALL(VecDestroy(&b));
  CALL(VecDestroy(&x));
  drop(&s);
}

/* A symmetric matrix with some negative eigenvalues, as where material buckles: conjugate gradients
 * stop, BiCGStab goes on. */
static void test_indefinite(void **state)
{
  Made s;
  PetscReal *v;
  PetscScalar work;
  (void)state;
  make(&s, CELL_QUADRILATERAL, PETSC_TRUE, 2, 2, -0.6);
  Vec x = random_vector(&s, 0), y = random_vector(&s, 0);
  CALL(VecGetArrayWrite(x, &v));
  for (PetscInt i = 0; i < s.system->n_active * 2; ++i) v[i] = !s.fixed[s.system->active[i / 2] * 2 + i % 2];
  CALL(VecRestoreArrayWrite(x, &v));
  CALL(MatMult(matrix(&s, SYSTEM_ASSEMBLED), x, y));
  CALL(VecDot(x, y, &work));
  CHECK(PetscRealPart(work) < 0, "the matrix may be definite: %g", (double)PetscRealPart(work));
  CHECK(check_solution(&s, 1) > 10, "too few iterations for two methods");
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&y));
  drop(&s);
}

/* A negative diagonal, or a matrix far from definite with no room for factors: every rank hears of it. */
static void test_refused(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Made s;
    PetscInt iterations;
    make(&s, CELL_QUADRILATERAL, PETSC_TRUE, 2, k ? 2 : -20, k ? -3 : 0);
    Vec b = random_vector(&s, 1), x = random_vector(&s, 0);
    const KSPConvergedReason reason = solve_within(PETSC_DEFAULT, 1, &s, b, x, &iterations);
    CHECK((k ? reason < 0 : reason == KSP_DIVERGED_INDEFINITE_PC), "reason %d after %d", (int)reason, (int)iterations);
    CALL(VecDestroy(&b));
    CALL(VecDestroy(&x));
    drop(&s);
  }
}

/* Options that name a solver get PETSc's matrix. */
static void test_options(void **state)
{
  const LinearProblem problem = {.choice = LINEAR_AUTO, .dim = 2, .unknowns = 10, .dynamic = PETSC_TRUE, .courant = 1};
  SystemForm form;
  (void)state;
  CALL(LinearForm(&problem, &form));
  CHECK(form == SYSTEM_BLOCKS, "no blocks");
  CALL(PetscOptionsSetValue(NULL, "-pc_type", "icc"));
  CALL(LinearForm(&problem, &form));
  CALL(PetscOptionsClearValue(NULL, "-pc_type"));
  CHECK(form == SYSTEM_ASSEMBLED, "blocks");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_products_and_solutions),
    cmocka_unit_test(test_rescued),
    cmocka_unit_test(test_any_size),
    cmocka_unit_test(test_zero),
    cmocka_unit_test(test_indefinite),
    cmocka_unit_test(test_refused),
    cmocka_unit_test(test_options),
  };
  return run_model_tests(argc, argv, tests);
}
