/* The critical substep of explicit dynamics: 2 over the highest frequency of a cell with a point in its middle, which
 * is found here from shape functions and Hooke's law by vector iteration. */
#include "case_builder.h"
#include "model/explicit/critical.h"

#define CORNERS(dim) (1 << (dim))

static Model *block(Bench *b, PetscInt dim, const PetscReal h[3], PetscReal poisson)
{
  static PetscReal none[3];
  PetscReal max[3] = {0, 0, 0};
  bench_init(b, "mpm", dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 1);
  b->constants[1].value = poisson;
  b->body[0].points_per_cell = 1;
  b->c.basis.kind = "cell";
  bench_dynamic(b, 1, 1);
  b->c.analysis.type = ANALYSIS_EXPLICIT;
  for (PetscInt d = 0; d < dim; ++d) {
    b->c.grid.counts[d] = 3;
    max[d] = b->c.grid.max[d] = 3 * h[d];
  }
  bench_box(b, 0, none, max);
  return bench_model(b, PETSC_COMM_WORLD);
}

/* y = M^-1 K x of that cell. */
static void multiply(PetscInt dim, const PetscReal h[3], PetscReal poisson, const PetscReal *x, PetscReal *y)
{
  const PetscReal E = 1e6, rho = 1000, mu = E / (2 * (1 + poisson));
  const PetscReal lambda = E * poisson / ((1 + poisson) * (1 - 2 * poisson));
  const PetscInt corners = CORNERS(dim);
  PetscReal H[3][3] = {{0}}, s[3][3], trace = 0;
  for (PetscInt I = 0; I < corners; ++I)
    for (PetscInt i = 0; i < dim; ++i)
      for (PetscInt d = 0; d < dim; ++d)
        H[i][d] += x[I * dim + i] * (I >> d & 1 ? 2 : -2) / (h[d] * (PetscReal)corners);
  for (PetscInt d = 0; d < dim; ++d) trace += H[d][d];
  for (PetscInt i = 0; i < dim; ++i)
    for (PetscInt d = 0; d < dim; ++d) s[i][d] = mu * (H[i][d] + H[d][i]) + (i == d ? lambda * trace : 0);
  for (PetscInt I = 0; I < corners; ++I)
    for (PetscInt i = 0; i < dim; ++i) {
      y[I * dim + i] = 0;
      for (PetscInt d = 0; d < dim; ++d) y[I * dim + i] += s[i][d] * (I >> d & 1 ? 2 : -2) / h[d] / rho;
    }
}

static PetscReal two_over_frequency(PetscInt dim, const PetscReal h[3], PetscReal poisson)
{
  const PetscInt n = CORNERS(dim) * dim;
  PetscReal x[24], y[24], size = 0;
  for (PetscInt i = 0; i < n; ++i) x[i] = cos(1.0 + 1.7 * (double)(i * i));
  for (int k = 0; k < 4000; ++k) {
    multiply(dim, h, poisson, x, y);
    size = 0;
    for (PetscInt i = 0; i < n; ++i) size += y[i] * y[i];
    size = PetscSqrtReal(size);
    for (PetscInt i = 0; i < n; ++i) x[i] = y[i] / size;
  }
  return 2 / PetscSqrtReal(size);
}

static const PetscReal ratios[] = {-0.3, 0, 0.2, 0.3, 0.45, 0.499};
static const struct {
  PetscInt dim;
  PetscReal h[3];
} sides[] = {{2, {0.1, 0.1}}, {2, {0.1, 0.2}}, {2, {0.3, 0.1}}, {3, {0.2, 0.2, 0.2}}, {3, {0.1, 0.15, 0.3}}};

/* Never longer than it, nor shorter than what a wave along each axis leaves; of squares and cubes it is that. */
static void test_bound(void **state)
{
  (void)state;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(sides); ++k)
    for (size_t r = 0; r < PETSC_STATIC_ARRAY_LENGTH(ratios); ++r) {
      const PetscReal *h = sides[k].h, nu = ratios[r], exact = two_over_frequency(sides[k].dim, h, nu);
      PetscReal critical, crossing, fastest, sum = 0;
      Bench b;
      Model *m = block(&b, sides[k].dim, h, nu);
      for (PetscInt d = 0; d < sides[k].dim; ++d) sum += 1 / PetscSqr(h[d]);
      const PetscReal wave = PetscSqrtReal(1e3 * (1 - nu) / ((1 + nu) * (1 - 2 * nu)));
      CALL(ExplicitCritical(m, &critical, &crossing, &fastest));
      PetscPrintf(PETSC_COMM_WORLD, "%dD, %g x %g, nu %g: %.6g of %.6g s, a wave crosses in %.6g\n", (int)sides[k].dim,
                  (double)h[0], (double)h[1], (double)nu, (double)critical, (double)exact, (double)crossing);
      CHECK(critical <= exact * (1 + 1e-9), "longer than 2 / omega: %g", (double)(critical / exact));
      CHECK(critical > 0.8 * exact, "%g of what is possible", (double)(critical / exact));
      CHECK(critical >= crossing * (1 - 1e-12), "shorter than a wave takes: %g", (double)(critical / crossing));
      CHECK_CLOSE(crossing, 1 / (wave * PetscSqrtReal(sum)), 1e-12 * crossing);
      if (h[0] == h[1] && nu >= 0) CHECK_CLOSE(critical, exact, 1e-9 * exact);
      CHECK_CLOSE(fastest, 0, 0);
      CALL(ModelDestroy(&m));
    }
}

/* Whoever moves has less, and who updates stresses last, or bears walls, has what a wave takes. */
static void test_others(void **state)
{
  const PetscReal h[3] = {0.1, 0.1, 0.1};
  PetscReal rest, moving, crossing, fastest;
  Bench b;
  (void)state;
  Model *m = block(&b, 2, h, 0.3);
  CALL(ExplicitCritical(m, &rest, &crossing, &fastest));
  for (PetscInt p = 0; p < m->points->n; ++p) point_real(m->points, POINT_V, p)[0] = 7;
  CALL(ExplicitCritical(m, &moving, &crossing, &fastest));
  CHECK_CLOSE(1 / moving, 1 / rest + 7 * PetscSqrtReal(2) / h[0], 1e-9 / rest);
  CHECK_CLOSE(fastest, 7, 1e-14);
  b.c.analysis.update = EXPLICIT_USL;
  CALL(ExplicitCritical(m, &moving, &crossing, &fastest));
  CHECK_CLOSE(moving, crossing, 1e-14 * moving);
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_bound), cmocka_unit_test(test_others)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
