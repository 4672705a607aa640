/* Seeding: volumes and masses to round-off, the same points on any number of ranks, mistakes that
 * are told. */
#include <string.h>
#include "points/seed/seed.h"
#include "points_test.h"

static const PetscReal area = 6, volume = 12; /* of the test grid */

static void free_all(TestCase *t, Grid *grid, Points *points)
{
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  CALL(PetscFree(t));
}

static void check_rule(TestCase *t, Grid *grid, PetscInt n, PointWeights weights)
{
  const PetscReal whole = grid->dim == 3 ? volume : area;
  t->body[0].points_per_cell = n;
  t->body[0].weights = weights;
  Points *points = seed_points(t, grid);
  CHECK(count_over_ranks(points->n) == n * grid->n_cells_global);
  CHECK_CLOSE(total(points, POINT_VOLUME), whole, 1e-12 * whole);
  CHECK_CLOSE(total(points, POINT_MASS), 1500 * whole, 1500e-12 * whole);
  check_ids_unique(points);
  check_located(points, grid);
  for (PetscInt p = 0; p < points->n; ++p) {
    CHECK(*point_real(points, POINT_VOLUME, p) > 0);
    CHECK(point_real(points, POINT_STATE, p)[0] == 0.25 && point_real(points, POINT_STATE, p)[1] == -7);
    if (weights == WEIGHTS_GAUSS) continue;
    CHECK_CLOSE(*point_real(points, POINT_VOLUME, p), whole / (PetscReal)(n * grid->n_cells_global), 1e-14);
  }
  CALL(PointsDestroy(&points));
}

static void every_rule_fills_the_volume(void **state)
{
  (void)state;
  for (int type = 0; type < 4; ++type) {
    TestCase *t = test_case((CellType)type, 4, 3, 2);
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    for (const PetscInt *n = cell_rules((CellType)type); *n; ++n) {
      check_rule(t, grid, *n, WEIGHTS_EQUAL);
      check_rule(t, grid, *n, WEIGHTS_GAUSS);
    }
    free_all(t, grid, NULL);
  }
}

/* 6 triangle points have two weights; mpm shares the mass equally, fem and gmm do not. */
static void method_chooses_the_weights(void **state)
{
  static char fem[] = "fem", mpm[] = "mpm", gmm[] = "gmm";
  char *const methods[3] = {fem, mpm, gmm};
  (void)state;
  for (int m = 0; m < 3; ++m) {
    TestCase *t = test_case(CELL_TRIANGLE, 3, 2, 1);
    t->body[0].points_per_cell = 6;
    t->c.method = methods[m];
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    Points *points = seed_points(t, grid);
    PetscReal spread = 0;
    for (PetscInt p = 0; p < points->n; ++p)
      spread = PetscMax(spread, PetscAbsReal(*point_real(points, POINT_VOLUME, p) - 0.5 / 6));
    if (m == 1) CHECK(spread < 1e-15);
    else CHECK(points->n == 0 || spread > 0.01);
    free_all(t, grid, points);
  }
}

static void grading_keeps_the_volume(void **state)
{
  (void)state;
  TestCase *t = test_case(CELL_HEXAHEDRON, 5, 4, 3);
  t->c.grid.grading[0] = 4;
  t->c.grid.grading[2] = 0.3;
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  for (int w = WEIGHTS_AUTO; w <= WEIGHTS_GAUSS; ++w) {
    t->body[0].weights = (PointWeights)w;
    Points *points = seed_points(t, grid);
    CHECK_CLOSE(total(points, POINT_VOLUME), volume, 1e-12 * volume);
    CALL(PointsDestroy(&points));
  }
  free_all(t, grid, NULL);
}

/* A cylinder of radius 3 and height 2. */
static void axisymmetric_volume_is_the_full_circle(void **state)
{
  static const Kinematics rings = {.name = "rings", .dim = 2, .hoop = PETSC_TRUE};
  (void)state;
  for (int type = CELL_TRIANGLE; type <= CELL_QUADRILATERAL; ++type) {
    TestCase *t = test_case((CellType)type, 6, 4, 1);
    t->c.kinematics = &rings;
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    for (int w = WEIGHTS_EQUAL; w <= WEIGHTS_GAUSS; ++w) {
      t->body[0].weights = (PointWeights)w;
      Points *points = seed_points(t, grid);
      CHECK_CLOSE(total(points, POINT_VOLUME), 18 * PETSC_PI, 1e-12 * 18 * PETSC_PI);
      CALL(PointsDestroy(&points));
    }
    free_all(t, grid, NULL);
  }
}

