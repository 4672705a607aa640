/* Prescribed unknowns in the system: rows and columns that are cut, diagonals, columns lifted to
 * the right-hand side; in double and single precision, with pressures, on any number of ranks. */
#include "made_system.h"
#include "solve/blocks/blocks.h"

static const PetscReal large = 1e7; /* of the matrices' numbers */

/* A system with `block` unknowns a node, without symmetry; every third node is idle where there
 * are pressures. */
typedef struct {
  Made made;
  unsigned char *none, *idle;
  PetscReal *lift, *force, *volume;
} Subject;

/* More on the diagonal: blocks take its inverse. */
static void add_numbers(Subject *t)
{
  System *s = t->made.system;
  const PetscInt nn = t->made.grid->nodes_per_cell, block = s->block;
  for (PetscInt g = 0; g < t->made.cells.n_groups; ++g) {
    Random random = {(uint64_t)t->made.cells.point_start[g] + 3};
    for (PetscInt k = 0; k < nn * nn; ++k)
      for (PetscInt e = 0; e < block * block; ++e)
        s->values[s->slot[g * nn * nn + k] * block * block + e] +=
          large * (random_real(&random, -1, 1) + (k % (nn + 1) == 0 && e % (block + 1) == 0 ? 4 : 0));
  }
}

static void begin(Subject *t, CellType type, PetscBool pressure)
{
  make(&t->made, type, PETSC_FALSE, 2, 2, 0);
  const Grid *grid = t->made.grid;
  const Support *some = &t->made.cells;
  const PetscInt dim = grid->dim;
  CALL(SystemDestroy(&t->made.system));
  CALL(SystemCreate(PETSC_COMM_WORLD, dim, dim + (pressure ? 1 : 0), &t->made.system));
  CALL(SystemBuild(t->made.system, grid,
                   &(NodeGroups){.n = some->n_groups, .start = some->node_start, .node = some->node}));
  CALL(SystemSlots(t->made.system, some, NULL));
  add_numbers(t);
  CALL(PetscCalloc5(grid->n_nodes * dim, &t->none, grid->n_nodes, &t->idle, grid->n_nodes * dim, &t->lift,
                    grid->n_nodes * dim, &t->force, grid->n_nodes, &t->volume));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) {
    Random random = {(uint64_t)grid->global_node[i] + 7};
    t->idle[i] = pressure && grid->global_node[i] % 3 == 0;
    for (PetscInt d = 0; d < dim; ++d) {
      const PetscReal v = random_real(&random, -1, 1);
      t->lift[i * dim + d] = t->made.fixed[i * dim + d] ? v : 0;
    }
  }
}

static void end(Subject *t)
{
  CALL(PetscFree5(t->none, t->idle, t->lift, t->force, t->volume));
  drop(&t->made);
}

/* Displacements (and pressures) -> a vector. */
static Vec vector_of(const Subject *t, const PetscReal *u, const PetscReal *p)
{
  const System *s = t->made.system;
  Vec x;
  CALL(SystemCreateVec(s, &x));
  CALL(SystemFromNodes(s, u, 0, s->dim, x));
  if (s->block > s->dim) CALL(SystemFromNodes(s, p, s->dim, 1, x));
  return x;
}

static PetscBool is_held(const Subject *t, PetscInt i)
{
  const System *s = t->made.system;
  const PetscInt node = s->active[i / s->block], d = i % s->block;
  return d < s->dim ? t->made.fixed[node * s->dim + d] : t->idle[node];
}

