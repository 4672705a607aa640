/* Migration: points wander over all ranks and nothing of them is lost; what happens to those that
 * leave the grid. */
#include "points_test.h"

static const PetscReal size_of_grid[3] = {3, 2, 2};

static PetscReal wrapped(PetscReal x, PetscReal length) { return x < 0 ? x + length : x > length ? x - length : x; }

/* One step of a point: its velocity follows from its id; what leaves on one side comes in on the
 * other, far away. */
static void advect(PetscInt64 id, PetscInt dim, PetscReal *x)
{
  for (PetscInt d = 0; d < dim; ++d) x[d] = wrapped(x[d] + pseudo_random(3 * id + d) - 0.5, size_of_grid[d]);
}

/* Every field that migration must carry, as a function of the id. */
static void fill_fields(Points *points)
{
  static const PointReal fields[] = {POINT_U, POINT_V, POINT_A, POINT_MASS, POINT_VOLUME, POINT_F, POINT_STATE};
  for (PetscInt p = 0; p < points->n; ++p) {
    points->body[p] = (PetscInt)(points->id[p] % 7);
    for (size_t f = 0; f < sizeof fields / sizeof *fields; ++f)
      for (PetscInt k = 0; k < points->components[fields[f]]; ++k)
        point_real(points, fields[f], p)[k] = pseudo_random(500 + 1000 * points->id[p] + 10 * fields[f] + k);
  }
}

static void check_fields(const Points *points)
{
  static const PointReal fields[] = {POINT_U, POINT_V, POINT_A, POINT_MASS, POINT_VOLUME, POINT_F, POINT_STATE};
  for (PetscInt p = 0; p < points->n; ++p) {
    CHECK(points->body[p] == points->id[p] % 7);
    for (size_t f = 0; f < sizeof fields / sizeof *fields; ++f)
      for (PetscInt k = 0; k < points->components[fields[f]]; ++k)
        CHECK(point_real(points, fields[f], p)[k] == pseudo_random(500 + 1000 * points->id[p] + 10 * fields[f] + k));
  }
}

/* Where all points are, by id: followed on every rank without any migration. And which of them are
 * here. */
typedef struct {
  PetscInt dim, n, arrived;
  PetscReal *x;
  PetscBool *here;
} Track;