/* Two materials side by side, and a third body apart. */
static TestCase *three_bodies(CellType type)
{
  TestCase *t = test_case(type, 12, 8, 4);
  t->c.n_bodies = 3;
  set_box(t->body, 0, 0, 1, 1);
  set_box(t->body + 1, 1, 0, 2, 1);
  set_box(t->body + 2, 0, 1.5, 3, 2);
  t->body[2].points_per_cell = 1;
  t->body[2].velocity[0] = 0.5;
  t->body[2].spin[2] = 2;
  t->body[2].spin_centre[0] = 1;
  return t;
}

static void check_body(const Points *points, PetscInt p)
{
  const PetscReal *x = point_real(points, POINT_X, p), *v = point_real(points, POINT_V, p);
  const PetscReal *state = point_real(points, POINT_STATE, p);
  const PetscInt body = points->body[p];
  CHECK(points->material[p] == (body == 1));
  CHECK(state[0] == (body == 1 ? 0 : 0.25));
  CHECK((x[0] > 1 && x[1] < 1) == (body == 1));
  CHECK((x[1] > 1.5) == (body == 2));
  CHECK_CLOSE(v[0], body == 2 ? 0.5 - 2 * x[1] : 0, 1e-15);
  CHECK_CLOSE(v[1], body == 2 ? 2 * (x[0] - 1) : 0, 1e-15);
  CHECK_CLOSE(*point_real(points, POINT_MASS, p), *point_real(points, POINT_VOLUME, p) * (body == 1 ? 2000 : 1500),
              1e-12);
}

static void bodies_stand_side_by_side(void **state)
{
  (void)state;
  for (int type = 0; type < 4; ++type) {
    TestCase *t = three_bodies((CellType)type);
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    Points *points = seed_points(t, grid);
    PetscReal mass[3] = {0};
    for (PetscInt p = 0; p < points->n; ++p) {
      check_body(points, p);
      mass[points->body[p]] += *point_real(points, POINT_MASS, p);
    }
    const PetscReal depth = grid->dim == 3 ? 2 : 1, expected[3] = {1500, 2000, 2250};
    for (int b = 0; b < 3; ++b) CHECK_CLOSE(sum_over_ranks(mass[b]), expected[b] * depth, 1e-12 * expected[b]);
    check_ids_unique(points);
    check_located(points, grid);
    free_all(t, grid, points);
  }
}

/* Ids are those of points of a body after those of the body before it, wherever in the grid they
 * stand: the first may hold the last cells, and the next ones the first. */
static void ids_belong_to_one_point(void **state)
{
  (void)state;
  for (int type = 0; type < 4; ++type) {
    TestCase *t = test_case((CellType)type, 12, 8, 4);
    t->c.n_bodies = 3;
    set_box(t->body, 1.5, 1, 3, 2);
    set_box(t->body + 1, 0, 0, 1.5, 1);
    set_box(t->body + 2, 1.5, 0, 3, 1);
    t->body[2].points_per_cell = 1;
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    Points *points = seed_points(t, grid);
    PetscInt64 range[3][2] = {{PETSC_MAX_INT, -1}, {PETSC_MAX_INT, -1}, {PETSC_MAX_INT, -1}};
    check_ids_unique(points);
    for (PetscInt p = 0; p < points->n; ++p) {
      PetscInt64 *r = range[points->body[p]];
      r[0] = PetscMin(r[0], points->id[p]);
      r[1] = PetscMax(r[1], points->id[p]);
    }
    for (int b = 0; b < 3; ++b) {
      CALL(MPI_Allreduce(MPI_IN_PLACE, &range[b][0], 1, MPIU_INT64, MPI_MIN, PETSC_COMM_WORLD));
      CALL(MPI_Allreduce(MPI_IN_PLACE, &range[b][1], 1, MPIU_INT64, MPI_MAX, PETSC_COMM_WORLD));
      CHECK(b == 0 || range[b][0] > range[b - 1][1]);
    }
    free_all(t, grid, points);
  }
}

