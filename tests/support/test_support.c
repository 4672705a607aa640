/* Support from cells: partition of unity, sum of x dN = I, groups that cover the points; on every
 * cell type, distorted too. */
#include "../points/points_test.h"
#include "support/basis.h"
#include "support/cloud.h"

/* Move the inner nodes, so that no Jacobian is constant. A function of the place alone: ghosts move
 * as their owners do. */
static void distort(Grid *grid)
{
  for (PetscInt n = 0; n < grid->n_nodes; ++n) {
    PetscReal *x = grid->x + n * grid->dim, y[3];
    for (PetscInt d = 0; d < grid->dim; ++d)
      y[d] = x[d] + 0.04 * sin(3 * x[(d + 1) % grid->dim] + (double)d) * cos(2 * x[d]);
    for (PetscInt d = 0; d < grid->dim; ++d) x[d] = y[d];
  }
}

static void check_point(const Grid *grid, const PetscInt *node, const PetscReal *N, const PetscReal *dN,
                        const PetscReal *x)
{
  const PetscInt dim = grid->dim, nn = grid->nodes_per_cell;
  PetscReal one = 0, place[3] = {0}, zero[3] = {0}, identity[9] = {0};
  for (PetscInt i = 0; i < nn; ++i) {
    const PetscReal *xn = grid->x + node[i] * dim;
    one += N[i];
    for (PetscInt a = 0; a < dim; ++a) {
      place[a] += N[i] * xn[a];
      zero[a] += dN[i * dim + a];
      for (PetscInt b = 0; b < dim; ++b) identity[3 * a + b] += xn[a] * dN[i * dim + b];
    }
  }
  CHECK_CLOSE(one, 1, 1e-14);
  for (PetscInt a = 0; a < dim; ++a) {
    CHECK_CLOSE(zero[a], 0, 1e-12);
    if (x) CHECK_CLOSE(place[a], x[a], 1e-13);
    for (PetscInt b = 0; b < dim; ++b) CHECK_CLOSE(identity[3 * a + b], a == b ? 1.0 : 0.0, 1e-12);
  }
}

static void check_support(const Support *s, const Points *points, const Grid *grid, PetscBool at_x)
{
  const PetscInt nn = grid->nodes_per_cell, dim = grid->dim;
  CHECK(s->n_runs == 1 && s->run[0].nodes == nn && s->point_start[0] == 0 && s->node_start[0] == 0 &&
        s->value_start[0] == 0);
  for (PetscInt g = 0; g < s->n_groups; ++g) {
    const PetscInt cell = points->cell[s->point_start[g]], *node = s->node + s->node_start[g];
    CHECK(g == 0 || points->cell[s->point_start[g] - 1] < cell);
    CHECK(s->node_start[g + 1] - s->node_start[g] == nn);
    for (PetscInt i = 0; i < nn; ++i) CHECK(node[i] == grid->cell_node[cell * nn + i]);
    for (PetscInt p = s->point_start[g]; p < s->point_start[g + 1]; ++p) {
      const PetscInt value = s->value_start[g] + (p - s->point_start[g]) * nn;
      CHECK(points->cell[p] == cell);
      check_point(grid, node, s->N + value, s->dN + dim * value, at_x ? point_real(points, POINT_X, p) : NULL);
    }
    CHECK(s->value_start[g + 1] - s->value_start[g] == nn * (s->point_start[g + 1] - s->point_start[g]));
  }
}

static void every_cell_type(void **state)
{
  (void)state;
  for (int type = 0; type < 4; ++type) {
    TestCase *t = test_case((CellType)type, 5, 4, 3);
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    Points *points = seed_points(t, grid);
    Support *s = NULL;
    CALL(SupportCreate(&s));
    for (int repeat = 0; repeat < 2; ++repeat) {
      CALL(basis_find("cell")->support(&(BasisInput){.grid = grid}, points, s));
      CHECK(s->n_groups == grid->n_cells && s->point_start[s->n_groups] == points->n);
      check_support(s, points, grid, repeat == 0);
      distort(grid);
    }
    CALL(SupportDestroy(&s));
    CHECK(s == NULL);
    CALL(PointsDestroy(&points));
    CALL(GridDestroy(&grid));
    CALL(PetscFree(t));
  }
}

