/* Points that are split as the body is stretched (basis gimp): a body pulled to four times its length through the
 * grid stays in uniform strain to round-off, while points that stay whole leave gaps. */
#include "smooth.h"

#define PULLED 4.0

/* x(t) = length(t) X, to four times in nine steps; its width is held. */
static PetscReal stretch_at(PetscReal t) { return 1 + (PULLED - 1) * t; }

static void pull(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  const PetscReal ratio = stretch_at(t1) / stretch_at(t0);
  (void)context;
  increment[0] = (ratio - 1) * x[0];
  increment[1] = increment[2] = 0;
}

/* Of 4 x 4 (x 2) cells; all nodes beyond x = 3.5 are led, those before that are free. */
static Model *pulled(Bench *b, PetscInt dim, const char *formulation, PetscReal split, PetscReal until)
{
  bench_init(b, "mpm", dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 1);
  bench_grid(b, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){18, 4, 2}, 1);
  bench_box(b, 0, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){4, 4, 2});
  b->c.basis.kind = "gimp";
  b->c.basis.split = split;
  b->c.formulation = (char *)formulation;
  b->c.stabilisation.curvature = 0.01;
  b->c.analysis.step = b->c.analysis.largest = 1.0 / 9;
  bench_motion(b, 0, 0, MOTION_FIXED, 1);
  for (PetscInt d = 1; d < dim; ++d) bench_motion(b, (int)d, 0, MOTION_FIXED, 1u << d);
  for (PetscInt d = 1; d < dim; ++d) bench_motion(b, (int)d, d == 1 ? 4 : 2, MOTION_FIXED, 1u << d);
  bench_motion(b, 0, 18, MOTION_FIXED, dim == 3 ? 7 : 3)->on.min[0] = 3.5;
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  m->boundary->field = pull;
  while (m->time < until - 1e-9) CHECK(model_step(m, until - m->time).cuts == 0, "the step was halved");
  return m;
}

static PetscInt count(const Model *m)
{
  PetscInt n;
  CALL(ModelCountPoints(m, &n));
  return n;
}

/* Points that stand half a cell apart come to two cells, and in four parts to half a cell. */
static void uniform(PetscInt dim, const char *formulation)
{
  const PetscReal F[9] = {PULLED, 0, 0, 0, 1, 0, 0, 0, 1};
  const PetscInt at_start = dim == 3 ? 4 * 4 * 2 * 8 : 4 * 4 * 4;
  Bench b;
  Model *m = pulled(&b, dim, formulation, 0.6, 1);
  CHECK(count(m) == 4 * at_start, "%d points", (int)count(m));
  check_uniform(m, F, 1e-11);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_uniform(void **state)
{
  (void)state;
  uniform(2, "displacement");
  uniform(2, "mixed");
  uniform(3, "displacement");
}

/* What it is against: a cell and a third apart, points that stay whole are not in
 * uniform strain any more; a step later they fall apart. */
static void test_whole(void **state)
{
  const PetscReal until = 5.0 / 9;
  PetscReal worst = 0, f[9];
  Bench b;
  (void)state;
  Model *m = pulled(&b, 2, "displacement", 0, until);
  CHECK(count(m) == 64, "%d points", (int)count(m));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    point_F(m->points, p, f);
    worst = PetscMax(worst, PetscAbsReal(f[0] - stretch_at(until)));
  }
  CALL(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  CHECK(worst > 0.02, "whole points are off by %g only", (double)worst);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_uniform), cmocka_unit_test(test_whole)};
  return run_model_tests(argc, argv, tests);
}