static PetscBool same_point(const Points *a, PetscInt p, const Points *b, PetscInt q)
{
  static const PointReal fields[] = {POINT_X, POINT_V, POINT_MASS, POINT_VOLUME, POINT_F, POINT_STATE};
  PetscBool same = a->body[p] == b->body[q] && a->material[p] == b->material[q];
  for (size_t f = 0; f < sizeof fields / sizeof *fields; ++f)
    for (PetscInt k = 0; k < a->components[fields[f]]; ++k)
      if (point_real(a, fields[f], p)[k] != point_real(b, fields[f], q)[k]) same = PETSC_FALSE;
  return same;
}

/* What one rank seeds alone is what all seed together. */
static void ranks_do_not_matter(void **state)
{
  (void)state;
  for (int type = 0; type < 4; ++type) {
    TestCase *t = three_bodies((CellType)type);
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c), *alone = make_grid(PETSC_COMM_SELF, &t->c);
    Points *points = seed_points(t, grid), *reference = seed_points(t, alone);
    PetscInt *index;
    PetscInt64 last = 0;
    for (PetscInt p = 0; p < reference->n; ++p) last = PetscMax(last, reference->id[p]);
    CALL(PetscCalloc1((size_t)last + 1, &index));
    for (PetscInt p = 0; p < reference->n; ++p) index[reference->id[p]] = p + 1;
    CHECK(count_over_ranks(points->n) == reference->n);
    for (PetscInt p = 0; p < points->n; ++p) {
      CHECK(points->id[p] <= last && index[points->id[p]] > 0);
      CHECK(same_point(points, p, reference, index[points->id[p]] - 1));
    }
    CALL(PetscFree(index));
    CALL(GridDestroy(&alone));
    CALL(PointsDestroy(&reference));
    free_all(t, grid, points);
  }
}

