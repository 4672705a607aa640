/* Curves of runs beside each other: differences are exact whatever the times, keys that differ are found, pictures are
 * drawn in three formats, and mistakes have their word. */
#include "../output/test_output.h"
#include <math.h>
#include <sys/stat.h>
#include "picture/compare/compare.h"
#include "picture/compare/found.h"
#include "picture/compare/lack.h"
#include "picture/curves/keys.h"
#include "picture/figure.h"
#include "picture/plot.h"

/* What lies on the straight line between entries, by looking at all of them. */
static PetscReal Between(const Curve *c, PetscReal t)
{
  for (PetscInt i = 0; i + 1 < c->n; ++i)
    if (c->time[i] <= t && t <= c->time[i + 1] && c->time[i] < c->time[i + 1])
      return c->value[i] + (c->value[i + 1] - c->value[i]) * (t - c->time[i]) / (c->time[i + 1] - c->time[i]);
  return NAN;
}

/* Irregular times, waves: no sample of a million is farther apart than what is found, and one nearly is as far. */
static void test_difference_of_waves(void **state)
{
  enum { N = 37, M = 23, SAMPLES = 1000000 };
  PetscReal ta[N], a[N], tb[M], b[M], largest = 0, at = 0, size = 0;
  Difference d;
  (void)state;
  for (int i = 0; i < N; ++i) ta[i] = pow(i / (N - 1.), 1.3), a[i] = sin(9 * ta[i]);
  for (int i = 0; i < M; ++i) tb[i] = 0.1 + 1.2 * pow(i / (M - 1.), 0.8), b[i] = sin(9.5 * tb[i]) + 0.02;
  const Curve first = {N, ta, a}, second = {M, tb, b};
  assert_true(curve_difference(&first, &second, &d));
  assert_true(d.from == 0.1 && d.to == 1);
  for (int k = 0; k <= SAMPLES; ++k) {
    const PetscReal t = 0.1 + 0.9 * k / SAMPLES, value = Between(&first, t), apart = Between(&second, t) - value;
    size = PetscMax(size, fabs(value));
    if (fabs(apart) > fabs(largest)) largest = apart, at = t;
  }
  assert_true(fabs(d.largest) >= fabs(largest) - 1e-14 && fabs(d.largest - largest) < 1e-4);
  assert_true(fabs(d.at - at) < 1e-5 && fabs(d.size - size) < 1e-4);
  assert_true(fabs(d.relative - fabs(d.largest) / d.size) < 1e-15);
  assert_true(fabs(d.last - (Between(&second, 1) - sin(9))) < 1e-14);
}

static void test_difference_by_hand(void **state)
{
  const PetscReal ta[] = {0, 1}, a[] = {0, 2}, tb[] = {0, 0.25, 1}, b[] = {0, 1, 2}, late[] = {3, 4};
  const PetscReal tc[] = {0, 0.25, 0.25, 0.5, 1}, c[] = {0, 9, 1, NAN, 2}, none[] = {NAN, NAN}, zero[] = {0, 0};
  const Curve first = {2, ta, a}, second = {3, tb, b}, third = {5, tc, c}, after = {2, late, a}, empty = {2, ta, none},
              touching = {2, (PetscReal[]){1, 2}, a}, still = {2, ta, zero};
  Difference d;
  (void)state;
  assert_true(curve_difference(&first, &second, &d));
  assert_true(d.largest == 0.5 && d.at == 0.25 && d.size == 2 && d.relative == 0.25 && d.last == 0);
  assert_true(curve_difference(&second, &first, &d) && d.largest == -0.5);
  /* of two entries at a time the last counts, and one without a value is none */
  assert_true(curve_difference(&second, &third, &d) && d.largest == 0 && d.relative == 0);
  assert_true(curve_difference(&first, &touching, &d) && d.from == 1 && d.to == 1 && d.largest == -2);
  assert_true(curve_difference(&still, &first, &d) && isinf(d.relative) && d.largest == 2);
  assert_false(curve_difference(&first, &after, &d));
  assert_false(curve_difference(&first, &empty, &d));
}

