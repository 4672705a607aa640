/* Pictures: points fill their body, colours mean their values, and gnuplot makes a PNG of it, or
 * says why not. */
#include "../output/test_output.h"
#include <math.h>
#include <sys/stat.h>
#include "picture/figure.h"
#include "picture/label.h"
#include "picture/plot.h"
#include "picture/ticks.h"
#include "picture/scene/field.h"
#include "picture/raster/raster.h"
#include "picture/raster/spacing.h"
#include "picture/scene/scene.h"
#include "output/directory/run_dir.h"
#include "output/vtk/vtk.h"

/* Points at 2 x 2 Gauss points of n x n cells in the unit square, or 2 x 2 x 2 in the unit cube. */
static PetscInt GaussPoints(PetscInt dim, PetscInt n, PetscReal *x)
{
  const PetscReal h = 1.0 / n, g = 0.5 / sqrt(3.0);
  PetscInt count = 0;
  for (PetscInt c = 0; c < (dim == 3 ? n : 1); ++c)
    for (PetscInt b = 0; b < n; ++b)
      for (PetscInt a = 0; a < n; ++a)
        for (PetscInt k = 0; k < (dim == 3 ? 8 : 4); ++k, ++count) {
          x[3 * count] = h * (a + 0.5 + (k & 1 ? g : -g));
          x[3 * count + 1] = h * (b + 0.5 + (k & 2 ? g : -g));
          x[3 * count + 2] = dim == 3 ? h * (c + 0.5 + (k & 4 ? g : -g)) : 0;
        }
  return count;
}

static void test_spacing(void **state)
{
  static PetscReal x[3 * 8000], radius[8000];
  (void)state;
  PetscInt n = GaussPoints(2, 20, x);
  assert_int_equal(PlotSpacing(2, n, x, radius), 0);
  for (PetscInt i = 0; i < n; ++i) /* half the diagonal of the gap; more in corners */
    assert_true(radius[i] > 0.408 / 20 && radius[i] < 0.6 / 20);
  n = GaussPoints(3, 8, x);
  assert_int_equal(PlotSpacing(3, n, x, radius), 0);
  for (PetscInt i = 0; i < n; ++i) assert_true(radius[i] > 0.4 / 8 && radius[i] < 0.7 / 8);
  for (n = 0; n <= 3; ++n) { /* a handful of points, some in the same place, is no reason to fail */
    x[0] = x[1] = x[3] = x[4] = 1, x[6] = x[7] = 2;
    assert_int_equal(PlotSpacing(2, n, x, radius), 0);
    for (PetscInt i = 0; i < n; ++i) assert_true(radius[i] > 0 && radius[i] < 10);
  }
}

/* A share of the numbers, also where half a million of them are equal, as in a lattice. */
static void test_quantile(void **state)
{
  enum { N = 500000 };
  static PetscReal values[N];
  const PetscReal few[] = {3, 1, 2, 5, 4};
  PetscReal q;
  (void)state;
  assert_int_equal(PlotQuantile(5, few, 0.5, &q), 0);
  assert_true(q == 3);
  assert_int_equal(PlotQuantile(5, few, 1, &q), 0);
  assert_true(q == 5);
  for (PetscInt i = 0; i < N; ++i) values[i] = i % 1000 ? 1 : 2;
  assert_int_equal(PlotQuantile(N, values, 0.5, &q), 0);
  assert_true(q == 1);
}

/* The square is filled, all else is empty, and each place has the colour of its value (which is
 * x). */
static void test_raster(void **state)
{
  enum { W = 120, H = 100 };
  static PetscReal x[3 * 1600], radius[1600], value[1600];
  static unsigned char rgba[4 * W * H];
  (void)state;
  const PetscInt n = GaussPoints(2, 20, x);
  assert_int_equal(PlotSpacing(2, n, x, radius), 0);
  for (PetscInt i = 0; i < n; ++i) value[i] = x[3 * i];
  const RasterScene scene = {
    .n = n, .x = x, .radius = radius, .value = value, .min = {-0.1, 0}, .max = {1.1, 1}, .width = W, .height = H};
  assert_int_equal(RasterDraw(&scene, rgba), 0);
  for (int row = 2; row < H - 2; ++row)
    for (int column = 0; column < W; ++column) {
      const unsigned char *pixel = rgba + 4 * (row * W + column);
      PetscReal rgb[3];
      if (column < 8 || column >= W - 8) assert_int_equal(pixel[3], 0);
      if (column < 12 || column >= W - 12) continue;
      assert_int_equal(pixel[3], 255);
      palette_colour((column + 0.5) / 100 - 0.1, rgb);
      for (int c = 0; c < 3; ++c) assert_true(fabs(pixel[c] - rgb[c]) < 12);
    }
}

/* What is nearer to the eye hides what is behind, whichever comes first. */
static void test_raster_depth(void **state)
{
  const PetscReal x[] = {0, 0, 1, 0, 0, 0}, y[] = {0, 0, 0, 0, 0, 1}, radius[] = {0.5, 0.5}, value[] = {0, 1};
  unsigned char rgba[4 * 25];
  (void)state;
  RasterScene scene = {
    .n = 2, .x = x, .radius = radius, .value = value, .min = {-1, -1}, .max = {1, 1}, .width = 5, .height = 5};
  assert_int_equal(RasterDraw(&scene, rgba), 0);
  assert_true(rgba[4 * 12] == 68 && rgba[4 * 12 + 3] == 255);
  scene.x = y;
  assert_int_equal(RasterDraw(&scene, rgba), 0);
  assert_int_equal(rgba[4 * 12], 253);
}