/* All that the seeding has to say, on rank 0; the number of errors and warnings on all. */
static PetscInt messages(const TestCase *t, size_t size, char *text, PetscInt *warnings)
{
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = make_points(t);
  Diag *diag = NULL;
  PetscInt errors = 0;
  FILE *out = tmpfile();
  CHECK(out != NULL);
  CALL(DiagCreate(&diag));
  CALL(PointsSeed(points, grid, &t->c, t->seed, PETSC_TRUE, diag));
  CALL(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
  if (warnings) *warnings = count_over_ranks(diag_warnings(diag));
  CALL(DiagFlush(diag, out));
  rewind(out);
  text[fread(text, 1, size - 1, out)] = 0;
  fclose(out);
  CALL(DiagDestroy(&diag));
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  return errors;
}

static void check_says(const TestCase *t, PetscInt errors, const char *const *words)
{
  char text[4096];
  PetscMPIInt rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  CHECK(messages(t, sizeof text, text, NULL) == errors);
  for (; *words && rank == 0; ++words) {
    if (!strstr(text, *words)) fprintf(stderr, "'%s' is not in:\n%s\n", *words, text);
    CHECK(strstr(text, *words) != NULL);
  }
}

#define SAYS(t, errors, ...) check_says(t, errors, (const char *const[]){__VA_ARGS__, NULL})

static void mistakes_are_told(void **state)
{
  static char nowhere[] = "nowhere", lefd[] = "lefd", left[] = "left", gold[] = "gold";
  (void)state;
  TestCase *t = test_case(CELL_QUADRILATERAL, 12, 8, 1);
  t->body[0].points_per_cell = 5;
  SAYS(t, 1, "no rule places 5 points in a quadrilateral", "1, 4, 9, 16");
  t->body[0].points_per_cell = -1;
  SAYS(t, 1, "no rule places -1 points");
  t->body[0].points_per_cell = 4;
  set_box(t->body, 5, 0, 6, 1);
  SAYS(t, 1, "body 'first' holds the centre of no cell", "[5, 6] x [0, 1]", "[0, 3] x [0, 2]", "outside the grid");
  /* a box is found however thin, and has its volume; others between the places where cells are looked at are not */
  set_box(t->body, 0.3, 0, 0.31, 2);
  SAYS(t, 0, "");
  t->body[0].shape = (Shape){.kind = SHAPE_BALL, .centre = {0.34, 0.09}, .radius = 0.01};
  SAYS(t, 1, "thinner than a cell", "0.25");
  t->body[0].has_shape = PETSC_FALSE;
  t->body[0].region = nowhere;
  SAYS(t, 1, "no region 'nowhere'");
  t->body[0].region = lefd;
  SAYS(t, 1, "no region 'lefd'", "did you mean 'left'?");
  t->body[0].region = left;
  SAYS(t, 1, "'left' is a boundary, not a region");
  t->body[0].region = NULL;
  t->body[0].material = gold;
  SAYS(t, 1, "no material 'gold'");
  CALL(PetscFree(t));
}

static void overlap_is_told(void **state)
{
  const Shape hole = {.kind = SHAPE_BALL, .centre = {0.6, 0.65}, .radius = 0.2};
  (void)state;
  TestCase *t = test_case(CELL_QUADRILATERAL, 12, 8, 1);
  t->c.n_bodies = 2;
  set_box(t->body, 0, 0, 1, 1);
  set_box(t->body + 1, 0.5, 0.5, 2, 1);
  SAYS(t, 1, "bodies 'first' and 'second' overlap: 0.25 m2 would be filled twice");
  /* whole cells that both have are told however few they are */
  set_box(t->body + 1, 0.75, 0.75, 3, 2);
  t->body[0].fill = t->body[1].fill = FILL_CELLS;
  SAYS(t, 1, "overlap: 0.0625 m2");
  t->body[0].fill = t->body[1].fill = FILL_AUTO;
  /* no cell is filled by both: a thin layer, and a ball */
  set_box(t->body, 0.1, 0.1, 1.03, 1.1);
  set_box(t->body + 1, 1.02, 0.1, 2.1, 1.1);
  SAYS(t, 1, "overlap: 0.0");
  t->body[1].shape = hole;
  SAYS(t, 1, "bodies 'first' and 'second' overlap: 0.12");
  CALL(PetscFree(t));
}

/* Bodies that share a face, straight or round, have nothing in common, nor have those that are a hair apart. */
static void neighbours_do_not_overlap(void **state)
{
  const Shape hole = {.kind = SHAPE_BALL, .centre = {0.6, 0.65}, .radius = 0.2};
  Shape parts[2] = {{.kind = SHAPE_BOX}, hole};
  (void)state;
  TestCase *t = test_case(CELL_QUADRILATERAL, 12, 8, 1);
  t->c.n_bodies = 2;
  set_box(t->body, 0.1, 0.1, 1.03, 1.1);
  set_box(t->body + 1, 1.03, 0.1, 2.1, 1.1);
  SAYS(t, 0, "");
  set_box(t->body + 1, 1.03 - 1e-9, 0.1, 2.1, 1.1);
  SAYS(t, 0, "");
  for (int d = 0; d < 2; ++d) parts[0].min[d] = 0.1, parts[0].max[d] = 1.1;
  t->body[0].shape = (Shape){.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = parts};
  t->body[1].shape = hole;
  SAYS(t, 0, "");
  CALL(PetscFree(t));
}

static void bad_volume_is_told(void **state)
{
  static const Kinematics rings = {.name = "rings", .dim = 2, .hoop = PETSC_TRUE};
  char text[4096];
  PetscInt warnings;
  PetscMPIInt rank;
  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  TestCase *t = test_case(CELL_QUADRILATERAL, 12, 8, 1);
  set_box(t->body, 0, 0, 1.1, 1);
  CHECK(messages(t, sizeof text, text, &warnings) == 0 && warnings == 0);
  t->body[0].fill = FILL_CELLS;
  CHECK(messages(t, sizeof text, text, &warnings) == 0 && warnings == 1);
  CHECK(rank || (strstr(text, "they hold 1 m2, its shape 1.1 m2 (-9.1 %)") && strstr(text, "smaller cells")));
  set_box(t->body, 2, 0, 4, 1);
  SAYS(t, 1, "body 'first' reaches outside the grid", "[2, 4] x [0, 1]", "[0, 3] x [0, 2]");
  t->body[0].shape = (Shape){.kind = SHAPE_BALL, .centre = {1.5, 1}, .radius = 0.4};
  CHECK(messages(t, sizeof text, text, &warnings) == 0 && warnings == 1);
  CHECK(rank || strstr(text, "its shape 0.502655 m2"));
  set_box(t->body, 0, 0, 3, 1);
  CHECK(messages(t, sizeof text, text, &warnings) == 0 && warnings == 0);
  /* a part of a cell at the rim of a cylinder turns with its own radius, not with that of the cell */
  t->c.kinematics = &rings;
  set_box(t->body, 0, 0, 1.1, 1);
  t->body[0].fill = FILL_SHAPE;
  CHECK(messages(t, sizeof text, text, &warnings) == 0 && warnings == 0);
  CALL(PetscFree(t));
}

static void polygon_volume_is_known(void **state)
{
  PetscReal vertices[8] = {0, 0, 2, 0, 2, 1, 0, 1};
  char text[4096];
  PetscInt warnings;
  (void)state;
  TestCase *t = test_case(CELL_QUADRILATERAL, 12, 8, 1);
  t->body[0].has_shape = PETSC_TRUE;
  t->body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = vertices};
  CHECK(messages(t, sizeof text, text, &warnings) == 0 && warnings == 0);
  vertices[2] = vertices[4] = 2.1;
  CHECK(messages(t, sizeof text, text, &warnings) == 0 && warnings == 0);
  t->body[0].fill = FILL_CELLS;
  CHECK(messages(t, sizeof text, text, &warnings) == 0 && warnings == 1);
  CALL(PetscFree(t));
}

