/* Constraints kept by projections against the whole system with its multipliers, and what a node
 * does to them that hardly counts. */
#include "made_system.h"
#include "solve/blocks/blocks.h"
#include "solve/blocks/projection.h"

enum { CELLS = 11 };

static PetscBool is_twin(const Grid *grid, PetscInt node) { return grid->x[node * 2 + 1] > 1 - 0.5 / CELLS; }

/* A node of the second row from above, which two constraints hold. */
static PetscBool is_weak(const Grid *grid, PetscInt node)
{
  const PetscReal *x = grid->x + node * 2, h = 1.0 / CELLS;
  return PetscAbsReal(x[0] - 5 * h) < h / 2 && PetscAbsReal(x[1] - 10 * h) < h / 2;
}

/* The top row has multipliers in place of motions. What couples the weak node takes `factor`, its
 * own block the other sign as well: a point in plastic flow has just reached it. */
static void make_special(Made *s, PetscReal factor)
{
  const System *y = s->system;
  for (PetscInt I = 0; I < y->n_nodes; ++I)
    for (PetscInt k = y->row[I] < 0 ? 0 : y->row_start[y->row[I]]; y->row[I] >= 0 && k < y->row_start[y->row[I] + 1];
         ++k) {
      const PetscInt J = y->column[k];
      const PetscReal weak = is_weak(s->grid, I) || is_weak(s->grid, J) ? (I == J && factor < 1 ? -factor : factor) : 1;
      for (int e = 0; e < 4; ++e) y->values[4 * k + e] *= is_twin(s->grid, I) || is_twin(s->grid, J) ? 0 : weak;
    }
}

/* The first cell of this rank that has the node; it holds the pairs of the constraint in the
 * system's pattern. */
static const PetscInt *cell_of(const Grid *grid, PetscInt node)
{
  for (PetscInt c = 0; c < grid->n_cells; ++c)
    for (PetscInt i = 0; i < 4; ++i)
      if (grid->cell_node[4 * c + i] == node) return grid->cell_node + 4 * c;
  return NULL;
}

/* Of the two nodes below each node of the top row: more of the nearer one. */
static Constraints *make_constraints(const Made *s)
{
  const Grid *grid = s->grid;
  Constraints *c;
  CALL(ConstraintsCreate(2, &c));
  c->scale = 1e8;
  for (PetscInt node = 0; node < grid->n_owned; ++node) {
    PetscInt below[2], n = 0;
    PetscReal N[2];
    const PetscInt *cell = is_twin(grid, node) ? cell_of(grid, node) : NULL;
    for (int i = 0; cell && i < 4; ++i) {
      if (is_twin(grid, cell[i])) continue;
      N[n] = PetscAbsReal(grid->x[cell[i] * 2] - grid->x[node * 2]) < 0.5 / CELLS ? 0.75 : 0.25;
      below[n++] = cell[i];
    }
    if (cell) CALL(ConstraintsAdd(c, node, node, n, below, N));
  }
  CHECK(constraints_find_slots(c, s->system), "pairs are missing");
  return c;
}

/* Iterations. y: the solution. */
static PetscInt solve_projected(Made *s, const Constraints *c, Vec f, Vec y)
{
  const LinearProblem problem = {
    .choice = LINEAR_ITERATIVE, .dim = 2, .dynamic = PETSC_TRUE, .symmetric = s->symmetric};
  Projection *projection;
  KSPConvergedReason reason;
  PetscInt iterations;
  PetscBool direct;
  const char *what;
  KSP ksp;
  CALL(SystemUse(s->system, SYSTEM_BLOCKS, s->symmetric));
  CALL(ProjectionCreate(s->system, s->grid, c, s->fixed, &projection));
  s->system->blocks->projection = projection;
  CALL(ProjectionFactor(projection));
  CALL(SystemPrescribe(s->system, projection->held, NULL));
  CALL(SystemToMatrix(s->system));
  CALL(KSPCreate(PETSC_COMM_WORLD, &ksp));
  CALL(LinearConfigure(ksp, &problem, &direct, &what));
  CALL(KSPSetOperators(ksp, s->system->matrix, s->system->matrix));
  CALL(KSPSetTolerances(ksp, 1e-7, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  CALL(KSPSolve(ksp, f, y));
  CALL(KSPGetConvergedReason(ksp, &reason));
  CHECK(reason == KSP_CONVERGED_RTOL, "reason %d", (int)reason);
  CALL(KSPGetIterationNumber(ksp, &iterations));
  CALL(KSPDestroy(&ksp));
  CALL(ProjectionDestroy(&projection));
  s->system->blocks->projection = NULL;
  return iterations;
}

/* |f - A y| / |f| for the matrix with multipliers, made anew. */
static PetscReal residual(Made *s, const Constraints *c, PetscReal factor, Vec f, Vec y)
{
  PetscReal *nothing;
  Vec r;
  CALL(PetscCalloc1(s->grid->n_nodes * 2, &nothing));
  CALL(VecDuplicate(f, &r));
  CALL(SystemZero(s->system));
  for (PetscInt g = 0; g < s->cells.n_groups; ++g) add_cell(s, g);
  make_special(s, factor);
  const NodalScene scene = {.grid = s->grid, .fixed = s->fixed, .du = nothing, .prescribed = nothing};
  constraints_assemble(c, &scene, &(NodalOutput){.force = nothing, .system = s->system});
  CALL(SystemUse(s->system, SYSTEM_ASSEMBLED, s->symmetric));
  CALL(SystemPrescribe(s->system, s->fixed, NULL));
  CALL(SystemToMatrix(s->system));
  CALL(MatMult(s->system->matrix, y, r));
  CALL(VecAXPY(r, -1, f));
  const PetscReal size = norm(r) / norm(f);
  CALL(VecDestroy(&r));
  CALL(PetscFree(nothing));
  return size;
}

static PetscInt check(PetscBool symmetric, PetscReal factor, PetscReal bound)
{
  Made s;
  make(&s, CELL_QUADRILATERAL, symmetric, 2, 2, 0);
  make_special(&s, factor);
  Constraints *c = make_constraints(&s);
  Vec f = random_vector(&s, 1e5), y = random_vector(&s, 0);
  const PetscInt iterations = solve_projected(&s, c, f, y);
  const PetscReal left = residual(&s, c, factor, f, y);
  CHECK(left <= bound, "a residual of %g after %d iterations", (double)left, (int)iterations);
  CALL(VecDestroy(&f));
  CALL(VecDestroy(&y));
  CALL(ConstraintsDestroy(&c));
  drop(&s);
  return iterations;
}

static void test_constraints(void **state)
{
  (void)state;
  for (int symmetric = 0; symmetric < 2; ++symmetric) {
    const PetscInt iterations = check(symmetric, 1, 1e-5);
    CHECK(iterations <= 30, "%d iterations", (int)iterations);
  }
}

/* As many iterations as without it; the node's own equation takes no part in the residual, so small
 * is it. */
static void test_node_that_hardly_counts(void **state)
{
  (void)state;
  for (int symmetric = 0; symmetric < 2; ++symmetric) {
    const PetscBool is_symmetric = symmetric;
    const PetscInt usual = check(is_symmetric, 1, 1e-5), weak = check(is_symmetric, 1e-8, 1e-3);
    CHECK(weak <= usual + 5, "%d iterations, %d without", (int)weak, (int)usual);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_constraints),
    cmocka_unit_test(test_node_that_hardly_counts),
  };
  return run_model_tests(argc, argv, tests);
}