/* Balls of a lattice in planes that are turned to the eye make planes, without bumps: one light everywhere, that of the
 * plane, and a straight edge. */
static void test_raster_planes(void **state)
{
  enum { W = 200, H = 200, N = 24 };
  static unsigned char rgba[4 * W * H];
  static PetscReal x[3 * N * N], radius[N * N], value[N * N];
  const PetscReal slope[2][2] = {{0.6, -0.3}, {-0.8, 0.5}};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    const PetscReal *s = slope[k], length = sqrt(1 + s[0] * s[0] + s[1] * s[1]);
    const PetscReal light = 0.72 + 0.28 * PetscMax((0.35 * s[0] - 0.50 * s[1] + 0.79) / length, 0);
    for (int i = 0; i < N * N; ++i) {
      PetscReal *at = x + 3 * i;
      at[0] = 0.05 * (i % N) - 0.575, at[1] = 0.05 * (i / N) - 0.575, at[2] = s[0] * at[0] + s[1] * at[1];
      radius[i] = 0.05, value[i] = 1;
    }
    const RasterScene scene = {.n = N * N,
                               .x = x,
                               .radius = radius,
                               .value = value,
                               .shaded = PETSC_TRUE,
                               .gap = 0.05,
                               .min = {-1, -1},
                               .max = {1, 1},
                               .width = W,
                               .height = H};
    assert_int_equal(RasterDraw(&scene, rgba), 0);
    for (int row = 60; row < 140; ++row)
      for (int column = 60; column < 140; ++column) assert_true(fabs(rgba[4 * (row * W + column)] - 253 * light) < 4);
    for (int row = 60; row < 140; ++row) { /* half a radius beyond the last balls */
      PetscReal wide = 0;
      for (int column = 0; column < W; ++column) wide += rgba[4 * (row * W + column) + 3] / 255. * 2 / W;
      assert_true(fabs(wide - 1.2) < 0.012);
    }
  }
}

/* Two columns of balls, 0.1 in radius, with 0.4 between them: the gap is filled from both sides, and the outline is
 * drawn back by half a radius, with sharp corners. */
static void test_raster_gap(void **state)
{
  enum { W = 100, H = 100 };
  static unsigned char rgba[4 * W * H], plain[4 * W * H];
  static PetscReal x[3 * 40], radius[40], value[40];
  (void)state;
  for (int i = 0; i < 40; ++i) {
    x[3 * i] = i < 20 ? 0.2 : 0.8;
    x[3 * i + 1] = 0.025 + 0.05 * (i % 20);
    radius[i] = 0.1;
    value[i] = i < 20 ? 0 : 1;
  }
  RasterScene scene = {
    .n = 40, .x = x, .radius = radius, .value = value, .min = {0, 0}, .max = {1, 1}, .width = W, .height = H};
  assert_int_equal(RasterDraw(&scene, plain), 0);
  scene.gap = 0.25;
  assert_int_equal(RasterDraw(&scene, rgba), 0);
  for (int column = 2; column < W - 2; ++column) {
    const unsigned char *before = plain + 4 * (50 * W + column), *after = rgba + 4 * (50 * W + column);
    const int body = column > 15 && column < 84;
    if (column > 30 && column < 69) assert_int_equal(before[3], 0);
    if (abs(column - 15) > 1 && abs(column - 84) > 1) assert_int_equal(after[3], body ? 255 : 0);
    if (body && column > 17 && column < 82) assert_int_equal(after[0], column < 50 ? 68 : 253);
  }
  scene.gap = 0.15; /* too little to close it */
  assert_int_equal(RasterDraw(&scene, rgba), 0);
  assert_int_equal(rgba[4 * (50 * W + 50) + 3], 0);
}

static void test_scalars(void **state)
{
  const PetscReal stress[6] = {3, 0, 0, 0, 0, 2}, vector[3] = {2, 3, 6};
  PlotScalar scalar;
  Diag *diag;
  (void)state;
  assert_int_equal(DiagCreate(&diag), 0);
  assert_true(plot_scalar_choose("stress", 6, NULL, diag, &scalar));
  assert_true(fabs(plot_scalar_value(&scalar, 6, stress) - sqrt(9 + 12.0)) < 1e-14);
  assert_true(plot_scalar_choose("stress", 6, "zx", diag, &scalar) && plot_scalar_value(&scalar, 6, stress) == 2);
  assert_true(plot_scalar_choose("stress", 6, "mean", diag, &scalar) && plot_scalar_value(&scalar, 6, stress) == 1);
  assert_true(plot_scalar_choose("velocity", 3, NULL, diag, &scalar) && plot_scalar_value(&scalar, 3, vector) == 7);
  assert_true(plot_scalar_choose("velocity", 3, "y", diag, &scalar) && plot_scalar_value(&scalar, 3, vector) == 3);
  assert_true(plot_scalar_choose("velocity", 3, "2", diag, &scalar) && plot_scalar_value(&scalar, 3, vector) == 6);
  assert_true(plot_scalar_choose("mass", 1, NULL, diag, &scalar) && plot_scalar_value(&scalar, 1, vector) == 2);
  assert_true(plot_scalar_choose("strain", 6, NULL, diag, &scalar)); /* 2/3 e:e = 2/3 (4 + 1 + 1 + 8) */
  assert_string_equal(scalar.name, "deviatoric");
  assert_true(fabs(plot_scalar_value(&scalar, 6, stress) - sqrt(2. / 3 * 14)) < 1e-14);
  assert_int_equal(diag_errors(diag), 0);
  assert_false(plot_scalar_choose("velocity", 3, "mises", diag, &scalar));
  assert_false(plot_scalar_choose("velocity", 3, "3", diag, &scalar));
  assert_int_equal(diag_errors(diag), 2);
  assert_int_equal(DiagDestroy(&diag), 0);
}

