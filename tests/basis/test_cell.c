/* Cells: the basis suite on distorted cells, the inverse map, faces and volumes. */
#include "../conformance/basis_suite.h"
#include "cells.h"
#include <string.h>

#define N_CELLS 50
#define N_SAMPLES 10

typedef struct {
  CellType type;
  const PetscReal *x;
} CellContext;

static PetscBool evaluate(const void *context, const PetscReal *point, PetscReal *N, PetscReal *dN)
{
  const CellContext *c = context;
  PetscReal xi[3];
  if (!cell_inverse_map(c->type, c->x, point, xi)) return PETSC_FALSE;
  return cell_gradients(c->type, c->x, xi, N, dN) > 0.0;
}

static void run_suite(Random *random, CellType type)
{
  const PetscInt dim = cells[type].dim;
  PetscReal x[CELL_MAX_NODES * 3], samples[N_SAMPLES * 3], xi[3];
  const CellContext context = {type, x};
  const PetscReal distortion = type == CELL_TRIANGLE || type == CELL_TETRAHEDRON ? 0.0 : 0.2;
  distorted_cell(random, type, distortion, 3.0, x);
  for (PetscInt s = 0; s < N_SAMPLES; ++s) {
    random_inside(random, type, xi);
    sample_position(type, x, xi, samples + s * dim);
  }
  const BasisUnderTest basis = {.name = cells[type].name,
                                .dim = dim,
                                .nodes = cells[type].nodes,
                                .x = x,
                                .n_samples = N_SAMPLES,
                                .sample = samples,
                                .size = 1.0,
                                .tolerance = 1e-13,
                                .difference = 1e-9,
                                .interpolates = PETSC_TRUE,
                                .evaluate = evaluate,
                                .context = &context};
  basis_suite_run(&basis);
}

static void test_suite(void **state)
{
  (void)state;
  Random random = {1};
  for (int type = 0; type < 4; ++type)
    for (int k = 0; k < N_CELLS; ++k) run_suite(&random, (CellType)type);
}

static void test_inverse_map_round_trip(void **state)
{
  (void)state;
  Random random = {2};
  for (int type = 0; type < 4; ++type)
    for (int k = 0; k < 2000; ++k) {
      PetscReal x[CELL_MAX_NODES * 3], xi[3], point[3], found[3];
      distorted_cell(&random, (CellType)type, 0.2, 0.0, x);
      random_inside(&random, (CellType)type, xi);
      sample_position((CellType)type, x, xi, point);
      assert_true(cell_inverse_map((CellType)type, x, point, found));
      for (PetscInt d = 0; d < cells[type].dim; ++d) assert_true(fabs(found[d] - xi[d]) < 1e-12);
    }
}

/* A walk from cell to cell asks for positions outside: parallelograms answer at any distance. */
static void test_inverse_map_outside(void **state)
{
  (void)state;
  Random random = {3};
  for (int type = 0; type < 4; ++type)
    for (int k = 0; k < 500; ++k) {
      PetscReal x[CELL_MAX_NODES * 3], xi[3], point[3], found[3];
      distorted_cell(&random, (CellType)type, 0.0, 0.0, x);
      for (PetscInt d = 0; d < 3; ++d) xi[d] = random_real(&random, -100, 100);
      sample_position((CellType)type, x, xi, point);
      assert_true(cell_inverse_map((CellType)type, x, point, found));
      for (PetscInt d = 0; d < cells[type].dim; ++d) assert_true(fabs(found[d] - xi[d]) < 1e-8);
    }
}

/* A small cell far from the origin keeps the digits that its coordinates hold. */
static void test_inverse_map_far_from_origin(void **state)
{
  (void)state;
  const PetscReal h = 0x1p-10, at = 4096.0;
  const PetscReal x[8] = {at, at, at + h, at, at + 1.25 * h, at + h, at, at + 1.5 * h};
  const PetscReal centre[2] = {at + 0.5625 * h, at + 0.625 * h};
  PetscReal xi[2];
  assert_true(cell_inverse_map(CELL_QUADRILATERAL, x, centre, xi));
  assert_true(fabs(xi[0]) < 1e-14 && fabs(xi[1]) < 1e-14);
}

