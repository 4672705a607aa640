/* Nonlinear elimination: which nodes are chosen, that they are settled against all their points while the others
 * stay, and that a flow solved with it is in balance everywhere. */
#include "case_builder.h"
#include "model/model_private.h"
#include "solve/newton/patches/eliminate.h"

static NamedValue grains[] = {
  {"young", 1e6}, {"poisson", 0.3}, {"friction_angle", 35}, {"dilatancy_angle", 1}, {"cohesion", 0}};

/* A column of grains in triangles or squares of 5 mm that begins to fall apart. */
static Model *column(Bench *b, CellType cell, PetscBool hoop)
{
  bench_init(b, "mpm", cell, 0);
  b->material =
    (MaterialSpec){.name = "grains", .law = "mohr-coulomb", .density = 1500, .n_parameters = 5, .parameters = grains};
  b->body[0].material = "grains";
  if (hoop) b->c.kinematics = &kinematics_axisymmetric;
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.2, 0.2, 0}, 0.005);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.1, 0.15, 0});
  bench_dynamic(b, 1, 1e-3);
  bench_motion(b, 1, 0, MOTION_FIXED, 3);
  bench_motion(b, 0, 0, MOTION_FIXED, 1);
  b->c.gravity[1] = -9.81;
  b->c.newton = (NewtonSpec){.residual = 1e-8, .increment = 1e-10, .max_iterations = 25, .ease = 6};
  b->c.stabilisation = (StabilisationSpec){.stiffness = 1e-6, .mass = 1, .inertia = 0.05};
  b->c.linear = LINEAR_AUTO;
  return bench_model(b, PETSC_COMM_WORLD);
}

/* A step of dt as it stands before Newton's method. */
static void prepare(Model *m, PetscReal dt, StepProblem *p)
{
  StepReport report = {0};
  StepStart start;
  CALL(ModelInitialise(m));
  CALL(PrepareUnknowns(m, &start, &report));
  CALL(PrepareStep(m, dt, p));
  guess_make(m, GUESS_INERTIA, dt, p->du);
}

/* Residual by a pass over all points; whole at the nodes that this rank owns. */
static void residual(const StepProblem *p, PetscReal *f)
{
  WeakFormInput in = p->in;
  WeakFormOutput out = {.force = f};
  in.du = p->du;
  for (PetscInt i = 0; i < p->grid->n_nodes * p->grid->dim; ++i) f[i] = 0;
  CALL(p->formulation->assemble(&in, &out));
  CHECK(out.status == LAW_OK, "a point failed");
  CALL(GridSumToOwners(p->grid, p->grid->dim, f));
  for (PetscInt i = 0; i < p->grid->n_nodes * p->grid->dim; ++i) f[i] = p->fixed[i] ? 0 : f[i] - p->external[i];
}

/* Norm of the residual of a patch. */
static PetscReal norm_at(const Elimination *e, PetscInt dim, const PetscReal *f, PetscInt patch)
{
  PetscReal square = 0;
  for (PetscInt k = e->node_start[patch]; k < e->node_start[patch + 1]; ++k) {
    for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(f[e->node[k] * dim + d]);
  }
  return PetscSqrtReal(square);
}

/* Residuals of 1 N at a few active nodes of each rank, spread over it, and nowhere else. */
static void choose(Elimination *e, const StepProblem *p, PetscInt few)
{
  const PetscInt n = p->system->n_active;
  PetscReal *f;
  CALL(PetscCalloc1(n * 2, &f));
  for (int k = 0; k < few; ++k) f[2 * ((2 * k + 1) * n / (2 * few))] = 1;
  CALL(EliminationChoose(e, p, f, 2));
  CALL(PetscFree(f));
}