/* Two states, of which the second is ten times as fast: so are its arrows, and the longest is as long as suits it. */
static void test_arrows(void **state)
{
  const PetscReal x[6] = {0, 0, 0, 1, 0, 0}, v[6] = {0, 1, 0, 0, 2, 0}, fast[6] = {0, 10, 0, 0, 20, 0};
  PlotOptions options = {0};
  PlotScene scene = {.n_frames = 2};
  PlotFrame *slow = scene.frames, *second = scene.frames + 1;
  (void)state;
  assert_int_equal(PlotFrameArrows(2, x, 3, v, slow), 0);
  assert_int_equal(PlotFrameArrows(2, x, 3, fast, second), 0);
  plot_scale_arrows(&scene, &options);
  assert_true(slow->n_arrows == 2 && second->n_arrows == 2 && scene.arrow_most == 20);
  for (int k = 0; k < 2; ++k) assert_true(fabs(10 * slow->arrow[4 * k + 3] - second->arrow[4 * k + 3]) < 1e-14);
  assert_true(fabs(second->arrow[7] - second->reach) < 1e-14);
  plot_choose_colours(&scene, &options, "m/s", "velocity");
  assert_non_null(strstr(scene.label, "velocity [m/s], longest arrow 20 m/s"));
  PetscFree(slow->arrow);
  PetscFree(second->arrow);
}

static void test_units(void **state)
{
  char unit[64];
  (void)state;
  assert_true(fabs(2.5e7 * figure_unit("Pa", 2.5e7, unit) - 25) < 1e-9);
  assert_string_equal(unit, "MPa");
  assert_true(fabs(2e-4 * figure_unit("m", 2e-4, unit) - 200) < 1e-9);
  assert_string_equal(unit, "µm");
  assert_true(figure_unit("m", 0.5, unit) == 1 && !strcmp(unit, "m"));
  assert_true(figure_unit("kg", 1e9, unit) == 1 && !strcmp(unit, "kg"));
  assert_true(figure_unit("m", 0, unit) == 1 && figure_unit("Pa", INFINITY, unit) == 1);
}

/* In place of gnuplot, into a file `text`: one that draws with letters, and one that keeps what it is told. */
#define LETTERS \
  "sed \"s,^set terminal.*,set terminal dumb 100 30,; s,^set output.*,set output '$folder/text',\" | gnuplot -d -"
#define SCRIPT "cat >\"$folder/text\""

static void OtherGnuplot(const char *folder, const char *paths, const char *command)
{
  char path[128];
  snprintf(path, sizeof path, "%s/gnuplot", folder);
  FILE *out = fopen(path, "w");
  assert_non_null(out);
  fprintf(out, "#!/bin/sh\nPATH='%s'\n", paths);
  fprintf(out, "folder='%s'\n%s\n", folder, command);
  fclose(out);
  assert_int_equal(chmod(path, 0700), 0);
}

/* The figure as such a gnuplot gives it; to be freed. */
static char *Drawn(const Figure *figure, const char *command)
{
  enum { ROOM = 8192 };
  char folder[64], text[128], png[128], *paths = strdup(getenv("PATH")), *letters = calloc(1, ROOM);
  PetscBool done;
  Diag *diag;
  assert_non_null(letters);
  TestFolder(folder);
  OtherGnuplot(folder, paths, command);
  setenv("PATH", folder, 1);
  snprintf(png, sizeof png, "%s/figure.png", folder);
  snprintf(text, sizeof text, "%s/text", folder);
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(FigureWrite(figure, png, diag, &done), 0); /* letters are no PNG */
  assert_int_equal(DiagDestroy(&diag), 0);
  FILE *in = fopen(text, "r");
  assert_non_null(in);
  assert_true(fread(letters, 1, ROOM - 1, in) > 0);
  fclose(in);
  setenv("PATH", paths, 1);
  free(paths);
  TestRemove(folder);
  return letters;
}

/* Ticks of numbers that are small, or close to each other, have names of their own. */
static void test_tick_names(void **state)
{
  const PetscReal x[] = {0, 1}, y[2][2] = {{-9e-5, -7e-5}, {0.12341, 0.12343}};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    const FigureSeries series = {.style = FIGURE_LINE, .n = 2, .x = x, .y = y[k]};
    const Figure figure = {.title = "small", .x_label = "x", .n_series = 1, .series = &series};
    char *letters = Drawn(&figure, LETTERS), *rest = letters, *line, name[64], last[64] = "";
    int names = 0;
    while ((line = strsep(&rest, "\n"))) {
      if (!strpbrk(line, "|+") || sscanf(line, "%63s", name) != 1 || !strpbrk(name, "0123456789")) continue;
      assert_string_not_equal(name, last);
      strcpy(last, name);
      ++names;
    }
    assert_true(names >= 3);
    free(letters);
  }
}

/* Along x numbers stand side by side: in a large picture as many as gnuplot chooses, in a small one fewer, two at
 * least. What is 310 pixels wide has room for 33 letters. */
