/* The matrix as scaled blocks in single precision against PETSc's: products, solutions, rows that ranks share, ranks
 * without rows, prescribed dofs, right-hand sides of any size, and matrices that it must refuse. */
#include "../model/case_builder.h"
#include "solve/blocks.h"

/* A system over some cells of a grid; its values depend on the cells and not on the ranks that own them. */
typedef struct {
  Bench b;
  Grid *grid;
  System *system;
  Support cells;
  unsigned char *fixed;
  PetscBool symmetric;
  PetscReal shift, coupling; /* on the diagonal of every cell's matrix, and between nodes */
} Made;

static void make_grid(Made *s, CellType type)
{
  Diag *diag;
  bench_init(&s->b, "mpm", type, type >= CELL_TETRAHEDRON ? 5 : 11);
  CALL(DiagCreate(&diag));
  CALL(GridCreate(PETSC_COMM_WORLD, &s->b.c, NULL, NULL, diag, &s->grid));
  CHECK(s->grid, "no grid");
  CALL(DiagDestroy(&diag));
}

/* Unknowns on the cells whose first node lies left of `width`: a small width leaves ranks without any. */
static void make_pattern(Made *s, PetscReal width)
{
  const Grid *grid = s->grid;
  const PetscInt nn = grid->nodes_per_cell;
  CALL(PetscMalloc2(grid->n_cells + 1, &s->cells.node_start, grid->n_cells * nn, &s->cells.node));
  CALL(PetscMalloc1(grid->n_cells, &s->cells.point_start)); /* here: the cell's number over all ranks */
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    const PetscInt *node = grid->cell_node + c * nn;
    if (grid->x[node[0] * grid->dim] >= width) continue;
    s->cells.node_start[s->cells.n_groups] = s->cells.n_groups * nn;
    s->cells.point_start[s->cells.n_groups] = grid->global_cell[c];
    CALL(PetscArraycpy(s->cells.node + s->cells.n_groups * nn, node, nn));
    ++s->cells.n_groups;
  }
  s->cells.node_start[s->cells.n_groups] = s->cells.n_groups * nn;
  s->cells.uniform = nn;
  CALL(SystemCreate(PETSC_COMM_WORLD, grid->dim, grid->dim, &s->system));
  CALL(SystemBuild(s->system, grid,
                   &(NodeGroups){.n = s->cells.n_groups, .start = s->cells.node_start, .node = s->cells.node}));
  CALL(SystemSlots(s->system, &s->cells, NULL));
}

/* Prescribed: x on the floor, and all of one node. */
static void make_fixed(Made *s)
{
  const PetscInt dim = s->grid->dim;
  CALL(PetscCalloc1(s->grid->n_nodes * dim, &s->fixed));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) {
    const PetscReal *x = s->grid->x + i * dim;
    if (x[1] == 0) s->fixed[i * dim] = 1;
    if (x[0] == 0 && x[1] == 1)
      for (PetscInt d = 0; d < dim; ++d) s->fixed[i * dim + d] = 1;
  }
}

/* G G^T + mass, for a random G of a cell; unsymmetric: one more random matrix. */
static void add_cell(Made *s, PetscInt g)
{
  const PetscInt dim = s->grid->dim, nn = s->grid->nodes_per_cell, n = nn * dim;
  const PetscInt *node = s->cells.node + g * nn, *slot = s->system->slot + g * nn * nn;
  PetscReal G[24 * 4], more[24 * 24];
  Random random = {(uint64_t)s->cells.point_start[g] + 11};
  for (PetscInt i = 0; i < 4 * n; ++i) G[i] = random_real(&random, -1, 1);
  for (PetscInt i = 0; i < n * n; ++i) more[i] = s->symmetric ? 0 : random_real(&random, -0.2, 0.2);
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) {
      const PetscInt I = i / dim, J = j / dim, a = i % dim, b = j % dim;
      if (s->fixed[node[I] * dim + a] || s->fixed[node[J] * dim + b]) continue;
      PetscReal value = more[i * n + j] + (i == j ? s->shift : I != J ? s->coupling : 0);
      for (int k = 0; k < 4; ++k) value += G[4 * i + k] * G[4 * j + k];
      s->system->values[(slot[I * nn + J] * dim + a) * dim + b] += 1e7 * value;
    }
}

