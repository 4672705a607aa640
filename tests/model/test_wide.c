/* Two levels of the box in statics; and what is done for functions that reach beyond their cell (gimp, bspline): half
 * of a symmetric tangent, whose rows of empty nodes are left alone. */
#include "case_builder.h"
#include "model/model_private.h"
#include "solve/levels/coarse_box.h"
#include "solve/newton/newton_private.h"
#include "solve/system/rigid_motions.h"

/* A beam that its weight bends, by less than makes its tangent indefinite on the way. */
static Model *beam(Bench *b, int dim, const char *basis, PetscReal size, PetscReal grading, PetscReal follow,
                   LinearChoice linear)
{
  bench_init(b, "mpm", dim == 2 ? CELL_QUADRILATERAL : CELL_HEXAHEDRON, 0);
  bench_grid(b, (PetscReal[]){0, -2, -size}, (PetscReal[]){4 + size, 1 + size, 1 + 2 * size}, size);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1});
  b->c.grid.grading[0] = grading;
  b->body[0].points_per_cell = dim == 2 ? 4 : 8;
  b->c.basis.kind = basis;
  b->c.linear = linear;
  b->c.stabilisation.follow = follow;
  b->c.gravity[1] = -0.3;
  bench_motion(b, 0, 0, MOTION_FIXED, dim == 2 ? 3 : 7);
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Rigid motions of the coarse nodes become those of all nodes: odd and even numbers of cells, graded ones. */
static void rigid(int dim, const char *basis, PetscReal size, PetscReal grading)
{
  MatNullSpace fine;
  const Vec *motion;
  unsigned char *none;
  CoarseBox *box;
  PetscInt n;
  Vec v;
  Bench b;
  Model *m = beam(&b, dim, basis, size, grading, 0.02, LINEAR_ITERATIVE);
  CHECK(coarse_box_fits(m->grid), "no coarse nodes");
  model_step(m, 1);
  CALL(PetscCalloc1(m->grid->n_nodes * dim, &none));
  CALL(CoarseBoxCreate(m->system, m->grid, none, &box));
  CALL(RigidMotions(m->system, m->grid, &fine));
  CALL(MatNullSpaceGetVecs(box->motions, NULL, &n, &motion));
  assert_int_equal(n, dim == 2 ? 3 : 6);
  CALL(MatCreateVecs(box->interpolation, NULL, &v));
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal all, rest;
    CALL(MatMult(box->interpolation, motion[k], v));
    CALL(VecNorm(v, NORM_2, &all));
    CALL(MatNullSpaceRemove(fine, v));
    CALL(VecNorm(v, NORM_2, &rest));
    CHECK(all > 0.5 && rest <= 1e-13 * all, "motion %d: %g of %g is not rigid", (int)k, (double)rest, (double)all);
  }
  CALL(VecDestroy(&v));
  CALL(CoarseBoxDestroy(&box));
  CALL(MatNullSpaceDestroy(&fine));
  CALL(PetscFree(none));
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_rigid(void **state)
{
  (void)state;
  for (int dim = 2; dim <= 3; ++dim) {
    rigid(dim, "gimp", 0.25, 1);
    rigid(dim, "gimp", 0.2, 1);
    rigid(dim, "cell", 0.25, 1.5);
  }
  rigid(3, "gimp", 0.25, 1.5);
}

/* The preconditioner of the last solve is symmetric and positive, which conjugate gradients want; numbers of its
 * sweeps are single. */
static void check_symmetric(Model *m)
{
  PetscReal xy, yx, xx, size[2];
  Vec x, y, z;
  KSP ksp;
  PC pc;
  CALL(SNESGetKSP(m->newton->snes, &ksp));
  CALL(KSPGetPC(ksp, &pc));
  CALL(VecDuplicate(m->newton->x, &x));
  CALL(VecDuplicate(x, &y));
  CALL(VecDuplicate(x, &z));
  CALL(VecSetRandom(x, NULL));
  CALL(VecSetRandom(y, NULL));
  CALL(PCApply(pc, x, z));
  CALL(VecDot(z, y, &xy));
  CALL(VecDot(z, x, &xx));
  CALL(VecNorm(z, NORM_2, &size[0]));
  CALL(VecNorm(y, NORM_2, &size[1]));
  CALL(PCApply(pc, y, z));
  CALL(VecDot(z, x, &yx));
  CHECK(xx > 0, "not positive: %g", (double)xx);
  CHECK(PetscAbsReal(xy - yx) <= 1e-5 * size[0] * size[1], "%.9g and %.9g", (double)xy, (double)yx);
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&y));
  CALL(VecDestroy(&z));
}

/* Two levels give the answer of a factorisation with as many iterations of Newton's method, and with few of their
 * own, however fine the cells. */
