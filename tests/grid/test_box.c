/* Box grids: counts, volumes, boundaries, ghosts, location and partition do not depend on the
 * number of ranks. */
#include "grid_test.h"

typedef struct {
  CellType cell;
  Diagonal diagonal;
  PetscInt n[3];
  PetscInt cells, nodes, x_faces; /* x_faces: on the left side */
} BoxExpectation;

static const BoxExpectation boxes[] = {
  {CELL_QUADRILATERAL, DIAGONAL_RIGHT, {7, 5, 0}, 35, 48, 5},
  {CELL_TRIANGLE, DIAGONAL_RIGHT, {7, 5, 0}, 70, 48, 5},
  {CELL_TRIANGLE, DIAGONAL_LEFT, {7, 5, 0}, 70, 48, 5},
  {CELL_TRIANGLE, DIAGONAL_ALTERNATING, {7, 5, 0}, 70, 48, 5},
  {CELL_TRIANGLE, DIAGONAL_CROSSED, {7, 5, 0}, 140, 83, 5},
  {CELL_HEXAHEDRON, DIAGONAL_RIGHT, {4, 5, 3}, 60, 120, 15},
  {CELL_TETRAHEDRON, DIAGONAL_RIGHT, {4, 5, 3}, 360, 120, 30},
  {CELL_QUADRILATERAL, DIAGONAL_RIGHT, {1, 1, 0}, 1, 4, 1},
  {CELL_TRIANGLE, DIAGONAL_CROSSED, {2, 1, 0}, 8, 8, 1},
  {CELL_HEXAHEDRON, DIAGONAL_RIGHT, {1, 1, 2}, 2, 12, 2},
};
#define N_BOXES (sizeof boxes / sizeof *boxes)

static Case expected_case(const BoxExpectation *e) { return box_case(e->cell, e->diagonal, e->n[0], e->n[1], e->n[2]); }

static void totals_and_volume(void **state)
{
  (void)state;
  for (size_t b = 0; b < N_BOXES; ++b) {
    const Case c = expected_case(boxes + b);
    Grid *grid = make_grid(&c, NULL, NULL);
    assert_int_equal(grid->n_cells_global, boxes[b].cells);
    assert_int_equal(grid->n_nodes_global, boxes[b].nodes);
    assert_int_equal(count_over_ranks(grid->n_cells), boxes[b].cells);
    assert_int_equal(count_over_ranks(grid->n_owned), boxes[b].nodes);
    const PetscReal expected = grid->dim == 2 ? 6.0 : 18.0;
    assert_true(PetscAbsReal(grid_volume(grid) - expected) < 1e-12 * expected);
    PetscReal cell_sum = 0;
    for (PetscInt k = 0; k < grid->n_cells; ++k) cell_sum += (PetscReal)grid->global_cell[k];
    assert_true(sum_over_ranks(cell_sum) == 0.5 * boxes[b].cells * (boxes[b].cells - 1));
    CALL(GridDestroy(&grid));
    assert_null(grid);
  }
}

static void ghosts(void **state)
{
  (void)state;
  for (size_t b = 0; b < N_BOXES; ++b) {
    const Case c = expected_case(boxes + b);
    Grid *grid = make_grid(&c, NULL, NULL);
    PetscReal total;
    check_ghost_sum(grid, &total);
    assert_true(total == (PetscReal)(boxes[b].cells * grid->nodes_per_cell));
    check_ghost_positions(grid);
    CALL(GridDestroy(&grid));
  }
}

/* Cells conform: every face is on the outer boundary or shared by two cells. One rank sees them
 * all. */
