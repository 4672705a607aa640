/* The projection that holds pressures inside a cell of a ring, against a quadrature that is exact
 * for it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "basis/cell.h"
#include "formulation/kernels/mixed_kernels.h"

/* P of a cell by its points: mean of (N_I - mean)(N_J - mean) in the ring's volume. */
static void by_points(CellType type, PetscInt n_points, const PetscReal *x, PetscReal *P)
{
  const int nn = cells[type].nodes;
  PetscReal xi[16 * 2], weight[16], N[16][CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], mean[CELL_MAX_NODES] = {0}, sum = 0;
  assert_true(cell_quadrature(type, n_points, xi, weight));
  for (PetscInt p = 0; p < n_points; ++p) {
    PetscReal r = 0;
    weight[p] *= cell_gradients(type, x, xi + 2 * p, N[p], dN);
    for (int I = 0; I < nn; ++I) r += N[p][I] * x[2 * I];
    weight[p] *= r;
    sum += weight[p];
    for (int I = 0; I < nn; ++I) mean[I] += weight[p] * N[p][I];
  }
  for (int I = 0; I < nn; ++I)
    for (int J = 0; J < nn; ++J) {
      P[I * nn + J] = 0;
      for (PetscInt p = 0; p < n_points; ++p)
        P[I * nn + J] += weight[p] * (N[p][I] - mean[I] / sum) * (N[p][J] - mean[J] / sum) / sum;
    }
}

static void check_cell(CellType type, const PetscReal *x)
{
  const int nn = cells[type].nodes;
  PetscReal P[CELL_MAX_NODES * CELL_MAX_NODES], expected[CELL_MAX_NODES * CELL_MAX_NODES], radius[CELL_MAX_NODES];
  for (int I = 0; I < nn; ++I) radius[I] = x[2 * I];
  ring_projection(nn, radius, P);
  by_points(type, type == CELL_TRIANGLE ? 12 : 9, x, expected);
  for (int I = 0; I < nn; ++I) {
    PetscReal sum = 0;
    for (int J = 0; J < nn; ++J) {
      assert_true(PetscAbsReal(P[I * nn + J] - expected[I * nn + J]) < 1e-14);
      sum += P[I * nn + J];
    }
    assert_true(PetscAbsReal(sum) < PETSC_MACHINE_EPSILON); /* none for a uniform pressure */
  }
}

/* At the axis and far from it; parallelograms, where the reference cell's integral is exact. */
static void test_cells(void **state)
{
  (void)state;
  check_cell(CELL_TRIANGLE, (const PetscReal[]){0, 0, 0.5, 0.1, 0.2, 0.7});
  check_cell(CELL_TRIANGLE, (const PetscReal[]){0, 0, 0.5, 0.1, 0, 0.7});
  check_cell(CELL_TRIANGLE, (const PetscReal[]){7.3, -1, 8, 0.1, 6.9, 0.7});
  check_cell(CELL_QUADRILATERAL, (const PetscReal[]){0, 0, 0.5, 0, 0.5, 0.3, 0, 0.3});
  check_cell(CELL_QUADRILATERAL, (const PetscReal[]){3, 0, 3.5, 0.2, 3.75, 0.6, 3.25, 0.4});
}

/* Far from the axis it is that of the plane. */
static void test_far(void **state)
{
  (void)state;
  for (int nn = 3; nn <= 4; ++nn) {
    const PetscReal radius[4] = {1e9, 1e9, 1e9, 1e9};
    PetscReal P[CELL_MAX_NODES * CELL_MAX_NODES];
    ring_projection(nn, radius, P);
    for (int I = 0; I < nn; ++I)
      for (int J = 0; J < nn; ++J) assert_true(PetscAbsReal(P[I * nn + J] - projection_entry(2, nn, I, J)) < 1e-15);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_cells), cmocka_unit_test(test_far)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
