/* A manufactured solution in finite strains: with the body force that makes a chosen smooth
 * displacement the solution, the error falls with the square of the cell size, in fem and in mpm's
 * first step.
 *
 * u = A (a sin sin sin) vanishes on the boundary of the unit square or cube; b = - Div P / density
 * with P from F by the law's first Piola-Kirchhoff stress, Div by differences of sixth order:
 * nothing of the program takes part in it. */
#include "case_builder.h"

static const PetscReal direction[3] = {1, -0.6, 0.4};

typedef struct {
  PetscInt dim;
  PetscReal amplitude;
} Manufactured;

/* Displacement, and its gradient du_i/dX_j. */
static void solution(const Manufactured *s, const PetscReal *X, PetscReal u[3], PetscReal H[9])
{
  PetscReal shape = s->amplitude, slope[3];
  for (PetscInt d = 0; d < s->dim; ++d) shape *= sin(PETSC_PI * X[d]);
  for (PetscInt d = 0; d < s->dim; ++d) {
    slope[d] = s->amplitude * PETSC_PI * cos(PETSC_PI * X[d]);
    for (PetscInt e = 0; e < s->dim; ++e)
      if (e != d) slope[d] *= sin(PETSC_PI * X[e]);
  }
  for (int i = 0; i < 9; ++i) H[i] = 0;
  for (PetscInt i = 0; i < s->dim; ++i) {
    u[i] = direction[i] * shape;
    for (PetscInt j = 0; j < s->dim; ++j) H[3 * i + j] = direction[i] * slope[j];
  }
}

/* P = mu (F - F^-T) + lambda ln J F^-T */
static void piola(const Manufactured *s, const PetscReal *X, PetscReal P[9])
{
  const PetscReal E = 1e6, nu = 0.3, mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  PetscReal u[3], F[9], inverse[9];
  solution(s, X, u, F);
  for (int i = 0; i < 9; i += 4) F[i] += 1;
  const PetscReal log_J = log(tensor_inverse(F, inverse));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P[3 * i + j] = mu * (F[3 * i + j] - inverse[3 * j + i]) + lambda * log_J * inverse[3 * j + i];
}

static void force_at(const Manufactured *s, const PetscReal *X, PetscReal *b)
{
  static const PetscReal weight[3] = {3. / 4, -3. / 20, 1. / 60};
  const PetscReal h = 5e-3;
  for (PetscInt j = 0; j < s->dim; ++j)
    for (int k = -3; k <= 3; ++k) {
      PetscReal at[3] = {0, 0, 0}, P[9];
      if (!k) continue;
      for (PetscInt d = 0; d < s->dim; ++d) at[d] = X[d] + (d == j ? k * h : 0);
      piola(s, at, P);
      for (PetscInt i = 0; i < s->dim; ++i)
        b[i] -= (k > 0 ? 1 : -1) * weight[PetscAbsInt(k) - 1] * P[3 * i + j] / h / 1000;
    }
}

static void body_force(void *context, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *b)
{
  const Manufactured *s = context;
  (void)x;
  (void)t;
  for (PetscInt p = 0; p < n; ++p) force_at(s, X + 3 * p, b + 3 * p);
}

/* L2 norm of the error of the displacement over the points. */
static PetscReal error_with(const char *method, CellType cell, PetscInt n)
{
  Bench b;
  Manufactured s = {cell >= CELL_TETRAHEDRON ? 3 : 2, cell >= CELL_TETRAHEDRON ? 0.05 : 0.1};
  PetscReal sum = 0, all, u[3], H[9];
  bench_init(&b, method, cell, n);
  bench_motion(&b, -1, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CALL(ModelSetBodyForce(m, body_force, &s));
  CHECK(model_step(m, 1).cuts == 0, "the step was halved");
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), *v = point_real(m->points, POINT_U, p);
    const PetscReal X[3] = {x[0] - v[0], x[1] - v[1], s.dim == 3 ? x[2] - v[2] : 0};
    solution(&s, X, u, H);
    for (PetscInt d = 0; d < s.dim; ++d) sum += m->points->real[POINT_VOLUME][p] * PetscSqr(v[d] - u[d]);
  }
  CALL(MPI_Allreduce(&sum, &all, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  CALL(ModelDestroy(&m));
  return PetscSqrtReal(all);
}

static void convergence(const char *method, CellType cell, PetscInt coarsest, PetscInt meshes, PetscReal least)
{
  PetscReal last = 0, order = 0;
  for (PetscInt k = 0, n = coarsest; k < meshes; ++k, n *= 2) {
    const PetscReal error = error_with(method, cell, n);
    if (k) order = log2(last / error);
    PetscPrintf(PETSC_COMM_WORLD, "%s, cell %d, n = %2d: error %.4e m, order %.3f\n", method, (int)cell, (int)n,
                (double)error, (double)order);
    last = error;
  }
  CHECK(order > least, "order %g", (double)order);
}

static void test_2d(void **state)
{
  (void)state;
  convergence("fem", CELL_QUADRILATERAL, 4, 4, 1.9);
  convergence("fem", CELL_TRIANGLE, 4, 4, 1.9);
  convergence("mpm", CELL_QUADRILATERAL, 4, 4, 1.9);
  convergence("mpm", CELL_TRIANGLE, 4, 4, 1.9);
}

static void test_3d(void **state)
{
  (void)state;
  convergence("fem", CELL_HEXAHEDRON, 2, 3, 1.9);
  /* 1.70, 1.89, ... : sixteen tetrahedra a side are still coarse */
  convergence("fem", CELL_TETRAHEDRON, 4, 3, 1.87);
  convergence("mpm", CELL_HEXAHEDRON, 2, 3, 1.9);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_2d), cmocka_unit_test(test_3d)};
  return run_model_tests(argc, argv, tests);
}