/* A value that only one curve has is missing in the other, but where rows are apart and at the seam of two stages. */
static void test_lack(void **state)
{
  const PetscReal t[] = {0, 1, 2, 3, 4}, whole[] = {0, 1, 2, 3, 4}, lost[] = {0, 1, NAN, NAN, NAN},
                  gap[] = {0, 1, NAN, 3, 4};
  const PetscReal late[] = {0.5, 1.5, 1.9}, some[] = {1, 1, NAN}, seam[] = {0, 1 + 1e-13, 1 + 1e-13, 2, 4},
                  end[] = {0, 1, NAN, NAN, NAN};
  const Curve all = {5, t, whole}, until = {5, t, lost}, between = {5, t, gap}, other = {3, late, some},
              stages = {5, seam, end};
  Lack lack;
  (void)state;
  assert_true(curve_lack(&until, &all, &lack) && lack.from == 2 && lack.to == 4);
  assert_false(curve_lack(&all, &until, &lack) || curve_lack(&until, &until, &lack));
  assert_true(curve_lack(&between, &all, &lack) && lack.from == 2 && lack.to == 2);
  /* the other one has no row between 1.5, where it has a value, and 1.9, where the first may have lost it already */
  assert_false(curve_lack(&other, &until, &lack) || curve_lack(&until, &other, &lack));
  assert_true(curve_lack(&other, &all, &lack) && lack.from == 1.9 && lack.to == 1.9);
  assert_false(curve_lack(&stages, &until, &lack) || curve_lack(&until, &stages, &lack));
}

static void test_found(void **state)
{
  const PetscReal t[] = {0, 1, 2, 3}, early[] = {NAN, 4, 4, 4}, late[] = {NAN, NAN, NAN, 5}, more[] = {NAN, NAN, 5, 6},
                  full[] = {5, 5, 5, 5};
  const Curve a = {4, t, early}, b = {4, t, late}, c = {4, t, more}, d = {4, t, full};
  Difference found;
  (void)state;
  assert_true(curve_found_difference(&a, &b, &found) && found.largest == 1 && found.last == 1 &&
              found.relative == 0.25);
  assert_true(found.from == 1 && found.to == 3);
  assert_false(curve_found_difference(&a, &a, &found) || curve_found_difference(&a, &c, &found) ||
               curve_found_difference(&a, &d, &found));
}

static void WriteFile(const char *folder, const char *name, const char *text)
{
  char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *out = fopen(path, "w");
  assert_non_null(out);
  assert_true(fputs(text, out) >= 0 && !fclose(out));
}

/* A run whose tip goes to `end` in n steps, and whose load is twice as many kN. */
static void WriteRun(const char *folder, const char *name, PetscInt n, PetscReal end, PetscReal young)
{
  char path[128], text[4096] = "time [s],step,tip [m],load [N],weight [N],slope [deg]\n", yaml[400];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  assert_int_equal(mkdir(path, 0700), 0);
  for (PetscInt i = 0; i <= n; ++i) {
    const double t = (double)i / (double)n;
    sprintf(text + strlen(text), "%.9g,%d,%.9g,%.9g,3,%.9g\n", t, (int)i, t * end, 2e3 * t * end, t);
  }
  WriteFile(path, "history.csv", text);
  snprintf(yaml, sizeof yaml,
           "title: %s\nmaterials:\n  rubber: {law: neo-hookean, young: %g}\nloads:\n  gravity: [0, %g]\nbodies:\n- "
           "{name: a, shape: {box: {min: [0, 0], max: [1, 1]}}}\n",
           name, (double)young, -9.81);
  WriteFile(path, "case.yaml", yaml);
}

