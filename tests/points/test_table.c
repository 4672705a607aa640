/* The table of points: growth, order, compaction; every field goes along. */
#include "points_test.h"
#include "points/fields.h"

/* Every number of a point follows from its id. */
static PetscReal content(PetscInt64 id, PetscInt field, PetscInt component)
{
  return pseudo_random(1000 * id + 20 * field + component);
}

static void fill(Points *points, PetscInt p, PetscInt64 id)
{
  points->id[p] = id;
  points->body[p] = (PetscInt)(id % 5);
  points->material[p] = (PetscInt)(id % 3);
  for (int f = 0; f < POINT_N_REAL; ++f)
    for (PetscInt k = 0; k < points->components[f]; ++k) point_real(points, (PointReal)f, p)[k] = content(id, f, k);
}

static void check_content(const Points *points)
{
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscInt64 id = points->id[p];
    CHECK(points->body[p] == id % 5 && points->material[p] == id % 3);
    for (int f = 0; f < POINT_N_REAL; ++f)
      for (PetscInt k = 0; k < points->components[f]; ++k)
        CHECK(point_real(points, (PointReal)f, p)[k] == content(id, f, k));
  }
}

static Points *filled_points(PetscInt dim, PetscInt n_state, PetscInt n_force, PetscInt n)
{
  Points *points = NULL;
  CALL(PointsCreate(dim, n_state, n_force, &points));
  for (PetscInt k = 0; k < n; ++k) {
    PetscInt p = -1;
    CALL(PointsAppend(points, &p));
    CHECK(p == k);
    fill(points, p, k);
  }
  return points;
}

static void new_point_is_at_rest(void **state)
{
  (void)state;
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    Points *points = NULL;
    PetscReal F[9];
    PetscInt p;
    CALL(PointsCreate(dim, 4, dim, &points));
    CHECK(points->components[POINT_F] == (dim == 3 ? 9 : 5) && points->components[POINT_STATE] == 4);
    CALL(PointsAppend(points, &p));
    point_F(points, p, F);
    for (int i = 0; i < 9; ++i) CHECK(F[i] == (i % 4 == 0 ? 1.0 : 0.0));
    CHECK(points->cell[p] == -1 && points->id[p] == 0);
    for (int f = 0; f < POINT_N_REAL; ++f)
      for (PetscInt k = 0; k < points->components[f] && f != POINT_F; ++k)
        CHECK(point_real(points, (PointReal)f, p)[k] == (f == POINT_J ? 1 : 0));
    CALL(PointsDestroy(&points));
    CHECK(points == NULL);
  }
}

static void growth_keeps_points(void **state)
{
  (void)state;
  Points *points = filled_points(2, 3, 0, 1000);
  CHECK(points->n == 1000 && points->capacity >= 1000 && points->capacity < 2000);
  check_content(points);
  CALL(PointsReserve(points, 5000));
  CHECK(points->capacity == 5000);
  CALL(PointsReserve(points, 10));
  CHECK(points->capacity == 5000);
  check_content(points);
  CALL(PointsDestroy(&points));
}

static void set_F_reads_back(void **state)
{
  const PetscReal F[9] = {1.1, 0.2, 0, 0.3, 0.9, 0, 0, 0, 1.05};
  PetscReal again[9];
  (void)state;
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    Points *points = filled_points(dim, 0, 0, 3);
    point_set_F(points, 1, F);
    point_F(points, 1, again);
    for (int i = 0; i < 9; ++i) CHECK(F[i] == again[i]);
    CALL(PointsDestroy(&points));
  }
}