static void levels(int dim, const char *basis, PetscReal size, PetscReal follow, PetscInt most)
{
  PetscReal own[2] = {0, 0}, all[2];
  StepReport r[2];
  Model *m[2];
  Bench b[2];
  for (int k = 0; k < 2; ++k) {
    m[k] = beam(&b[k], dim, basis, size, 1, follow, k ? LINEAR_ITERATIVE : LINEAR_DIRECT);
    r[k] = model_step(m[k], 1);
    CHECK(r[k].cuts == 0, "the step was halved");
  }
  CHECK(strstr(newton_linear_name(m[1]->newton), "two levels"), "%s", newton_linear_name(m[1]->newton));
  for (PetscInt p = 0; p < m[0]->points->n * dim; ++p) {
    own[0] = PetscMax(own[0], PetscAbsReal(m[0]->points->real[POINT_U][p] - m[1]->points->real[POINT_U][p]));
    own[1] = PetscMax(own[1], PetscAbsReal(m[0]->points->real[POINT_U][p]));
  }
  CALL(MPI_Allreduce(own, all, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  CHECK(all[1] > 0.01 && all[0] <= 1e-6 * all[1], "displacements of %g m differ by %g m", (double)all[1],
        (double)all[0]);
  CHECK(r[1].newton.iterations == r[0].newton.iterations, "%d iterations for %d", (int)r[1].newton.iterations,
        (int)r[0].newton.iterations);
  CHECK(r[1].newton.linear_iterations <= most * r[1].newton.iterations, "%d linear iterations in %d",
        (int)r[1].newton.linear_iterations, (int)r[1].newton.iterations);
  check_symmetric(m[1]);
  for (int k = 0; k < 2; ++k) {
    CALL(ModelDestroy(&m[k]));
    bench_end(&b[k]);
  }
}

static void test_levels(void **state)
{
  (void)state;
  levels(3, "gimp", 0.25, 0.02, 14);
  levels(3, "gimp", 0.2, 0.02, 14);
  levels(3, "cell", 0.25, 0.02, 14);
  levels(2, "cell", 0.0625, 0.02, 14);
  levels(2, "cell", 0.05, 0.02, 14);
  levels(2, "gimp", 0.0625, 0.02, 14);
  levels(3, "bspline", 0.25, 0, 18);
  /* outer nodes follow those inside along lines that no coarse node knows; 123 in 4 on two ranks */
  levels(3, "bspline", 0.25, 0.02, 32);
}

/* Numbers from the diagonals on, of the step to come at rest; half: as Newton's method has them gathered. */
static void gather(Model *m, PetscBool half, float *upper)
{
  System *s = m->system;
  WeakFormInput in = weak_form_of(m, 1e6);
  WeakFormOutput out = {.force = m->nodes->force, .singles = s->singles, .slot = s->slot};
  in.half = PETSC_TRUE;
  if (half) CALL(SystemZeroHalf(s));
  else CALL(SystemZero(s));
  CALL(m->formulation->assemble(&in, &out));
  for (PetscInt r = 0; r < s->n_rows; ++r)
    for (PetscInt i = 9 * s->diagonal[r]; i < 9 * s->row_start[r + 1]; ++i) upper[i] = s->singles[i];
}

static void check_slots(const Model *m)
{
  const Support *w = m->space->support;
  const PetscInt *slot = m->system->slot;
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt I = 0; I < nn; ++I)
      for (PetscInt J = I; J < nn; ++J) assert_int_equal(slot[I * nn + J], system_pair(m->system, node[I], node[J]));
    slot += nn * nn;
  }
}

/* A block that has left nodes and reached others has the tangent that it has from nothing, to the bit. */
static void test_left_alone(void **state)
{
  float *upper[2];
  PetscInt left = 0, n, all;
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_HEXAHEDRON, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 2, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0.25, 1.25, 0.25}, (PetscReal[]){0.75, 1.75, 0.75});
  bench_dynamic(&b, 0.2, 0.01);
  b.body[0].points_per_cell = 8;
  b.body[0].velocity[1] = -3;
  b.body[0].spin[2] = 3;
  b.body[0].spin_centre[0] = 0.5;
  b.body[0].spin_centre[1] = 1.5;
  b.c.linear = LINEAR_ITERATIVE;
  b.c.basis.kind = "gimp";
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int k = 0; k < 12; ++k) model_step(m, 0.01);
  CALL(ModelActivate(m));
  CALL(SystemWantSlots(m->system, PETSC_TRUE));
  check_slots(m);
  CHECK(m->system->single, "not in single precision");
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i) m->nodes->idle[i] = !m->nodes->touched[i];
  CALL(SystemPrescribe(m->system, m->nodes->fixed, m->nodes->idle));
  for (PetscInt r = 0; r < m->system->n_rows; ++r) left += m->system->matter[r] == ROW_EMPTY;
  CALL(MPI_Allreduce(&left, &all, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  CHECK(all > 0, "no row is left alone");
  n = 9 * m->system->row_start[m->system->n_rows];
  CALL(PetscCalloc2(n, &upper[0], n, &upper[1]));
  gather(m, PETSC_TRUE, upper[0]);
  gather(m, PETSC_FALSE, upper[1]);
  for (PetscInt i = 0; i < n; ++i) CHECK(upper[0][i] == upper[1][i], "%g", (double)(upper[0][i] - upper[1][i]));
  CALL(PetscFree2(upper[0], upper[1]));
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_levels),
    cmocka_unit_test(test_rigid),
    cmocka_unit_test(test_left_alone),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
