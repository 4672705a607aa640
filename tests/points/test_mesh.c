/* Points and unstructured meshes: bodies that are regions, bodies with a mesh of their own,
 * wandering, keep-on-boundary. */
#include <string.h>
#include "points_test.h"

static const PetscInt n_side = 8;

static int node_number(PetscInt i, PetscInt j) { return (int)(j * (n_side + 1) + i + 1); }

static void write_nodes(FILE *out, const PetscReal *origin, PetscReal length)
{
  fprintf(out, "$Nodes\n%d\n", node_number(n_side, n_side));
  for (PetscInt j = 0; j <= n_side; ++j) {
    for (PetscInt i = 0; i <= n_side; ++i) {
      const PetscBool inner = i % 4 && j % 4;
      const double shift = inner ? 0.3 * (double)(pseudo_random(10 * i + j) - 0.5) : 0,
                   scale = (double)length / (double)n_side;
      fprintf(out, "%d %.17g %.17g 0\n", node_number(i, j), (double)origin[0] + scale * ((double)i + shift),
              (double)origin[1] + scale * ((double)j - shift));
    }
  }
  fprintf(out, "$EndNodes\n");
}

/* Every fourth line of nodes is straight (see write_nodes), so that the halves have straight
 * sides. */
static void write_triangles(FILE *out)
{
  int number = 0;
  fprintf(out, "$Elements\n%d\n", (int)(2 * n_side * n_side));
  for (PetscInt j = 0; j < n_side; ++j) {
    for (PetscInt i = 0; i < n_side; ++i) {
      const int group = i < 4 ? 1 : 2, a = node_number(i, j), b = node_number(i + 1, j), c = node_number(i + 1, j + 1),
                d = node_number(i, j + 1);
      fprintf(out, "%d 2 2 %d 1 %d %d %d\n", ++number, group, a, b, c);
      fprintf(out, "%d 2 2 %d 1 %d %d %d\n", ++number, group, a, c, d);
    }
  }
  fprintf(out, "$EndElements\n");
}

/* A square of distorted triangles; its left half is the region "west", the right one "east". All
 * ranks get the file's name. */
static void write_square(char *path, PetscReal x, PetscReal y, PetscReal length)
{
  const PetscReal origin[2] = {x, y};
  PetscMPIInt rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  strcpy(path, "/tmp/talus_points_XXXXXX.msh");
  if (rank == 0) {
    FILE *out = fdopen(mkstemps(path, 4), "w");
    CHECK(out != NULL);
    fprintf(out,
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"west\"\n2 2 \"east\"\n$EndPhysicalNames\n");
    write_nodes(out, origin, length);
    write_triangles(out);
    fclose(out);
  }
  CALL(MPI_Bcast(path, (int)strlen(path) + 1, MPI_CHAR, 0, PETSC_COMM_WORLD));
}

static void remove_square(const char *path)
{
  PetscMPIInt rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  CALL(MPI_Barrier(PETSC_COMM_WORLD));
  if (rank == 0) unlink(path);
}

/* The grid is the square [0, 2] x [0, 2]. */
static TestCase *mesh_case(char *path)
{
  TestCase *t = test_case(CELL_TRIANGLE, 1, 1, 1);
  write_square(path, 0, 0, 2);
  t->c.grid.kind = GRID_MESH;
  t->c.grid.mesh = path;
  return t;
}