static void make(Made *s, CellType type, PetscBool symmetric, PetscReal width, PetscReal shift, PetscReal coupling)
{
  *s = (Made){.symmetric = symmetric, .shift = shift, .coupling = coupling};
  make_grid(s, type);
  make_pattern(s, width);
  make_fixed(s);
  CALL(SystemZero(s->system));
  for (PetscInt g = 0; g < s->cells.n_groups; ++g) add_cell(s, g);
}

static void drop(Made *s)
{
  CALL(SystemDestroy(&s->system));
  CALL(GridDestroy(&s->grid));
  CALL(PetscFree2(s->cells.node_start, s->cells.node));
  CALL(PetscFree(s->cells.point_start));
  CALL(PetscFree(s->fixed));
}

/* Zero on prescribed dofs. */
static Vec random_vector(const Made *s, PetscReal size)
{
  const PetscInt dim = s->grid->dim;
  PetscReal *v;
  Vec x;
  CALL(SystemCreateVec(s->system, &x));
  CALL(VecGetArrayWrite(x, &v));
  for (PetscInt k = 0; k < s->system->n_active; ++k) {
    const PetscInt i = s->system->active[k];
    Random random = {(uint64_t)s->grid->global_node[i] + 5};
    for (PetscInt d = 0; d < dim; ++d) v[k * dim + d] = s->fixed[i * dim + d] ? 0 : size * random_real(&random, -1, 1);
  }
  CALL(VecRestoreArrayWrite(x, &v));
  return x;
}

static Mat matrix(Made *s, SystemForm form)
{
  CALL(SystemUse(s->system, form, s->symmetric));
  CALL(SystemToMatrix(s->system, s->fixed, NULL));
  return s->system->matrix;
}

static PetscReal norm(Vec x)
{
  PetscReal value;
  CALL(VecNorm(x, NORM_2, &value));
  return value;
}

static KSPConvergedReason solve(Made *s, Vec b, Vec x, PetscInt *iterations)
{
  const LinearProblem problem = {
    .choice = LINEAR_ITERATIVE, .dim = s->grid->dim, .dynamic = PETSC_TRUE, .symmetric = s->symmetric};
  KSPConvergedReason reason;
  PetscBool direct;
  const char *what;
  KSP ksp;
  Mat A = matrix(s, SYSTEM_BLOCKS);
  CALL(KSPCreate(PETSC_COMM_WORLD, &ksp));
  CALL(LinearConfigure(ksp, &problem, &direct, &what));
  CHECK(!direct, "%s", what);
  CALL(KSPSetOperators(ksp, A, A));
  CALL(KSPSetTolerances(ksp, 1e-6, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  CALL(KSPSolve(ksp, b, x));
  CALL(KSPGetConvergedReason(ksp, &reason));
  CALL(KSPGetIterationNumber(ksp, iterations));
  CALL(KSPDestroy(&ksp));
  return reason;
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
        make(&s, type, symmetric ? PETSC_TRUE : PETSC_FALSE, narrow ? 0.1 : 2, 2, 0);
        check_products(&s);
        const PetscInt iterations = check_solution(&s, 1);
        CHECK(iterations <= 25, "%d iterations", (int)iterations);
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

/* A symmetric matrix with some negative eigenvalues, as where material buckles: conjugate gradients stop, BiCGStab goes on. */
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

/* A negative diagonal, or a matrix far from definite: every rank hears of it. */
static void test_refused(void **state)
{
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Made s;
    PetscInt iterations;
    make(&s, CELL_QUADRILATERAL, PETSC_TRUE, 2, k ? 2 : -20, k ? -3 : 0);
    Vec b = random_vector(&s, 1), x = random_vector(&s, 0);
    const KSPConvergedReason reason = solve(&s, b, x, &iterations);
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
    cmocka_unit_test(test_any_size),
    cmocka_unit_test(test_zero),
    cmocka_unit_test(test_indefinite),
    cmocka_unit_test(test_refused),
    cmocka_unit_test(test_options),
  };
  return run_model_tests(argc, argv, tests);
}
