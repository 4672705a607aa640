/* A patch of which only the boundary is prescribed: meshfree shape functions and a few points do
 * not give it exactly, and this is why.
 *
 * Insert the exact motion, with its uniform P. What stands at a node is P sum_p V_p grad N_I, and
 * nothing else: it would vanish inside if points integrated the divergence exactly. The error
 * follows that sum: it falls with more points if these carry volumes of a rule that integrates (not
 * equal shares of a distorted cell) and the clouds end where weights are small; it vanishes where
 * functions become those of linear finite elements; finer cells with the same points leave the
 * error of F as it is and take that of u down. */
#include "case_builder.h"

#define SIDE 8

typedef struct {
  BasisSpec basis;
  CellType cell;
  PetscInt points, side;  /* points in a cell, cells along a side */
  PetscReal shake, shear; /* inner nodes are displaced by so much of a cell, then all are sheared */
  PointWeights weights;
  PetscBool all; /* all nodes are prescribed, not only those of the boundary */
  Random random;
} Patch;

/* Clouds as they are by default; wide ones whose weights have died down where they end. */
static const BasisSpec usual_lme = {
  .kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
static const BasisSpec wide_lme = {.kind = "lme", .choice = 2, .gamma = 1.8, .radius = 3.4};
static const BasisSpec wide_mls = {.kind = "mls", .choice = 2, .effective_radius = 1, .radius = 3.4};
static const BasisSpec narrow_mls = {.kind = "mls", .choice = 2, .effective_radius = 0.7, .radius = 3.4};

static const PetscReal H[9] = {0.12, 0.15, 0, -0.08, -0.1, 0, 0, 0, 0};

static void affine(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *du)
{
  (void)context, (void)t0, (void)t1;
  for (int i = 0; i < 2; ++i) du[i] = H[3 * i] * x[0] + H[3 * i + 1] * x[1];
}

static void put_node(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  Patch *p = context;
  PetscBool keep = PETSC_FALSE;
  for (PetscInt d = 0; d < dim; ++d) keep |= x[d] < 1e-9 || x[d] > 1 - 1e-9;
  for (PetscInt d = 0; d < dim && !keep; ++d) x[d] += p->shake * size * random_real(&p->random, -1, 1);
  x[0] += p->shear * x[1];
}

static Model *patch_model(Patch *p, Bench *b, MPI_Comm comm)
{
  bench_init(b, "gmm", p->cell, p->side);
  p->random = (Random){7};
  bench_mesh(b, put_node, p);
  b->c.basis = p->basis;
  if (p->all) b->c.basis.essential = ESSENTIAL_DIRECT;
  b->body[0].has_shape = PETSC_FALSE;
  b->body[0].points_per_cell = p->points;
  b->body[0].weights = p->weights;
  MotionSpec *motion = bench_motion(b, -1, 0, MOTION_FIXED, 7);
  motion->on.has_shape = p->all;
  motion->on.shape = (Shape){.kind = SHAPE_BOX, .min = {-1, -1, -1}, .max = {2, 2, 2}};
  b->c.newton.residual = 1e-11;
  Model *m = bench_model(b, comm);
  m->boundary->field = affine;
  return m;
}

/* sum_p V_p grad N_I, on owned nodes. */
static PetscReal *divergence(const Model *m)
{
  const Support *w = m->space->support;
  PetscReal *G;
  CALL(PetscCalloc1(m->grid->n_nodes * 2, &G));
  for (PetscInt p = 0; p < w->n_groups; ++p)
    for (PetscInt i = w->node_start[p]; i < w->node_start[p + 1]; ++i)
      for (int d = 0; d < 2; ++d) G[w->node[i] * 2 + d] += m->points->real[POINT_VOLUME][p] * w->dN[i * 2 + d];
  CALL(GridSumToOwners(m->grid, 2, G));
  return G;
}

typedef struct {
  PetscReal F, u; /* roots of the mean squares of the errors, u over the side */
} Error;

static Error patch_error(const Model *m)
{
  PetscReal sum[3] = {0, 0, 0}, F[9], u[2];
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal volume = m->points->real[POINT_VOLUME][p], *x = point_real(m->points, POINT_X, p),
                    *moved = point_real(m->points, POINT_U, p);
    const PetscReal X[2] = {x[0] - moved[0], x[1] - moved[1]};
    point_F(m->points, p, F);
    affine(NULL, X, 0, 1, u);
    for (int k = 0; k < 9; ++k) sum[0] += volume * PetscSqr(F[k] - (k % 4 == 0) - H[k]);
    for (int d = 0; d < 2; ++d) sum[1] += volume * PetscSqr(u[d] - moved[d]);
    sum[2] += volume;
  }
  CALL(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  return (Error){PetscSqrtReal(sum[0] / sum[2]), PetscSqrtReal(sum[1] / sum[2])};
}

static Error patch(Patch p)
{
  Bench b;
  Model *m = patch_model(&p, &b, PETSC_COMM_WORLD);
  CHECK(model_step(m, 1).cuts == 0, "the step was halved");
  const Error error = patch_error(m);
  PetscPrintf(PETSC_COMM_WORLD, "%s %.3g, radius %.3g%s, cell %d of 1/%d with %d points: F off by %.3g, u by %.3g\n",
              p.basis.kind, (double)(p.basis.gamma > 0 ? p.basis.gamma : p.basis.effective_radius),
              (double)p.basis.radius, p.weights == WEIGHTS_EQUAL ? ", equal shares" : "", (int)p.cell, (int)p.side,
              (int)p.points, (double)error.F, (double)error.u);
  CALL(ModelDestroy(&m));
  bench_end(&b);
  return error;
}

/* --- the cause --- */
static void check_forces(const BasisSpec *basis)
{
  Patch p = {.basis = *basis, .cell = CELL_QUADRILATERAL, .points = 4, .side = SIDE, .shake = 0.2, .all = PETSC_TRUE};
  Bench b;
  PetscReal F[9], inverse[9], sigma[6], P[4], off = 0, size = 0;
  /* owners may change in a step, and with them the order of nodes */
  Model *m = patch_model(&p, &b, PETSC_COMM_SELF);
  PetscReal *G = divergence(m);
  CHECK_CLOSE(m->grid->cloud->spacing, 1.0 / SIDE, 1e-14); /* whatever the shortest edge */
  model_step(m, 1);
  CHECK(patch_error(m).F < 1e-13, "F is not uniform");
  for (int k = 0; k < 9; ++k) F[k] = (k % 4 == 0) + H[k];
  rubber_stress(F, sigma);
  tensor_inverse(F, inverse);
  const PetscReal J = (1 + H[0]) * (1 + H[4]) - H[1] * H[3], s[4] = {sigma[0], sigma[3], sigma[3], sigma[1]};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) P[2 * i + j] = J * (s[2 * i] * inverse[3 * j] + s[2 * i + 1] * inverse[3 * j + 1]);
  for (PetscInt i = 0; i < m->grid->n_owned * 2; ++i) {
    const PetscReal force = P[i % 2 * 2] * G[i - i % 2] + P[i % 2 * 2 + 1] * G[i - i % 2 + 1];
    off = PetscMax(off, PetscAbsReal(m->nodes->force[i] - force));
    size = PetscMax(size, PetscAbsReal(force));
  }
  PetscPrintf(PETSC_COMM_WORLD, "nodal forces of the exact motion, up to %.3g N, are P sum V grad N to %.2g\n",
              (double)size, (double)(off / size));
  CHECK(off <= 1e-12 * size, "forces are off by %g of %g", (double)off, (double)size);
  CALL(PetscFree(G));
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_cause(void **state)
{
  (void)state;
  check_forces(&usual_lme);
  check_forces(&wide_mls);
}

/* --- more points --- */
static void test_points(void **state)
{
  static const struct {
    const BasisSpec *basis;
    PetscReal few, many; /* bounds with 4 and 16 points */
  } rows[] = {
    {&usual_lme, 4e-3, 6e-4}, {&wide_lme, 3e-3, 2.5e-4}, {&wide_mls, 1.5e-3, 6e-4}, {&narrow_mls, 4.5e-3, 3.5e-4}};
  Patch p = {.cell = CELL_QUADRILATERAL, .side = SIDE, .shake = 0.2};
  (void)state;
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    p.basis = *rows[k].basis;
    const Error one = (p.points = 1, patch(p)), few = (p.points = 4, patch(p)), many = (p.points = 16, patch(p));
    CHECK(few.F <= rows[k].few && many.F <= rows[k].many, "F is off by %g and %g", (double)few.F, (double)many.F);
    const PetscReal order = PetscLogReal(one.F / many.F) / PetscLogReal(4);
    CHECK(order > 1.8, "with four times as many points along a line the error falls with the order %g", (double)order);
  }
  p.basis = wide_lme;
  p.weights = WEIGHTS_EQUAL;
  const Error equal = patch(p);
  CHECK(equal.F > 5e-3, "equal shares of distorted cells integrate better than thought: %g", (double)equal.F);
}