/* More and fewer points than before, lost ones, and none. */
static void arrays_are_reused(void **state)
{
  (void)state;
  TestCase *t = test_case(CELL_QUADRILATERAL, 10, 10, 1);
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = seed_points(t, grid);
  Support *s = NULL;
  CALL(SupportCreate(&s));
  CALL(basis_find("cell")->support(&(BasisInput){.grid = grid}, points, s));
  const PetscReal *N = s->N;
  const PetscInt n = points->n;
  for (PetscInt p = 0; p < n; p += 3) points->cell[p] = -1;
  CALL(PointsSort(points));
  CALL(basis_find("cell")->support(&(BasisInput){.grid = grid}, points, s));
  CHECK(s->N == N && s->point_start[s->n_groups] == n - (n + 2) / 3);
  check_support(s, points, grid, PETSC_TRUE);
  points->n = 0;
  CALL(basis_find("cell")->support(&(BasisInput){.grid = grid}, points, s));
  CHECK(s->n_groups == 0 && s->point_start[0] == 0);
  CALL(SupportDestroy(&s));
  CALL(SupportCreate(&s));
  CALL(basis_find("cell")->support(&(BasisInput){.grid = grid}, points, s));
  CHECK(s->n_groups == 0 && s->point_start[0] == 0);
  CALL(SupportDestroy(&s));
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  CALL(PetscFree(t));
}

/* Clouds turn with the material: a lattice drawn out so far that only its stretch tells that its
 * nodes are neighbours still has the same cloud when it is turned, with its F. */
static void clouds_turn_with_the_material(void **state)
{
  const CloudRule rule = {.basis = {.kind = CLOUD_LME, .gamma = 1.8}, .support = support_default_lme, .h = 1};
  PetscInt n[2][2]; /* with F and without, by angle */
  (void)state;
  for (int turned = 0; turned < 2; ++turned) {
    const PetscReal c = turned ? 0 : 1, s = turned ? 1 : 0, stretch = 2.4;
    const PetscReal F[9] = {c * stretch, -s, 0, s * stretch, c, 0, 0, 0, 1};
    PetscReal X[2 * 81], N[CLOUD_MAX_NODES], dN[3 * CLOUD_MAX_NODES];
    PetscInt node[CLOUD_MAX_NODES];
    CloudTally tally = {0};
    Neighbours nodes;
    for (int k = 0; k < 81; ++k) {
      const PetscReal x = stretch * (k % 9 - 4), y = k / 9 - 4;
      X[2 * k] = c * x - s * y;
      X[2 * k + 1] = s * x + c * y;
    }
    CALL(NeighboursCreate(2, 81, X, 0, NULL, NULL, 1, &nodes));
    const PetscReal x = 0.3, y = 0.4, at[2] = {c * x - s * y, s * x + c * y};
    n[turned][0] = cloud_at(&nodes, &rule, at, F, NULL, node, N, dN, &tally);
    n[turned][1] = cloud_at(&nodes, &rule, at, NULL, NULL, node, N, dN, &tally);
    CALL(NeighboursDestroy(&nodes));
  }
  CHECK(n[0][0] == n[1][0] && n[0][1] == n[1][1]);
  CHECK(n[0][0] != n[0][1]);
}

/* Clouds that follow the material: of a lattice that is drawn out and turned they are those of the lattice with
 * spacings of 1.2 along the pull, whatever its stretch up to three, with gradients by the map. */
static void clouds_follow_the_stretch(void **state)
{
  CloudRule rule = {
    .basis = {.kind = CLOUD_LME, .gamma = 1.8}, .support = support_default_lme, .h = 1, .follows = PETSC_TRUE};
  const PetscReal c = 0, s = 1, stretch[] = {1.2, 2, 2.5}; /* whose squares are sixteenths */
  PetscReal N[3][CLOUD_MAX_NODES], dN[3][2 * CLOUD_MAX_NODES];
  PetscInt n[3], node[3][CLOUD_MAX_NODES];
  (void)state;
  for (int k = 0; k < 3; ++k) {
    const PetscReal F[9] = {c * stretch[k], -s, 0, s * stretch[k], c, 0, 0, 0, 3}, x = 0.3 * stretch[k], y = 0.4;
    PetscReal X[2 * 121];
    CloudTally tally = {0};
    Neighbours nodes;
    for (int i = 0; i < 121; ++i) {
      X[2 * i] = c * stretch[k] * (i % 11 - 5) - s * (i / 11 - 5);
      X[2 * i + 1] = s * stretch[k] * (i % 11 - 5) + c * (i / 11 - 5);
    }
    CALL(NeighboursCreate(2, 121, X, 0, NULL, NULL, 1, &nodes));
    const PetscReal at[2] = {c * x - s * y, s * x + c * y};
    n[k] = cloud_at(&nodes, &rule, at, F, NULL, node[k], N[k], dN[k], &tally);
    CALL(NeighboursDestroy(&nodes));
  }
  for (int k = 1; k < 3; ++k) {
    CHECK(n[k] == n[0] && n[0] > 8);
    for (PetscInt i = 0; i < n[0]; ++i) {
      const PetscReal *was = dN[0] + 2 * i, *is = dN[k] + 2 * i;
      CHECK(node[k][i] == node[0][i]);
      CHECK_CLOSE(N[k][i], N[0][i], 1e-12);
      CHECK_CLOSE(stretch[k] * (c * is[0] + s * is[1]), 1.2 * (c * was[0] + s * was[1]), 1e-12);
      CHECK_CLOSE(c * is[1] - s * is[0], c * was[1] - s * was[0], 1e-12);
    }
  }
}