static void test_tick_steps(void **state)
{
  static const struct {
    PetscReal min, max, room, step;
  } ticks[] = {{0, 1, 80, 0.2},
               {0, 1.9, 80, 0.2},
               {0, 4, 80, 0.5},
               {0, 9, 80, 1},
               {-0.45, 0, 80, 0.05},
               {1233.09, 1234, 80, 0.1},
               {1233.09, 1234, 33, 0.2},
               {1.09e-4, 1.2e-4, 33, 5e-6},
               {1000.11491, 1000.115, 33, 5e-5},
               {1000.11491, 1000.115, 5, 5e-5}};
  (void)state;
  for (size_t k = 0; k < sizeof ticks / sizeof ticks[0]; ++k)
    assert_float_equal(ticks_step(ticks[k].min, ticks[k].max, ticks[k].room) / ticks[k].step, 1, 1e-12);
  assert_true(ticks_step(3, 3, 80) == 0 && ticks_step(-PETSC_MAX_REAL, PETSC_MAX_REAL, 80) == 0);
  assert_true(ticks_step(0, 1e-310, 80) == 0 && ticks_letters(-0.45, 0) == 5);
}

/* The legend below takes the figure away from the middle of the picture: of a long label less has room, not above the
 * picture's edge. 600 pixels, less 45 and two lines of 23, are 46 letters of 11 pixels. */
static void test_label_above_legend(void **state)
{
  const PetscReal x[] = {0, 1}, level[4] = {0, 1, 0, 1}, down[] = {1, 0};
  const FigureSeries series[] = {
    {.name = "the force that a wall with a very long name bears along x", .style = FIGURE_LINE, .n = 2, .x = x, .y = x},
    {.name = "another", .style = FIGURE_LINE, .n = 2, .x = x, .y = down},
    {.style = FIGURE_LINE, .n = 4, .x = (PetscReal[]){0, 0, 1, 1}, .y = level}};
  const Figure figure = {
    .y_label = "the force that a wall with a very long name bears along x [kN]", .n_series = 3, .series = series};
  char *script = Drawn(&figure, SCRIPT), *label = strstr(script, "set ylabel \"");
  (void)state;
  assert_non_null(strstr(script, "set key below"));
  assert_non_null(label);
  label += strlen("set ylabel \"");
  const char *end = strchr(label, '"');
  assert_true(end - label == 46 + 2 && !strncmp(end - 5, " [kN]", 5)); /* … has three bytes */
  free(script);
}

/* A title wider than the picture stands in two lines, both of them whole. */
static void test_long_title(void **state)
{
  const char *title =
    "What the flow of all bars together has cost until they rest, error against time of computing, "
    "friction that grows with the rate of shear";
  const PetscReal x[] = {0, 1};
  const FigureSeries series = {.style = FIGURE_LINE, .n = 2, .x = x, .y = x};
  const Figure figure = {.title = title, .x_label = "x", .n_series = 1, .series = &series};
  char *letters = Drawn(&figure, LETTERS);
  const char *first = strstr(letters, "What the flow of all"), *second = strstr(letters, "the rate of shear");
  (void)state;
  assert_true(first && second && first < second);
  assert_non_null(memchr(first, '\n', (size_t)(second - first)));
  free(letters);
}

static char *Label(const char *text, PetscInt most)
{
  char *written;
  size_t size;
  FILE *out = open_memstream(&written, &size);
  label_write(out, text, most);
  fclose(out);
  return written;
}

/* Of a name that is too long the unit stays. */
static void test_long_label(void **state)
{
  static const struct {
    const char *text, *label;
    PetscInt most;
  } labels[] = {{"tip [mm]", "\"tip [mm]\"", 8},
                {"a_very_long_name [mm]", "\"a_very_l… [mm]\"", 14},
                {"Wärmeströme über Grenzflächen [µm]", "\"Wärmeströme ü… [µm]\"", 19},
                {"a_title_of_more_than_twenty_letters", "\"a_title_of_mor…tters\"", 20}};
  (void)state;
  for (size_t k = 0; k < sizeof labels / sizeof *labels; ++k) {
    char *label = Label(labels[k].text, labels[k].most);
    assert_string_equal(label, labels[k].label);
    free(label);
  }
}

/* Names of ticks along a flat body, and in a small picture, do not run into one another. */
static void test_flat_and_small(void **state)
{
  PlotScene scene = {.dim = 2, .n_frames = 1, .high = 1, .box_min = {-2.4, -0.05}, .box_max = {2.4, 0.3}};
  const int sizes[3][2] = {{0, 0}, {300, 200}, {1200, 800}};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    char *script, *ticks;
    size_t size;
    PlotPage page;
    PetscReal step = 0;
    plot_lay_out(&scene, sizes[k][0], sizes[k][1], &page);
    assert_true(page.left > 0 && page.bottom > 0 && page.left + page.w <= page.width &&
                page.bottom + page.h <= page.height);
    assert_true(k == 1 ? page.scale < 0.9 : page.scale == 1);
    unsigned char *rgba = calloc((size_t)page.w * (size_t)page.h, 4);
    FILE *out = open_memstream(&script, &size);
    assert_int_equal(PlotDrawFrame(out, &scene, 0, &page, rgba), 0);
    fclose(out);
    ticks = strstr(script, "set ytics ");
    if (page.h < 160) assert_non_null(ticks);
    if (ticks) {
      assert_int_equal(sscanf(ticks, "set ytics %lf", &step), 1);
      assert_true(step * page.h / (page.max[1] - page.min[1]) > 25 * page.scale);
    }
    free(script);
    free(rgba);
  }
}