/* --- finer cells --- */
static void test_cells(void **state)
{
  static const BasisSpec *const bases[] = {&wide_lme, &narrow_mls};
  Patch p = {.cell = CELL_QUADRILATERAL, .points = 4};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    p.basis = *bases[k];
    p.shake = 0.2;
    const Error coarse = (p.side = 16, patch(p)), fine = (p.side = 32, patch(p));
    CHECK(fine.F < 1.2 * coarse.F && fine.F > 0.8 * coarse.F, "F is off by %g and %g", (double)coarse.F,
          (double)fine.F);
    CHECK_CLOSE(PetscLog2Real(coarse.u / fine.u), 1, 0.15);
    p.shake = 0; /* on a lattice the sum vanishes but near the boundary */
    const Error regular = (p.side = 16, patch(p)), finer = (p.side = 32, patch(p));
    CHECK(regular.F < 1e-4 && finer.F < 0.75 * regular.F, "on a lattice F is off by %g and %g", (double)regular.F,
          (double)finer.F);
  }
}

/* --- linear finite elements --- */
static void test_finite_elements(void **state)
{
  static const PetscReal gamma[] = {1.8, 6, 20, 60};
  static const PetscReal bound[] = {2e-3, 6e-4, 1e-4, 1e-5};
  Patch p = {.basis = wide_lme, .cell = CELL_TRIANGLE, .points = 3, .side = SIDE, .shake = 0.1, .shear = -0.3};
  (void)state;
  p.basis.radius = 2;
  for (int k = 0; k < 4; ++k) {
    p.basis.gamma = gamma[k];
    const Error error = patch(p);
    CHECK(error.F <= bound[k], "gamma = %g: F is off by %g", (double)gamma[k], (double)error.F);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_cause),
    cmocka_unit_test(test_points),
    cmocka_unit_test(test_cells),
    cmocka_unit_test(test_finite_elements),
  };
  return run_model_tests(argc, argv, tests);
}