static void test_inverse_map_refuses(void **state)
{
  (void)state;
  const PetscReal flat[8] = {0, 0, 1, 1, 2, 2, 3, 3}, square[8] = {0, 0, 1, 0, 1, 1, 0, 1};
  const PetscReal point[2] = {0.5, 0.25}, nan[2] = {NAN, 0}, infinite[2] = {0, INFINITY};
  PetscReal xi[2];
  for (int type = 0; type < 2; ++type) {
    assert_false(cell_inverse_map((CellType)type, flat, point, xi));
    assert_false(cell_inverse_map((CellType)type, square, nan, xi));
    assert_false(cell_inverse_map((CellType)type, square, infinite, xi));
  }
}

/* A trapezoid whose sides meet at (0, 2): beyond that point the map folds, and no xi may be made
 * up. */
static void test_inverse_map_beyond_fold(void **state)
{
  (void)state;
  const PetscReal x[8] = {-2, 0, 2, 0, 1, 1, -1, 1};
  PetscReal xi[2], point[2], back[2];
  for (int i = -40; i <= 40; ++i)
    for (int j = -40; j <= 40; ++j) {
      point[0] = 0.1 * i, point[1] = 0.1 * j;
      if (!cell_inverse_map(CELL_QUADRILATERAL, x, point, xi)) {
        assert_true(point[1] > 1.9);
        continue;
      }
      sample_position(CELL_QUADRILATERAL, x, xi, back);
      assert_true(fabs(back[0] - point[0]) < 1e-8 && fabs(back[1] - point[1]) < 1e-8);
    }
}

static void test_outside(void **state)
{
  (void)state;
  const PetscReal centre[4][3] = {{1.0 / 3, 1.0 / 3}, {0, 0}, {0.25, 0.25, 0.25}, {0, 0, 0}};
  const PetscReal depth[4] = {-1.0 / 3, -1, -0.25, -1}, far[3] = {3, 0, 0};
  for (int type = 0; type < 4; ++type) {
    assert_true(fabs(cell_outside((CellType)type, centre[type]) - depth[type]) < 1e-15);
    assert_true(fabs(cell_outside((CellType)type, far) - 2) < 1e-15);
    for (PetscInt a = 0; a < cells[type].nodes; ++a)
      assert_true(cell_outside((CellType)type, cells[type].reference[a]) == 0.0);
  }
}

/* Area vector of a face of the reference cell, outward by the right-hand rule; exact for planar
 * faces. */
static void face_area(CellType type, PetscInt face, PetscReal area[3])
{
  const Cell *cell = &cells[type];
  const PetscReal *a = cell->reference[cell->face[face][0]], *b = cell->reference[cell->face[face][1]];
  if (cell->dim == 2) {
    area[0] = b[1] - a[1], area[1] = a[0] - b[0], area[2] = 0.0;
    return;
  }
  area[0] = area[1] = area[2] = 0.0;
  for (PetscInt k = 2; k < cell->face_nodes; ++k) {
    const PetscReal *p = cell->reference[cell->face[face][k - 1]], *q = cell->reference[cell->face[face][k]];
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, l = (i + 2) % 3;
      area[i] += 0.5 * ((p[j] - a[j]) * (q[l] - a[l]) - (p[l] - a[l]) * (q[j] - a[j]));
    }
  }
}