/* Width, height and length of a PNG file; it must be a whole one. */
static long CheckPng(const char *path, int *width, int *height)
{
  static const unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  unsigned char head[24], tail[8];
  FILE *in = fopen(path, "rb");
  assert_non_null(in);
  assert_int_equal(fread(head, 1, 24, in), 24);
  assert_memory_equal(head, signature, 8);
  *width = head[18] << 8 | head[19];
  *height = head[22] << 8 | head[23];
  fseek(in, -8, SEEK_END);
  assert_int_equal(fread(tail, 1, 8, in), 8);
  assert_memory_equal(tail, "IEND", 4);
  const long size = ftell(in);
  fclose(in);
  return size;
}

static void WriteState(const char *folder, PetscInt dim, PetscInt index, PetscReal time)
{
  static PetscReal x[3 * 8000], u[3 * 8000], stress[6 * 8000];
  char path[128], file[64], reason[256];
  const PetscInt n = GaussPoints(dim, dim == 3 ? 6 : 20, x);
  for (PetscInt i = 0; i < 3 * n; ++i) u[i] = x[i] * x[i];
  for (PetscInt i = 0; i < n; ++i) stress[6 * i] = 1e6 * x[3 * i];
  const VtkField fields[] = {{"displacement", "m", 3, u}, {"stress", "Pa", 6, stress}};
  const VtkData data = {.n_points = n, .x = x, .n_point_fields = 2, .point_fields = fields, .time = time};
  snprintf(file, sizeof file, "points_%06d.hdf", (int)index);
  snprintf(path, sizeof path, "%s/%s", folder, file);
  assert_int_equal(VtkWrite(PETSC_COMM_WORLD, path, &data, reason), 0);
  assert_int_equal(VtkSeriesAppend(PETSC_COMM_WORLD, folder, "points", file, time, reason), 0);
}

static void WriteGrid(const char *folder)
{
  const PetscReal x[] = {-0.5, -0.5, 0, 1.5, -0.5, 0, 1.5, 1.5, 0, -0.5, 1.5, 0};
  const PetscInt cells[] = {0, 1, 2, 0, 2, 3};
  const VtkData data = {.n_points = 4, .x = x, .n_cells = 2, .connectivity = cells, .nodes_per_cell = 3, .vtk_type = 5};
  char path[128], reason[256];
  snprintf(path, sizeof path, "%s/grid_000001.hdf", folder);
  assert_int_equal(VtkWrite(PETSC_COMM_WORLD, path, &data, reason), 0);
}

/* Plot, and return what was said (to be freed). */
static char *Plot(const PlotOptions *options, char *picture)
{
  char *text = NULL;
  size_t size;
  Diag *diag;
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(PlotState(options, diag, picture), 0);
  if (picture[0]) assert_int_equal(PlotHistories(options, diag, NULL), 0);
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(DiagFlush(diag, out), 0);
  fclose(out);
  assert_int_equal(DiagDestroy(&diag), 0);
  return text;
}

static void test_state_in_the_plane(void **state)
{
  char folder[64], picture[PETSC_MAX_PATH_LEN];
  int width, height;
  (void)state;
  TestFolder(folder);
  WriteState(folder, 2, 0, 0);
  WriteState(folder, 2, 1, 0.5);
  WriteGrid(folder);
  PlotOptions options = {.run = folder, .up = 2};
  char *text = Plot(&options, picture);
  assert_string_equal(text, "");
  assert_non_null(strstr(picture, "/pictures/state_displacement_magnitude_000001.png"));
  const long plain = CheckPng(picture, &width, &height);
  assert_true(plain > 10000 && width > 400 && height > 400);
  free(text);
  options = (PlotOptions){.run = folder, .field = "stress", .grid = PETSC_TRUE, .width = 640, .height = 480, .up = 2};
  text = Plot(&options, picture);
  assert_string_equal(text, "");
  assert_non_null(strstr(picture, "state_stress_mises_000001.png"));
  assert_true(CheckPng(picture, &width, &height) > 5000 && width == 640 && height == 480);
  assert_false(TestExists(folder, "pictures/state_stress_mises_000001.png.tmp-unfinished"));
  free(text);
  TestRemove(folder);
}

/* Side by side, or one below the other. */
static void test_several_states(void **state)
{
  char folder[64], picture[PETSC_MAX_PATH_LEN];
  int width, height, tall_width, tall_height;
  (void)state;
  TestFolder(folder);
  for (int k = 0; k < 4; ++k) WriteState(folder, 2, k, 0.5 * k);
  PlotOptions options = {.run = folder, .width = 600, .up = 2, .n_times = 3, .times = {0, 0.5, 1.5}};
  char *text = Plot(&options, picture);
  assert_string_equal(text, "");
  assert_non_null(strstr(picture, "/pictures/states_displacement_magnitude.png"));
  assert_true(CheckPng(picture, &width, &height) > 10000 && width > height);
  free(text);
  options.columns = 1;
  text = Plot(&options, picture);
  assert_string_equal(text, "");
  assert_true(CheckPng(picture, &tall_width, &tall_height) > 10000 && tall_height > tall_width);
  free(text);
  options = (PlotOptions){.run = folder, .width = 600, .up = 2, .all_times = PETSC_TRUE};
  text = Plot(&options, picture);
  assert_string_equal(text, "");
  assert_true(CheckPng(picture, &width, &height) > 10000);
  free(text);
  TestRemove(folder);
}

static void test_state_in_space(void **state)
{
  char folder[64], picture[PETSC_MAX_PATH_LEN];
  int width, height;
  (void)state;
  TestFolder(folder);
  WriteState(folder, 3, 0, 0);
  for (PetscInt up = 0; up < 3; ++up) {
    const PlotOptions options = {.run = folder, .component = "x", .width = 500, .height = 450, .up = up};
    char *text = Plot(&options, picture);
    assert_string_equal(text, "");
    assert_true(CheckPng(picture, &width, &height) > 20000);
    free(text);
  }
  TestRemove(folder);
}

