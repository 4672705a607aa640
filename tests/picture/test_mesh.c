/* Cells as bodies: points find their cells, triangles have the colours of their corners, shapes keep corners. */
#include "../output/test_output.h"
#include <math.h>
#include "picture/raster/raster.h"
#include "picture/raster/spacing.h"
#include "picture/body/cells.h"

/* n x n (x n) sheared cells of the unit square (cube). */
static void Cells(PetscInt dim, PetscInt n, PetscReal *x, VtkCells *cells)
{
  const PetscInt m = n + 1;
  PetscInt c = 0;
  for (PetscInt k = 0; k < (dim == 3 ? m : 1); ++k)
    for (PetscInt j = 0; j < m; ++j)
      for (PetscInt i = 0; i < m; ++i) {
        PetscReal *at = x + 3 * (i + m * (j + m * k));
        at[1] = (PetscReal)j / n, at[2] = (PetscReal)k / n, at[0] = (PetscReal)i / n + 0.7 * at[1] - 0.2 * at[2];
      }
  PetscCallAbort(PETSC_COMM_SELF,
                 PetscMalloc3(n * n * n + 1, &cells->start, 8 * n * n * n, &cells->node, n * n * n, &cells->type));
  cells->start[0] = 0;
  for (PetscInt k = 0; k < (dim == 3 ? n : 1); ++k)
    for (PetscInt j = 0; j < n; ++j)
      for (PetscInt i = 0; i < n; ++i, ++c) {
        const PetscInt a = i + m * (j + m * k), of[8] = {a, a + 1, a + 1 + m, a + m};
        for (PetscInt q = 0; q < (dim == 3 ? 8 : 4); ++q)
          cells->node[cells->start[c] + q] = q < 4 ? of[q] : of[q - 4] + m * m;
        cells->start[c + 1] = cells->start[c] + (dim == 3 ? 8 : 4);
        cells->type[c] = dim == 3 ? 12 : 9;
      }
  cells->n = c;
}

static void test_points_in_cells(void **state)
{
  enum { N = 7 };
  static PetscReal node[3 * 512], x[3 * 3000];
  static PetscInt cell[3000], expected[3000];
  (void)state;
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    VtkCells cells;
    PetscInt n = 0;
    Cells(dim, N, node, &cells);
    for (PetscInt c = 0; c < cells.n; ++c) /* places near all corners and the middle of each cell */
      for (int q = 0; q < 5; ++q, ++n) {
        const PetscReal a[3] = {q == 4  ? 0.5
                                : q & 1 ? 0.98
                                        : 0.02,
                                q == 4  ? 0.5
                                : q & 2 ? 0.98
                                        : 0.02,
                                dim == 2 ? 0
                                : q & 1  ? 0.03
                                         : 0.9};
        const PetscInt at[3] = {c % N, c / N % N, c / N / N};
        for (int d = 1; d < 3; ++d) x[3 * n + d] = (d < dim ? (PetscReal)at[d] + a[d] : 0) / N;
        x[3 * n] = ((PetscReal)at[0] + a[0]) / N + 0.7 * x[3 * n + 1] - 0.2 * x[3 * n + 2];
        expected[n] = c;
      }
    assert_int_equal(CellsOfPoints(&cells, node, dim, n, x, cell), 0);
    for (PetscInt i = 0; i < n; ++i) assert_int_equal(cell[i], expected[i]);
    assert_int_equal(VtkCellsFree(&cells), 0);
  }
}