static void conforming(void **state)
{
  PetscMPIInt size;
  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (size_t b = 0; b < N_BOXES && size == 1; ++b) {
    const Case c = expected_case(boxes + b);
    Grid *grid = make_grid(&c, NULL, NULL);
    const Cell *shape = cells + grid->type;
    const PetscInt n = grid->n_cells * shape->faces;
    PetscInt64 *key;
    PetscInt single = 0;
    CALL(PetscMalloc1(n, &key));
    for (PetscInt k = 0; k < n; ++k) {
      PetscInt node[4];
      for (PetscInt i = 0; i < shape->face_nodes; ++i)
        node[i] = grid->cell_node[k / shape->faces * shape->nodes + shape->face[k % shape->faces][i]];
      CALL(PetscSortInt(shape->face_nodes, node));
      key[k] = 0;
      for (PetscInt i = 0; i < shape->face_nodes; ++i) key[k] = 1000 * key[k] + node[i];
    }
    for (PetscInt k = 0; k < n; ++k) {
      PetscInt seen = 0;
      for (PetscInt m = 0; m < n; ++m) seen += key[m] == key[k];
      assert_true(seen == 1 || seen == 2);
      single += seen == 1;
    }
    assert_int_equal(single, grid->outer.n_faces);
    CALL(PetscFree(key));
    CALL(GridDestroy(&grid));
  }
}

static void sides(void **state)
{
  static const char *const names[] = {"left", "right", "bottom", "top", "front", "back"};
  (void)state;
  for (size_t b = 0; b < N_BOXES; ++b) {
    const Case c = expected_case(boxes + b);
    const PetscReal length[3] = {3.0, 2.0, 3.0};
    Grid *grid = make_grid(&c, NULL, NULL);
    assert_int_equal(grid->n_sets, 2 * grid->dim);
    for (PetscInt s = 0; s < grid->n_sets; ++s) {
      const GridSet *set = grid_find_set(grid, names[s]);
      const PetscInt axis = s / 2;
      PetscReal area = 1.0, normal[3];
      PetscInt nodes = 1;
      assert_ptr_equal(set, grid->sets + s);
      for (PetscInt d = 0; d < grid->dim; ++d)
        if (d != axis) area *= length[d], nodes *= boxes[b].n[d] + 1;
      assert_int_equal(owned_nodes(grid, set), nodes);
      assert_true(PetscAbsReal(faces_area(grid, set, normal) - area) < 1e-12);
      assert_true(PetscAbsReal(normal[axis] - (s % 2 ? area : -area)) < 1e-12);
      for (PetscInt k = 0; k < set->n_nodes; ++k)
        assert_true(grid->x[set->nodes[k] * grid->dim + axis] == (s % 2 ? grid->max : grid->min)[axis]);
    }
    assert_int_equal(count_over_ranks(grid_find_set(grid, "left")->n_faces), boxes[b].x_faces);
    assert_null(grid_find_set(grid, "nowhere"));
    const char **list;
    CALL(GridSetNames(grid, &list));
    assert_string_equal(list[0], "left");
    assert_null(list[2 * grid->dim]);
    CALL(PetscFree(list));
    CALL(GridDestroy(&grid));
  }
}

/* A fine sample that meets nodes, faces and insides alike. */
static void sample_position(const Grid *grid, PetscInt k, const PetscInt m[3], PetscReal x[3])
{
  const PetscInt i[3] = {k % m[0], k / m[0] % m[1], k / m[0] / m[1]};
  for (PetscInt d = 0; d < grid->dim; ++d)
    x[d] = grid->min[d] + (grid->max[d] - grid->min[d]) * (PetscReal)i[d] / (PetscReal)(m[d] - 1);
}

static void check_candidates(const Grid *grid, const PetscReal *x, PetscInt found)
{
  PetscMPIInt rank, size, ranks[8];
  PetscReal holder = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  holder = sum_over_ranks(found ? rank : 0);
  const PetscInt n = grid_candidates(grid, x, 8, ranks);
  PetscBool named = found != 0;
  for (PetscInt r = 0; r < n; ++r) {
    assert_true(ranks[r] != rank && ranks[r] >= 0 && ranks[r] < size);
    if (ranks[r] == (PetscMPIInt)holder) named = PETSC_TRUE;
  }
  assert_true(named);
}