static void test_keys(void **state)
{
  char folder[64], a[128], b[128], c[128], legend[128];
  const char *const runs[] = {a, b, c};
  DifferingKeys keys;
  (void)state;
  TestFolder(folder);
  WriteRun(folder, "a", 4, 1, 5e6), WriteRun(folder, "b", 8, 1.5, 7e6), WriteRun(folder, "c", 8, 1.5, 7e6);
  snprintf(a, sizeof a, "%s/a", folder), snprintf(b, sizeof b, "%s/b", folder), snprintf(c, sizeof c, "%s/c", folder);
  WriteFile(c, "case.yaml",
            "materials: {rubber: {law: neo-hookean, young: 7e6}}\nloads: {gravity: [0, -1]}\nbodies: [{name: a}]\n"
            "basis: {cell: {}}\n");
  assert_int_equal(KeysDiffer(2, runs, &keys), 0);
  assert_int_equal(keys.n, 1);
  assert_string_equal(keys.key[0], "materials.rubber.young");
  assert_true(!strcmp(keys.value[0], "5e+06") && !strcmp(keys.value[1], "7e+06"));
  keys_legend(&keys, 1, legend);
  assert_string_equal(legend, "young = 7e+06 Pa");
  assert_int_equal(DifferingKeysFree(&keys), 0);
  assert_int_equal(KeysDiffer(3, runs, &keys), 0);
  assert_int_equal(keys.n, 5); /* the text 7e6 is another than 7e+06; gravity; two lists of the box; basis */
  assert_string_equal(keys.key[1], "loads.gravity");
  assert_string_equal(keys.value[3 + 2], "[0, -1]");
  assert_true(!strcmp(keys.key[2], "bodies[0].shape.box.min") && !keys.value[6 + 2]);
  assert_true(!strcmp(keys.key[4], "basis.cell") && !keys.value[12] && !strcmp(keys.value[12 + 2], "{}"));
  assert_int_equal(DifferingKeysFree(&keys), 0);
  TestRemove(folder);
}

static char last_said[PETSC_MAX_PATH_LEN];
static int times_said;
static void Said(const char *path) { snprintf(last_said, sizeof last_said, "%s", path), ++times_said; }

/* What the drawing complained about, to be freed. */
static char *Draw(const PlotXYOptions *options)
{
  char *text = NULL;
  size_t size;
  Diag *diag;
  last_said[0] = 0;
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(PlotXY(options, diag, Said), 0);
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(DiagFlush(diag, out), 0);
  fclose(out);
  assert_int_equal(DiagDestroy(&diag), 0);
  return text;
}

static void Begins(const char *path, const char *with)
{
  char begin[8] = "";
  FILE *in = fopen(path, "rb");
  assert_non_null(in);
  assert_true(fread(begin, 1, strlen(with), in) == strlen(with));
  fclose(in);
  assert_memory_equal(begin, with, strlen(with));
}

/* A case with an amplitude of n points (k, k), of which those from `other` on are (k, k + 0.5), and a short one. */
static void WriteAmplitudes(const char *folder, int n, int other, int end)
{
  char text[2048], *at = text;
  at += sprintf(at, "boundary: [{amplitude: [");
  for (int k = 0; k < n; ++k) at += sprintf(at, "%s[%d, %g]", k ? ", " : "", k, k >= other ? k + 0.5 : k);
  sprintf(at, "]}]\nloads: {gravity_amplitude: [[0, 0], [%d, 1]]}\n", end);
  WriteFile(folder, "case.yaml", text);
}

/* An amplitude of many points is one key, whose values say which point is another; a short one stands as it is. */
static void test_keys_of_tables(void **state)
{
  char folder[64], a[128], b[128];
  const char *const runs[] = {a, b};
  DifferingKeys keys;
  (void)state;
  TestFolder(folder);
  WriteRun(folder, "a", 4, 1, 5e6), WriteRun(folder, "b", 4, 1, 5e6);
  snprintf(a, sizeof a, "%s/a", folder), snprintf(b, sizeof b, "%s/b", folder);
  WriteAmplitudes(a, 50, 50, 1), WriteAmplitudes(b, 51, 7, 2);
  assert_int_equal(KeysDiffer(2, runs, &keys), 0);
  assert_int_equal(keys.n, 2);
  assert_string_equal(keys.key[0], "boundary[0].amplitude");
  assert_string_equal(keys.value[0], "50 points, [7]: [7, 7]");
  assert_string_equal(keys.value[1], "51 points, [7]: [7, 7.5]");
  assert_string_equal(keys.key[1], "loads.gravity_amplitude");
  assert_string_equal(keys.value[2 + 1], "[[0, 0], [2, 1]]");
  assert_int_equal(DifferingKeysFree(&keys), 0);
  WriteAmplitudes(b, 52, 52, 1); /* alike as far as the shorter one goes */
  assert_int_equal(KeysDiffer(2, runs, &keys), 0);
  assert_int_equal(keys.n, 1);
  assert_string_equal(keys.value[0], "50 points, [50]: -");
  assert_string_equal(keys.value[1], "52 points, [50]: [50, 50]");
  assert_int_equal(DifferingKeysFree(&keys), 0);
  TestRemove(folder);
}