static void check_settled(CellType cell, PetscBool hoop)
{
  Bench b;
  StepProblem p;
  Elimination e = {0};
  PetscReal *f, *before, *du;
  Model *m = column(&b, cell, hoop);
  for (int s = 0; s < 12; ++s) model_step(m, 1);
  prepare(m, 1e-3, &p);
  const PetscInt dofs = p.grid->n_nodes * 2;
  CALL(PetscMalloc3(dofs, &f, dofs, &before, dofs, &du));
  CALL(EliminationSetUp(&e, &p));
  choose(&e, &p, 6);
  residual(&p, before);
  for (PetscInt i = 0; i < dofs; ++i) du[i] = p.du[i];
  CALL(EliminationApply(&e, &p, 1e-9));
  residual(&p, f);
  for (PetscInt k = 0; k < e.n_patches; ++k) {
    const PetscReal left = norm_at(&e, 2, f, k), was = norm_at(&e, 2, before, k);
    CHECK(left <= 1e-8 && was > 1e-4, "a patch is left with %g N of %g", (double)left, (double)was);
    for (PetscInt i = e.node_start[k]; i < e.node_start[k + 1]; ++i)
      for (int d = 0; d < 2; ++d) du[2 * e.node[i] + d] = p.du[2 * e.node[i] + d];
  }
  for (PetscInt i = 0; i < dofs; ++i) CHECK(du[i] == p.du[i], "another node was moved");
  CALL(PetscFree3(f, before, du));
  CALL(EliminationReset(&e));
  CALL(ModelDestroy(&m));
}

static void test_settled(void **state)
{
  (void)state;
  check_settled(CELL_TRIANGLE, PETSC_FALSE);
  check_settled(CELL_TRIANGLE, PETSC_TRUE);
  check_settled(CELL_QUADRILATERAL, PETSC_FALSE);
}

/* Two nodes that are far apart make two patches, each with its neighbours and with all groups that hold one of its
 * nodes; a residual that stands everywhere makes none, but in stiff matter that yields. */
static void test_chosen(void **state)
{
  (void)state;
  Bench b;
  StepProblem p;
  Elimination e = {0};
  PetscReal *f;
  PetscMPIInt ranks;
  Model *m = column(&b, CELL_TRIANGLE, PETSC_FALSE);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  prepare(m, 1e-3, &p);
  CALL(EliminationSetUp(&e, &p));
  choose(&e, &p, 2);
  CHECK(ranks > 1 || e.n_patches == 2, "%d patches", (int)e.n_patches);
  for (PetscInt k = 0; k < e.n_patches; ++k) {
    const PetscInt n = e.node_start[k + 1] - e.node_start[k];
    CHECK(n >= 2 && n <= 9, "a patch of %d nodes", (int)n);
    for (PetscInt i = e.node_start[k]; i < e.node_start[k + 1]; ++i) {
      PetscInt holding = 0, found = 0;
      for (PetscInt g = 0; g < p.in.support->n_groups; ++g)
        for (PetscInt j = 0; j < 3; ++j) holding += p.in.support->node[3 * g + j] == e.node[i];
      for (PetscInt j = e.group_start[k]; j < e.group_start[k + 1]; ++j)
        for (PetscInt c = 0; c < 3; ++c) found += p.in.support->node[3 * e.group[j] + c] == e.node[i];
      CHECK(holding == found, "%d of %d groups of a node", (int)found, (int)holding);
    }
  }
  CALL(PetscMalloc1(p.system->n_active * 2, &f));
  for (PetscInt i = 0; i < p.system->n_active * 2; ++i) f[i] = 1;
  CALL(EliminationChoose(&e, &p, f, 1));
  CHECK(e.n_patches == 0 && !e.any, "all nodes were chosen");
  p.stiff = PETSC_TRUE;
  CALL(EliminationChoose(&e, &p, f, 1));
  CHECK(e.any && (ranks > 1 || e.n_patches == 1), "%d patches of stiff matter", (int)e.n_patches);
  p.stiff = PETSC_FALSE;
  CALL(EliminationChoose(&e, &p, f, 1));
  for (PetscInt i = 0; i < p.grid->n_nodes; ++i) CHECK(e.place[i] == -1, "a mark was left");
  CALL(PetscFree(f));
  CALL(EliminationReset(&e));
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_chosen), cmocka_unit_test(test_settled)};
  return run_model_tests(argc, argv, tests);
}