/* 44,000,000 cells of 64 points would wrap a PetscInt to a negative number; nothing is
 * allocated. */
static void too_many_points_are_told(void **state)
{
  Seeding s = {.n_cells = 44000000, .rule.n = 64};
  Points crowd = {.dim = 2, .n = 7, .components = {2, 5}};
  PetscBool fits;
  Diag *diag;
  (void)state;
  CALL(DiagCreate(&diag));
  TestCase *t = test_case(CELL_QUADRILATERAL, 4, 3, 1);
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  s.c = &t->c, s.grid = s.source = grid, s.body = t->body, s.diag = diag;
  CALL(SeedCheckRoom(&s, &crowd, &fits));
  CHECK(!fits);
  CHECK(count_over_ranks(diag_errors(diag)) == 1);
  s.n_cells = 4000000; /* 256,000,007 x 8 numbers are less than 2^31 */
  CALL(SeedCheckRoom(&s, &crowd, &fits));
  CHECK(fits);
  s.n_cells = 4300000; /* 275,200,007 x 8 are more */
  CALL(SeedCheckRoom(&s, &crowd, &fits));
  CHECK(!fits);
  crowd.n = PETSC_MAX_INT - 2; /* one more than a body's points */
  s.n_cells = 1, s.rule.n = 4;
  CALL(SeedCheckRoom(&s, &crowd, &fits));
  CHECK(!fits);
  CALL(DiagDestroy(&diag));
  free_all(t, grid, NULL);
}

/* A body that fills its shape has the volume and the middle of a ball that cuts its cells, and
 * all points are inside; the rest of the grid has what is left. */