/* Each mistake has its word, and there is no picture. */
static void Refused(const PlotOptions *options, const char *word)
{
  char picture[PETSC_MAX_PATH_LEN];
  char *text = Plot(options, picture);
  assert_non_null(strstr(text, word));
  assert_string_equal(picture, "");
  free(text);
}

/* Both sides of the axis make a picture twice as wide; the body in space is asked for. */
static void test_body_of_revolution(void **state)
{
  char folder[64], path[128], picture[PETSC_MAX_PATH_LEN];
  int width, height[3];
  (void)state;
  TestFolder(folder);
  WriteState(folder, 2, 0, 0);
  WriteState(folder, 2, 1, 0.5);
  WriteGrid(folder);
  PlotOptions options = {.run = folder, .field = "stress", .component = "xx", .turned = PETSC_TRUE, .up = 2};
  Refused(&options, "is no axisymmetric run: there is nothing to turn");
  snprintf(path, sizeof path, "%s/case.yaml", folder);
  FILE *out = fopen(path, "w");
  assert_true(fputs("kinematics: axisymmetric\n", out) >= 0 && !fclose(out));
  for (int k = 0; k < 3; ++k) {
    options.half = k == 1, options.turned = k == 2, options.grid = k < 2;
    options.width = 900;
    char *text = Plot(&options, picture);
    assert_string_equal(text, "");
    assert_non_null(
      strstr(picture, k == 2 ? "/pictures/state_stress_xx_turned_000001.png" : "/pictures/state_stress_xx_000001.png"));
    assert_true(CheckPng(picture, &width, &height[k]) > 5000 && width == 900);
    free(text);
  }
  assert_true(height[0] < height[1] - 100);
  TestRemove(folder);
}

static void test_histories(void **state)
{
  const char *const names[] = {"tip of/beam", "mass", "gone"}, *const units[] = {"m", "kg", "m"};
  char folder[64], picture[PETSC_MAX_PATH_LEN], path[256];
  int width, height;
  Diag *diag;
  RunDir *dir;
  (void)state;
  TestFolder(folder);
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(RunDirCreate(PETSC_COMM_WORLD, folder, PETSC_FALSE, PETSC_TRUE, NULL, diag, &dir), 0);
  assert_int_equal(HistoryOpen(dir, 3, names, units), 0);
  for (PetscInt i = 0; i <= 50; ++i)
    assert_int_equal(HistoryWrite(dir, 0.1 * i, i, (PetscReal[]){sin(0.1 * i), 8000, NAN}, NULL), 0);
  assert_int_equal(RunDirDestroy(&dir), 0);
  assert_int_equal(DiagDestroy(&diag), 0);
  WriteState(folder, 2, 0, 0);
  const PlotOptions options = {.run = folder, .up = 2};
  char *text = Plot(&options, picture);
  assert_string_equal(text, "warning: the measure 'gone' has no value in any row: it is not drawn\n");
  snprintf(path, sizeof path, "%s/pictures/history_tip_of_beam.png", folder);
  assert_true(CheckPng(path, &width, &height) > 5000);
  snprintf(path, sizeof path, "%s/pictures/history_mass.png", folder);
  CheckPng(path, &width, &height);
  assert_false(TestExists(folder, "pictures/history_gone.png"));
  free(text);
  TestRemove(folder);
}

static void test_mistakes(void **state)
{
  char folder[64], picture[PETSC_MAX_PATH_LEN], damaged[128];
  struct stat status;
  PlotOptions options = {.run = folder, .width = 320, .height = 240, .up = 2};
  (void)state;
  TestFolder(folder);
  Refused(&options, "there is no state of a run");
  WriteState(folder, 2, 0, 0);
  WriteState(folder, 2, 1, 0.5);
  options.field = "displacment";
  Refused(&options, "did you mean 'displacement'?");
  options.field = "stress";
  options.component = "w";
  Refused(&options, "has no component 'w'");
  options.component = NULL;
  options.out = "/proc/no/such.png";
  Refused(&options, "cannot write the picture '/proc/no/such.png': No such file");
  snprintf(damaged, sizeof damaged, "%s/pipe", folder);
  assert_int_equal(mkfifo(damaged, 0600), 0);
  options.out = damaged; /* root's /dev/full became a picture */
  Refused(&options, "cannot write the picture");
  assert_true(!lstat(damaged, &status) && S_ISFIFO(status.st_mode));
  options.out = NULL;
  options.n_times = 1;
  options.times[0] = 0.1;
  char *text = Plot(&options, picture);
  assert_non_null(strstr(text, "no state at 0.1 s: the nearest is drawn, at 0 s"));
  assert_non_null(strstr(picture, "000000.png"));
  free(text);
  options.n_times = 0;
  snprintf(damaged, sizeof damaged, "%s/points_000001.hdf", folder);
  assert_int_equal(truncate(damaged, 3000), 0);
  Refused(&options, "cannot read");
  TestRemove(folder);
}

static void test_no_gnuplot(void **state)
{
  char folder[64], *path = strdup(getenv("PATH"));
  const PlotOptions options = {.run = folder, .width = 320, .height = 240, .up = 2};
  (void)state;
  TestFolder(folder);
  WriteState(folder, 2, 0, 0);
  setenv("PATH", folder, 1);
  Refused(&options, "apt install gnuplot-nox");
  setenv("PATH", path, 1);
  free(path);
  TestRemove(folder);
}

