/* The tangent as it was gathered, and what coarse nodes of a box make of it, against PETSc's assembled matrix and its
 * products: symmetric and not, half of it alone, prescribed dofs, nodes with axes of their own, 1 to 3 ranks. */
#include "made_system.h"
#include "solve/levels/coarse_product.h"
#include "solve/system/linear.h"

typedef struct {
  CellType type;
  PetscBool symmetric, half, frames;
} Kind;

/* Every fifth node has axes of its own. */
static void turn_nodes(Made *s, Frames *frames)
{
  const PetscInt dim = s->grid->dim;
  CALL(FramesClear(frames, s->grid->n_nodes));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) {
    const PetscInt global = s->grid->global_node[i];
    const PetscReal a = 0.3 + 0.1 * (PetscReal)(global % 7), b = dim == 3 ? 0.4 : 0;
    if (global % 5 == 0) CALL(FramesAdd(frames, dim, i, 0, (PetscReal[]){cos(a), sin(a) * cos(b), sin(a) * sin(b)}));
  }
  s->system->frames = frames;
}

static void make_kind(Made *s, const Kind *k, Frames *frames)
{
  *s = (Made){.symmetric = k->symmetric, .shift = 2};
  make_grid(s, k->type);
  CALL(GridWiden(&s->grid, 1));
  make_pattern(s, 0.7);
  make_fixed(s);
  if (k->frames) turn_nodes(s, frames);
  CALL(SystemZero(s->system));
  for (PetscInt g = 0; g < s->cells.n_groups; ++g) add_cell(s, g);
  CALL(SystemPrescribe(s->system, s->fixed, NULL));
  system_turn(s->system);
}

/* What nobody should read. */
static void spoil_lower_half(System *s)
{
  const PetscInt size = s->dim * s->dim;
  for (PetscInt r = 0; r < s->n_active; ++r)
    for (PetscInt i = s->row_start[r] * size; i < s->diagonal[r] * size; ++i) s->values[i] = NAN;
}

/* Zero where no coarse node has a stiffness: what stands there is no sum. */
static Vec random_coarse(Mat P)
{
  PetscRandom random;
  PetscReal *v, *e;
  PetscInt first, end, n;
  Vec x, unit, fine;
  CALL(MatCreateVecs(P, &x, &fine));
  CALL(VecDuplicate(x, &unit));
  CALL(PetscRandomCreate(PETSC_COMM_WORLD, &random));
  CALL(VecSetRandom(x, random));
  CALL(PetscRandomDestroy(&random));
  CALL(VecGetOwnershipRange(x, &first, &end));
  CALL(VecGetSize(x, &n));
  for (PetscInt i = 0; i < n; ++i) {
    PetscReal size;
    CALL(VecZeroEntries(unit));
    CALL(VecGetArray(unit, &e));
    if (i >= first && i < end) e[i - first] = 1;
    CALL(VecRestoreArray(unit, &e));
    CALL(MatMult(P, unit, fine));
    CALL(VecNorm(fine, NORM_2, &size));
    CALL(VecGetArray(x, &v));
    if (i >= first && i < end && size == 0) v[i - first] = 0;
    CALL(VecRestoreArray(x, &v));
  }
  CALL(VecDestroy(&unit));
  CALL(VecDestroy(&fine));
  return x;
}

static void check_difference(Vec x, Vec y, PetscReal most, const char *what)
{
  const PetscReal size = norm(y);
  CALL(VecAXPY(x, -1, y));
  CHECK(size > 0 && norm(x) <= most * size, "%s differ by %g of %g", what, (double)norm(x), (double)size);
}

static void check_kind(const Kind *k)
{
  Frames frames = {0}, others = {0};
  CoarseBox *box;
  Made s, t;
  Mat C;
  make_kind(&s, k, &frames);
  CALL(SystemUse(s.system, SYSTEM_ASSEMBLED, k->symmetric));
  CALL(SystemToMatrix(s.system));
  make_kind(&t, k, &others);
  CALL(SystemUse(t.system, SYSTEM_GATHERED, k->symmetric));
  CALL(SystemToMatrix(t.system));
  if (k->half) spoil_lower_half(t.system);
  Vec x = random_vector(&s, 1), y, z;
  CALL(VecDuplicate(x, &y));
  CALL(VecDuplicate(x, &z));
  CALL(MatMult(s.system->matrix, x, y));
  CALL(MatMult(t.system->matrix, x, z));
  check_difference(z, y, 1e-14, "products");
  CALL(MatGetDiagonal(s.system->matrix, y));
  CALL(MatGetDiagonal(t.system->matrix, z));
  check_difference(z, y, 1e-14, "diagonals");
  CALL(CoarseBoxCreate(t.system, t.grid, t.fixed, &box));
  CALL(CoarseProduct(t.system->gathered, box, t.fixed, &C));
  Vec a = random_coarse(box->interpolation), b, c;
  CALL(VecDuplicate(a, &b));
  CALL(VecDuplicate(a, &c));
  CALL(MatMult(box->interpolation, a, x));
  CALL(MatMult(s.system->matrix, x, y));
  CALL(MatMultTranspose(box->interpolation, y, b));
  CALL(MatMult(C, a, c));
  check_difference(c, b, 1e-13, "coarse products");
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&y));
  CALL(VecDestroy(&z));
  CALL(VecDestroy(&a));
  CALL(VecDestroy(&b));
  CALL(VecDestroy(&c));
  CALL(MatDestroy(&C));
  CALL(CoarseBoxDestroy(&box));
  CALL(FramesDestroy(&frames));
  CALL(FramesDestroy(&others));
  drop(&s);
  drop(&t);
}

static void test_products(void **state)
{
  (void)state;
  for (int solid = 0; solid < 2; ++solid)
    for (int frames = 0; frames < 2; ++frames)
      for (int kind = 0; kind < 3; ++kind)
        check_kind(&(Kind){solid ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, kind > 0, kind > 1, frames});
}

/* No matrix where two levels work; a factorisation, and a matrix for it, near failure. */
static void test_choice(void **state)
{
  SystemForm form;
  LinearProblem problem = {.choice = LINEAR_AUTO, .dim = 3, .unknowns = 9000, .levels = PETSC_TRUE};
  (void)state;
  CALL(LinearForm(&problem, &form));
  CHECK(form == SYSTEM_GATHERED, "a matrix");
  problem.failing = PETSC_TRUE;
  CALL(LinearForm(&problem, &form));
  CHECK(form == SYSTEM_ASSEMBLED && linear_factorises(&problem), "no factorisation");
  problem.failing = PETSC_FALSE;
  problem.levels = PETSC_FALSE;
  problem.choice = LINEAR_ITERATIVE;
  CALL(LinearForm(&problem, &form));
  CHECK(form == SYSTEM_ASSEMBLED, "nothing for algebraic multigrid");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_products), cmocka_unit_test(test_choice)};
  return run_model_tests(argc, argv, tests);
}