static void shape_is_filled(void **state)
{
  const Shape ball = {.kind = SHAPE_BALL, .centre = {1.37, 0.96, 1.04}, .radius = 0.83};
  (void)state;
  for (int type = 0; type < 4; ++type) {
    const PetscBool flat = type < CELL_TETRAHEDRON;
    const PetscReal part = PETSC_PI * PetscSqr(ball.radius) * (flat ? 1 : 4.0 / 3.0 * ball.radius);
    Shape rest[2] = {box_shape(0, 0, 0, 3, 2, 2), ball};
    TestCase *t = test_case((CellType)type, flat ? 12 : 6, flat ? 8 : 4, 4);
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    t->body[0].has_shape = PETSC_TRUE;
    for (int inside = 1; inside >= 0; --inside) {
      const PetscReal wanted = inside ? part : (flat ? area : volume) - part;
      t->body[0].shape = inside ? ball : (Shape){.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = rest};
      Points *points = seed_points(t, grid);
      PetscReal middle[3] = {0, 0, 0};
      check_ids_unique(points);
      check_located(points, grid);
      CHECK_CLOSE(total(points, POINT_VOLUME), wanted, (flat ? 1e-6 : 1e-4) * wanted);
      for (PetscInt p = 0; p < points->n; ++p) {
        const PetscReal *x = point_real(points, POINT_X, p);
        if (inside) CHECK(shape_contains(&ball, grid->dim, x, 1e-12));
        for (PetscInt d = 0; d < grid->dim; ++d) middle[d] += x[d] * *point_real(points, POINT_VOLUME, p) / wanted;
      }
      CALL(MPI_Allreduce(MPI_IN_PLACE, middle, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
      for (PetscInt d = 0; d < grid->dim && inside; ++d) CHECK_CLOSE(middle[d], ball.centre[d], flat ? 1e-4 : 1e-3);
      CALL(PointsDestroy(&points));
    }
    free_all(t, grid, NULL);
  }
}

/* Numbers that tell any two sets of points apart, whichever order these have, and whatever was mirrored about the
 * middle of the grid, or two axes changed. */
static void look_at(const Points *points, const Grid *grid, unsigned mirror, PetscReal *print)
{
  PetscReal local[6] = {0};
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal V = *point_real(points, POINT_VOLUME, p);
    PetscReal x[3] = {0, 0, 0};
    for (PetscInt d = 0; d < points->dim; ++d) {
      const PetscReal from = point_real(points, POINT_X, p)[d] - 0.5 * (grid->min[d] + grid->max[d]);
      x[d] = mirror >> d & 1 ? -from : from;
    }
    const PetscReal terms[6] = {1, x[0], x[1] * x[1] * x[1], x[0] * x[1] * x[1], x[2] * x[0], 1 / V};
    for (int k = 0; k < 6; ++k) local[k] += V * V * terms[k];
  }
  CALL(MPI_Allreduce(local, print, 6, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
}

/* The image of a box or a ball. */
static Shape image_of(const Shape *shape, const Grid *grid, unsigned mirror)
{
  Shape image = *shape;
  for (PetscInt d = 0; d < grid->dim; ++d) {
    const PetscReal twice = grid->min[d] + grid->max[d];
    if (!(mirror >> d & 1)) continue;
    image.min[d] = twice - shape->max[d];
    image.max[d] = twice - shape->min[d];
    image.centre[d] = twice - shape->centre[d];
  }
  return image;
}

/* A body and its image in a mirror have the same points, whatever part of a cell is theirs. */
static void mirrors_do_not_matter(void **state)
{
  const PetscInt rules[2][5] = {{1, 4, 9, 16, 25}, {1, 8, 27, 64}};
  const Shape shapes[4] = {box_shape(0.13, 0.31, 0.07, 1.43, 1.08, 1.7),
                           box_shape(0.5, 0.5, 0.4, 1.51, 1.262, 1.515),
                           box_shape(0.24, 0.5, 0.4, 1.01, 1.01, 1.51),
                           {.kind = SHAPE_BALL, .centre = {1.37, 0.96, 1.04}, .radius = 0.83}};
  (void)state;
  for (int k = 0; k < 9; ++k)
    for (int shape = 0; shape < 4; ++shape) {
      PetscReal first[6], print[6];
      const PetscBool flat = k < 5;
      TestCase *t = test_case(flat ? CELL_QUADRILATERAL : CELL_HEXAHEDRON, flat ? 12 : 6, flat ? 8 : 4, 4);
      Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
      t->body[0].has_shape = PETSC_TRUE;
      t->body[0].points_per_cell = rules[!flat][flat ? k : k - 5];
      for (unsigned mirror = 0; mirror < (flat ? 4 : 8); mirror += flat ? 1 : 5) {
        t->body[0].shape = image_of(shapes + shape, grid, mirror);
        Points *points = seed_points(t, grid);
        look_at(points, grid, mirror, mirror ? print : first);
        for (int i = 0; mirror && i < 6; ++i)
          CHECK_CLOSE(print[i], first[i], 1e-9 * PetscMax(first[0], PetscAbsReal(first[i])));
        CALL(PointsDestroy(&points));
      }
      free_all(t, grid, NULL);
    }
}

/* A plane that cuts the cells askew leaves every cell its exact part, and no point a sliver:
 * trapezoid of the section, and what it is as a ring. */
static void planes_are_exact(void **state)
{
  static const Kinematics rings = {.name = "rings", .dim = 2, .hoop = PETSC_TRUE};
  PetscReal vertices[8] = {0.13, 0.11, 2.77, 0.11, 2.77, 1.71, 0.13, 0.37};
  const PetscReal width = 2.64, low = 0.26, high = 1.6, section = width * (low + high) / 2;
  const PetscReal moment = 0.13 * section + width * width * (low / 6 + high / 3);
  (void)state;
  for (int type = 0; type < 4; ++type) {
    TestCase *t = test_case(type & 1 ? CELL_QUADRILATERAL : CELL_TRIANGLE, 12, 8, 1);
    if (type > 1) t->c.kinematics = &rings;
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    t->body[0].has_shape = PETSC_TRUE;
    t->body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = vertices};
    Points *points = seed_points(t, grid);
    const PetscReal wanted = type > 1 ? 2 * PETSC_PI * moment : section;
    check_located(points, grid);
    CHECK_CLOSE(total(points, POINT_VOLUME), wanted, 2e-4 * wanted); /* its four corners lie within simplices */
    free_all(t, grid, points);
  }
}

/* What of the surface that cuts cells looks along each axis, forth and back. */
static void check_faces(const TestCase *t, const Grid *grid, const PetscReal *wanted, PetscReal tolerance)
{
  PetscReal looks[3][2] = {{0}};
  Points *points = make_points(t);
  points->components[POINT_REACH] = 1;
  points->components[POINT_FACE] = points->components[POINT_CORNER] = grid->dim;
  seed_into(t, grid, points);
  for (PetscInt p = 0; p < points->n; ++p)
    for (PetscInt d = 0; d < grid->dim; ++d) {
      const PetscReal face = point_real(points, POINT_FACE, p)[d];
      looks[d][face < 0] += PetscAbsReal(face);
    }
  for (PetscInt d = 0; d < grid->dim; ++d)
    for (int back = 0; back < 2; ++back) {
      const PetscReal found = sum_over_ranks(looks[d][back]);
      CHECK_CLOSE(found, wanted[d], tolerance * wanted[d]);
    }
  CALL(PointsDestroy(&points));
}

/* Points of a body know its surface: the shadows of a ball, and of a box whose sides lie on lines of the grid or
 * beside them (of cells that are whole nobody asks: there is no more to know). */
static void surfaces_are_shared_out(void **state)
{
  const Shape ball = {.kind = SHAPE_BALL, .centre = {1.37, 0.96, 1.04}, .radius = 0.83};
  (void)state;
  for (int type = 0; type < 4; ++type) {
    const PetscBool flat = type < CELL_TETRAHEDRON;
    const PetscReal shadow = flat ? 2 * ball.radius : PETSC_PI * PetscSqr(ball.radius);
    TestCase *t = test_case((CellType)type, flat ? 12 : 6, flat ? 8 : 4, 4);
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    t->body[0].has_shape = PETSC_TRUE;
    t->body[0].shape = ball;
    /* parts that look both ways count for what is left */
    check_faces(t, grid, (PetscReal[]){shadow, shadow, shadow}, flat ? 2e-3 : 0.035);
    free_all(t, grid, NULL);
  }
  TestCase *t = test_case(CELL_QUADRILATERAL, 12, 8, 1);
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  t->body[0].has_shape = PETSC_TRUE;
  t->body[0].shape = box_shape(0.5625, 0.3125, 0, 0.6875, 1.4375, 0); /* one column of cells */
  check_faces(t, grid, (PetscReal[]){1.125, 0.125}, 1e-6);
  t->body[0].shape = box_shape(0.5, 0.3125, 0, 0.75, 0.4375, 0); /* one cell, both its sides along lines */
  check_faces(t, grid, (PetscReal[]){0.125, 0.25}, 1e-6);
  free_all(t, grid, NULL);
}

/* A hole whose crown touches a line of the grid: below that the ground has long and thin parts, whose middles lie where
 * they are thickest. Joined to one of them, the surface of two pressed half as far again from the crown as it does: the
 * moment about it of a pressure on the quarter of a metre beside it is half of a square, within a fifth. */
static void thin_parts_press_where_they_are(void **state)
{
  Shape parts[2] = {{.kind = SHAPE_BOX, .max = {3, 2}}, {.kind = SHAPE_BALL, .centre = {1.5, 0.25}, .radius = 1}};
  PetscReal moment = 0;
  (void)state;
  TestCase *t = test_case(CELL_QUADRILATERAL, 12, 8, 4);
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  t->body[0].has_shape = PETSC_TRUE;
  t->body[0].points_per_cell = 4;
  t->body[0].shape = (Shape){.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = parts};
  Points *points = make_points(t);
  points->components[POINT_REACH] = 1;
  points->components[POINT_FACE] = points->components[POINT_CORNER] = grid->dim;
  t->c.n_walls = 1; /* seeding asks for no more of them */
  seed_into(t, grid, points);
  t->c.n_walls = 0;
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal *x = point_real(points, POINT_X, p);
    const PetscBool beside = x[0] > 1.5 && x[0] < 1.75 && x[1] > 1 && x[1] < 1.25;
    moment += beside ? -point_real(points, POINT_FACE, p)[1] * (x[0] - 1.5) : 0;
  }
  const PetscReal wanted = 0.25 * 0.25 / 2;
  CHECK_CLOSE(sum_over_ranks(moment), wanted, 0.2 * wanted);
  free_all(t, grid, points);
}

/* Towards each of two sides of a cell that meet at 87 degrees, as a round surface and a plane of symmetry do, the point
 * between them reaches as far as that side is. Turned, the cell has them the other way round. */
static void skew_corners_know_both_sides(void **state)
{
  static const PetscReal cell[2][8] = {{0, 0, 1, 0.05, 1, 1, 0, 1}, {0, 0, 1, 0, 1, 1, 0.05, 1}};
  SeedRule rule = {.n = 4, .side = 2};
  (void)state;
  CHECK(cell_quadrature(CELL_QUADRILATERAL, 4, rule.xi, rule.weight));
  for (int k = 0; k < 2; ++k) {
    const PetscReal *x = cell[k];
    unsigned char outer[4];
    PetscReal normal[3], position[3], corner[3];
    PetscInt q = 0;
    for (PetscInt side = 0; side < 4; ++side) {
      cell_side_area(CELL_QUADRILATERAL, side, x, normal);
      outer[side] = normal[0] < -0.5 || normal[1] < -0.5;
    }
    while (rule.xi[2 * q] > 0 || rule.xi[2 * q + 1] > 0) ++q;
    cell_position(CELL_QUADRILATERAL, x, rule.xi + 2 * q, position);
    const PetscReal reach = seed_reach(CELL_QUADRILATERAL, x, position, 0.25, &rule, q, outer);
    seed_corner(CELL_QUADRILATERAL, x, position, &rule, q, outer, corner, NULL);
    for (PetscInt side = 0; side < 4; ++side) {
      if (!outer[side]) continue;
      cell_side_area(CELL_QUADRILATERAL, side, x, normal);
      const PetscReal size = PetscSqrtReal(normal[0] * normal[0] + normal[1] * normal[1]);
      const PetscReal wanted =
        -(normal[0] * position[0] + normal[1] * position[1]) / size; /* both go through the origin */
      CHECK_CLOSE(PetscMax(reach, (corner[0] * normal[0] + corner[1] * normal[1]) / size), wanted, 1e-12);
    }
  }
}

/* Where its surface follows the cells it is seeded as ever. */
static void aligned_shape_is_the_same(void **state)
{
  (void)state;
  for (int type = 0; type < 4; ++type) {
    TestCase *t = test_case((CellType)type, 12, 8, 4);
    Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
    set_box(t->body, 0.5, 0.25, 1.75, 1);
    t->body[0].fill = FILL_CELLS;
    Points *cells_points = seed_points(t, grid);
    t->body[0].fill = FILL_AUTO;
    Points *points = seed_points(t, grid);
    CHECK(points->n == cells_points->n);
    for (PetscInt p = 0; p < points->n; ++p) {
      CHECK(points->id[p] == cells_points->id[p]);
      CHECK(*point_real(points, POINT_VOLUME, p) == *point_real(cells_points, POINT_VOLUME, p));
      CHECK(!memcmp(point_real(points, POINT_X, p), point_real(cells_points, POINT_X, p),
                    (size_t)grid->dim * sizeof(PetscReal)));
    }
    CALL(PointsDestroy(&cells_points));
    free_all(t, grid, points);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(shape_is_filled),
    cmocka_unit_test(mirrors_do_not_matter),
    cmocka_unit_test(planes_are_exact),
    cmocka_unit_test(surfaces_are_shared_out),
    cmocka_unit_test(thin_parts_press_where_they_are),
    cmocka_unit_test(skew_corners_know_both_sides),
    cmocka_unit_test(aligned_shape_is_the_same),
    cmocka_unit_test(every_rule_fills_the_volume),
    cmocka_unit_test(method_chooses_the_weights),
    cmocka_unit_test(grading_keeps_the_volume),
    cmocka_unit_test(axisymmetric_volume_is_the_full_circle),
    cmocka_unit_test(bodies_stand_side_by_side),
    cmocka_unit_test(ranks_do_not_matter),
    cmocka_unit_test(mistakes_are_told),
    cmocka_unit_test(overlap_is_told),
    cmocka_unit_test(neighbours_do_not_overlap),
    cmocka_unit_test(too_many_points_are_told),
    cmocka_unit_test(bad_volume_is_told),
    cmocka_unit_test(ids_belong_to_one_point),
    cmocka_unit_test(polygon_volume_is_known),
  };
  return run_point_tests(argc, argv, tests, sizeof tests / sizeof *tests);
}