static void location(void **state)
{
  (void)state;
  for (size_t b = 0; b < N_BOXES; ++b) {
    Case c = expected_case(boxes + b);
    c.grid.grading[1] = b % 2 ? 1.0 : 6.0;
    Grid *grid = make_grid(&c, NULL, NULL);
    const PetscInt m[3] = {29, 21, grid->dim == 3 ? 13 : 1};
    for (PetscInt k = 0; k < m[0] * m[1] * m[2]; ++k) {
      PetscReal x[3];
      sample_position(grid, k, m, x);
      const PetscInt found = check_located(grid, x);
      assert_int_equal(count_over_ranks(found), 1);
      if (k % 7 == 0) check_candidates(grid, x, found);
    }
    CALL(GridDestroy(&grid));
  }
}

static void outside(void **state)
{
  const Case c = box_case(CELL_TRIANGLE, DIAGONAL_CROSSED, 6, 4, 0);
  Grid *grid = make_grid(&c, NULL, NULL);
  PetscReal xi[3];
  PetscMPIInt ranks[8];
  (void)state;
  const PetscReal far[][2] = {{-1.001, 1},         {2.001, 1}, {0, 0.4999},     {0, 1e300},
                              {PETSC_INFINITY, 1}, {0, NAN},   {-1.0 - 1e-9, 1}};
  for (size_t k = 0; k < sizeof far / sizeof *far; ++k) {
    assert_int_equal(grid_locate(grid, far[k], 3, xi), -1);
    assert_int_equal(grid_candidates(grid, far[k], 8, ranks), 0);
  }
  /* Rounding at the outer boundary loses no point. */
  const PetscReal near[][2] = {{-1.0 - 1e-13, 1.0}, {2.0 + 1e-13, 2.5 + 1e-13}};
  for (size_t k = 0; k < 2; ++k) assert_int_equal(count_over_ranks(check_located(grid, near[k])), 1);
  PetscReal x[2] = {-7.0, 1.25};
  grid_clamp(grid, x);
  assert_true(x[0] == -1.0 && x[1] == 1.25);
  assert_int_equal(count_over_ranks(check_located(grid, x)), 1);
  CALL(GridDestroy(&grid));
}