static void test_formats(void **state)
{
  char folder[64], a[128], b[128];
  const char *const runs[] = {a, b}, *const y[] = {"tip", "load", "weight"};
  const char *const formats[] = {"png", "svg", "pdf"}, *const begin[] = {"\x89PNG", "<?xml", "%PDF"};
  (void)state;
  TestFolder(folder);
  WriteRun(folder, "a", 4, 1, 5e6), WriteRun(folder, "b", 8, 1.5, 7e6);
  snprintf(a, sizeof a, "%s/a/", folder), snprintf(b, sizeof b, "%s/b", folder);
  for (int k = 0; k < 3; ++k) {
    const PlotXYOptions options = {.n_runs = 2, .runs = runs, .n_y = 3, .y = y, .x = "slope", .format = formats[k]};
    char *text = Draw(&options);
    assert_string_equal(text, "");
    assert_non_null(strstr(last_said, "a//pictures/tip_load_weight_over_slope_of_several_runs."));
    Begins(last_said, begin[k]);
    if (k == 1) { /* text of an SVG can be read: legends, and both axes with their units */
      char *svg = TestRead(folder, "a/pictures/tip_load_weight_over_slope_of_several_runs.svg");
      assert_true(strstr(svg, "young = 5e+06 Pa: tip") && strstr(svg, "young = 7e+06 Pa: weight (right axis)"));
      assert_true(strstr(svg, ">tip [m]<") && strstr(svg, ">load, weight [N]<") && strstr(svg, ">slope [deg]<"));
      free(svg);
    }
    free(text);
  }
  TestRemove(folder);
}

/* How far along (0) or down (1) a word of an SVG stands, in its own unit. */
static double Place(const char *svg, const char *word, int axis)
{
  const char *at = strstr(svg, word), *place = NULL;
  double x[2] = {0};
  assert_non_null(at);
  for (const char *k = svg; (k = strstr(k, "translate(")) && k < at; ++k) place = k;
  assert_non_null(place);
  assert_int_equal(sscanf(place, "translate(%lf,%lf)", &x[0], &x[1]), 2);
  return x[axis];
}

/* A picture of a line from one place to another; the folder is the caller's to remove, the text to free. */
static char *DrawLine(const PetscReal x[2], const PetscReal y[2], char folder[64])
{
  const FigureSeries curve = {.n = 2, .x = x, .y = y};
  const Figure figure = {.n_series = 1, .series = &curve};
  char path[128];
  PetscBool done;
  Diag *diag;
  TestFolder(folder);
  snprintf(path, sizeof path, "%s/a.svg", folder);
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(FigureWrite(&figure, path, diag, &done), 0);
  assert_int_equal(DiagDestroy(&diag), 0);
  return TestRead(folder, "a.svg");
}

/* The number at the end of an axis is half beyond it, and within the picture: seven letters of 11 pixels. */
static void test_last_number(void **state)
{
  const PetscReal x[] = {60e6, 120e6}, y[] = {0, 1};
  char folder[64];
  (void)state;
  char *svg = DrawLine(x, y, folder);
  assert_true(Place(svg, ">1.2e+08<", 0) + 0.5 * 7 * 11 <= 900);
  free(svg);
  TestRemove(folder);
}

/* A legend covers no curve: where one is free it stands in a corner, and else below the axis. */
static void test_legend(void **state)
{
  const PetscReal x[2] = {0, 1}, up[2] = {0, 1}, down[2] = {1, 0};
  char folder[64], path[128];
  (void)state;
  TestFolder(folder);
  for (int crossed = 0; crossed < 2; ++crossed) {
    const FigureSeries series[2] = {{.name = "first of both", .n = 2, .x = x, .y = up},
                                    {.name = "second", .n = 2, .x = x, .y = crossed ? down : up}};
    const Figure figure = {.x_label = "along", .n_series = 2, .series = series};
    PetscBool done;
    Diag *diag;
    assert_int_equal(DiagCreate(&diag), 0);
    snprintf(path, sizeof path, "%s/legend.svg", folder);
    assert_int_equal(FigureWrite(&figure, path, diag, &done), 0);
    assert_true(done);
    char *svg = TestRead(folder, "legend.svg");
    assert_int_equal(Place(svg, ">second<", 1) > Place(svg, ">along<", 1), crossed);
    free(svg);
    assert_int_equal(DiagDestroy(&diag), 0);
  }
  TestRemove(folder);
}

