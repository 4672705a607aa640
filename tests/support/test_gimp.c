/* Bases of a box that are products along its axes, gimp and bspline: sums, linear fields, gradients, continuity
 * across cells, between splines, and from a domain that lies within a cell to one that does not. */
#include "../conformance/basis_suite.h"
#include "../points/points_test.h"
#include "support/basis.h"

/* A box of 5 x 4 (x 3) cells, graded for gimp, and one point in it with a domain. */
typedef struct {
  const char *basis;
  Grid *grid;
  PetscReal half[3];
  PetscBool hoop;
  const unsigned char *rim;
} OnePoint;

static const char *const names[] = {"gimp", "bspline"};

static Grid *small_box(PetscInt dim, const char *basis)
{
  TestCase *t = test_case(dim == 2 ? CELL_QUADRILATERAL : CELL_HEXAHEDRON, 5, 4, 3);
  if (!strcmp(basis, "gimp")) t->c.grid.grading[0] = 3;
  Grid *grid = make_grid(PETSC_COMM_SELF, &t->c);
  CALL(PetscFree(t));
  return grid;
}

static PetscBool evaluate(const void *context, const PetscReal *x, PetscReal *N, PetscReal *dN)
{
  const OnePoint *one = context;
  const Grid *grid = one->grid;
  const PetscInt dim = grid->dim;
  Points *points;
  Support *s;
  PetscInt p;
  CALL(PointsCreate(dim, 0, 0, &points));
  points->components[POINT_DOMAIN] = dim;
  CALL(PointsAppend(points, &p));
  for (PetscInt d = 0; d < dim; ++d) {
    point_real(points, POINT_X, p)[d] = x[d];
    point_real(points, POINT_DOMAIN, p)[d] = one->half[d];
  }
  points->cell[p] = grid_locate(grid, x, -1, point_real(points, POINT_XI, p));
  CALL(SupportCreate(&s));
  CALL(basis_find(one->basis)->support(&(BasisInput){.grid = grid, .hoop = one->hoop, .rim = one->rim}, points, s));
  for (PetscInt i = 0; i < grid->n_nodes * dim; ++i) dN[i] = N[i / dim] = 0;
  for (PetscInt I = 0; I < support_nodes(s, 0); ++I) {
    CHECK(I == 0 || s->node[I] > s->node[I - 1]);
    N[s->node[I]] = s->N[I];
    for (PetscInt d = 0; d < dim; ++d) dN[dim * s->node[I] + d] = s->dN[dim * I + d];
  }
  CALL(SupportDestroy(&s));
  CALL(PointsDestroy(&points));
  return PETSC_TRUE;
}

/* In cells, on lines, beside them, at edges and corners; domains small and as large as they get. */
static void suite_of(const char *basis, const unsigned char *rim)
{
  static const PetscReal part[][3] = {{0.31, 0.42, 0.63}, {0.45, 0.5, 0.34},  {0.21, 0.26, 0.66},
                                      {0.02, 0.97, 0.01}, {0.99, 0.04, 0.45}, {0.74, 0.74, 0.3}};
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (int k = 0; k < 3; ++k) {
      OnePoint one = {.basis = basis, .grid = small_box(dim, basis), .rim = rim};
      PetscReal sample[18];
      for (PetscInt d = 0; d < dim; ++d) {
        const PetscReal length = one.grid->max[d] - one.grid->min[d];
        one.half[d] = one.grid->smallest * (k == 0 ? 0.11 : k == 1 ? 0.25 : 0.5);
        for (int s = 0; s < 6; ++s) sample[s * dim + d] = one.grid->min[d] + part[s][d] * length;
      }
      const BasisUnderTest test = {.name = basis,
                                   .dim = dim,
                                   .nodes = one.grid->n_nodes,
                                   .x = one.grid->x,
                                   .n_samples = 6,
                                   .sample = sample,
                                   .size = one.grid->smallest,
                                   .tolerance = 2e-13,
                                   .difference = 1e-9,
                                   .evaluate = evaluate,
                                   .context = &one};
      basis_suite_run(&test);
      CALL(GridDestroy(&one.grid));
    }
}

