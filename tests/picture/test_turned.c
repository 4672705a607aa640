/* Bodies of revolution: distances of an image, both sides of a section, and the turned body against
 * what rays through a cylinder meet. */
#include "../output/test_output.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "output/vtk/vtk.h"
#include "picture/scene/scene.h"
#include "picture/raster/distance.h"
#include "picture/revolution/revolution.h"

enum { W = 37, H = 23 };

/* Of two pixels. */
static double between(int i, int k)
{
  const int across = i % W - k % W, up = i / W - k / W;
  return hypot(across, up);
}

/* Against all pairs, of sparse and of dense images, and of one without anything. */
static void test_distances(void **state)
{
  static unsigned char in[W * H];
  static float distance[W * H];
  static int nearest[W * H];
  (void)state;
  for (int share = 0; share <= 100; share += 5) {
    srand((unsigned)share);
    for (int i = 0; i < W * H; ++i) in[i] = share == 5 ? i == 100 : rand() % 100 < share;
    assert_int_equal(DistanceTo(W, H, in, distance, nearest), 0);
    for (int i = 0; i < W * H; ++i) {
      double least = INFINITY;
      for (int k = 0; k < W * H; ++k)
        if (in[k]) least = fmin(least, between(i, k));
      if (isinf(least)) {
        assert_true(isinf(distance[i]) && nearest[i] == -1);
        continue;
      }
      const int k = nearest[i];
      assert_true(fabs((double)distance[i] - least) < 1e-5 && in[k]);
      assert_true(fabs(between(i, k) - least) < 1e-5);
    }
  }
}

/* A hollow cylinder 1 high from radius 0.5 to 1, red with the radius, green all over. What light
 * does to a colour leaves red over green as it is: the radius at which a ray arrives. */
enum { SECTION_W = 240, SECTION_H = 140, IMAGE = 120 };

static void Look(const PetscReal x[3], const PetscReal y[3], const PetscReal z[3], unsigned char *rgba)
{
  static unsigned char section[4 * SECTION_W * SECTION_H];
  const PetscReal pixel = 0.01;
  TurnedScene scene = {.section = section,
                       .section_width = SECTION_W,
                       .section_height = SECTION_H,
                       .section_min = {-1.2, -0.2},
                       .pixel = pixel,
                       .min = {-1.2, -1.2},
                       .max = {1.2, 1.2},
                       .width = IMAGE,
                       .height = IMAGE};
  for (int i = 0; i < SECTION_W * SECTION_H; ++i) {
    const int column = i % SECTION_W, row = i / SECTION_W;
    const PetscReal r = fabs(-1.2 + (column + 0.5) * pixel), h = -0.2 + (row + 0.5) * pixel;
    const PetscBool in = r > 0.5 && r < 1 && h > 0 && h < 1;
    section[4 * i] = (unsigned char)lround(200 * fmin(r, 1.2)), section[4 * i + 1] = 200, section[4 * i + 2] = 0;
    section[4 * i + 3] = in ? 255 : 0;
  }
  for (int d = 0; d < 3; ++d) scene.x[d] = x[d], scene.y[d] = y[d], scene.z[d] = z[d];
  assert_int_equal(TurnedDraw(&scene, rgba), 0);
}

/* At the place (u, v) of the page: the radius that is seen, -1 for nothing; *light: of 1. */
static PetscReal seen(const unsigned char *rgba, PetscReal u, PetscReal v, PetscReal *light)
{
  const int column = (int)((u + 1.2) / 2.4 * IMAGE), row = (int)((v + 1.2) / 2.4 * IMAGE);
  const unsigned char *pixel = rgba + 4 * (row * IMAGE + column);
  if (light) *light = pixel[1] / 200.0;
  assert_true(pixel[3] == 0 || pixel[3] == 255);
  return pixel[3] ? (PetscReal)pixel[0] / pixel[1] : -1;
}

/* From the front, along z: the quarter x > 0, z > 0 is gone, so on the right the section is seen
 * with its hole, through which the inner wall behind; on the left the mantle. */