/* A peak below the end of a legend's longer name, beside a right axis, which leaves less room: the legend goes below
 * the axis. With a peak farther on it stands in its corner. */
static void test_legend_right(void **state)
{
  const PetscReal x[4] = {0, 0.33, 0.35, 1}, far[4] = {0, 0.6, 0.7, 1}, up[4] = {0, 0, 0, 1}, peak[4] = {0, 1, 0, 0};
  char folder[64], path[128];
  (void)state;
  TestFolder(folder);
  for (int k = 0; k < 2; ++k) {
    const PetscReal *at = k ? far : x;
    const FigureSeries series[2] = {{.name = "low", .n = 4, .x = at, .y = up},
                                    {.name = "fz (right axis)", .n = 4, .x = at, .y = peak, .right = PETSC_TRUE}};
    const Figure figure = {.x_label = "along", .right_label = "fz", .n_series = 2, .series = series};
    PetscBool done;
    Diag *diag;
    assert_int_equal(DiagCreate(&diag), 0);
    snprintf(path, sizeof path, "%s/legend.svg", folder);
    assert_int_equal(FigureWrite(&figure, path, diag, &done), 0);
    char *svg = TestRead(folder, "legend.svg");
    assert_int_equal(Place(svg, ">low<", 1) > Place(svg, ">along<", 1), k == 0);
    free(svg);
    assert_int_equal(DiagDestroy(&diag), 0);
  }
  TestRemove(folder);
}

/* A range that is narrow beside its numbers has ticks that differ, and do not touch: nine letters of 11 pixels. */
static void test_narrow_ticks(void **state)
{
  const PetscReal x[2] = {1000.12, 1000.13}, y[2] = {0, 1};
  char folder[64];
  (void)state;
  char *svg = DrawLine(x, y, folder);
  assert_true(Place(svg, ">1000.122<", 0) - Place(svg, ">1000.12<", 0) > 9 * 11);
  free(svg);
  TestRemove(folder);
}

static void Refused(const PlotXYOptions *options, const char *word)
{
  char *text = Draw(options);
  assert_non_null(strstr(text, word));
  assert_string_equal(last_said, "");
  free(text);
}

static void test_mistakes(void **state)
{
  char folder[64], a[128];
  const char *const runs[] = {a}, *y[] = {"tip", "load", "slope"};
  PlotXYOptions options = {.n_runs = 1, .runs = runs, .n_y = 3, .y = y};
  (void)state;
  TestFolder(folder);
  snprintf(a, sizeof a, "%s/a", folder);
  Refused(&options, "there is no run directory");
  WriteRun(folder, "a", 4, 1, 5e6);
  Refused(&options, "'slope' is in deg, but the axes are in m and N already");
  y[2] = "wieght";
  Refused(&options, "did you mean 'weight'?");
  options.n_y = 1, options.x = "tme";
  Refused(&options, "did you mean 'time'?");
  WriteFile(a, "history.csv", "time [s],step,tip [m]\n0,0,1\n");
  options.x = NULL;
  Refused(&options, "a single row");
  WriteFile(a, "history.csv", "time [s],step,tip [m]\n0,0,nan\n1,1,nan\n");
  Refused(&options, "nothing to draw");
  assert_false(TestExists(a, "pictures/tip_over_time.png"));
  TestRemove(folder);
}

/* Compare, and what was said to the terminal and as diagnostics, to be freed. */
static char *Compare(const CompareOptions *options, PetscReal *worst)
{
  char *text = NULL;
  size_t size;
  Diag *diag;
  times_said = 0;
  assert_int_equal(DiagCreate(&diag), 0);
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(CompareRuns(options, out, diag, Said, worst), 0);
  assert_int_equal(DiagFlush(diag, out), 0);
  fclose(out);
  assert_int_equal(DiagDestroy(&diag), 0);
  return text;
}

