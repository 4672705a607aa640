/* Measures of one or several runs over each other. */
#include <string.h>
#include "base/text.h"
#include "output/directory/run_dir_files.h"
#include "picture/curves/keys.h"
#include "picture/curves/runs.h"
#include "picture/figure.h"
#include "picture/plot.h"

const char *const plot_legends[] = {"names", "keys", NULL};

/* One of the axes: what all its columns are measured in, and as what they are drawn. */
typedef struct {
  const char *unit; /* NULL: nothing is along this axis */
  char shown[64];   /* with its prefix */
  PetscReal largest, factor;
} Axis;

enum { X, LEFT, RIGHT, AXES };

typedef struct {
  const PlotXYOptions *options;
  CurveRun *runs;
  DifferingKeys keys;
  PetscInt *column; /* n_runs x (1 + n_y): of x, then of each y */
  int *axis;        /* n_y */
  Axis axes[AXES];
  PetscReal *values; /* of all curves */
  FigureSeries *series;
  char (*names)[320];
  PetscInt n_series;
} XY;

static const char *measure_of(const XY *xy, PetscInt k) { return k ? xy->options->y[k - 1] : xy->options->x; }

static PetscInt *column_of(const XY *xy, PetscInt run, PetscInt k)
{
  return &xy->column[run * (1 + xy->options->n_y) + k];
}

static void measure_axis(const XY *xy, PetscInt run, PetscInt k, Axis *axis)
{
  for (PetscInt i = 0; i < xy->runs[run].history.n_rows; ++i) {
    const PetscReal v = PetscAbsReal(curve_run_value(&xy->runs[run], i, *column_of(xy, run, k)));
    if (v < 1e300) axis->largest = PetscMax(axis->largest, v);
  }
}

/* The axis for a measure, number k of the options: x has its own, and there are two units of y at most. */
static int find_axis(XY *xy, PetscInt k, const char *unit, Diag *diag)
{
  for (int a = k ? LEFT : X; a < (k ? AXES : LEFT); ++a) {
    if (!xy->axes[a].unit) xy->axes[a].unit = unit;
    if (!strcmp(xy->axes[a].unit, unit)) return a;
  }
  if (k) {
    diag_error(diag, NULL, "'%s' is in %s, but the axes are in %s and %s already", measure_of(xy, k),
               unit[0] ? unit : "no unit", xy->axes[LEFT].unit[0] ? xy->axes[LEFT].unit : "no unit",
               xy->axes[RIGHT].unit[0] ? xy->axes[RIGHT].unit : "no unit");
    diag_hint(diag, "measures of two units fit into a picture: draw the others by a command of their own");
  } else
    diag_error(diag, NULL, "'%s' is in %s in one run and in %s in another", measure_of(xy, k), xy->axes[X].unit, unit);
  return -1;
}

static PetscErrorCode FindColumns(XY *xy, Diag *diag)
{
  const PlotXYOptions *o = xy->options;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(o->n_runs * (1 + o->n_y), &xy->column, o->n_y, &xy->axis));
  for (PetscInt r = 0; r < o->n_runs; ++r)
    for (PetscInt k = 0; k <= o->n_y; ++k) {
      PetscInt *column = column_of(xy, r, k);
      PetscCall(CurveRunColumn(&xy->runs[r], measure_of(xy, k), diag, column));
      if (*column < 0) continue;
      const int axis = find_axis(xy, k, xy->runs[r].history.units[*column], diag);
      if (axis < 0) PetscFunctionReturn(0);
      if (k && r && axis != xy->axis[k - 1])
        diag_error(diag, NULL, "'%s' has another unit in '%s'", measure_of(xy, k), xy->runs[r].folder);
      if (k) xy->axis[k - 1] = axis;
      measure_axis(xy, r, k, &xy->axes[axis]);
    }
  for (int a = 0; a < AXES; ++a)
    if (xy->axes[a].unit) xy->axes[a].factor = figure_unit(xy->axes[a].unit, xy->axes[a].largest, xy->axes[a].shown);
  PetscFunctionReturn(0);
}

/* What tells a curve from the others: the run, or the keys in which it differs, and the measure. */
static void name_curve(const XY *xy, PetscInt r, PetscInt k, char name[320])
{
  const PlotXYOptions *o = xy->options;
  const char *word = o->legend ? o->legend : xy->keys.n <= 2 ? "keys" : "names";
  char run[128] = "";
  if (o->n_runs > 1 && !strcmp(word, "keys")) keys_legend(&xy->keys, r, run);
  if (o->n_runs > 1 && !run[0]) snprintf(run, sizeof run, "%s", xy->runs[r].name);
  const PetscBool measure = o->n_runs == 1 || o->n_y > 1;
  snprintf(name, 320, "%s%s%.160s%s", run, run[0] && measure ? ": " : "", measure ? measure_of(xy, k) : "",
           xy->axis[k - 1] == RIGHT ? " (right axis)" : "");
}