static char film[PETSC_MAX_PATH_LEN];
static void Said(const char *path) { snprintf(film, sizeof film, "%s", path); }

static char *Animate(const PlotOptions *options)
{
  char *text = NULL;
  size_t size;
  Diag *diag;
  film[0] = 0;
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(PlotAnimate(options, diag, Said), 0);
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(DiagFlush(diag, out), 0);
  fclose(out);
  assert_int_equal(DiagDestroy(&diag), 0);
  return text;
}

/* A GIF has an image for each state; ffmpeg, here a stand-in, makes a film of it; nothing is left of what fails. */
static void test_animation(void **state)
{
  char folder[64], path[512], *paths = strdup(getenv("PATH"));
  PlotOptions options = {.run = folder, .up = -1, .width = 400};
  int images = 0;
  (void)state;
  TestFolder(folder);
  WriteState(folder, 2, 0, 0);
  char *text = Animate(&options);
  assert_non_null(strstr(text, "a single state: nothing moves"));
  free(text);
  WriteState(folder, 2, 1, 0.5);
  WriteState(folder, 2, 2, 1);
  text = Animate(&options);
  assert_string_equal(text, "");
  assert_non_null(strstr(film, "/pictures/animation_displacement_magnitude.gif"));
  FILE *in = fopen(film, "rb");
  for (int c, last[2] = {0, 0}; (c = fgetc(in)) != EOF; last[0] = last[1], last[1] = c)
    images += last[0] == 0x21 && last[1] == 0xf9 && c == 4;
  fclose(in);
  assert_int_equal(images, 3);
  free(text);
  options.format = "mp4";
  setenv("PATH", folder, 1);
  text = Animate(&options);
  assert_non_null(strstr(text, "apt install ffmpeg, or a GIF"));
  free(text);
  snprintf(path, sizeof path, "%s/ffmpeg", folder);
  for (int fails = 1; fails >= 0; --fails) {
    FILE *out = fopen(path, "w");
    fprintf(out, "#!/bin/sh\nfor last; do :; done\nhead -c 3 \"$7\" >\"$last\"\n%s\n",
            fails ? "echo no such codec; exit 1" : "[ $6 = gif ] || exit 0");
    assert_true(!fclose(out) && !chmod(path, 0700));
    snprintf(path, sizeof path, "%s:%.400s", folder, paths);
    setenv("PATH", path, 1);
    snprintf(path, sizeof path, "%s/ffmpeg", folder);
    text = Animate(&options);
    if (fails) assert_non_null(strstr(text, "ffmpeg could not draw the picture: no such codec"));
    else assert_string_equal(text, "");
    assert_int_equal(film[0] != 0, !fails);
    assert_int_equal(TestExists(folder, "pictures/animation_displacement_magnitude.mp4"), !fails);
    assert_false(TestExists(folder, "pictures/animation_displacement_magnitude.mp4.tmp-unfinished"));
    assert_false(TestExists(folder, "pictures/animation_displacement_magnitude.mp4.film.tmp-unfinished"));
    free(text);
  }
  setenv("PATH", paths, 1);
  free(paths);
  TestRemove(folder);
}

/* Colours of the cells of fem: of their points, and of the nodes where the mesh has the field. */
static void check_cells(const char *folder)
{
  VtkState at = {.time = 0};
  snprintf(at.file, sizeof at.file, "points_000000.hdf");
  for (int k = 0; k < 2; ++k) {
    const PlotOptions options = {.run = folder, .field = k ? "displacement" : "heat", .component = k ? "x" : NULL};
    PlotScene scene = {0};
    PlotSubject subject;
    Diag *diag;
    assert_int_equal(DiagCreate(&diag), 0);
    assert_int_equal(PlotSceneFill(&options, 1, &at, &subject, diag, &scene), 0);
    assert_int_equal(diag_errors(diag), 0);
    const PlotFrame *f = &scene.frames[0];
    assert_true(f->n == 0 && f->n_triangles == 4);
    for (PetscInt i = 0; i < 12; ++i) {
      const PetscReal expected = k ? 0.25 * f->corner[3 * i] : f->corner[9 * (i / 3)] < 0.5 ? 3 : 7;
      assert_true(fabs(f->corner_value[i] - expected) < 1e-14);
      assert_true(fabs(f->first_corner[3 * i] - 0.75 * f->corner[3 * i]) < 1e-14);
    }
    assert_true(fabs(scene.low - (k ? 0 : 3)) < 1e-14 && fabs(scene.high - (k ? 0.5 : 7)) < 1e-14);
    assert_int_equal(PlotSceneFree(&scene), 0);
    assert_int_equal(DiagDestroy(&diag), 0);
  }
}

