/* Fields without what scatters from point to point, and colours that go over into each other. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "picture/scene/scene.h"

enum { N = 20, POINTS = N * N };

/* A lattice of the unit square in the plane of x and y; index of its point (i, j). */
static void lattice(PetscReal *x)
{
  for (PetscInt k = 0; k < POINTS; ++k) {
    x[3 * k] = (k % N + 0.5) / N;
    x[3 * k + 1] = (k / N + 0.5) / N;
    x[3 * k + 2] = 0;
  }
}

static PetscBool is_inside(PetscInt k)
{
  return (PetscBool)(k % N >= 3 && k % N < N - 3 && k / N >= 3 && k / N < N - 3);
}

/* Away from the border a linear field stays as it is, and what alternates from point to point nearly vanishes; of a
 * vector each component, so that a scatter about rest has no speed left. */
static void LinearStays(void **state)
{
  static PetscReal x[3 * POINTS], data[3 * POINTS];
  (void)state;
  lattice(x);
  for (PetscInt k = 0; k < POINTS; ++k) {
    const PetscReal turn = (k % N + k / N) % 2 ? 1 : -1;
    data[3 * k] = 1 + 2 * x[3 * k] - 3 * x[3 * k + 1];
    data[3 * k + 1] = turn;
    data[3 * k + 2] = -turn;
  }
  assert_int_equal(PlotSmooth(2, POINTS, x, NULL, 3, data), 0);
  for (PetscInt k = 0; k < POINTS; ++k) {
    if (!is_inside(k)) continue;
    assert_true(fabs(data[3 * k] - (1 + 2 * x[3 * k] - 3 * x[3 * k + 1])) < 1e-12);
    assert_true(hypot(data[3 * k + 1], data[3 * k + 2]) < 0.05);
  }
}

/* Two bodies side by side keep what is theirs, and points without a place take no part. */
static void BodiesAndStrays(void **state)
{
  static PetscReal x[3 * POINTS], body[POINTS], data[POINTS];
  (void)state;
  lattice(x);
  for (PetscInt k = 0; k < POINTS; ++k) data[k] = body[k] = k % N < N / 2 ? 0 : 1;
  x[0] = PETSC_MAX_REAL, data[0] = 1e6;
  assert_int_equal(PlotSmooth(2, POINTS, x, body, 1, data), 0);
  for (PetscInt k = 1; k < POINTS; ++k) assert_true(fabs(data[k] - body[k]) < 1e-12);
  assert_true(data[0] == 1e6);
}

/* The blue to green to yellow of two halves: sharp as they are, over the width of the blur with it; what has no value
 * stays grey, and gives nothing to others. */
static void ColoursGoOver(void **state)
{
  enum { W = 100, WIDE = 10 };
  static PetscReal x[3 * POINTS], radius[POINTS], value[POINTS];
  static unsigned char rgba[4 * W * W];
  RasterScene scene = {
    .n = POINTS, .x = x, .radius = radius, .value = value, .max = {1, 1}, .width = W, .height = W, .min = {0, 0}};
  PetscReal low[3], high[3], before = 0;
  (void)state;
  lattice(x);
  palette_colour(0, low), palette_colour(1, high);
  for (PetscInt k = 0; k < POINTS; ++k) radius[k] = 0.75 / N, value[k] = k % N < N / 2 ? 0 : 1;
  for (PetscInt k = 0; k < 2 * N; ++k) value[k] = NAN;
  for (int blurred = 0; blurred < 2; ++blurred) {
    const unsigned char *row = rgba + 4 * (W / 2 * W);
    scene.blur = blurred ? (PetscReal)WIDE / W : 0;
    assert_int_equal(RasterDraw(&scene, rgba), 0);
    for (int i = 0; i < W; ++i) {
      const PetscReal *end = i < W / 2 ? low : high;
      if (!blurred || abs(i - W / 2) > WIDE) assert_true(fabs(row[4 * i] - end[0]) < 1.5);
      if (blurred && i > W / 2) assert_true(row[4 * i] >= before - 1); /* red rises from green to yellow */
      before = row[4 * i];
    }
    assert_in_range(rgba[4 * (2 * W + W / 2)], 159, 161);
    if (blurred) assert_in_range(row[4 * (W / 2) + 1], 130, 180); /* green between */
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(LinearStays), cmocka_unit_test(BodiesAndStrays),
                                     cmocka_unit_test(ColoursGoOver)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
