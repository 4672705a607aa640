/* Terrain: what its files say, and what lies below it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "case/case.h"
#include "case/terrain/relief.h"

static char file[] = "/tmp/talus_relief_XXXXXX";
static char message[1024];

static int open_file(void **state)
{
  (void)state;
  const int fd = mkstemp(file);
  return fd < 0 || close(fd);
}

static int remove_file(void **state)
{
  (void)state;
  return unlink(file);
}

static Relief *read_text(const char *text, PetscReal scale, const PetscReal offset[3])
{
  Relief *relief;
  FILE *out = fopen(file, "wb");
  assert_non_null(out);
  assert_true(fputs(text, out) >= 0 && fclose(out) == 0);
  assert_int_equal(ReliefRead(file, scale, offset, &relief, sizeof message, message), 0);
  return relief;
}

/* Rows go from north to south; corners are half a cell off the first post. */
static void Reads(void **state)
{
  static const char *const heads[] = {"xllcorner 995\nyllcorner 1995\n", "XLLCENTER 1000\nYLLCENTER 2000\n"};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    char text[512];
    PetscReal min[3], max[3];
    snprintf(text, sizeof text, "ncols 3\r\nnrows 2\r\n%scellsize 10\nNODATA_value -9999\n4 5 6\n1 2 -9999\n",
             heads[k]);
    Relief *r = read_text(text, 0.1, (const PetscReal[]){-100, -200, 7});
    assert_non_null(r);
    assert_true(r->n[0] == 3 && r->n[1] == 2);
    assert_true(fabs(r->low[0]) < 1e-12 && fabs(r->low[1]) < 1e-12 && fabs(r->step - 1) < 1e-15);
    assert_true(fabs(relief_post(r, 0, 0) - 7.1) < 1e-14 && fabs(relief_post(r, 2, 1) - 7.6) < 1e-14);
    assert_true(isnan(relief_post(r, 2, 0)));
    relief_bounds(r, min, max);
    assert_true(fabs(max[0] - 2) < 1e-12 && fabs(max[1] - 1) < 1e-12 && fabs(max[2] - 7.6) < 1e-12);
    assert_true(min[2] < 7.1 - 2.9);
    assert_int_equal(ReliefDestroy(&r), 0);
  }
}

/* A plane is met everywhere, with a tolerance across it; beyond its posts there is nothing. */
static void Plane(void **state)
{
  const PetscReal zero[3] = {0, 0, 0}, slope[2] = {0.5, -0.25}, across = sqrt(1 + 0.25 + 0.0625);
  char text[4096];
  int at = snprintf(text, sizeof text, "ncols 9\nnrows 7\nxllcenter 0\nyllcenter 0\ncellsize 0.5\n");
  (void)state;
  for (int j = 6; j >= 0; --j)
    for (int i = 0; i < 9; ++i)
      at += snprintf(text + at, sizeof text - (size_t)at, "%.17g ", 1 + slope[0] * 0.5 * i + slope[1] * 0.5 * j);
  Relief *r = read_text(text, 1, zero);
  assert_non_null(r);
  const Shape s = {.kind = SHAPE_TERRAIN, .relief = r};
  for (int k = 0; k < 2000; ++k) {
    PetscReal x[3] = {4.0 * (k * 0.6180339887 - floor(k * 0.6180339887)), 3.0 * (k % 101) / 101.0, 0};
    const PetscReal surface = 1 + slope[0] * x[0] + slope[1] * x[1];
    for (int t = -1; t <= 1; ++t) {
      x[2] = surface + 0.1 * t * across - 1e-9;
      assert_true(shape_contains(&s, 3, x, 0.1 * t));
      x[2] += 2e-9;
      assert_false(shape_contains(&s, 3, x, 0.1 * t));
    }
  }
  assert_false(shape_contains(&s, 3, (const PetscReal[]){-0.01, 1, -1}, 1e-6));
  assert_true(shape_contains(&s, 3, (const PetscReal[]){-0.01, 1, -1}, 0.02));
  assert_false(shape_contains(&s, 3, (const PetscReal[]){1, 3.01, -1}, 1e-6));
  assert_int_equal(ReliefDestroy(&r), 0);
}