/* One triangle over half of the picture: covered there, with the colours of its linear values, lit in space. */
static void test_triangle(void **state)
{
  enum { W = 60 };
  const PetscReal corner[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, value[3] = {0, 1, 0};
  const unsigned char side = 4; /* from (0, 1) to (0, 0) */
  static unsigned char rgba[4 * W * W], lined[4 * W * W];
  RasterScene scene = {
    .n_triangles = 1, .corner = corner, .corner_value = value, .max = {1, 1}, .width = W, .height = W};
  (void)state;
  assert_int_equal(RasterDraw(&scene, rgba), 0);
  scene.side = &side;
  assert_int_equal(RasterDraw(&scene, lined), 0);
  for (int row = 0; row < W; ++row)
    for (int column = 0; column < W; ++column) {
      const unsigned char *p = rgba + 4 * (row * W + column), *l = lined + 4 * (row * W + column);
      PetscReal rgb[3];
      palette_colour((column + 0.5) / W, rgb);
      if (row + column > W) assert_int_equal(p[3], 0);
      if (row + column > W - 3) continue;
      assert_int_equal(p[3], 255);
      for (int c = 0; c < 3; ++c) assert_true(fabs(p[c] - rgb[c]) < 3);
      if (column > 1) assert_memory_equal(p, l, 4);
      if (column == 0) assert_true(l[2] < 0.9 * p[2]);
    }
}

/* A square of 2 x 2 Gauss points per cell is drawn with its own edges and corners. */
static void test_shape_of_a_square(void **state)
{
  enum { N = 16, W = 320 };
  static PetscReal x[3 * 4 * N * N], radius[4 * N * N], value[4 * N * N];
  static unsigned char rgba[4 * W * W];
  const PetscReal g = 0.5 / sqrt(3.);
  PetscInt n = 0;
  PetscReal area = 0;
  (void)state;
  for (int c = 0; c < N * N; ++c)
    for (int q = 0; q < 4; ++q, ++n) {
      x[3 * n] = (c % N + 0.5 + (q & 1 ? g : -g)) / N;
      x[3 * n + 1] = (c / N + 0.5 + (q & 2 ? g : -g)) / N;
    }
  assert_int_equal(PlotSpacing(2, n, x, radius), 0);
  RasterScene scene = {
    .n = n, .x = x, .radius = radius, .value = value, .min = {-0.3, -0.3}, .max = {1.3, 1.3}, .width = W, .height = W};
  for (int k = 0; k < 2; ++k) {
    scene.gap = (k ? 0.5 : 2) * radius[n / 2];
    assert_int_equal(RasterDraw(&scene, rgba), 0);
    area = 0;
    for (int i = 0; i < W * W; ++i) area += rgba[4 * i + 3] / 255. * (1.6 / W) * (1.6 / W);
    assert_true(fabs(area - 1) < 0.02); /* 1.11 as balls */
    for (int i = 62; i < 258; ++i) assert_int_equal(rgba[4 * (62 * W + i) + 3], 255);
    for (int i = 0; i < W; ++i) assert_int_equal(rgba[4 * (57 * W + i) + 3], 0);
  }
}

/* Of two parts, one on the other, the corner between them stays empty, which as one body is filled, and there is a line
 * where they meet. */
static void test_parts(void **state)
{
  enum { N = 8, W = 300, MOST = 3 * 4 * N * N };
  static PetscReal x[3 * MOST], radius[MOST], value[MOST];
  static unsigned char rgba[4 * W * W], part[MOST];
  const PetscReal g = 0.5 / sqrt(3.), corner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  PetscInt n = 0;
  (void)state;
  for (int square = 0; square < 3; ++square)
    for (int c = 0; c < N * N; ++c)
      for (int q = 0; q < 4; ++q, ++n) {
        x[3 * n] = corner[square][0] + (c % N + 0.5 + (q & 1 ? g : -g)) / N;
        x[3 * n + 1] = corner[square][1] + (c / N + 0.5 + (q & 2 ? g : -g)) / N;
        part[n] = square == 2;
      }
  assert_int_equal(PlotSpacing(2, n, x, radius), 0);
  RasterScene scene = {.n = n,
                       .x = x,
                       .radius = radius,
                       .value = value,
                       .gap = 2 * radius[n / 2],
                       .part = part,
                       .min = {-0.5, -0.5},
                       .max = {2.5, 2.5},
                       .width = W,
                       .height = W};
  for (int parts = 0; parts <= 2; parts += 2) {
    PetscReal area = 0;
    scene.n_parts = parts;
    assert_int_equal(RasterDraw(&scene, rgba), 0);
    for (int i = 0; i < W * W; ++i) area += rgba[4 * i + 3] / 255. * 1e-4;
    assert_int_equal(rgba[4 * (153 * W + 153) + 3], parts ? 0 : 255);
    assert_true(fabs(area - 3) < (parts ? 0.03 : 0.06));
    PetscInt line = 0; /* where they meet: y = 1 is between rows 149 and 150 */
    for (int row = 145; row < 155; ++row) line += rgba[4 * (row * W + 100) + 1] > 20;
    assert_int_equal(line > 0, parts > 0);
  }
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_points_in_cells), cmocka_unit_test(test_triangle),
                                     cmocka_unit_test(test_shape_of_a_square), cmocka_unit_test(test_parts)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