static void test_seen_from_the_front(void **state)
{
  static unsigned char rgba[4 * IMAGE * IMAGE];
  PetscReal light[3];
  (void)state;
  Look((PetscReal[]){1, 0, 0}, (PetscReal[]){0, 1, 0}, (PetscReal[]){0, 0, 1}, rgba);
  for (PetscReal v = 0.05; v < 0.96; v += 0.1) {
    for (PetscReal u = 0.55; u < 0.96; u += 0.1) assert_true(fabs(seen(rgba, u, v, NULL) - u) < 0.03);
    for (PetscReal u = 0.05; u < 0.46; u += 0.1) assert_true(fabs(seen(rgba, u, v, NULL) - 0.5) < 0.03);
    for (PetscReal u = 0.05; u < 0.96; u += 0.1) assert_true(fabs(seen(rgba, -u, v, NULL) - 1) < 0.03);
    assert_true(seen(rgba, 1.05, v, NULL) < 0 && seen(rgba, -1.05, v, NULL) < 0);
  }
  assert_true(seen(rgba, 0.7, 1.05, NULL) < 0 && seen(rgba, 0.7, -0.05, NULL) < 0);
  /* light comes from the upper left, in front: less of it the more the mantle turns away */
  seen(rgba, -0.35, 0.5, &light[0]), seen(rgba, -0.97, 0.5, &light[1]), seen(rgba, 0.75, 0.5, &light[2]);
  assert_true(light[0] > light[1] + 0.05 && light[0] <= 1 && light[1] > 0.4);
  assert_true(light[2] > 0.9); /* the section keeps its colours */
}

/* From above: the ring without a quarter, every radius in its place, one light all over. */
static void test_seen_from_above(void **state)
{
  static unsigned char rgba[4 * IMAGE * IMAGE];
  PetscReal first = 0, light;
  (void)state;
  Look((PetscReal[]){1, 0, 0}, (PetscReal[]){0, 0, 1}, (PetscReal[]){0, -1, 0}, rgba);
  for (PetscReal u = -1.15; u < 1.16; u += 0.1)
    for (PetscReal v = -1.15; v < 1.16; v += 0.1) { /* z = -v */
      const PetscReal r = hypot(u, v);
      const PetscBool in = r > 0.5 && r < 1 && !(u > 0 && v < 0);
      if (fabs(r - 0.5) < 0.08 || fabs(r - 1) < 0.08 || fabs(u) < 0.06 || fabs(v) < 0.06) continue;
      const PetscReal found = seen(rgba, u, v, &light);
      assert_true(in ? fabs(found - r) < 0.03 : found < 0);
      if (!in) continue;
      if (first == 0) first = light;
      assert_true(fabs(light - first) < 0.02);
    }
  assert_true(first > 0.5);
}

/* Cells of fem, which have no gaps: a ring of radius 0.5 to 1, and nothing beside, above and below
 * it. */
static void test_cells_are_turned(void **state)
{
  PetscReal corner[2][2][3][3] = {{{{0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0.5, 0, 0}, {1, 1, 0}, {0.5, 1, 0}}}},
            value[12] = {0};
  unsigned char side[4] = {0}, *rgba;
  PlotScene scene = {.dim = 3,
                     .n_frames = 1,
                     .up = 1,
                     .high = 1,
                     .revolution = PETSC_TRUE,
                     .mirrored = PETSC_TRUE,
                     .turned = PETSC_TRUE,
                     .box_min = {-1, 0, -1},
                     .box_max = {1, 1, 1}};
  PlotFrame *f = &scene.frames[0];
  PlotPage page;
  (void)state;
  memcpy(corner[1], corner[0], sizeof corner[0]);
  for (int k = 0; k < 6; ++k) corner[1][k / 3][k % 3][0] *= -1;
  f->n_triangles = 4, f->corner = &corner[0][0][0][0], f->corner_value = value, f->side = side;
  plot_lay_out(&scene, 600, 400, &page);
  const size_t n = (size_t)page.w * (size_t)page.h;
  assert_non_null(rgba = calloc(n, 4));
  assert_int_equal(PlotImage(&scene, f, &page, rgba), 0);
  PetscInt full = 0, edge = 0;
  for (size_t i = 0; i < n; ++i) {
    const int column = (int)(i % (size_t)page.w), row = (int)(i / (size_t)page.w);
    full += rgba[4 * i + 3] == 255;
    edge += rgba[4 * i + 3] && (!column || !row || column == page.w - 1 || row == page.h - 1);
  }
  assert_true(full > (PetscInt)n / 5 && full < (PetscInt)(4 * n / 5));
  assert_int_equal(edge, 0);
  free(rgba);
}

