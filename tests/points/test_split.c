/* Points that are split: what the two halves have together is what the whole had, they stand where the
 * deformation has put the halves of its domain, and only what is stretched is split, not what is sheared. */
#include "points_test.h"
#include "points/split.h"

#define H 0.5 /* m, side of a cell */

/* One point with a domain of half lengths L, and F; all else looks random. */
static Points *one(PetscInt dim, const PetscReal *L, const PetscReal F[9])
{
  Points *points = NULL;
  CALL(PointsCreate(dim, 2, 0, &points));
  points->components[POINT_DOMAIN] = dim;
  CALL(PointsAppend(points, NULL));
  for (int f = 0; f < POINT_N_REAL; ++f)
    for (PetscInt k = 0; k < points->components[f]; ++k)
      point_real(points, (PointReal)f, 0)[k] = 0.5 + pseudo_random(20 * f + k);
  point_set_F(points, 0, F);
  for (PetscInt d = 0; d < dim; ++d) point_real(points, POINT_DOMAIN, 0)[d] = L[d];
  points->cell[0] = 0;
  points->id[0] = 77;
  return points;
}

/* What becomes of material 0 and 1: it holds together, and it opens. */
static const PetscBool opens[2] = {PETSC_FALSE, PETSC_TRUE};

static PetscInt split(Points *points, const Grid *grid, PetscBool hoop, PetscReal most)
{
  const SplitRule rule = {.cells = most, .hoop = hoop, .opens = opens};
  PetscInt n;
  CALL(PointsSplit(points, grid, &rule, &n));
  return n;
}

/* Of all points, numbers that splitting must not change: mass, mass at places of now and of the start, momentum,
 * angular momentum, kinetic energy, volume at the start and now, work of the stress. */
enum {
  MASS,
  PLACE,
  START = PLACE + 3,
  MOMENTUM = START + 3,
  TURN = MOMENTUM + 3,
  KINETIC = TURN + 3,
  FIRST,
  NOW,
  WORK,
  N
};

static void add_vectors(const Points *points, PetscInt p, PetscReal *sum)
{
  const PetscReal *x = point_real(points, POINT_X, p), *v = point_real(points, POINT_V, p);
  const PetscReal *u = point_real(points, POINT_U, p), m = points->real[POINT_MASS][p];
  for (PetscInt d = 0; d < points->dim; ++d) {
    const PetscInt e = (d + 1) % points->dim;
    sum[PLACE + d] += m * x[d];
    sum[START + d] += m * (x[d] - u[d]);
    sum[MOMENTUM + d] += m * v[d];
    sum[TURN + d] += m * (x[d] * v[e] - x[e] * v[d]);
    sum[KINETIC] += 0.5 * m * v[d] * v[d];
  }
}

static void sums(const Points *points, PetscReal sum[N])
{
  for (int i = 0; i < N; ++i) sum[i] = 0;
  for (PetscInt p = 0; p < points->n; ++p) {
    add_vectors(points, p, sum);
    sum[MASS] += points->real[POINT_MASS][p];
    sum[FIRST] += points->real[POINT_VOLUME][p];
    sum[NOW] += points->real[POINT_VOLUME][p] * points->real[POINT_J][p];
    sum[WORK] += points->real[POINT_WORK][p];
  }
}

static const PetscReal stretched[2][9] = {
  {2.2, 0.3, 0, -0.2, 0.4, 0, 0, 0, 1},
  {2.2, 0.3, 0.1, -0.2, 0.5, 0.2, 0.1, -0.1, 0.6},
};

/* Twice, so that there are four quarters. */
static void whole_and_halves(void **state)
{
  (void)state;
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    TestCase *t = test_case(dim == 2 ? CELL_QUADRILATERAL : CELL_HEXAHEDRON, 6, 4, 4);
    Grid *grid = make_grid(PETSC_COMM_SELF, &t->c);
    const PetscReal L[3] = {0.25 * H, 0.25 * H, 0.25 * H};
    Points *points = one(dim, L, stretched[dim - 2]);
    PetscReal before[N], after[N];
    sums(points, before);
    for (int k = 1; k <= 2; ++k) {
      CHECK(split(points, grid, PETSC_FALSE, k == 1 ? 0.8 : 0.45) == k && points->n == 2 * k);
      sums(points, after);
      for (int i = 0; i < N; ++i) CHECK_CLOSE(after[i], before[i], 1e-14);
    }
    for (PetscInt p = 0; p < points->n; ++p)
      for (PetscInt q = 0; q < p; ++q) CHECK(points->id[p] != points->id[q]);
    for (PetscInt p = 0; p < points->n; ++p) CHECK(point_seed_id(points->id[p]) == 77);
    CALL(PointsDestroy(&points));
    CALL(GridDestroy(&grid));
    CALL(PetscFree(t));
  }
}