static void compaction_keeps_order(void **state)
{
  (void)state;
  Points *points = filled_points(3, 7, 3, 500);
  PetscBool drop[500];
  PetscInt kept = 0;
  for (PetscInt p = 0; p < 500; ++p) drop[p] = pseudo_random(p) < 0.3;
  for (PetscInt p = 0; p < 500; ++p) kept += !drop[p];
  CALL(PointsCompact(points, drop));
  CHECK(points->n == kept);
  for (PetscInt p = 1; p < points->n; ++p) CHECK(points->id[p] > points->id[p - 1]);
  for (PetscInt p = 0; p < points->n; ++p) CHECK(!drop[points->id[p]]);
  check_content(points);
  for (PetscInt p = 0; p < 500; ++p) drop[p] = PETSC_TRUE;
  CALL(PointsCompact(points, drop));
  CHECK(points->n == 0);
  CALL(PointsDestroy(&points));
}

static void check_order(const Points *points)
{
  for (PetscInt p = 1; p < points->n; ++p) {
    const PetscInt q = p - 1, a = points->cell[q] < 0 ? PETSC_MAX_INT : points->cell[q],
                   b = points->cell[p] < 0 ? PETSC_MAX_INT : points->cell[p];
    CHECK(a <= b);
    if (a == b) CHECK(points->material[q] <= points->material[p]);
    if (a == b && points->material[q] == points->material[p]) CHECK(points->id[q] < points->id[p]);
  }
}

/* Few cells (long runs), many cells (most of them empty), and some points lost, which stand
 * last. */
static void sort_orders_all_fields(void **state)
{
  (void)state;
  for (PetscInt n_cells = 4; n_cells <= 40000; n_cells *= 100) {
    Points *points = filled_points(2, 3, 2, 3000);
    for (PetscInt p = 0; p < points->n; ++p) {
      const PetscReal r = pseudo_random(77 + p);
      points->cell[p] = r < 0.01 ? -1 : (PetscInt)(r * (PetscReal)n_cells);
    }
    CALL(PointsSort(points));
    CHECK(points->n == 3000 && points->cell[0] >= 0 && points->cell[2999] == -1);
    check_order(points);
    check_content(points);
    check_ids_unique(points);
    points->cell[1500] = 0;
    CALL(PointsSort(points));
    check_order(points);
    check_content(points);
    CALL(PointsDestroy(&points));
  }
}

static void empty_table_is_harmless(void **state)
{
  (void)state;
  Points *points = filled_points(2, 0, 0, 0);
  CALL(PointsSort(points));
  CALL(PointsCompact(points, NULL));
  CALL(PointsReserve(points, 0));
  CHECK(points->n == 0);
  CALL(PointsDestroy(&points));
  CALL(PointsDestroy(&points));
}

static void packing_moves_points(void **state)
{
  (void)state;
  Points *from = filled_points(3, 5, 0, 100), *to = filled_points(3, 5, 0, 7);
  const PetscInt index[4] = {99, 3, 50, 4};
  char *buffer;
  CALL(PetscMalloc1(4 * points_bytes(from), &buffer));
  points_pack(from, 4, index, buffer);
  CALL(PointsUnpack(to, 4, buffer));
  CHECK(to->n == 11);
  for (int k = 0; k < 4; ++k) CHECK(to->id[7 + k] == index[k]);
  check_content(to);
  CALL(PetscFree(buffer));
  CALL(PointsDestroy(&from));
  CALL(PointsDestroy(&to));
}

/* Storage of a 2D point with a law without state; 48 bytes of it are J, stress and work. */
static void point_is_small(void **state)
{
  (void)state;
  Points *points = filled_points(2, 0, 0, 1);
  CHECK(points_bytes(points) <= 208);
  CALL(PointsDestroy(&points));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(new_point_is_at_rest),   cmocka_unit_test(growth_keeps_points),
    cmocka_unit_test(set_F_reads_back),       cmocka_unit_test(compaction_keeps_order),
    cmocka_unit_test(sort_orders_all_fields), cmocka_unit_test(empty_table_is_harmless),
    cmocka_unit_test(packing_moves_points),   cmocka_unit_test(point_is_small),
  };
  return run_point_tests(argc, argv, tests, sizeof tests / sizeof *tests);
}