static void regions_become_bodies(void **state)
{
  static char west[] = "west", east[] = "east", wset[] = "wset";
  char path[64];
  PetscReal volume[2] = {0};
  PetscInt errors = 0;
  (void)state;
  TestCase *t = mesh_case(path);
  t->c.n_bodies = 2;
  t->body[0].region = west;
  t->body[1].region = east;
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = seed_points(t, grid);
  for (PetscInt p = 0; p < points->n; ++p) {
    volume[points->body[p]] += *point_real(points, POINT_VOLUME, p);
    CHECK((point_real(points, POINT_X, p)[0] > 1) == (points->body[p] == 1));
  }
  for (int b = 0; b < 2; ++b) CHECK_CLOSE(sum_over_ranks(volume[b]), 2, 1e-12);
  CHECK(count_over_ranks(points->n) == 3 * 2 * n_side * n_side);
  check_ids_unique(points);
  check_located(points, grid);
  CALL(PointsDestroy(&points));
  t->body[1].region = wset;
  Diag *diag = NULL;
  points = make_points(t);
  CALL(DiagCreate(&diag));
  CALL(PointsSeed(points, grid, &t->c, t->seed, PETSC_TRUE, diag));
  CALL(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
  CHECK(errors == 1);
  CALL(DiagDestroy(&diag));
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  remove_square(path);
  CALL(PetscFree(t));
}

/* Positions and ids do not depend on the number of ranks, though the partition of the mesh does. */
static void id_moments(const Points *points, PetscReal *moment)
{
  moment[0] = moment[1] = moment[2] = 0;
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal *x = point_real(points, POINT_X, p);
    moment[0] += (PetscReal)points->id[p] * x[0];
    moment[1] += (PetscReal)points->id[p] * x[1];
    moment[2] += (PetscReal)points->id[p] * *point_real(points, POINT_MASS, p);
  }
}

static void own_mesh_seeds_points(void **state)
{
  static char east[] = "east";
  char path[64];
  (void)state;
  write_square(path, 0.55, 0.35, 1);
  for (int type = CELL_TRIANGLE; type <= CELL_QUADRILATERAL; ++type) {
    for (int part = 0; part < 2; ++part) {
      PetscReal here[3], alone[3];
      TestCase *t = test_case((CellType)type, 12, 8, 1);
      t->body[0].points_per_cell = 3;
      t->body[0].mesh = path;
      t->body[0].region = part ? east : NULL;
      Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c), *self = make_grid(PETSC_COMM_SELF, &t->c);
      Points *points = seed_points(t, grid), *reference = seed_points(t, self);
      CHECK(count_over_ranks(points->n) == 3 * 2 * n_side * n_side / (part + 1) &&
            reference->n == count_over_ranks(points->n));
      CHECK_CLOSE(total(points, POINT_VOLUME), part ? 0.5 : 1, 1e-12);
      check_ids_unique(points);
      check_located(points, grid);
      id_moments(points, here);
      id_moments(reference, alone);
      for (int k = 0; k < 3; ++k) CHECK_CLOSE(sum_over_ranks(here[k]), alone[k], 1e-11 * alone[k]);
      CALL(PointsDestroy(&points));
      CALL(PointsDestroy(&reference));
      CALL(GridDestroy(&grid));
      CALL(GridDestroy(&self));
      CALL(PetscFree(t));
    }
  }
  remove_square(path);
}