static void grading(void **state)
{
  Case c = box_case(CELL_QUADRILATERAL, DIAGONAL_RIGHT, 10, 1, 0);
  (void)state;
  c.grid.grading[0] = 4.0;
  Grid *grid = make_grid(&c, NULL, NULL);
  PetscReal width[10] = {0}, all[10];
  for (PetscInt k = 0; k < grid->n_cells; ++k) {
    const PetscInt *node = grid->cell_node + 4 * k;
    width[grid->global_cell[k]] = grid->x[2 * node[1]] - grid->x[2 * node[0]];
  }
  CALL(MPI_Allreduce(width, all, 10, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  assert_true(PetscAbsReal(all[9] / all[0] - 4.0) < 1e-12);
  for (int i = 1; i < 10; ++i) assert_true(PetscAbsReal(all[i] / all[i - 1] - PetscPowReal(4.0, 1.0 / 9)) < 1e-12);
  assert_true(PetscAbsReal(grid->smallest - all[0]) < 1e-14);
  CALL(GridDestroy(&grid));
}

/* Material in a corner only: its cells, not all cells, must be shared evenly. */
static PetscReal corner_weight(void *context, const PetscReal *x)
{
  const PetscReal *reach = context;
  return x[0] < reach[0] && x[1] < reach[1] ? 4.0 : 0.0;
}

static void partition_balance(void **state)
{
  const Case c = box_case(CELL_QUADRILATERAL, DIAGONAL_RIGHT, 300, 200, 0);
  PetscReal reach[2] = {-0.2, 1.1}, load = 0, largest;
  PetscMPIInt size;
  (void)state;
  Grid *grid = make_grid(&c, corner_weight, reach);
  assert_int_equal(count_over_ranks(grid->n_cells), 60000);
  for (PetscInt k = 0; k < grid->n_cells; ++k) {
    PetscReal x[8], centre[2] = {0, 0};
    grid_cell_x(grid, k, x);
    for (int i = 0; i < 8; ++i) centre[i % 2] += 0.25 * x[i];
    load += corner_weight(reach, centre) + 0.08; /* an empty cell weighs a fiftieth of a full one */
  }
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  CALL(MPI_Allreduce(&load, &largest, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  assert_true(largest / (sum_over_ranks(load) / size) < 1.1);
  PetscReal total;
  check_ghost_sum(grid, &total);
  assert_true(total == 240000.0);
  CALL(GridDestroy(&grid));
}

static PetscReal no_weight(void *context, const PetscReal *x)
{
  (void)context;
  (void)x;
  return 0.0;
}

static void partition_without_material(void **state)
{
  const Case c = box_case(CELL_HEXAHEDRON, DIAGONAL_RIGHT, 8, 9, 10);
  PetscMPIInt size;
  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  Grid *grid = make_grid(&c, no_weight, NULL);
  assert_int_equal(count_over_ranks(grid->n_cells), 720);
  assert_true(grid->n_cells * size < 1.3 * 720 && grid->n_cells * size > 0.7 * 720);
  CALL(GridDestroy(&grid));
}

static PetscInt selected_owned(const Grid *grid, const Selector *on)
{
  PetscInt n, *nodes, owned = 0;
  CALL(GridSelectNodes(grid, on, &n, &nodes));
  for (PetscInt k = 0; k < n; ++k) {
    if (k) assert_true(nodes[k] > nodes[k - 1]);
    owned += nodes[k] < grid->n_owned;
  }
  CALL(PetscFree(nodes));
  return count_over_ranks(owned);
}

static PetscInt selected_faces(const Grid *grid, const Selector *on)
{
  PetscInt n, *cell, *side;
  CALL(GridSelectFaces(grid, on, &n, &cell, &side));
  for (PetscInt k = 0; k < n; ++k)
    assert_true(cell[k] >= 0 && cell[k] < grid->n_cells && side[k] >= 0 && side[k] < cells[grid->type].faces);
  CALL(PetscFree(cell));
  CALL(PetscFree(side));
  return count_over_ranks(n);
}

static void selection(void **state)
{
  const Case c = box_case(CELL_QUADRILATERAL, DIAGONAL_RIGHT, 6, 4, 0);
  Grid *grid = make_grid(&c, NULL, NULL);
  Selector on = {0};
  (void)state;
  assert_int_equal(selected_owned(grid, &on), 20);
  assert_int_equal(selected_faces(grid, &on), 20);
  on.has[0] = PETSC_TRUE; /* x = 0: an inner line of nodes, and no face of the boundary */
  assert_int_equal(selected_owned(grid, &on), 5);
  assert_int_equal(selected_faces(grid, &on), 0);
  on.min[0] = -1.0;
  on.max[0] = 0.5 + 1e-10; /* 4 columns of 7, 3 faces below and above and 4 at the left */
  assert_int_equal(selected_owned(grid, &on), 20);
  assert_int_equal(selected_faces(grid, &on), 10);
  on.boundary = "bottom";
  assert_int_equal(selected_owned(grid, &on), 4);
  assert_int_equal(selected_faces(grid, &on), 3);
  on.boundary = "nowhere";
  assert_int_equal(selected_owned(grid, &on), 0);
  assert_int_equal(selected_faces(grid, &on), 0);
  on = (Selector){.has_shape = PETSC_TRUE,
                  /* the corner and its two neighbours */
                  .shape = {.kind = SHAPE_BALL, .centre = {-1.0, 0.5}, .radius = 0.5}};
  assert_int_equal(selected_owned(grid, &on), 3);
  assert_int_equal(selected_faces(grid, &on), 2);
  CALL(GridDestroy(&grid));
}

/* A plane is named by decimals, which the lines of the grid meet but for the last digit. */
static void selection_by_decimals(void **state)
{
  static const PetscReal plane[] = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7};
  Case c = box_case(CELL_QUADRILATERAL, DIAGONAL_RIGHT, 7, 3, 0);
  PetscInt exact = 0;
  (void)state;
  c.grid.min[0] = 0;
  c.grid.max[0] = 0.7;
  Grid *grid = make_grid(&c, NULL, NULL);
  for (int k = 0; k < 8; ++k) {
    const Selector on = {.has = {PETSC_TRUE}, .min = {plane[k]}, .max = {plane[k]}};
    assert_int_equal(selected_owned(grid, &on), 4);
    for (PetscInt i = 0; i < grid->n_owned; ++i) exact += grid->x[2 * i] == plane[k];
  }
  assert_true(count_over_ranks(exact) < 8 * 4); /* else this tests nothing */
  CALL(GridDestroy(&grid));
}

/* A position on a line between cells belongs to the upper one, on even and on graded grids. */
static void lines_belong_to_upper_cells(void **state)
{
  (void)state;
  for (int graded = 0; graded < 2; ++graded) {
    Case c = box_case(CELL_QUADRILATERAL, DIAGONAL_RIGHT, 9, 5, 0);
    if (graded) c.grid.grading[0] = 4.0, c.grid.grading[1] = 0.5;
    Grid *grid = make_grid(&c, NULL, NULL);
    for (PetscInt i = 0; i < grid->n_nodes; ++i) {
      const PetscReal *x = grid->x + 2 * i;
      PetscReal xi[2];
      const PetscInt cell = grid_locate(grid, x, -1, xi);
      if (cell < 0) continue;
      for (int d = 0; d < 2; ++d) assert_true(xi[d] == (x[d] == c.grid.max[d] ? 1 : -1));
    }
    CALL(GridDestroy(&grid));
  }
}

static void bounds(void **state)
{
  const Case c = box_case(CELL_TETRAHEDRON, DIAGONAL_RIGHT, 1, 1, 2);
  PetscMPIInt rank;
  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  Grid *grid = make_grid(&c, NULL, NULL);
  const PetscReal *mine = grid->rank_bounds[rank];
  if (grid->n_cells) {
    assert_true(mine[0] == -1.0 && mine[3] == 2.0 && mine[1] == 0.5 && mine[4] == 2.5);
  } else {
    assert_true(mine[0] > mine[3]);
    assert_int_equal(grid->n_nodes, 0);
  }
  CALL(GridDestroy(&grid));
}

static void bad_boxes(void **state)
{
  Case wrong_cell = box_case(CELL_HEXAHEDRON, DIAGONAL_RIGHT, 2, 2, 2),
       none = box_case(CELL_TRIANGLE, DIAGONAL_LEFT, 0, 3, 0);
  Case huge = box_case(CELL_QUADRILATERAL, DIAGONAL_RIGHT, 2000000, 2000000, 0);
  Case *bad[] = {&wrong_cell, &none, &huge};
  (void)state;
  wrong_cell.kinematics = &kinematics_plane_strain;
  for (int k = 0; k < 3; ++k) {
    Diag *diag;
    Grid *grid = NULL;
    PetscInt errors;
    CALL(DiagCreate(&diag));
    CALL(GridCreate(PETSC_COMM_WORLD, bad[k], NULL, NULL, diag, &grid));
    assert_null(grid);
    CALL(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
    assert_int_equal(errors, 1);
    CALL(DiagDestroy(&diag));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(totals_and_volume),
    cmocka_unit_test(ghosts),
    cmocka_unit_test(conforming),
    cmocka_unit_test(sides),
    cmocka_unit_test(location),
    cmocka_unit_test(outside),
    cmocka_unit_test(grading),
    cmocka_unit_test(partition_balance),
    cmocka_unit_test(partition_without_material),
    cmocka_unit_test(selection),
    cmocka_unit_test(selection_by_decimals),
    cmocka_unit_test(lines_belong_to_upper_cells),
    cmocka_unit_test(bounds),
    cmocka_unit_test(bad_boxes),
  };
  return run_grid_tests(argc, argv, tests, sizeof tests / sizeof *tests, NULL, NULL);
}
