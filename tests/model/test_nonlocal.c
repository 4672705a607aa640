/* What points of a nonlocal law hear of the strains around them: against sums over all pairs of points, on any ranks,
 * in the plane and in space, wherever the origin is; and that they hear it in every step. */
#include "case_builder.h"
#include "model/model_private.h"

#define LENGTH 0.3
#define KAPPA 6
#define OFFSET 8
#define WEIGHT 2.0

static NamedValue soil[] = {{(char *)"young", 1e6},
                            {(char *)"poisson", 0.3},
                            {(char *)"friction_angle", 25},
                            {(char *)"cohesion", 5e3},
                            {(char *)"residual_cohesion", 1e3},
                            {(char *)"residual_strain", 0.5},
                            {(char *)"nonlocal_length", LENGTH},
                            {(char *)"nonlocal_weight", WEIGHT}};

static void ground(Bench *b, CellType cell, PetscInt side)
{
  bench_init(b, "mpm", cell, side);
  bench_dynamic(b, 1, 1e-6);
  b->material.law = (char *)"mohr-coulomb-softening";
  b->material.n_parameters = 8;
  b->material.parameters = soil;
}

static PetscReal strain_at(const PetscReal *x) { return 0.2 + 0.1 * sin(7 * x[0]) * cos(5 * x[1]); }

/* x, y, z, volume, strain of the points of all ranks. */
static PetscReal *everything(const Model *m, PetscInt *n)
{
  PetscMPIInt size, mine = 5 * (PetscMPIInt)m->points->n, count[8], start[8], all = 0;
  PetscReal *own, *every;
  CALL(PetscCalloc1(mine + 1, &own));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    for (PetscInt d = 0; d < m->dim; ++d) own[5 * p + d] = point_real(m->points, POINT_X, p)[d];
    own[5 * p + 3] = m->points->real[POINT_VOLUME][p];
    own[5 * p + 4] = point_real(m->points, POINT_STATE, p)[KAPPA];
  }
  MPI_Comm_size(m->comm, &size);
  MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, m->comm);
  for (int r = 0; r < size; ++r) start[r] = all, all += count[r];
  CALL(PetscMalloc1(all, &every));
  MPI_Allgatherv(own, mine, MPIU_REAL, every, count, start, MPIU_REAL, m->comm);
  CALL(PetscFree(own));
  *n = all / 5;
  return every;
}

static PetscReal mean_of_pairs(PetscInt n, const PetscReal *point, PetscInt dim, const PetscReal *x)
{
  PetscReal weight = 0, sum = 0;
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal r2 = 0;
    for (PetscInt d = 0; d < dim; ++d) r2 += PetscSqr(point[5 * k + d] - x[d]);
    if (r2 >= LENGTH * LENGTH) continue;
    const PetscReal w = point[5 * k + 3] * PetscSqr(1 - r2 / (LENGTH * LENGTH));
    weight += w;
    sum += w * point[5 * k + 4];
  }
  return sum / weight;
}

static void means(CellType cell, PetscInt side, PetscBool uniform)
{
  PetscReal off = 0;
  PetscInt n;
  Bench b;
  ground(&b, cell, side);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p)
    point_real(m->points, POINT_STATE, p)[KAPPA] = uniform ? 0.3 : strain_at(point_real(m->points, POINT_X, p));
  PetscReal *point = everything(m, &n);
  CALL(NonlocalStep(m));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal heard = point_real(m->points, POINT_STATE, p)[OFFSET] / WEIGHT;
    off = PetscMax(off, PetscAbsReal(heard - mean_of_pairs(n, point, m->dim, point_real(m->points, POINT_X, p))));
  }
  CHECK_CLOSE(off, 0, 1e-14);
  CALL(PetscFree(point));
  CALL(ModelDestroy(&m));
}

static void test_means(void **state)
{
  (void)state;
  means(CELL_QUADRILATERAL, 16, PETSC_TRUE);
  means(CELL_QUADRILATERAL, 16, PETSC_FALSE);
  means(CELL_QUADRILATERAL, 5, PETSC_FALSE); /* points farther apart than rows */
  means(CELL_HEXAHEDRON, 6, PETSC_FALSE);
}

/* Strains where points were before they were moved, by an axis turned round if `mirror` and by `far`; returned: the
 * largest difference to what points heard there. */
static PetscReal moved(CellType cell, PetscInt side, PetscBool mirror, PetscReal far)
{
  PetscReal off = 0, *heard;
  Bench b;
  ground(&b, cell, side);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p)
    point_real(m->points, POINT_STATE, p)[KAPPA] = strain_at(point_real(m->points, POINT_X, p));
  CALL(NonlocalStep(m));
  CALL(PetscMalloc1(m->points->n, &heard));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal *x = point_real(m->points, POINT_X, p);
    heard[p] = point_real(m->points, POINT_STATE, p)[OFFSET];
    if (mirror) x[0] = -x[0];
    for (PetscInt d = 0; d < m->dim; ++d) x[d] += far;
  }
  CALL(NonlocalStep(m));
  for (PetscInt p = 0; p < m->points->n; ++p)
    off = PetscMax(off, PetscAbsReal(point_real(m->points, POINT_STATE, p)[OFFSET] - heard[p]));
  CALL(PetscFree(heard));
  CALL(ModelDestroy(&m));
  return off;
}

static void test_anywhere(void **state)
{
  (void)state;
  CHECK_CLOSE(moved(CELL_QUADRILATERAL, 16, PETSC_FALSE, 0.03125), 0, 1e-13);
  CHECK_CLOSE(moved(CELL_QUADRILATERAL, 16, PETSC_FALSE, 1. / 3), 0, 1e-13);
  CHECK_CLOSE(moved(CELL_QUADRILATERAL, 16, PETSC_TRUE, -0.01), 0, 1e-13);
  CHECK_CLOSE(moved(CELL_HEXAHEDRON, 6, PETSC_TRUE, 0.01), 0, 1e-13);
}

static void test_every_step(void **state)
{
  StepReport report;
  Bench b;
  (void)state;
  ground(&b, CELL_QUADRILATERAL, 4);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    CHECK_CLOSE(point_real(m->points, POINT_STATE, p)[OFFSET], -1, 0);
    point_real(m->points, POINT_STATE, p)[KAPPA] = 0.1;
  }
  CALL(ModelStep(m, 1, &report));
  for (PetscInt p = 0; p < m->points->n; ++p)
    CHECK_CLOSE(point_real(m->points, POINT_STATE, p)[OFFSET], 0.1 * WEIGHT, 1e-14);
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_means), cmocka_unit_test(test_anywhere),
                                     cmocka_unit_test(test_every_step)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
