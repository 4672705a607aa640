/* What the tests of the grid share: cases made by hand, sums over ranks, a quiet cmocka on ranks >
 * 0. */
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <unistd.h>
#include <cmocka.h>
#include "grid/grid.h"

#define CALL(call) assert_int_equal((call), 0)

static inline Case box_case(CellType cell, Diagonal diagonal, PetscInt nx, PetscInt ny, PetscInt nz)
{
  Case c = {0};
  const PetscInt counts[3] = {nx, ny, nz};
  const PetscReal min[3] = {-1.0, 0.5, 2.0}, max[3] = {2.0, 2.5, 5.0};
  c.kinematics = cell >= CELL_TETRAHEDRON ? &kinematics_3d : &kinematics_plane_strain;
  c.grid.kind = GRID_BOX;
  c.grid.cell = cell;
  c.grid.diagonal = diagonal;
  for (int d = 0; d < 3; ++d) {
    c.grid.min[d] = min[d];
    c.grid.max[d] = max[d];
    c.grid.counts[d] = counts[d];
    c.grid.grading[d] = 1.0;
  }
  return c;
}

static inline Grid *make_grid(const Case *c, GridWeight weight, void *context)
{
  Diag *diag;
  Grid *grid = NULL;
  CALL(DiagCreate(&diag));
  CALL(GridCreate(PETSC_COMM_WORLD, c, weight, context, diag, &grid));
  if (diag_errors(diag)) CALL(DiagFlush(diag, stderr));
  assert_non_null(grid);
  CALL(DiagDestroy(&diag));
  return grid;
}