/* The faces close the cell (their areas sum to zero) and enclose its volume: int x . n = dim V. */
static void test_faces_enclose_the_cell(void **state)
{
  (void)state;
  for (int type = 0; type < 4; ++type) {
    const Cell *cell = &cells[type];
    PetscReal sum[3] = {0}, flux = 0.0;
    for (PetscInt f = 0; f < cell->faces; ++f) {
      PetscReal area[3], reach = 0.0;
      face_area((CellType)type, f, area);
      const PetscReal *node = cell->reference[cell->face[f][0]];
      for (int d = 0; d < 3; ++d) sum[d] += area[d], flux += node[d] * area[d], reach += node[d] * area[d];
      for (PetscInt a = 0; a < cell->nodes; ++a) { /* every node lies on the inner side */
        PetscReal distance = -reach;
        for (int d = 0; d < 3; ++d) distance += cell->reference[a][d] * area[d];
        assert_true(distance < 1e-15);
      }
    }
    for (int d = 0; d < 3; ++d) assert_true(fabs(sum[d]) < 1e-15);
    assert_true(fabs(flux - (PetscReal)cell->dim * cell->reference_volume) < 1e-14);
  }
}

static PetscReal determinant(PetscInt dim, PetscReal f[3][3])
{
  if (dim == 2) return f[0][0] * f[1][1] - f[0][1] * f[1][0];
  return tensor_det(&f[0][0]);
}

/* An affine map scales the volume by its determinant; node order decides the sign. */
static void test_volume(void **state)
{
  (void)state;
  Random random = {4};
  for (int type = 0; type < 4; ++type) {
    const Cell *cell = &cells[type];
    PetscReal f[3][3], x[CELL_MAX_NODES * 3];
    for (int i = 0; i < 9; ++i) f[i / 3][i % 3] = random_real(&random, -1, 1);
    for (PetscInt a = 0; a < cell->nodes; ++a)
      for (PetscInt i = 0; i < cell->dim; ++i) {
        x[a * cell->dim + i] = 5.0;
        for (PetscInt j = 0; j < cell->dim; ++j) x[a * cell->dim + i] += f[i][j] * cell->reference[a][j];
      }
    const PetscReal expected = determinant(cell->dim, f) * cell->reference_volume;
    assert_true(fabs(cell_volume((CellType)type, x) - expected) < 1e-13);
  }
}

/* Distorted: the shoelace formula, and for the hexahedron the finest rule. */
static void test_volume_distorted(void **state)
{
  (void)state;
  Random random = {5};
  PetscReal x[CELL_MAX_NODES * 3], xi[64 * 3], weight[64], N[8], dN[24], shoelace = 0.0, volume = 0.0;
  distorted_cell(&random, CELL_QUADRILATERAL, 0.3, 1.0, x);
  for (int a = 0, b = 1; a < 4; ++a, b = (a + 1) % 4)
    shoelace += 0.5 * (x[2 * a] * x[2 * b + 1] - x[2 * b] * x[2 * a + 1]);
  assert_true(fabs(cell_volume(CELL_QUADRILATERAL, x) - shoelace) < 1e-13);
  distorted_cell(&random, CELL_HEXAHEDRON, 0.3, 1.0, x);
  assert_true(cell_quadrature(CELL_HEXAHEDRON, 64, xi, weight));
  for (int p = 0; p < 64; ++p) volume += weight[p] * cell_gradients(CELL_HEXAHEDRON, x, xi + 3 * p, N, dN);
  assert_true(fabs(cell_volume(CELL_HEXAHEDRON, x) - volume) < 1e-12);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_suite),
    cmocka_unit_test(test_inverse_map_round_trip),
    cmocka_unit_test(test_inverse_map_outside),
    cmocka_unit_test(test_inverse_map_far_from_origin),
    cmocka_unit_test(test_inverse_map_refuses),
    cmocka_unit_test(test_inverse_map_beyond_fold),
    cmocka_unit_test(test_outside),
    cmocka_unit_test(test_faces_enclose_the_cell),
    cmocka_unit_test(test_volume),
    cmocka_unit_test(test_volume_distorted),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