/* nan is no height, whatever the head says of it. */
static void NotANumber(void **state)
{
  static const char *const heads[] = {"", "nodata_value nan\n", "nodata_value -9\n"};
  const PetscReal zero[3] = {0, 0, 0};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    char text[256];
    snprintf(text, sizeof text, "ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n%s1 2 3\n4 5 nan\n", heads[k]);
    Relief *r = read_text(text, 1, zero);
    assert_non_null(r);
    assert_true(isnan(relief_post(r, 2, 0)) && relief_post(r, 1, 0) == 5);
    assert_int_equal(ReliefDestroy(&r), 0);
    snprintf(text, sizeof text, "ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n%sNaN 2 3\n4 5 6\n", heads[k]);
    r = read_text(text, 1, zero);
    assert_non_null(r);
    assert_true(isnan(relief_post(r, 0, 1)) && relief_post(r, 1, 1) == 2);
    assert_int_equal(ReliefDestroy(&r), 0);
  }
}

/* Two triangles a square: along the diagonal from the lower left the mean of its ends. */
static void Fold(void **state)
{
  const PetscReal zero[3] = {0, 0, 0};
  Relief *r = read_text("ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n0 2\n0 0\n", 1, zero);
  (void)state;
  assert_non_null(r);
  assert_true(relief_contains(r, (const PetscReal[]){0.5, 0.5, 0.999}, 0));
  assert_false(relief_contains(r, (const PetscReal[]){0.5, 0.5, 1.001}, 0));
  assert_true(relief_contains(r, (const PetscReal[]){0.75, 0.25, 0.499}, 0));
  assert_false(relief_contains(r, (const PetscReal[]){0.75, 0.25, 0.501}, 0));
  assert_true(relief_contains(r, (const PetscReal[]){0.25, 0.75, 0.499}, 0));
  assert_int_equal(ReliefDestroy(&r), 0);
}

static void NoHeight(void **state)
{
  const PetscReal zero[3] = {0, 0, 0};
  Relief *r =
    read_text("ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\nnodata_value -1\n1 1 1\n1 1 -1\n", 1, zero);
  (void)state;
  assert_non_null(r);
  assert_true(relief_contains(r, (const PetscReal[]){0.5, 0.5, 0}, 0));
  assert_true(relief_contains(r, (const PetscReal[]){1.25, 0.75, 0}, 0));
  assert_false(relief_contains(r, (const PetscReal[]){1.75, 0.25, 0}, 0));
  assert_int_equal(ReliefDestroy(&r), 0);
}

/* The box around what lies between two surfaces. */
static void Between(void **state)
{
  const PetscReal zero[3] = {0, 0, 0};
  PetscReal min[3], max[3];
  Relief *bed =
    read_text("ncols 4\nnrows 3\nxllcenter 0\nyllcenter 0\ncellsize 1\n3 2 1 0\n3 2 1 0\n3 2 1 0\n", 1, zero);
  Relief *top = read_text(
    "ncols 4\nnrows 3\nxllcenter 0\nyllcenter 0\ncellsize 1\nnodata_value -9\n"
    "-9 -9 -9 -9\n4 3 -9 -9\n4 3 -9 -9\n",
    1, zero);
  Shape parts[2] = {{.kind = SHAPE_TERRAIN, .relief = top}, {.kind = SHAPE_TERRAIN, .relief = bed}};
  const Shape s = {.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = parts};
  (void)state;
  assert_true(bed && top);
  shape_bounds(&s, 3, min, max);
  assert_true(min[0] == 0 && max[0] == 1 && min[1] == 0 && max[1] == 1 && max[2] == 4);
  assert_true(min[2] >= 1 && min[2] <= 2);
  assert_true(shape_contains(&s, 3, (const PetscReal[]){0.5, 0.5, 3}, 1e-9));
  assert_false(shape_contains(&s, 3, (const PetscReal[]){0.5, 0.5, 2.4}, 1e-9));
  assert_false(shape_contains(&s, 3, (const PetscReal[]){2.5, 0.5, 0}, 1e-9));
  assert_int_equal(ReliefDestroy(&bed), 0);
  assert_int_equal(ReliefDestroy(&top), 0);
}

/* Of what is left of terrain, a mountain elsewhere is no part: the box ends as high as the ground within it, which has
 * its highest place at a corner, on the side of a square or on its diagonal. */