/* The largest difference of a and b, where rows are held, or else free. */
static PetscReal largest(const Subject *t, PetscBool held, Vec a, Vec b)
{
  const PetscReal *x, *y;
  PetscReal value = 0;
  CALL(VecGetArrayRead(a, &x));
  CALL(VecGetArrayRead(b, &y));
  for (PetscInt i = 0; i < t->made.system->n_active * t->made.system->block; ++i)
    if (is_held(t, i) == held) value = PetscMax(value, PetscAbsReal(x[i] - y[i]));
  CALL(VecRestoreArrayRead(a, &x));
  CALL(VecRestoreArrayRead(b, &y));
  CALL(MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  return value;
}

/* Random on free unknowns, or on held ones. */
static Vec random_where(const Subject *t, PetscBool held)
{
  PetscReal *v;
  Vec x;
  CALL(SystemCreateVec(t->made.system, &x));
  CALL(VecGetArrayWrite(x, &v));
  for (PetscInt i = 0; i < t->made.system->n_active * t->made.system->block; ++i) {
    const PetscInt block = t->made.system->block;
    Random random = {(uint64_t)(t->made.grid->global_node[t->made.system->active[i / block]] * block + i % block)};
    v[i] = is_held(t, i) == held ? random_real(&random, -1, 1) : 0;
  }
  CALL(VecRestoreArrayWrite(x, &v));
  return x;
}

/* What lifting leaves in the forces. */
static Vec lifted(Subject *t)
{
  const Grid *grid = t->made.grid;
  const PetscInt dofs = grid->n_nodes * grid->dim;
  CALL(PetscArrayzero(t->force, dofs));
  CALL(PetscArrayzero(t->volume, grid->n_nodes));
  system_lift(t->made.system, t->made.fixed, t->lift, t->force, t->volume);
  CALL(GridSumToOwners(grid, grid->dim, t->force));
  CALL(GridSumToOwners(grid, 1, t->volume));
  return vector_of(t, t->force, t->volume);
}

static void check_lift(const Subject *t, Vec found, Vec wanted, PetscReal bound)
{
  Vec zero;
  CALL(VecDuplicate(found, &zero));
  CALL(VecZeroEntries(zero));
  const PetscReal off = largest(t, PETSC_FALSE, found, wanted), size = largest(t, PETSC_FALSE, wanted, zero);
  const PetscReal reaction = t->made.system->block > t->made.system->dim ? 0 : largest(t, PETSC_TRUE, found, zero);
  CHECK(size > large && off <= bound * size, "%g of %g lifted", (double)off, (double)size);
  CHECK(reaction == 0, "reactions are changed by %g", (double)reaction);
  CALL(VecDestroy(&zero));
}

/* A x of the free, by the cut matrix as by the whole one; nothing on held rows; held columns
 * give their diagonal alone. */
static void check_cut(const Subject *t, Mat cut, Vec whole, PetscReal bound)
{
  Vec x = random_where(t, PETSC_FALSE), h = random_where(t, PETSC_TRUE), y, zero;
  CALL(VecDuplicate(x, &y));
  CALL(VecDuplicate(x, &zero));
  CALL(VecZeroEntries(zero));
  CALL(MatMult(cut, x, y));
  const PetscReal size = largest(t, PETSC_FALSE, whole, zero);
  CHECK(largest(t, PETSC_FALSE, y, whole) <= bound * size, "products are off by %g of %g",
        (double)largest(t, PETSC_FALSE, y, whole), (double)size);
  CHECK(largest(t, PETSC_TRUE, y, zero) == 0, "rows are not empty");
  CALL(MatMult(cut, h, y));
  CHECK(largest(t, PETSC_FALSE, y, zero) <= bound * large, "columns are not empty");
  CHECK(largest(t, PETSC_TRUE, y, zero) > 0, "no diagonal");
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&h));
  CALL(VecDestroy(&y));
  CALL(VecDestroy(&zero));
}

static void check(CellType type, PetscBool pressure)
{
  Subject t;
  Vec x, whole, wanted, found, lift;
  PetscReal *copy;
  begin(&t, type, pressure);
  System *s = t.made.system;
  const PetscInt n = s->row_start[s->n_rows] * s->block * s->block;
  CALL(PetscMalloc1(n, &copy));
  CALL(PetscArraycpy(copy, s->values, n));
  CALL(PetscArrayzero(t.volume, t.made.grid->n_nodes));
  lift = vector_of(&t, t.lift, t.volume);
  x = random_where(&t, PETSC_FALSE);
  CALL(VecDuplicate(x, &whole));
  CALL(VecDuplicate(x, &wanted));
  unsigned char *nobody = t.none; /* n_nodes x dim zeros serve as n_nodes, too */
  CALL(SystemPrescribe(s, t.none, nobody));
  CALL(SystemToMatrix(s));
  CALL(MatMult(s->matrix, x, whole));
  CALL(MatMult(s->matrix, lift, wanted));
  CALL(SystemPrescribe(s, t.made.fixed, t.idle));
  found = lifted(&t);
  check_lift(&t, found, wanted, 1e-14);
  CALL(SystemToMatrix(s));
  check_cut(&t, s->matrix, whole, 1e-14);
  if (!pressure) {
    CALL(VecDestroy(&found));
    CALL(SystemUse(s, SYSTEM_BLOCKS, PETSC_FALSE));
    CALL(SystemGather(s, PETSC_TRUE));
    for (PetscInt i = 0; i < n; ++i) s->singles[i] = (float)copy[i];
    found = lifted(&t);
    check_lift(&t, found, wanted, 1e-6);
    CALL(SystemToMatrix(s));
    check_cut(&t, s->matrix, whole, 1e-5);
  }
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&whole));
  CALL(VecDestroy(&wanted));
  CALL(VecDestroy(&found));
  CALL(VecDestroy(&lift));
  CALL(PetscFree(copy));
  end(&t);
}

static void test_prescribed(void **state)
{
  (void)state;
  for (CellType type = CELL_TRIANGLE; type <= CELL_HEXAHEDRON; ++type)
    for (int pressure = 0; pressure < 2; ++pressure) check(type, pressure > 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_prescribed)};
  return run_model_tests(argc, argv, tests);
}