static void own_mesh_outside_is_told(void **state)
{
  char path[64];
  PetscInt errors = 0;
  Diag *diag = NULL;
  (void)state;
  write_square(path, 2.5, 0.5, 1);
  TestCase *t = test_case(CELL_QUADRILATERAL, 12, 8, 1);
  t->body[0].points_per_cell = 3;
  t->body[0].mesh = path;
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = make_points(t);
  CALL(DiagCreate(&diag));
  CALL(PointsSeed(points, grid, &t->c, t->seed, PETSC_TRUE, diag));
  CALL(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
  CHECK(errors == 1);
  CALL(DiagDestroy(&diag));
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  remove_square(path);
  CALL(PetscFree(t));
}

/* Every mistake of the file itself is told at the body that names it. */
static void unreadable_mesh_is_told(void **state)
{
  static char missing[] = "/nowhere/at/all.msh";
  char text[2048];
  PetscMPIInt rank;
  PetscInt errors = 0;
  Diag *diag = NULL;
  FILE *out = tmpfile();
  (void)state;
  CHECK(out != NULL);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  TestCase *t = test_case(CELL_QUADRILATERAL, 12, 8, 1);
  t->body[0].mesh = missing;
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = make_points(t);
  CALL(DiagCreate(&diag));
  CALL(PointsSeed(points, grid, &t->c, t->seed, PETSC_TRUE, diag));
  CALL(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
  CHECK(errors == 1 && points->n == 0);
  CALL(DiagFlush(diag, out));
  rewind(out);
  text[fread(text, 1, sizeof text - 1, out)] = 0;
  fclose(out);
  CHECK(rank || strstr(text, missing));
  CALL(DiagDestroy(&diag));
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  CALL(PetscFree(t));
}

/* Every point goes its own way, in again on the other side when it leaves, through all ranks. */
static void points_wander_on_a_mesh(void **state)
{
  char path[64];
  (void)state;
  TestCase *t = mesh_case(path);
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = seed_points(t, grid);
  const PetscInt n = count_over_ranks(points->n);
  for (int step = 0; step < 30; ++step) {
    PetscInt n_lost = -1;
    LostPoint *lost = NULL;
    for (PetscInt p = 0; p < points->n; ++p) {
      PetscReal *x = point_real(points, POINT_X, p);
      for (PetscInt d = 0; d < 2; ++d) {
        x[d] += 0.7 * (pseudo_random(31 * points->id[p] + d) - 0.5);
        if (x[d] < 0) x[d] += 2;
        if (x[d] > 2) x[d] -= 2;
      }
    }
    CALL(PointsRelocate(points, grid, OUTSIDE_STOP, &n_lost, &lost));
    CHECK(n_lost == 0 && count_over_ranks(points->n) == n);
    check_located(points, grid);
  }
  check_ids_unique(points);
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  remove_square(path);
  CALL(PetscFree(t));
}

/* Points thrown out on all sides come back to the side where they left, whichever rank has it. */
static void keep_clamps_on_a_mesh(void **state)
{
  char path[64];
  (void)state;
  TestCase *t = mesh_case(path);
  t->body[0].velocity[0] = 1;
  t->body[0].velocity[1] = 1;
  Grid *grid = make_grid(PETSC_COMM_WORLD, &t->c);
  Points *points = seed_points(t, grid);
  const PetscInt n = count_over_ranks(points->n);
  PetscInt n_lost;
  LostPoint *lost;
  for (PetscInt p = 0; p < points->n; ++p) {
    PetscReal *x = point_real(points, POINT_X, p);
    if (points->id[p] % 5 == 0) x[0] = 2.25;
    if (points->id[p] % 5 == 1) x[1] = -0.25;
  }
  CALL(PointsRelocate(points, grid, OUTSIDE_KEEP, &n_lost, &lost));
  CHECK(n_lost == 0 && count_over_ranks(points->n) == n);
  check_ids_unique(points);
  check_located(points, grid);
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal *x = point_real(points, POINT_X, p), *v = point_real(points, POINT_V, p);
    if (points->id[p] % 5 == 0) CHECK_CLOSE(x[0], 2, 1e-9);
    if (points->id[p] % 5 == 1) CHECK_CLOSE(x[1], 0, 1e-9);
    CHECK_CLOSE(v[0], points->id[p] % 5 == 0 ? 0 : 1, 1e-9);
    CHECK_CLOSE(v[1], 1, 1e-9);
  }
  CALL(PointsDestroy(&points));
  CALL(GridDestroy(&grid));
  remove_square(path);
  CALL(PetscFree(t));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(unreadable_mesh_is_told), cmocka_unit_test(regions_become_bodies),
    cmocka_unit_test(own_mesh_seeds_points),   cmocka_unit_test(own_mesh_outside_is_told),
    cmocka_unit_test(points_wander_on_a_mesh), cmocka_unit_test(keep_clamps_on_a_mesh),
  };
  return run_point_tests(argc, argv, tests, sizeof tests / sizeof *tests);
}