static void LeftOf(void **state)
{
  static const struct {
    PetscReal min[3], max[3], top, foot;
  } cut[] = {{{0, 0, 0}, {3, 3, 100}, 1, 0.5},
             {{0, 0, -3}, {5, 4, 100}, 3, 0.5}, /* a quarter of the way up */
             {{0, 0, 0}, {0.5, 0.5, 0.75}, 0.75, 0.5},
             {{9, 9, 0}, {10, 10, 10}, 10, 0}}; /* where there is none its bounds stay */
  const PetscReal zero[3] = {0, 0, 0};
  PetscReal min[3], max[3];
  Relief *top = read_text("ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 4\n1 1 9\n1 1 9\n", 1, zero);
  Relief *bed = read_text("ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 4\n.5 .5 8\n.5 .5 8\n", 1, zero);
  Relief *fold = read_text("ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n0 2\n0 -9\n", 1, zero);
  (void)state;
  assert_true(top && bed && fold);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(cut); ++k) {
    Shape parts[2] = {{.kind = SHAPE_TERRAIN, .relief = top}, {.kind = SHAPE_BOX}};
    Shape layer[2] = {{.kind = SHAPE_INTERSECTION, .n_children = 2, .children = parts},
                      {.kind = SHAPE_TERRAIN, .relief = bed}};
    const Shape left = {.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = layer};
    for (int d = 0; d < 3; ++d) parts[1].min[d] = cut[k].min[d], parts[1].max[d] = cut[k].max[d];
    shape_bounds(layer, 3, min, max);
    if (k < 3 && (min[2] != cut[k].min[2] || fabs(max[2] - cut[k].top) > 1e-14))
      fail_msg("%d: [%g, %g]", (int)k, min[2], max[2]);
    shape_bounds(&left, 3, min, max);
    if (k < 3 && (fabs(min[2] - cut[k].foot) > 1e-14 || fabs(max[2] - cut[k].top) > 1e-14))
      fail_msg("%d, on its bed: [%g, %g]", (int)k, min[2], max[2]);
  }
  /* up its diagonal from 0 to 2, and down from there to -9 */
  assert_true(fabs(relief_highest(fold, (const PetscReal[]){0.2, 0}, (const PetscReal[]){0.6, 1}) - 1.2) < 1e-14);
  assert_true(fabs(relief_highest(fold, (const PetscReal[]){0.7, 0}, (const PetscReal[]){0.8, 0.5}) + 0.8) < 1e-14);
  assert_int_equal(ReliefDestroy(&fold), 0);
  assert_int_equal(ReliefDestroy(&bed), 0);
  assert_int_equal(ReliefDestroy(&top), 0);
}

static void Mistakes(void **state)
{
  static const struct {
    const char *text, *says;
  } bad[] = {
    {"solid cube\n", ":1: unknown word 'solid'"},
    {"ncols 3\nnrows 2\ncellsize 1\n", "'xllcorner' is missing"},
    {"ncols 3\nnrows two\n", ":2: nrows is a number, not 'two'"},
    {"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 x\n", ":7: a height is a number, not 'x'"},
    {"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3\n", ":8: the file ends where a height should be"},
    {"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4 5\n", "more than the 2 x 2 heights"},
    {"ncols 2000\nnrows 2000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n", "too short for 2000 columns"},
    {"ncols 1\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n", "1 columns"},
    {"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value 1\n1 1 1 1\n", "no post has a height"},
    {"ncols nan\n", ":1: ncols is a number, not nan"},
    {"", "'ncols' is missing"},
  };
  const PetscReal zero[3] = {0, 0, 0};
  Relief *relief;
  (void)state;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(bad); ++k) {
    assert_null(read_text(bad[k].text, 1, zero));
    if (!strstr(message, bad[k].says)) fail_msg("'%s' does not say '%s'", message, bad[k].says);
  }
  assert_int_equal(ReliefRead("/nowhere.asc", 1, zero, &relief, sizeof message, message), 0);
  assert_true(!relief && strstr(message, "/nowhere.asc: No such file"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(Reads),      cmocka_unit_test(Plane),   cmocka_unit_test(Fold),   cmocka_unit_test(NoHeight),
    cmocka_unit_test(NotANumber), cmocka_unit_test(Between), cmocka_unit_test(LeftOf), cmocka_unit_test(Mistakes)};
  return cmocka_run_group_tests(tests, open_file, remove_file);
}