static PetscErrorCode FillCurves(XY *xy)
{
  const PlotXYOptions *o = xy->options;
  size_t all = 0;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < o->n_runs; ++r) all += (size_t)xy->runs[r].history.n_rows;
  PetscCall(PetscMalloc1(2 * all * (size_t)o->n_y, &xy->values));
  PetscCall(PetscCalloc1(o->n_runs * o->n_y, &xy->series));
  PetscCall(PetscMalloc1(o->n_runs * o->n_y, &xy->names));
  PetscReal *next = xy->values;
  for (PetscInt r = 0; r < o->n_runs; ++r)
    for (PetscInt k = 1; k <= o->n_y; ++k) {
      const PetscInt n = xy->runs[r].history.n_rows;
      const int axis = xy->axis[k - 1];
      PetscReal *x = next, *y = next + n;
      for (PetscInt i = 0; i < n; ++i) {
        x[i] = xy->axes[X].factor * curve_run_value(&xy->runs[r], i, *column_of(xy, r, 0));
        y[i] = xy->axes[axis].factor * curve_run_value(&xy->runs[r], i, *column_of(xy, r, k));
      }
      next += 2 * n;
      name_curve(xy, r, k, xy->names[xy->n_series]);
      xy->series[xy->n_series] = (FigureSeries){.name = o->n_runs * o->n_y > 1 ? xy->names[xy->n_series] : NULL,
                                                .style = n > 40 ? FIGURE_LINE : FIGURE_LINE_MARKS,
                                                .n = n,
                                                .x = x,
                                                .y = y,
                                                .right = axis == RIGHT};
      ++xy->n_series;
    }
  PetscFunctionReturn(0);
}

/* "load, weight [kN]"; where two axes take y, each is told by its own measures. */
static const char *axis_label(const XY *xy, int axis, char label[TEXT_LABEL])
{
  char words[256] = "";
  for (PetscInt k = 1; k <= xy->options->n_y; ++k) {
    const size_t used = strlen(words);
    if (xy->axis[k - 1] == axis && used < 160)
      snprintf(words + used, sizeof words - used, "%s%s", used ? ", " : "", measure_of(xy, k));
  }
  return text_with_unit(words, xy->axes[axis].shown, label);
}

/* tip_over_time.png, in the pictures of the first run. */
static void picture_path(const PlotXYOptions *o, char path[FILE_PATH + 300])
{
  char name[256] = "";
  for (PetscInt k = 0; k < o->n_y; ++k) {
    const size_t used = strlen(name);
    snprintf(name + used, sizeof name - used, "%s%.60s", k ? "_" : "", o->y[k]);
    if (strlen(name) > 120) break;
  }
  snprintf(name + strlen(name), sizeof name - strlen(name), "_over_%.60s%s.%s", o->x,
           o->n_runs > 1 ? "_of_several_runs" : "", plot_ending(o->format));
  plot_file_name(name);
  if (o->out) snprintf(path, FILE_PATH + 300, "%s", o->out);
  else snprintf(path, FILE_PATH + 300, "%s/pictures/%s", o->runs[0], name);
}

static PetscErrorCode Draw(XY *xy, Diag *diag, void (*said)(const char *path))
{
  const PlotXYOptions *o = xy->options;
  char x_label[TEXT_LABEL], left[TEXT_LABEL], right[TEXT_LABEL], path[FILE_PATH + 300];
  PetscBool done = PETSC_FALSE;

  PetscFunctionBeginUser;
  text_with_unit(o->x, xy->axes[X].shown, x_label);
  const Figure figure = {.x_label = x_label,
                         .y_label = axis_label(xy, LEFT, left),
                         .right_label = xy->axes[RIGHT].unit ? axis_label(xy, RIGHT, right) : NULL,
                         .n_series = xy->n_series,
                         .series = xy->series,
                         .width = o->width,
                         .height = o->height};
  picture_path(o, path);
  if (o->out || plot_folder(o->runs[0], diag)) PetscCall(FigureWrite(&figure, path, diag, &done));
  if (done && said) said(path);
  PetscFunctionReturn(0);
}

PetscErrorCode PlotXY(const PlotXYOptions *options, Diag *diag, void (*said)(const char *path))
{
  PlotXYOptions over_time = *options;
  XY xy = {.options = &over_time};

  PetscFunctionBeginUser;
  if (!options->x) over_time.x = "time";
  if (options->n_runs * options->n_y > PLOT_MAX_CURVES) {
    diag_error(diag, NULL, "nobody can tell %d curves from each other: a picture holds %d at most",
               (int)(options->n_runs * options->n_y), PLOT_MAX_CURVES);
    PetscFunctionReturn(0);
  }
  PetscCall(CurveRunsOpen(options->n_runs, options->runs, diag, &xy.runs));
  PetscCall(KeysDiffer(options->n_runs, options->runs, &xy.keys));
  if (!diag_errors(diag)) PetscCall(FindColumns(&xy, diag));
  if (!diag_errors(diag)) {
    PetscCall(FillCurves(&xy));
    PetscCall(Draw(&xy, diag, said));
  }
  PetscCall(PetscFree2(xy.column, xy.axis));
  PetscCall(PetscFree(xy.values));
  PetscCall(PetscFree(xy.series));
  PetscCall(PetscFree(xy.names));
  PetscCall(DifferingKeysFree(&xy.keys));
  PetscCall(CurveRunsClose(options->n_runs, &xy.runs));
  PetscFunctionReturn(0);
}