/* A lattice that is sheared by whole spacings is the one that it was, in the plane and in space, and its cloud round;
 * one that is drawn out as well has the map of that alone. Points whose F is a little uneven have one map. */
static void clouds_see_the_lattice(void **state)
{
  static const struct {
    PetscInt dim;
    PetscReal F[9], longest;
  } cases[] = {
    {2, {1, 1, 0, 0, 1, 0, 0, 0, 1}, 1},
    {2, {1, -3, 0, 0, 1, 0, 0, 0, 3}, 1},
    {3, {1, 2, -1, 0, 1, 5, 0, 0, 1}, 1},
    {2, {2, 2, 0, 0, 1, 0, 0, 0, 1}, 2 / 1.2},
    {2, {2.001, -0.002, 0, 0.001, 0.999, 0, 0, 0, 1}, 2 / 1.2},
    {3, {1, 0, 1, 0, 1, 0, 0, 0, 3}, 3 / 1.2},
  };
  (void)state;
  for (int k = 0; k < 6; ++k) {
    NeighboursMap room;
    const NeighboursMap *map = cloud_stretch(cases[k].dim, cases[k].F, &room);
    CHECK_CLOSE(map ? map->longest : 1, cases[k].longest, 0.01);
  }
}

/* Nodes near by distances of a map are those that one by one are near, nearest first. */
static void neighbours_by_a_map(void **state)
{
  enum { MOST = 128 };
  const NeighboursMap map = {.map = {0.7, -0.2, 0.1, -0.2, 0.8, 0.05, 0.1, 0.05, 0.9}, .longest = 2.5};
  const PetscReal at[3] = {0.1, -0.2, 0.3}, radius[] = {1.4, 2.6};
  PetscReal X[3 * 1331], d2[MOST];
  PetscInt item[MOST];
  Neighbours nodes;
  (void)state;
  for (int i = 0; i < 1331; ++i) {
    X[3 * i] = i % 11 - 5;
    X[3 * i + 1] = i / 11 % 11 - 5;
    X[3 * i + 2] = i / 121 - 5;
  }
  CALL(NeighboursCreate(3, 1331, X, 0, NULL, NULL, 1.5, &nodes));
  for (int k = 0; k < 2; ++k) {
    PetscInt near = 0;
    const PetscInt n = neighbours_mapped(&nodes, &map, at, radius[k], MOST, item, d2);
    for (int i = 0; i < 1331; ++i) near += neighbours_square(3, &map, X + 3 * i, at) < radius[k] * radius[k];
    CHECK(n == PetscMin(near, MOST) && n > 8);
    for (PetscInt i = 0; i < n; ++i) {
      CHECK_CLOSE(d2[i], neighbours_square(3, &map, X + 3 * item[i], at), 1e-13);
      CHECK(i == 0 || d2[i] >= d2[i - 1]);
    }
  }
  CALL(NeighboursDestroy(&nodes));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(clouds_turn_with_the_material),
    cmocka_unit_test(clouds_follow_the_stretch),
    cmocka_unit_test(clouds_see_the_lattice),
    cmocka_unit_test(neighbours_by_a_map),
    cmocka_unit_test(every_cell_type),
    cmocka_unit_test(arrays_are_reused),
  };
  return run_point_tests(argc, argv, tests, sizeof tests / sizeof *tests);
}