static inline PetscReal sum_over_ranks(PetscReal value)
{
  PetscReal sum;
  CALL(MPI_Allreduce(&value, &sum, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  return sum;
}

static inline PetscInt count_over_ranks(PetscInt value) { return (PetscInt)sum_over_ranks((PetscReal)value); }

/* Total volume of the cells; every one must be positive. */
static inline PetscReal grid_volume(const Grid *grid)
{
  PetscReal volume = 0;
  for (PetscInt cell = 0; cell < grid->n_cells; ++cell) {
    PetscReal x[3 * CELL_MAX_NODES];
    grid_cell_x(grid, cell, x);
    const PetscReal v = cell_volume(grid_cell_type(grid, cell), x);
    assert_true(v > 0);
    volume += v;
  }
  return sum_over_ranks(volume);
}

/* The position that N makes of the cell's nodes. */
static inline void interpolate(const Grid *grid, PetscInt cell, const PetscReal *xi, PetscReal *x)
{
  PetscReal N[CELL_MAX_NODES], nodes[3 * CELL_MAX_NODES];
  grid_cell_x(grid, cell, nodes);
  grid_shape(grid, cell, xi, N);
  for (PetscInt d = 0; d < grid->dim; ++d) {
    x[d] = 0;
    for (PetscInt i = 0; i < grid->nodes_per_cell; ++i) x[d] += N[i] * nodes[i * grid->dim + d];
  }
}

/* Each position must be found in one cell of one rank, with xi that reproduces it. Returns the
 * rank's number of finds (0 or 1). */
static inline PetscInt check_located(const Grid *grid, const PetscReal *x)
{
  PetscReal xi[3], again[3];
  const PetscInt cell = grid_locate(grid, x, -1, xi);
  if (cell < 0) return 0;
  assert_true(cell < grid->n_cells);
  assert_true(cell_outside(grid_cell_type(grid, cell), xi) < 1e-9);
  interpolate(grid, cell, xi, again);
  for (PetscInt d = 0; d < grid->dim; ++d) assert_true(PetscAbsReal(again[d] - x[d]) < 1e-10);
  assert_int_equal(grid_locate(grid, x, 0, xi), cell);
  return 1;
}

/* Every node gets the number of cells that touch it: by its own rank's cells and the sum over
 * ghosts; then its owner tells all. */
static inline void check_ghost_sum(const Grid *grid, PetscReal *total)
{
  PetscReal *count, sum = 0;
  CALL(PetscCalloc1(2 * grid->n_nodes, &count));
  for (PetscInt k = 0; k < grid->n_cells * grid->nodes_per_cell; ++k) {
    count[2 * grid->cell_node[k]] += 1;
    count[2 * grid->cell_node[k] + 1] += (PetscReal)grid->global_node[grid->cell_node[k]];
  }
  CALL(GridSumToOwners(grid, 2, count));
  CALL(GridToGhosts(grid, 2, count));
  for (PetscInt n = 0; n < grid->n_nodes; ++n) {
    assert_true(count[2 * n] >= 1);
    /* Every copy of a node carries the same global number, or the mean would differ. */
    assert_true(PetscAbsReal(count[2 * n + 1] / count[2 * n] - (PetscReal)grid->global_node[n]) < 1e-9);
    if (n < grid->n_owned) sum += count[2 * n];
  }
  *total = sum_over_ranks(sum);
  CALL(PetscFree(count));
}

/* Ghosts stand where their owners stand. */
static inline void check_ghost_positions(const Grid *grid)
{
  PetscReal *x;
  CALL(PetscMalloc1(grid->n_nodes * grid->dim, &x));
  CALL(PetscArraycpy(x, grid->x, grid->n_nodes * grid->dim));
  for (PetscInt k = grid->n_owned * grid->dim; k < grid->n_nodes * grid->dim; ++k) x[k] = PETSC_MAX_REAL;
  CALL(GridToGhosts(grid, grid->dim, x));
  for (PetscInt k = 0; k < grid->n_nodes * grid->dim; ++k) assert_true(x[k] == grid->x[k]);
  CALL(PetscFree(x));
}

/* Area of a set's faces and the sum of their normals, over all ranks. */
static inline PetscReal faces_area(const Grid *grid, const GridSet *set, PetscReal normal[3])
{
  PetscReal area = 0;
  for (PetscInt d = 0; d < 3; ++d) normal[d] = 0;
  for (PetscInt f = 0; f < set->n_faces; ++f) {
    const Cell *shape = grid_cell(grid, set->face_cell[f]);
    const PetscInt *node = grid->cell_node + set->face_cell[f] * grid->nodes_per_cell;
    const PetscReal *x[4];
    PetscReal n[3] = {0, 0, 0};
    for (PetscInt i = 0; i < shape->face_nodes; ++i)
      x[i] = grid->x + node[shape->face[set->face_side[f]][i]] * grid->dim;
    if (grid->dim == 2) n[0] = x[1][1] - x[0][1], n[1] = x[0][0] - x[1][0];
    for (PetscInt t = 2; t < shape->face_nodes; ++t)
      for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3, g = (d + 2) % 3;
        n[d] += 0.5 * ((x[t - 1][e] - x[0][e]) * (x[t][g] - x[0][g]) - (x[t - 1][g] - x[0][g]) * (x[t][e] - x[0][e]));
      }
    for (PetscInt d = 0; d < 3; ++d) normal[d] += n[d];
    area += PetscSqrtReal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  }
  for (PetscInt d = 0; d < 3; ++d) normal[d] = sum_over_ranks(normal[d]);
  return sum_over_ranks(area);
}

static inline PetscInt owned_nodes(const Grid *grid, const GridSet *set)
{
  PetscInt n = 0;
  for (PetscInt k = 0; k < set->n_nodes; ++k) n += set->nodes[k] < grid->n_owned;
  return count_over_ranks(n);
}

static inline int run_grid_tests(int argc, char **argv, const struct CMUnitTest *tests, size_t n,
                                 CMFixtureFunction setup, CMFixtureFunction teardown)
{
  PetscMPIInt rank;
  int failed = 1;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank) {
    if (!freopen("/dev/null", "w", stdout)) return 1;
  }
  failed = _cmocka_run_group_tests("grid", tests, n, setup, teardown);
  /* A rank that failed must not leave the others waiting in a collective call. */
  if (failed) MPI_Abort(PETSC_COMM_WORLD, 1);
  return PetscFinalize() ? 1 : failed;
}