static void test_compare(void **state)
{
  char folder[64], a[128], b[128], c[128], out[128];
  const char *const runs[] = {a, b}, *const strangers[] = {a, c};
  CompareOptions options = {.n_runs = 2, .runs = runs, .out = out};
  PetscReal worst;
  (void)state;
  TestFolder(folder);
  WriteRun(folder, "a", 4, 1, 5e6), WriteRun(folder, "b", 8, 1.5, 7e6), WriteRun(folder, "c", 1, 1, 1);
  snprintf(a, sizeof a, "%s/a", folder), snprintf(b, sizeof b, "%s/b", folder), snprintf(c, sizeof c, "%s/c", folder);
  snprintf(out, sizeof out, "%s/out", folder);
  char *text = Compare(&options, &worst);
  assert_true(fabs(worst - 0.5) < 1e-14 && times_said == 2 + 4);
  assert_true(strstr(text, "materials.rubber.young") && strstr(text, "5.00e-01") && strstr(text, "load [N]"));
  free(text);
  char *csv = TestRead(folder, "out/differences.csv"), *line = strstr(csv, "\nload,N,");
  double d[7];
  assert_int_equal(
    sscanf(strstr(line, "/b,"), "/b,%lf,%lf,%lf,%lf,%lf,%lf,%lf", d, d + 1, d + 2, d + 3, d + 4, d + 5, d + 6), 7);
  assert_true(d[0] == 0 && d[1] == 1 && d[2] == 2000 && d[3] == 1000 && d[4] == 1 && d[5] == 0.5 && d[6] == 1000);
  free(csv);
  assert_true(TestExists(out, "keys.csv") && TestExists(out, "history_tip.png"));
  options.runs = strangers;
  WriteFile(c, "history.csv", "time [s],step,spin [1/s]\n0,0,1\n1,1,1\n");
  text = Compare(&options, &worst);
  assert_true(strstr(text, "no measure in common") && strstr(text, "has: spin") && !times_said);
  free(text);
  WriteFile(c, "history.csv", "time [s],step,tip [m],load [kN]\n7,0,1,1\n8,1,1,1\n");
  text = Compare(&options, &worst);
  assert_true(strstr(text, "no time in common") && strstr(text, "from 7 to 8 s") && !times_said);
  free(text);
  WriteFile(c, "history.csv", "time [s],step,tip [m],load [kN]\n0,0,0,1\n1,1,1,1\n");
  text = Compare(&options, &worst);
  assert_true(worst == 0 && strstr(text, "no such measure: load, weight, slope"));
  free(text);
  TestRemove(folder);
}

/* What differs by round-off of the work done is no difference, however small it is itself; of the work itself it is. */
static void test_compare_energies(void **state)
{
  char folder[64], a[128], b[128], out[128];
  const char *const runs[] = {a, b}, *const head = "time [s],step,work [J],transfer [J],closed,other\n0,0,0,0,0,1\n";
  const char *const yaml =
    "measures: {work: {energy: external}, transfer: {energy: transfer}, closed: {energy: balance},"
    " other: {formula: 1}}\n";
  CompareOptions options = {.n_runs = 2, .runs = runs, .out = out};
  char text[256];
  PetscReal worst;
  (void)state;
  TestFolder(folder);
  WriteRun(folder, "a", 4, 1, 5e6), WriteRun(folder, "b", 4, 1, 5e6);
  snprintf(a, sizeof a, "%s/a", folder), snprintf(b, sizeof b, "%s/b", folder);
  snprintf(out, sizeof out, "%s/out", folder);
  for (int r = 0; r < 2; ++r) WriteFile(runs[r], "case.yaml", yaml);
  snprintf(text, sizeof text, "%s1,1,100,1e-8,1e-10,1\n", head), WriteFile(a, "history.csv", text);
  snprintf(text, sizeof text, "%s1,1,100,3e-8,-2e-10,1\n", head), WriteFile(b, "history.csv", text);
  char *said = Compare(&options, &worst);
  assert_true(fabs(worst - 3e-10) < 1e-20); /* of the balance; the transfer: 2e-8 of 100 J */
  assert_non_null(strstr(said, "Energies are relative to the largest energy of both runs"));
  free(said);
  snprintf(text, sizeof text, "%s1,1,80,1e-8,1e-10,1\n", head), WriteFile(b, "history.csv", text);
  free(Compare(&options, &worst));
  assert_true(fabs(worst - 0.2) < 1e-14);
  snprintf(text, sizeof text, "%s1,1,100,1e-8,1e-10,1.5\n", head), WriteFile(b, "history.csv", text);
  free(Compare(&options, &worst));
  assert_true(fabs(worst - 0.5) < 1e-14); /* no energy, and no balance */
  TestRemove(folder);
}