/* Splines end at a line of held nodes inside, too. */
static void suite(void **state)
{
  unsigned char rim[120] = {0};
  (void)state;
  for (int b = 0; b < 2; ++b) suite_of(names[b], NULL);
  for (int i = 2; i < 120; i += 6) rim[i] = 1;
  suite_of("bspline", rim);
}

/* Along a line through the whole box neither N nor dN jumps: from one of many small steps to the next
 * a slope changes by no more than its own largest slope 1 / (2 l h) times the step. */
static void continuity_of(const char *basis)
{
  enum { STEPS = 4000, MOST = 64 };
  OnePoint one = {.basis = basis, .grid = small_box(2, basis)};
  const Grid *grid = one.grid;
  const PetscReal h = grid->smallest, step = (grid->max[0] - grid->min[0]) / STEPS;
  PetscReal N[2][MOST], dN[2][2 * MOST];
  one.half[0] = one.half[1] = 0.2 * h;
  for (int i = 0; i <= STEPS; ++i) {
    const PetscReal x[2] = {grid->min[0] + step * (PetscReal)i, grid->min[1] + 0.3 * (grid->max[1] - grid->min[1])};
    const int now = i % 2, before = !now;
    (void)evaluate(&one, x, N[now], dN[now]);
    for (PetscInt I = 0; i && I < grid->n_nodes; ++I) {
      CHECK(PetscAbsReal(N[now][I] - N[before][I]) <= 1.001 * step / h);
      CHECK(PetscAbsReal(dN[now][2 * I] - dN[before][2 * I]) <= 1.001 * step / (0.2 * h * h));
    }
  }
  CALL(GridDestroy(&one.grid));
}

static void continuity(void **state)
{
  (void)state;
  for (int b = 0; b < 2; ++b) continuity_of(names[b]);
}

/* Splines at a place are those of the largest domain of gimp where cells are equal. On a line of held nodes, and only
 * there, functions of all others vanish. */
static void splines(void **state)
{
  OnePoint one = {.basis = "bspline", .grid = small_box(2, "bspline")}, other = {.basis = "gimp", .grid = one.grid};
  const Grid *grid = one.grid;
  const PetscReal h[2] = {(grid->max[0] - grid->min[0]) / 5, (grid->max[1] - grid->min[1]) / 4};
  unsigned char rim[32] = {0};
  PetscReal N[2][30], dN[2][60];
  (void)state;
  for (int d = 0; d < 2; ++d) other.half[d] = 0.5 * h[d];
  for (int k = 0; k < 50; ++k) {
    const PetscReal x[2] = {grid->min[0] + (0.0137 + 0.0973 * k) * h[0], grid->min[1] + (0.0211 + 0.0713 * k) * h[1]};
    (void)evaluate(&one, x, N[0], dN[0]);
    (void)evaluate(&other, x, N[1], dN[1]);
    for (int i = 0; i < 30; ++i) CHECK_CLOSE(N[0][i], N[1][i], 1e-13);
    for (int i = 0; i < 60; ++i) CHECK_CLOSE(dN[0][i] * h[i % 2], dN[1][i] * h[i % 2], 1e-12);
  }
  for (PetscInt i = 0; i < 30; ++i) rim[i] = PetscAbsReal(grid->x[2 * i] - grid->min[0] - 2 * h[0]) < 1e-9;
  one.rim = rim;
  for (int k = 0; k < 2; ++k) {
    const PetscReal x[2] = {grid->min[0] + (2 + k) * h[0], grid->min[1] + 1.7 * h[1]};
    PetscReal others = 0;
    (void)evaluate(&one, x, N[0], dN[0]);
    for (PetscInt i = 0; i < grid->n_nodes; ++i) others += PetscAbsReal(grid->x[2 * i] - x[0]) > 1e-9 ? N[0][i] : 0;
    CHECK_CLOSE(others, k ? 0.25 : 0, 1e-13);
  }
  CALL(GridDestroy(&one.grid));
}