/* Bodies have their names in the legend, and a mesh of fem is drawn by its cells. */
static void test_names_and_cells(void **state)
{
  const PetscReal x[] = {0.25, 0.25, 0, 1.25, 0.25, 0}, body[] = {0, 1}, heat[] = {3, 7}, u[6] = {0},
                  node[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0};
  const PetscInt cells[] = {0, 1, 4, 3, 1, 2, 5, 4};
  char folder[64], path[128], picture[PETSC_MAX_PATH_LEN], reason[256];
  (void)state;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/case.yaml", folder);
  FILE *out = fopen(path, "w");
  fputs(
    "kinematics: plane-strain\nmethod: fem\nanalysis: {type: static, steps: 1}\n"
    "grid: {box: {min: [0, 0], max: [2, 1]}, size: 1, cell: quadrilateral}\n"
    "bodies:\n- {name: steel & iron, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m}\n"
    "- {name: wood, shape: {box: {min: [1, 0], max: [2, 1]}}, material: m}\n"
    "materials: {m: {law: neo-hookean, density: 1, young: 1, poisson: 0}}\n",
    out);
  assert_int_equal(fclose(out), 0);
  PetscReal way[18];
  for (int i = 0; i < 18; ++i) way[i] = i % 3 ? 0 : 0.25 * node[i];
  const VtkField fields[] = {{"body", "", 1, body}, {"displacement", "m", 3, u}, {"heat", "", 1, heat}},
                 of_nodes = {"displacement", "m", 3, way};
  const VtkData points = {.n_points = 2, .x = x, .n_point_fields = 3, .point_fields = fields},
                grid = {.n_points = 6,
                        .x = node,
                        .n_cells = 2,
                        .connectivity = cells,
                        .nodes_per_cell = 4,
                        .vtk_type = 9,
                        .n_point_fields = 1,
                        .point_fields = &of_nodes};
  snprintf(path, sizeof path, "%s/points_000000.hdf", folder);
  assert_int_equal(VtkWrite(PETSC_COMM_WORLD, path, &points, reason), 0);
  assert_int_equal(VtkSeriesAppend(PETSC_COMM_WORLD, folder, "points", "points_000000.hdf", 0, reason), 0);
  snprintf(path, sizeof path, "%s/grid_000000.hdf", folder);
  assert_int_equal(VtkWrite(PETSC_COMM_WORLD, path, &grid, reason), 0);
  check_cells(folder);
  for (int k = 0; k < 2; ++k) {
    const PlotOptions options = {.run = folder, .field = "body", .width = 400, .up = -1, .format = "svg", .grid = k};
    char *text = Plot(&options, picture);
    assert_string_equal(text, "");
    char *svg = TestRead(folder, "pictures/state_body_000000.svg");
    assert_non_null(svg);
    assert_true(strstr(svg, "steel &amp; iron") && strstr(svg, "wood"));
    free(svg);
    free(text);
  }
  /* without a case, numbers */
  snprintf(path, sizeof path, "%s/case.yaml", folder);
  assert_int_equal(remove(path), 0);
  const PlotOptions options = {.run = folder, .field = "body", .width = 400, .up = -1, .format = "svg"};
  char *text = Plot(&options, picture), *svg = TestRead(folder, "pictures/state_body_000000.svg");
  assert_true(strstr(svg, "body 1") && !strstr(svg, "wood"));
  free(svg);
  free(text);
  TestRemove(folder);
}

static void test_convergence(void **state)
{
  const PetscReal h[] = {0.5, 0.25, 0.125, 0.0625}, fem[] = {0.1, 0.025, 0.00625, 0.0015625},
                  mpm[] = {0.2, 0.05, NAN, 0};
  const FigureSeries series[] = {
    {.name = "fem", .style = FIGURE_LINE_MARKS, .n = 4, .x = h, .y = fem},
    {.name = "mpm 'a' \"b\" `date` \\c", .style = FIGURE_LINE_MARKS, .n = 4, .x = h, .y = mpm},
    {.name = "none", .style = FIGURE_LINE, .n = 0, .x = h, .y = mpm}};
  const Figure figure = {.title = "Cantilever",
                         .x_label = "h [m]",
                         .y_label = "error",
                         .log_x = PETSC_TRUE,
                         .log_y = PETSC_TRUE,
                         .n_series = 3,
                         .series = series,
                         .slope = 2};
  Figure nothing = figure;
  char folder[64], png[128];
  int width, height;
  PetscBool done;
  Diag *diag;
  (void)state;
  nothing.n_series = 1, nothing.series = &series[2];
  TestFolder(folder);
  snprintf(png, sizeof png, "%s/it's \"convergence\" `x`.png", folder);
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(FigureWrite(&figure, png, diag, &done), 0);
  assert_true(done && diag_errors(diag) == 0);
  assert_true(CheckPng(png, &width, &height) > 8000 && width == 900 && height == 600);
  assert_int_equal(FigureWrite(&nothing, png, diag, &done), 0);
  assert_true(!done && diag_errors(diag) == 1);
  assert_int_equal(DiagDestroy(&diag), 0);
  TestRemove(folder);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_spacing),
                                     cmocka_unit_test(test_quantile),
                                     cmocka_unit_test(test_raster),
                                     cmocka_unit_test(test_raster_depth),
                                     cmocka_unit_test(test_raster_planes),
                                     cmocka_unit_test(test_raster_gap),
                                     cmocka_unit_test(test_several_states),
                                     cmocka_unit_test(test_scalars),
                                     cmocka_unit_test(test_arrows),
                                     cmocka_unit_test(test_units),
                                     cmocka_unit_test(test_tick_names),
                                     cmocka_unit_test(test_long_title),
                                     cmocka_unit_test(test_long_label),
                                     cmocka_unit_test(test_flat_and_small),
                                     cmocka_unit_test(test_state_in_the_plane),
                                     cmocka_unit_test(test_state_in_space),
                                     cmocka_unit_test(test_body_of_revolution),
                                     cmocka_unit_test(test_histories),
                                     cmocka_unit_test(test_mistakes),
                                     cmocka_unit_test(test_tick_steps),
                                     cmocka_unit_test(test_label_above_legend),
                                     cmocka_unit_test(test_no_gnuplot),
                                     cmocka_unit_test(test_animation),
                                     cmocka_unit_test(test_names_and_cells),
                                     cmocka_unit_test(test_convergence)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