/* Rows of forces are means since the row before: those of few rows are the impulses of many, and a formula that of its
 * row, wherever rows end: 4/3 = (1 + 0.5 * 2) / 1.5, 3.2 = (0.5 * 2 + 3 + 4) / 2.5. */
static void test_compare_means(void **state)
{
  char folder[64], a[128], b[128], out[128];
  const char *const runs[] = {a, b}, *const measures[] = {"f", "both", "tip"};
  const char *const many =
                      "time [s],step,f [N],tip [m],both\n0,0,0,0,0\n1,1,1,1,3\n2,2,2,4,8\n3,3,3,9,15\n4,4,4,16,24\n",
                    *const few = "time [s],step,f [N],tip [m],both\n0,0,0,0,0\n3,3,2,9,13\n4,4,4,16,24\n",
                    *const others =
                      "time [s],step,f [N],tip [m],both\n0,0,0,0,0\n1.5,1,1.3333333333333333,2.5,5.1666666666666667\n"
                      "4,2,3.2,16,22.4\n";
  const char *const yaml =
    "kinematics: plane-strain\nmethod: fem\nanalysis: {type: dynamic, end: 4, step: 1}\n"
    "grid: {box: {min: [0, 0], max: [1, 1]}, size: 1}\n"
    "bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, material: m}]\n"
    "materials: {m: {law: neo-hookean, density: 1, young: 1e6, poisson: 0.3}}\n"
    "boundary: [{name: floor, on: {y: 0}, fix: [x, y]}]\n"
    "measures: {f: {reaction: y, of: {boundary: floor}}, tip: {displacement: y, of: {tracer: [1, 1]}},"
    " both: {formula: 2 * f + tip}}\n";
  CompareOptions options = {.n_runs = 2, .n_measures = 2, .runs = runs, .measures = measures, .out = out};
  PetscReal worst;
  (void)state;
  TestFolder(folder);
  WriteRun(folder, "a", 4, 1, 5e6), WriteRun(folder, "b", 4, 1, 5e6);
  snprintf(a, sizeof a, "%s/a", folder), snprintf(b, sizeof b, "%s/b", folder);
  snprintf(out, sizeof out, "%s/out", folder);
  for (int r = 0; r < 2; ++r) WriteFile(runs[r], "case.yaml", yaml);
  WriteFile(a, "history.csv", many), WriteFile(b, "history.csv", few);
  free(Compare(&options, &worst));
  assert_true(worst < 1e-15);
  WriteFile(b, "history.csv", others);
  free(Compare(&options, &worst));
  assert_true(worst < 1e-15);
  /* what is no mean lies on lines between rows: 6 for 4 at 2 s */
  WriteFile(b, "history.csv", few);
  options.measures = measures + 2, options.n_measures = 1;
  free(Compare(&options, &worst));
  assert_true(fabs(worst - 2. / 16) < 1e-15);
  TestRemove(folder);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_difference_of_waves),
                                     cmocka_unit_test(test_difference_by_hand),
                                     cmocka_unit_test(test_lack),
                                     cmocka_unit_test(test_found),
                                     cmocka_unit_test(test_keys),
                                     cmocka_unit_test(test_keys_of_tables),
                                     cmocka_unit_test(test_formats),
                                     cmocka_unit_test(test_last_number),
                                     cmocka_unit_test(test_legend),
                                     cmocka_unit_test(test_legend_right),
                                     cmocka_unit_test(test_narrow_ticks),
                                     cmocka_unit_test(test_mistakes),
                                     cmocka_unit_test(test_compare),
                                     cmocka_unit_test(test_compare_energies),
                                     cmocka_unit_test(test_compare_means)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char **argv) { return TestMain(argc, argv, Tests); }