/* Of what a file holds both sides are taken, in the plane and in space. */
static void test_both_sides(void **state)
{
  const PetscReal x[] = {0.1, 0, 0, 0.5, 1, 0, 2, 0.5, 0}, u[] = {1, 2, 3};
  const PetscInt cells[] = {0, 1, 2};
  const VtkField field = {"mass", "kg", 1, u};
  const VtkData data = {.n_points = 3,
                        .x = x,
                        .n_point_fields = 1,
                        .point_fields = &field,
                        .n_cells = 1,
                        .connectivity = cells,
                        .nodes_per_cell = 3,
                        .vtk_type = 5};
  const PlotScalar scalar = {.reduction = PLOT_COMPONENT};
  char folder[64], path[128], reason[256];
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/points.hdf", folder);
  assert_int_equal(VtkWrite(PETSC_COMM_WORLD, path, &data, reason), 0);
  for (int turned = 0; turned < 2; ++turned) {
    PlotScene scene = {.revolution = PETSC_TRUE, .mirrored = PETSC_TRUE, .turned = turned, .up = 1};
    const VtkFieldInfo *info;
    VtkFile *file;
    assert_int_equal(VtkReadOpen(path, &file, reason), 0);
    assert_int_equal(vtk_read_fields(file, &info), 1);
    assert_int_equal(PlotFrameRead(file, info, &scalar, &scene, reason), 0);
    const PlotFrame *f = &scene.frames[0];
    assert_int_equal(f->n, 6);
    assert_int_equal(PlotFramesShape(&scene), 0);
    for (int i = 0; i < 3; ++i) {
      assert_true(f->x[3 * i] == x[3 * i] && f->x[3 * i + 9] == -x[3 * i] && f->x[3 * i + 10] == x[3 * i + 1]);
      assert_true(f->value[i] == u[i] && f->value[i + 3] == u[i]);
    }
    assert_int_equal(scene.dim, turned ? 3 : 2);
    assert_true(scene.box_max[0] >= 2 && scene.box_min[0] == -scene.box_max[0]);
    assert_true(!turned || (scene.box_max[2] == scene.box_max[0] && scene.box_min[2] == scene.box_min[0]));
    assert_int_equal(PlotFrameGrid(file, &scene, &scene.frames[0], reason), 0);
    assert_int_equal(f->n_edges, turned ? 0 : 6);
    for (int k = 0; k < 12 && !turned; ++k)
      assert_true(f->edges[12 + k] == (k % 2 ? f->edges[k] : -f->edges[k]) &&
                  f->edges[k] == x[3 * (((k + 2) / 4) % 3) + k % 2]);
    assert_int_equal(VtkReadClose(&file), 0);
    assert_int_equal(PlotFramesFree(&scene), 0);
  }
  TestRemove(folder);
}

static void test_kinds_of_runs(void **state)
{
  static const struct {
    const char *text;
    PetscBool is;
  } cases[] = {{"title: a\nkinematics: axisymmetric\n", PETSC_TRUE},
               {"kinematics: plane-strain\n", PETSC_FALSE},
               {"kinematics: [axisymmetric]\n", PETSC_FALSE},
               {"kinematics:\n", PETSC_FALSE},
               {"bodies: {kinematics: axisymmetric}\n", PETSC_FALSE},
               {"axisymmetric", PETSC_FALSE},
               {"", PETSC_FALSE},
               {"kinematics: axisymmetric\n\x01\xff{", PETSC_FALSE},
               {NULL, PETSC_FALSE}};
  char folder[64], path[128];
  PetscBool is;
  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    TestFolder(folder);
    snprintf(path, sizeof path, "%s/case.yaml", folder);
    FILE *out = cases[k].text ? fopen(path, "w") : NULL;
    if (out) assert_true(fputs(cases[k].text, out) >= 0 && !fclose(out));
    assert_int_equal(PlotIsRevolution(folder, &is), 0);
    if (is != cases[k].is) fail_msg("'%s' is %s axisymmetric", cases[k].text, is ? "" : "not");
    TestRemove(folder);
  }
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_distances),       cmocka_unit_test(test_seen_from_the_front),
                                     cmocka_unit_test(test_seen_from_above), cmocka_unit_test(test_cells_are_turned),
                                     cmocka_unit_test(test_both_sides),      cmocka_unit_test(test_kinds_of_runs)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