/* A half stands in the middle of its part of the domain, at the start and after x = F X. */
static void halves_stand_where_F_has_put_them(void **state)
{
  TestCase *t = test_case(CELL_QUADRILATERAL, 6, 4, 4);
  Grid *grid = make_grid(PETSC_COMM_SELF, &t->c);
  const PetscReal L[3] = {0.25 * H, 0.2 * H}, *F = stretched[0];
  Points *points = one(2, L, F);
  PetscReal x[2], X[2];
  (void)state;
  for (PetscInt d = 0; d < 2; ++d)
    x[d] = point_real(points, POINT_X, 0)[d], X[d] = x[d] - point_real(points, POINT_U, 0)[d];
  CHECK(split(points, grid, PETSC_FALSE, 0.8) == 1);
  for (PetscInt p = 0; p < 2; ++p) {
    const PetscReal off = (p ? 0.5 : -0.5) * L[0], *at = point_real(points, POINT_X, p);
    for (PetscInt d = 0; d < 2; ++d) {
      CHECK_CLOSE(at[d], x[d] + F[3 * d] * off, 1e-15);
      CHECK_CLOSE(at[d] - point_real(points, POINT_U, p)[d], X[d] + (d == 0 ? off : 0), 1e-15);
    }
    CHECK_CLOSE(point_real(points, POINT_DOMAIN, p)[0], 0.5 * L[0], 0);
    CHECK_CLOSE(point_real(points, POINT_DOMAIN, p)[1], L[1], 0);
  }
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  CALL(PetscFree(t));
}

/* Of a point of the plane with the usual domain of four points a cell: is it split? */
static PetscBool splits(PetscInt material, const PetscReal F[9], PetscReal most)
{
  TestCase *t = test_case(CELL_QUADRILATERAL, 6, 4, 4);
  Grid *grid = make_grid(PETSC_COMM_SELF, &t->c);
  Points *points = one(2, (PetscReal[]){0.25 * H, 0.25 * H}, F);
  points->material[0] = material;
  const PetscInt n = split(points, grid, PETSC_FALSE, most);
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  CALL(PetscFree(t));
  return n > 0;
}

/* Points half a cell apart, sheared by g: rows slide along each other, and each point meets another one at half a
 * cell whenever g is a whole number, at most 1.25^(1/2) halves between; stretch by s brings them to s / 2. */
static void stretch_splits_and_shear_does_not(void **state)
{
  (void)state;
  for (PetscReal g = 0; g < 12; g += 0.3) CHECK(!splits(0, (PetscReal[9]){1, g, 0, 0, 1, 0, 0, 0, 1}, 0.56));
  CHECK(splits(0, (PetscReal[9]){1, 0.5, 0, 0, 1, 0, 0, 0, 1}, 0.55));
  CHECK(!splits(0, (PetscReal[9]){1.49, 0, 0, 0, 0.7, 0, 0, 0, 1}, 0.75));
  CHECK(splits(0, (PetscReal[9]){1.51, 0, 0, 0, 0.7, 0, 0, 0, 1}, 0.75));
  CHECK(splits(0, (PetscReal[9]){1.6, 0, 0, 0, 1.6, 0, 0, 0, 1}, 0.75));  /* both ways alike */
  CHECK(!splits(1, (PetscReal[9]){1.6, 0, 0, 0, 1.6, 0, 0, 0, 1}, 0.75)); /* grains that are apart become no more */
}

/* What a ring keeps besides: its masses go with the radius at the start, F_tt is r / R. */
static void rings(void **state)
{
  TestCase *t = test_case(CELL_QUADRILATERAL, 6, 4, 4);
  Grid *grid = make_grid(PETSC_COMM_SELF, &t->c);
  const PetscReal r = 1.1, R = 0.8, L[2] = {0.25 * H, 0.25 * H}, F[9] = {2, 0, 0, 0, 0.4, 0, 0, 0, r / R};
  Points *points = one(2, L, F);
  PetscReal before[N], after[N], rate[2];
  (void)state;
  point_real(points, POINT_X, 0)[0] = r;
  point_real(points, POINT_U, 0)[0] = r - R;
  points->real[POINT_J][0] = F[0] * F[4] * F[8];
  sums(points, before);
  CHECK(split(points, grid, PETSC_TRUE, 0.8) == 1);
  sums(points, after);
  const int same[] = {MASS, MOMENTUM, MOMENTUM + 1, KINETIC, FIRST, NOW, WORK};
  for (int i = 0; i < 7; ++i) CHECK_CLOSE(after[same[i]], before[same[i]], 1e-14);
  for (PetscInt p = 0; p < 2; ++p) {
    PetscReal f[9];
    const PetscReal now = point_real(points, POINT_X, p)[0], start = now - point_real(points, POINT_U, p)[0];
    point_F(points, p, f);
    CHECK_CLOSE(start, R + (p ? 0.5 : -0.5) * L[0], 1e-15);
    CHECK_CLOSE(f[8], now / start, 1e-15);
    CHECK_CLOSE(points->real[POINT_J][p], F[0] * F[4] * f[8], 1e-15);
    rate[p] = points->real[POINT_MASS][p] / start;
  }
  CHECK_CLOSE(rate[0], rate[1], 1e-15);
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  CALL(PetscFree(t));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(whole_and_halves),
    cmocka_unit_test(halves_stand_where_F_has_put_them),
    cmocka_unit_test(stretch_splits_and_shear_does_not),
    cmocka_unit_test(rings),
  };
  return run_point_tests(argc, argv, tests, sizeof tests / sizeof *tests);
}
