/* What the tests of the points share: cases made by hand, checks that end all ranks when one fails,
 * sums over ranks. */
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <unistd.h>
#include <cmocka.h>
#include "points/points.h"

/* A rank that failed must not leave the others waiting in a collective call. */
static inline void check_failed(const char *file, int line, const char *what)
{
  PetscMPIInt rank, size;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  fprintf(stderr, "%s:%d: rank %d: failed: %s\n", file, line, (int)rank, what);
  if (size > 1) MPI_Abort(PETSC_COMM_WORLD, 1);
  _fail(file, line);
}

#define CHECK(condition)                                            \
  do {                                                              \
    if (!(condition)) check_failed(__FILE__, __LINE__, #condition); \
  } while (0)
#define CALL(call) CHECK((call) == 0)
#define CHECK_CLOSE(a, b, tolerance) CHECK(PetscAbsReal((a) - (b)) <= (tolerance))

/* A case of one box grid, [0, 3] x [0, 2] (x [0, 2]), with bodies to be added. */
typedef struct {
  Case c;
  BodySpec body[3];
  MaterialSpec material[2];
  PointSeed seed[2];
  PetscReal initial[2];
} TestCase;

static inline void set_bodies(TestCase *t, CellType cell)
{
  static char first[] = "first", second[] = "second", third[] = "third", sand[] = "sand", clay[] = "clay";
  char *const names[3] = {first, second, third};
  for (int b = 0; b < 3; ++b) {
    t->body[b].name = names[b];
    t->body[b].material = b == 1 ? clay : sand;
    t->body[b].points_per_cell = cell == CELL_HEXAHEDRON ? 8 : cell == CELL_TRIANGLE ? 3 : 4;
  }
  t->material[0] = (MaterialSpec){.name = sand, .density = 1500};
  t->material[1] = (MaterialSpec){.name = clay, .density = 2000};
  t->initial[0] = 0.25;
  t->initial[1] = -7;
  t->seed[0] = (PointSeed){.density = 1500, .n_state = 2, .initial = t->initial};
  t->seed[1] = (PointSeed){.density = 2000};
}

static inline TestCase *test_case(CellType cell, PetscInt nx, PetscInt ny, PetscInt nz)
{
  static char mpm[] = "mpm";
  const PetscInt counts[3] = {nx, ny, nz};
  const PetscReal max[3] = {3, 2, 2};
  TestCase *t = NULL;
  CALL(PetscNew(&t));
  t->c.kinematics = cell >= CELL_TETRAHEDRON ? &kinematics_3d : &kinematics_plane_strain;
  t->c.method = mpm;
  t->c.grid.kind = GRID_BOX;
  t->c.grid.cell = cell;
  t->c.grid.diagonal = DIAGONAL_ALTERNATING;
  for (int d = 0; d < 3; ++d) {
    t->c.grid.max[d] = max[d];
    t->c.grid.counts[d] = counts[d];
    t->c.grid.grading[d] = 1;
  }
  set_bodies(t, cell);
  t->c.n_bodies = 1;
  t->c.bodies = t->body;
  t->c.n_materials = 2;
  t->c.materials = t->material;
  return t;
}

static inline Shape box_shape(PetscReal x0, PetscReal y0, PetscReal z0, PetscReal x1, PetscReal y1, PetscReal z1)
{
  return (Shape){.kind = SHAPE_BOX, .min = {x0, y0, z0}, .max = {x1, y1, z1}};
}

static inline void set_box(BodySpec *body, PetscReal x0, PetscReal y0, PetscReal x1, PetscReal y1)
{
  body->has_shape = PETSC_TRUE;
  body->shape = box_shape(x0, y0, 0, x1, y1, 2);
}

static inline Grid *make_grid(MPI_Comm comm, const Case *c)
{
  Diag *diag = NULL;
  Grid *grid = NULL;
  CALL(DiagCreate(&diag));
  CALL(GridCreate(comm, c, NULL, NULL, diag, &grid));
  if (diag_errors(diag)) CALL(DiagFlush(diag, stderr));
  CHECK(grid != NULL);
  CALL(DiagDestroy(&diag));
  return grid;
}

static inline Points *make_points(const TestCase *t)
{
  Points *points = NULL;
  CALL(PointsCreate(kinematics_dim(t->c.kinematics), 2, 0, &points));
  return points;
}

/* Seed without an error. */
static inline void seed_into(const TestCase *t, const Grid *grid, Points *points)
{
  Diag *diag = NULL;
  PetscInt errors = 0;
  CALL(DiagCreate(&diag));
  CALL(PointsSeed(points, grid, &t->c, t->seed, !strcmp(t->c.method, "mpm"), diag));
  CALL(DiagReduce(grid->comm, diag, &errors));
  if (errors) CALL(DiagFlush(diag, stderr));
  CHECK(errors == 0);
  CALL(DiagDestroy(&diag));
}

static inline Points *seed_points(const TestCase *t, const Grid *grid)
{
  Points *points = make_points(t);
  seed_into(t, grid, points);
  return points;
}

static inline PetscReal sum_over_ranks(PetscReal value)
{
  PetscReal sum = 0;
  CALL(MPI_Allreduce(&value, &sum, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  return sum;
}

static inline PetscInt count_over_ranks(PetscInt value) { return (PetscInt)sum_over_ranks((PetscReal)value); }

static inline PetscReal total(const Points *points, PointReal field)
{
  PetscReal sum = 0;
  for (PetscInt p = 0; p < points->n; ++p) sum += *point_real(points, field, p);
  return sum_over_ranks(sum);
}

/* Every id on one rank only, once. */
static inline void check_ids_unique(const Points *points)
{
  PetscInt64 last = -1;
  PetscInt *seen = NULL;
  for (PetscInt p = 0; p < points->n; ++p) last = PetscMax(last, points->id[p]);
  CALL(MPI_Allreduce(MPI_IN_PLACE, &last, 1, MPIU_INT64, MPI_MAX, PETSC_COMM_WORLD));
  CALL(PetscCalloc1((size_t)last + 1, &seen));
  for (PetscInt p = 0; p < points->n; ++p) ++seen[points->id[p]];
  CALL(MPI_Allreduce(MPI_IN_PLACE, seen, (int)last + 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt64 i = 0; i <= last; ++i) CHECK(seen[i] <= 1);
  CALL(PetscFree(seen));
}

/* Cell and reference position give back the position, and the order is that of the cells. */
static inline void check_located(const Points *points, const Grid *grid)
{
  for (PetscInt p = 0; p < points->n; ++p) {
    PetscReal N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], nodes[3 * CELL_MAX_NODES];
    const PetscReal *xi = point_real(points, POINT_XI, p);
    CHECK(points->cell[p] >= 0 && points->cell[p] < grid->n_cells);
    CHECK(p == 0 || points->cell[p - 1] <= points->cell[p]);
    CHECK(cell_outside(grid->type, xi) < 1e-9);
    grid_cell_x(grid, points->cell[p], nodes);
    cell_shape(grid->type, xi, N, dN);
    for (PetscInt d = 0; d < grid->dim; ++d) {
      PetscReal x = 0;
      for (PetscInt i = 0; i < grid->nodes_per_cell; ++i) x += N[i] * nodes[i * grid->dim + d];
      CHECK_CLOSE(x, point_real(points, POINT_X, p)[d], 1e-11);
    }
  }
}

/* Index of the point with this id, -1 if it is not here. */
static inline PetscInt find_id(const Points *points, PetscInt64 id)
{
  for (PetscInt p = 0; p < points->n; ++p)
    if (points->id[p] == id) return p;
  return -1;
}

/* Numbers that look random, the same on every machine; in [0, 1). */
static inline PetscReal pseudo_random(PetscInt64 k)
{
  uint64_t z = (uint64_t)k * 0x9e3779b97f4a7c15u + 0x632be59bd9b4e019u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (PetscReal)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

static inline int run_point_tests(int argc, char **argv, const struct CMUnitTest *tests, size_t n)
{
  PetscMPIInt rank;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank) cmocka_set_message_output(CM_OUTPUT_SUBUNIT); /* which goes to stdout alone */
  if (rank && !freopen("/dev/null", "w", stdout)) return 1;
  const int failed = _cmocka_run_group_tests("points", tests, n, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