/* Slopes of means are what splines change by over the domain, so that sums over domains side by side are integrals,
 * wherever knots lie, and lines at which splines end. */
static void means(void **state)
{
  enum { AROUND = 30 };
  OnePoint one = {.basis = "bspline", .grid = small_box(2, "bspline")}, place = {.basis = "bspline", .grid = one.grid};
  const Grid *grid = one.grid;
  const PetscReal h = (grid->max[0] - grid->min[0]) / 5, y = grid->min[1] + 0.37 * (grid->max[1] - grid->min[1]);
  unsigned char rim[AROUND + 2] = {0};
  PetscReal N[3][AROUND], dN[3][2 * AROUND];
  (void)state;
  for (PetscInt i = 0; i < AROUND; ++i) rim[i] = PetscAbsReal(grid->x[2 * i] - grid->min[0] - 2 * h) < 1e-9;
  one.rim = place.rim = rim;
  for (int k = 0; k < 60; ++k) {
    const PetscReal l = (0.13 + 0.05 * (k % 5)) * h, x = grid->min[0] + l + 0.999 * (5 * h - 2 * l) * k / 60;
    one.half[0] = l;
    (void)evaluate(&one, (PetscReal[]){x, y}, N[0], dN[0]);
    (void)evaluate(&place, (PetscReal[]){x - l, y}, N[1], dN[1]);
    (void)evaluate(&place, (PetscReal[]){x + l, y}, N[2], dN[2]);
    for (int i = 0; i < AROUND; ++i) CHECK_CLOSE(dN[0][2 * i] * h, (N[2][i] - N[1][i]) * h / (2 * l), 1e-12);
  }
  CALL(GridDestroy(&one.grid));
}

/* Over a ring the mean of r dN counts: in cells of 1 m, a point at r = 2.1 with l = 0.25 has the kink
 * of node 2 at s = 0.1, so that to -(l - s) / (2 l h) of node 1 comes (l^2 - s^2) / (4 l h r). */
static void ring(void **state)
{
  TestCase *t = test_case(CELL_QUADRILATERAL, 4, 4, 1);
  for (int d = 0; d < 2; ++d) t->c.grid.min[d] = 0, t->c.grid.max[d] = 4;
  OnePoint one = {.basis = "gimp", .grid = make_grid(PETSC_COMM_SELF, &t->c), .half = {0.25, 0.25}, .hoop = PETSC_TRUE};
  PetscReal N[25], dN[50], slope = 0;
  (void)state;
  (void)evaluate(&one, (PetscReal[]){2.1, 1.5}, N, dN);
  for (PetscInt i = 0; i < 25; ++i) slope += one.grid->x[2 * i] == 1 ? dN[2 * i] : 0;
  CHECK_CLOSE(slope, -0.15 / 0.5 + (0.0625 - 0.01) / 2.1, 1e-14);
  one.basis = "bspline"; /* -(1/2 - s) / h and N'' l^2 / (3 r) */
  slope = 0;
  (void)evaluate(&one, (PetscReal[]){2.1, 1.5}, N, dN);
  for (PetscInt i = 0; i < 25; ++i) slope += one.grid->x[2 * i] == 1 ? dN[2 * i] : 0;
  CHECK_CLOSE(slope, -0.4 + 0.0625 / 6.3, 1e-14);
  CALL(GridDestroy(&one.grid));
  CALL(PetscFree(t));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(suite), cmocka_unit_test(continuity), cmocka_unit_test(ring),
                                     cmocka_unit_test(splines), cmocka_unit_test(means)};
  return run_point_tests(argc, argv, tests, sizeof tests / sizeof *tests);
}