static void track_start(Track *track, const Points *points)
{
  PetscInt64 last = -1;
  for (PetscInt p = 0; p < points->n; ++p) last = PetscMax(last, points->id[p]);
  CALL(MPI_Allreduce(MPI_IN_PLACE, &last, 1, MPIU_INT64, MPI_MAX, PETSC_COMM_WORLD));
  track->dim = points->dim;
  track->n = (PetscInt)last + 1;
  track->arrived = 0;
  CALL(PetscCalloc1((size_t)(track->n * track->dim), &track->x));
  CALL(PetscCalloc1((size_t)track->n, &track->here));
  for (PetscInt p = 0; p < points->n; ++p) track->here[points->id[p]] = PETSC_TRUE;
  for (PetscInt p = 0; p < points->n; ++p)
    for (PetscInt d = 0; d < track->dim; ++d)
      track->x[points->id[p] * track->dim + d] = point_real(points, POINT_X, p)[d];
  CALL(MPI_Allreduce(MPI_IN_PLACE, track->x, (int)(track->n * track->dim), MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
}

static void check_track(Track *track, const Points *points)
{
  for (PetscInt p = 0; p < points->n; ++p) track->arrived += !track->here[points->id[p]];
  CALL(PetscArrayzero(track->here, track->n));
  for (PetscInt p = 0; p < points->n; ++p) track->here[points->id[p]] = PETSC_TRUE;
  for (PetscInt p = 0; p < points->n; ++p)
    for (PetscInt d = 0; d < track->dim; ++d)
      CHECK(point_real(points, POINT_X, p)[d] == track->x[points->id[p] * track->dim + d]);
}

static void move(Points *points, Track *track)
{
  for (PetscInt p = 0; p < points->n; ++p) advect(points->id[p], points->dim, point_real(points, POINT_X, p));
  for (PetscInt k = 0; k < track->n; ++k) advect(k, track->dim, track->x + k * track->dim);
}

static void wander(CellType type, PetscInt steps)
{
  TestCase *t = test_case(type, 6, 5, 4);
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = seed_points(t, grid);
  const PetscInt n = count_over_ranks(points->n);
  Track track;
  fill_fields(points);
  track_start(&track, points);
  for (PetscInt step = 0; step < steps; ++step) {
    PetscInt n_lost = -1;
    LostPoint *lost = NULL;
    move(points, &track);
    CALL(PointsRelocate(points, grid, OUTSIDE_STOP, &n_lost, &lost));
    CHECK(n_lost == 0 && lost == NULL);
    CHECK(count_over_ranks(points->n) == n);
    check_located(points, grid);
    check_track(&track, points);
    check_fields(points);
  }
  check_ids_unique(points);
  PetscMPIInt size;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  /* or the test would show nothing */
  CHECK(size == 1 ? track.arrived == 0 : count_over_ranks(track.arrived) > n);
  CALL(PetscFree(track.x));
  CALL(PetscFree(track.here));
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  CALL(PetscFree(t));
}

static void points_wander_quadrilaterals(void **state)
{
  (void)state;
  wander(CELL_QUADRILATERAL, 60);
}
static void points_wander_triangles(void **state)
{
  (void)state;
  wander(CELL_TRIANGLE, 60);
}
static void points_wander_tetrahedra(void **state)
{
  (void)state;
  wander(CELL_TETRAHEDRON, 12);
}
static void points_wander_hexahedra(void **state)
{
  (void)state;
  wander(CELL_HEXAHEDRON, 20);
}

/* Positions on faces, edges and nodes of cells, where several ranks might claim them: each has one
 * owner. */
static void shared_positions_have_one_owner(void **state)
{
  (void)state;
  for (int type = 0; type < 4; ++type) {
    TestCase *t = test_case((CellType)type, 6, 4, 4);
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    Points *points = seed_points(t, grid);
    PetscInt n_lost;
    LostPoint *lost;
    const PetscInt n = count_over_ranks(points->n);
    for (PetscInt p = 0; p < points->n; ++p) {
      PetscReal *x = point_real(points, POINT_X, p);
      for (PetscInt d = 0; d < grid->dim; ++d)
        x[d] = 0.5 * PetscFloorReal(2 * (x[d] + pseudo_random(points->id[p])) - 0.5);
      for (PetscInt d = 0; d < grid->dim; ++d) x[d] = PetscMax(0, PetscMin(x[d], size_of_grid[d]));
    }
    CALL(PointsRelocate(points, grid, OUTSIDE_STOP, &n_lost, &lost));
    CHECK(n_lost == 0 && count_over_ranks(points->n) == n);
    check_ids_unique(points);
    check_located(points, grid);
    CALL(PointsDestroy(&points));
    CALL(GridDestroy(&grid));
    CALL(PetscFree(t));
  }
}

/* One point in each cell of 3 x 2; the three of the lower row are thrown out at the right, below,
 * and through a corner. */
typedef struct {
  TestCase *t;
  Grid *grid;
  Points *points;
  PetscInt n_lost;
  LostPoint *lost;
} Throw;

static void throw_points(Throw *s, OutsidePolicy policy)
{
  static const PetscReal to[3][2] = {{3.5, 0.25}, {1.5, -2}, {4, -1}};
  s->t = test_case(CELL_QUADRILATERAL, 3, 2, 1);
  s->t->body[0].points_per_cell = 1;
  s->t->body[0].velocity[0] = 1;
  s->t->body[0].velocity[1] = -2;
  s->grid = make_grid(PETSC_COMM_WORLD, &s->t->c);
  s->points = seed_points(s->t, s->grid);
  for (PetscInt p = 0; p < s->points->n; ++p) {
    PetscReal *x = point_real(s->points, POINT_X, p), *u = point_real(s->points, POINT_U, p);
    const PetscInt64 k = s->points->id[p];
    for (PetscInt d = 0; d < 2 && k < 3; ++d) u[d] = to[k][d] - x[d], x[d] = to[k][d];
  }
  CALL(PointsRelocate(s->points, s->grid, policy, &s->n_lost, &s->lost));
}

static void pick_up(Throw *s)
{
  CALL(PetscFree(s->lost));
  CALL(PointsDestroy(&s->points));
  CALL(GridDestroy(&s->grid));
  CALL(PetscFree(s->t));
}

static void check_report(const Throw *s)
{
  CHECK(s->n_lost == 3);
  for (PetscInt k = 0; k < 3; ++k) {
    CHECK(s->lost[k].id == k && s->lost[k].last_cell == k);
    CHECK(s->lost[k].v[0] == 1 && s->lost[k].v[1] == -2);
  }
  CHECK(s->lost[0].x[0] == 3.5 && s->lost[1].x[1] == -2 && s->lost[2].x[0] == 4);
}

static void stop_keeps_and_reports(void **state)
{
  Throw s;
  PetscInt n_out = 0, n_lost;
  LostPoint *lost;
  (void)state;
  throw_points(&s, OUTSIDE_STOP);
  check_report(&s);
  for (PetscInt p = 0; p < s.points->n; ++p) n_out += s.points->cell[p] < 0;
  CHECK(count_over_ranks(n_out) == 3 && count_over_ranks(s.points->n) == 6);
  for (PetscInt p = s.points->n - n_out; p < s.points->n; ++p) CHECK(s.points->cell[p] == -1);
  CALL(PointsRelocate(s.points, s.grid, OUTSIDE_STOP, &n_lost, &lost));
  CHECK(n_lost == 3 && lost[0].last_cell == -1);
  CALL(PetscFree(lost));
  pick_up(&s);
}

static void remove_drops_and_reports(void **state)
{
  Throw s;
  (void)state;
  throw_points(&s, OUTSIDE_REMOVE);
  check_report(&s);
  CHECK(count_over_ranks(s.points->n) == 3);
  for (PetscInt p = 0; p < s.points->n; ++p) CHECK(s.points->id[p] >= 3);
  check_located(s.points, s.grid);
  pick_up(&s);
}

/* Back on the boundary, without the velocity outward; x - u still says where the point started. */
static void keep_clamps(void **state)
{
  static const PetscReal x[3][2] = {{3, 0.25}, {1.5, 0}, {3, 0}}, v[3][2] = {{0, -2}, {1, 0}, {0, 0}};
  Throw s;
  (void)state;
  throw_points(&s, OUTSIDE_KEEP);
  CHECK(s.n_lost == 0 && s.lost == NULL && count_over_ranks(s.points->n) == 6);
  check_located(s.points, s.grid);
  check_ids_unique(s.points);
  for (PetscInt p = 0; p < s.points->n; ++p) {
    const PetscInt64 k = s.points->id[p];
    for (PetscInt d = 0; d < 2 && k < 3; ++d) {
      const PetscReal start = d == 0 ? 0.5 + (PetscReal)k : 0.5;
      CHECK(point_real(s.points, POINT_V, p)[d] == v[k][d]);
      CHECK_CLOSE(point_real(s.points, POINT_X, p)[d], x[k][d], 1e-12);
      CHECK_CLOSE(point_real(s.points, POINT_X, p)[d] - point_real(s.points, POINT_U, p)[d], start, 1e-12);
    }
  }
  pick_up(&s);
}

/* Reported first, under every policy, and never dropped or moved. */
static void nan_is_lost_under_every_policy(void **state)
{
  const PetscReal bad[3] = {NAN, INFINITY, -INFINITY};
  (void)state;
  for (int policy = OUTSIDE_STOP; policy <= OUTSIDE_KEEP; ++policy) {
    TestCase *t = test_case(CELL_QUADRILATERAL, 4, 4, 1);
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    Points *points = seed_points(t, grid);
    PetscInt n_lost, bad_here = 0;
    LostPoint *lost;
    for (PetscInt p = 0; p < points->n; ++p) {
      if (points->id[p] == 5) point_real(points, POINT_X, p)[0] = 7;
      if (points->id[p] >= 20 && points->id[p] < 23) point_real(points, POINT_X, p)[1] = bad[points->id[p] - 20];
    }
    CALL(PointsRelocate(points, grid, (OutsidePolicy)policy, &n_lost, &lost));
    CHECK(n_lost == (policy == OUTSIDE_KEEP ? 3 : 4));
    for (int k = 0; k < 3; ++k)
      CHECK(lost[k].id == 20 + k && !PetscIsNormalReal(lost[k].x[1]) && lost[k].last_cell == 5);
    for (PetscInt p = 0; p < points->n; ++p) {
      if (points->id[p] < 20 || points->id[p] >= 23) continue;
      ++bad_here;
      CHECK(points->cell[p] == -1);
    }
    CHECK(count_over_ranks(bad_here) == 3);
    CHECK(count_over_ranks(points->n) == (policy == OUTSIDE_REMOVE ? 63 : 64));
    CALL(PetscFree(lost));
    CALL(PointsDestroy(&points));
    CALL(GridDestroy(&grid));
    CALL(PetscFree(t));
  }
}

/* More are lost than are described: the first sixteen ids, the same list on every rank. */
static void long_lists_are_cut(void **state)
{
  (void)state;
  TestCase *t = test_case(CELL_QUADRILATERAL, 8, 8, 1);
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = seed_points(t, grid);
  PetscInt n_lost;
  LostPoint *lost;
  for (PetscInt p = 0; p < points->n; ++p)
    if (points->id[p] % 3 == 0) point_real(points, POINT_X, p)[1] = 50;
  CALL(PointsRelocate(points, grid, OUTSIDE_STOP, &n_lost, &lost));
  CHECK(n_lost == 86);
  for (PetscInt k = 0; k < 16; ++k) CHECK(lost[k].id == 3 * k && lost[k].last_cell == 3 * k / 4);
  CALL(PetscFree(lost));
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  CALL(PetscFree(t));
}

/* All points in one corner: other ranks are empty, and stay in the game. */
static void ranks_may_be_empty(void **state)
{
  (void)state;
  TestCase *t = test_case(CELL_QUADRILATERAL, 8, 8, 1);
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = seed_points(t, grid);
  PetscInt n_lost;
  LostPoint *lost;
  const PetscInt n = count_over_ranks(points->n);
  for (int corner = 0; corner < 4; ++corner) {
    for (PetscInt p = 0; p < points->n; ++p) {
      PetscReal *x = point_real(points, POINT_X, p);
      x[0] = (corner & 1 ? 2.9 : 0) + 0.1 * pseudo_random(points->id[p]);
      x[1] = (corner & 2 ? 1.9 : 0) + 0.1 * pseudo_random(points->id[p] + 1);
    }
    CALL(PointsRelocate(points, grid, OUTSIDE_STOP, &n_lost, &lost));
    CHECK(n_lost == 0 && (points->n == 0 || points->n == n) && count_over_ranks(points->n) == n);
    check_located(points, grid);
  }
  check_ids_unique(points);
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  CALL(PetscFree(t));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(points_wander_quadrilaterals),
    cmocka_unit_test(points_wander_triangles),
    cmocka_unit_test(points_wander_tetrahedra),
    cmocka_unit_test(points_wander_hexahedra),
    cmocka_unit_test(shared_positions_have_one_owner),
    cmocka_unit_test(stop_keeps_and_reports),
    cmocka_unit_test(remove_drops_and_reports),
    cmocka_unit_test(keep_clamps),
    cmocka_unit_test(nan_is_lost_under_every_policy),
    cmocka_unit_test(long_lists_are_cut),
    cmocka_unit_test(ranks_may_be_empty),
  };
  return run_point_tests(argc, argv, tests, sizeof tests / sizeof *tests);
}
