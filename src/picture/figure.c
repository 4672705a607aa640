#include "picture/figure.h"
#include <stdlib.h>
#include <string.h>
#include "picture/gnuplot.h"
#include "picture/label.h"
#include "picture/ticks.h"

#define WIDTH 900
#define HEIGHT 600
#define LETTER 11    /* pixels of one in a label, about */
#define KEY_LINE 23  /* pixels of a line of the legend */
#define KEY_SAMPLE 7 /* letters that a sample and the air about it take */
#define SHEET_WIDTH 640
#define SHEET_HEIGHT 460

/* Colours that stay apart in print and for the colour-blind, and marks of different shape: the
 * first is filled, the others are hollow and larger, so that curves that coincide can be told
 * apart. */
static const char *const colours[] = {"#0b559f", "#d1495b", "#2a9d5c", "#e08e0b", "#6a4c93", "#555555"};
static const int marks[] = {7, 4, 8, 12, 10, 6};
enum { N_COLOURS = 6 };

/* Axes of a figure; y of a series is along the left one or the right one. */
enum { AXIS_X, AXIS_LEFT, AXIS_RIGHT, N_AXES };

static int axis_of(const FigureSeries *series) { return series->right ? AXIS_RIGHT : AXIS_LEFT; }

static PetscBool figure_visible(const Figure *figure, const FigureSeries *series, PetscInt i)
{
  const PetscReal x = series->x[i], y = series->y[i];
  if (PetscIsInfOrNanReal(x) || PetscIsInfOrNanReal(y)) return PETSC_FALSE;
  return !((figure->log_x && x <= 0) || (figure->log_y && !series->right && y <= 0));
}

/* All visible points lie in [min, max] of their axes, and all bands; returns how many points there are. */
static PetscInt bounds(const Figure *figure, PetscReal min[N_AXES], PetscReal max[N_AXES])
{
  PetscInt n[N_AXES] = {0};
  for (PetscInt s = 0; s < figure->n_series; ++s)
    for (PetscInt i = 0; i < figure->series[s].n; ++i) {
      const FigureSeries *series = &figure->series[s];
      const int axes[2] = {AXIS_X, axis_of(series)};
      const PetscReal p[2] = {series->x[i], series->y[i]};
      if (!figure_visible(figure, series, i)) continue;
      for (int d = 0; d < 2; ++d) {
        const int axis = axes[d];
        min[axis] = n[axis] ? PetscMin(min[axis], p[d]) : p[d];
        max[axis] = n[axis] ? PetscMax(max[axis], p[d]) : p[d];
        ++n[axis];
      }
    }
  for (PetscInt b = 0; b < figure->n_bands && n[AXIS_X] > 0; ++b) {
    min[AXIS_LEFT] = PetscMin(min[AXIS_LEFT], figure->bands[b].low);
    max[AXIS_LEFT] = PetscMax(max[AXIS_LEFT], figure->bands[b].high);
  }
  if (figure->from < figure->to && n[AXIS_X] > 0) {
    min[AXIS_X] = PetscMin(min[AXIS_X], figure->from);
    max[AXIS_X] = PetscMax(max[AXIS_X], figure->to);
  }
  return n[AXIS_X];
}

/* A little air around the curves; on a logarithmic axis by a factor. */
static void write_range(FILE *out, const char *axis, PetscBool logarithmic, PetscReal min, PetscReal max,
                        PetscReal share)
{
  if (logarithmic) {
    const PetscReal factor = max > min ? PetscPowReal(max / min, share) : 2;
    fprintf(out, "set %srange [%.15g:%.15g]\n", axis, (double)(min / factor), (double)(max * factor));
  } else {
    PetscReal air = share * (max - min);
    const PetscReal size = PetscMax(PetscAbsReal(min), PetscAbsReal(max));
    if (!(max - min > 1e-12 * size)) air = PetscMax(0.1 * size, 1e-12);
    fprintf(out, "set %srange [%.15g:%.15g]\n", axis, (double)(min - air), (double)(max + air));
  }
}

/* How many letters have room above and below the figure. */
static PetscInt letters_across(const Figure *figure)
{
  const int width = figure->width ? figure->width : WIDTH, height = figure->height ? figure->height : HEIGHT;
  return (PetscInt)(width / (LETTER * label_scale(width, height)));
}

static void write_label(FILE *out, const char *what, const char *text, PetscInt most)
{
  if (!text) return;
  fprintf(out, "set %s ", what);
  label_write(out, text, most);
  fputc('\n', out);
}

/* The space next to the middle of a text, NULL if it has none. */
static const char *middle_space(const char *text)
{
  const char *middle = text + strlen(text) / 2, *before = middle, *after = strchr(middle, ' ');
  while (before > text && *before != ' ') --before;
  if (before == text) return after;
  return after && after - middle < middle - before ? after : before;
}

/* In two lines, if it is wider than the picture. */
static void write_title(FILE *out, const Figure *figure)
{
  const PetscInt fits = letters_across(figure);
  const char *middle = figure->title && (PetscInt)strlen(figure->title) > fits ? middle_space(figure->title) : NULL;
  char *first;
  if (!middle || !(first = strndup(figure->title, (size_t)(middle - figure->title)))) {
    write_label(out, "title", figure->title, fits);
    return;
  }
  fputs("set title ", out);
  label_write(out, first, fits);
  fputs(" . \"\\n\" . ", out);
  label_write(out, middle + 1, fits);
  fputc('\n', out);
  free(first);
}

static PetscReal share(PetscBool logarithmic, PetscReal min, PetscReal max, PetscReal value)
{
  if (!(max > min)) return 0.5;
  return logarithmic ? PetscLogReal(value / min) / PetscLogReal(max / min) : (value - min) / (max - min);
}

/* A place in shares of the picture: in which of the corners that a legend of this size could take is it, left or right
 * (x), bottom or top (y)? In the middle in both, if the legend is wide. */
static void count_in_corner(const PetscReal at[2], const PetscReal size[2], PetscInt count[2][2])
{
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y) count[x][y] += (x ? 1 - at[0] : at[0]) < size[0] && (y ? 1 - at[1] : at[1]) < size[1];
}

/* A sample of a curve in shares of the picture. */
static void place_of(const Figure *figure, const FigureSeries *s, PetscInt i, const PetscReal *min,
                     const PetscReal *max, PetscReal at[2])
{
  const int axis = axis_of(s);
  at[0] = share(figure->log_x, min[AXIS_X], max[AXIS_X], s->x[i]);
  at[1] = share(figure->log_y && axis == AXIS_LEFT, min[axis], max[axis], s->y[i]);
}

/* A curve in the corners: its samples, and places between those that a line joins. */
static void count_series(const Figure *figure, const FigureSeries *s, const PetscReal *min, const PetscReal *max,
                         const PetscReal size[2], PetscInt count[2][2])
{
  enum { PARTS = 24 }; /* of a line from one corner to the other: some lie in a legend that it crosses */
  const PetscBool joined = s->style != FIGURE_MARKS && s->style != FIGURE_DOTS;
  PetscReal a[2], b[2];
  for (PetscInt i = 0; i < s->n; ++i) {
    if (!figure_visible(figure, s, i)) continue;
    place_of(figure, s, i, min, max, a);
    count_in_corner(a, size, count);
    if (!joined || i + 1 == s->n || !figure_visible(figure, s, i + 1)) continue;
    place_of(figure, s, i + 1, min, max, b);
    for (int part = 1; part < PARTS; ++part) {
      const PetscReal t = (PetscReal)part / PARTS, at[2] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
      count_in_corner(at, size, count);
    }
  }
}

/* What a legend names: how much, and how many letters the longest name has. */
static PetscInt count_names(const Figure *figure, size_t *longest)
{
  PetscInt named = figure->n_bands + (figure->slope != 0);
  *longest = 8;
  for (PetscInt k = 0; k < figure->n_series; ++k) {
    if (!figure->series[k].name) continue;
    ++named;
    *longest = PetscMax(*longest, strlen(figure->series[k].name));
  }
  for (PetscInt k = 0; k < figure->n_bands; ++k) *longest = PetscMax(*longest, strlen(figure->bands[k].name));
  return named;
}

/* Of the legend with its distance from the frame, in shares of what the frame encloses. In pixels: the air above and
 * below its lines is 25; axes with their numbers and labels take 130 from the width, 100 more where there is a right
 * one, and 105 from the height, with the title. */
static void key_size(const Figure *figure, PetscReal size[2])
{
  const int width = figure->width ? figure->width : WIDTH, height = figure->height ? figure->height : HEIGHT;
  const PetscReal scale = label_scale(width, height);
  size_t longest;
  const PetscReal high = scale * (25 + KEY_LINE * (PetscReal)count_names(figure, &longest));
  const PetscReal wide = scale * LETTER * (KEY_SAMPLE + (PetscReal)longest);
  size[0] = PetscMin(wide / (width - scale * (figure->right_label ? 230 : 130)), 0.95);
  size[1] = PetscMin(high / (height - scale * 105), 0.95);
}

/* The corner where no curves are; where several are as good, at the top and at the left. PETSC_FALSE: none is free. */
static PetscBool find_corner(const Figure *figure, const PetscReal *min, const PetscReal *max, int *right, int *top)
{
  PetscInt count[2][2] = {{0, 0}, {0, 0}};
  PetscReal size[2];
  *right = figure->slope < 0, *top = 1; /* where falling curves leave room */
  key_size(figure, size);
  for (PetscInt k = 0; k < figure->n_series; ++k) count_series(figure, &figure->series[k], min, max, size, count);
  for (int y = 1; y >= 0; --y)
    for (int x = 0; x < 2; ++x)
      if (count[x][y] < count[*right][*top]) *right = x, *top = y;
  return (PetscBool)!count[*right][*top];
}

static void write_key(FILE *out, const Figure *figure, const PetscReal *min, const PetscReal *max)
{
  int right, top;
  if (!find_corner(figure, min, max, &right, &top)) fputs("set key below noopaque nobox height 0.3\n", out);
  else fprintf(out, "set key %s %s\n", top ? "top" : "bottom", right ? "right" : "left");
}

/* Lines of the legend below the figure, which stand side by side as far as they have room. */
static PetscInt lines_below(const Figure *figure, const PetscReal *min, const PetscReal *max)
{
  size_t longest;
  int right, top;
  const PetscInt named = count_names(figure, &longest);
  const PetscInt beside = PetscMax(letters_across(figure) / (KEY_SAMPLE + (PetscInt)longest), 1);
  return named && !find_corner(figure, min, max, &right, &top) ? (named + beside - 1) / beside : 0;
}

/* How many letters have room along an upright axis, about its middle: that stands the higher, the more is below. In
 * pixels: the numbers and the label of x and the air below take 45 more than the air above. */
static PetscInt letters_beside(const Figure *figure, const PetscReal *min, const PetscReal *max)
{
  const int width = figure->width ? figure->width : WIDTH, height = figure->height ? figure->height : HEIGHT;
  const PetscReal scale = label_scale(width, height);
  const PetscReal below = scale * (45 + KEY_LINE * (PetscReal)lines_below(figure, min, max));
  return (PetscInt)((height - below) / (LETTER * scale));
}

/* Half of a tick's number stands beyond the end of the axis: gnuplot leaves room for three letters. */
static PetscReal right_margin(PetscReal min, PetscReal max)
{
  return PetscMax(3, 0.5 * (PetscReal)ticks_letters(min, max) + 1);
}

/* How many letters have room along the axis of x. Beside it stand numbers of y with their label, and half a number of
 * x. */
static PetscReal letters_along(const Figure *figure, const PetscReal *min, const PetscReal *max)
{
  enum { LABEL = 4 }; /* letters that a label and the air about it take across */
  const PetscReal left = LABEL + (PetscReal)ticks_letters(min[AXIS_LEFT], max[AXIS_LEFT]);
  const PetscReal right = figure->right_label ? LABEL + (PetscReal)ticks_letters(min[AXIS_RIGHT], max[AXIS_RIGHT])
                                              : right_margin(min[AXIS_X], max[AXIS_X]);
  return (PetscReal)letters_across(figure) - left - right;
}

static void write_x_ticks(FILE *out, const Figure *figure, const PetscReal *min, const PetscReal *max)
{
  const PetscReal step = ticks_step(min[AXIS_X], max[AXIS_X], letters_along(figure, min, max));
  if (step > 0) fprintf(out, "set xtics %.15g\n", (double)step);
}

/* Has the figure a right axis? Where it has, ticks of the left one end at the left. */
static void write_right_axis(FILE *out, const Figure *figure, const PetscReal *min, const PetscReal *max)
{
  if (!figure->right_label) {
    fprintf(out, "set rmargin %g\n", (double)right_margin(min[AXIS_X], max[AXIS_X]));
    return;
  }
  write_label(out, "y2label", figure->right_label, letters_beside(figure, min, max));
  write_range(out, "y2", PETSC_FALSE, min[AXIS_RIGHT], max[AXIS_RIGHT], 0.06);
  fprintf(out, "set y2tics\nset format y2 '%%.%dg'\n", ticks_digits(min[AXIS_RIGHT], max[AXIS_RIGHT]));
}

static void write_axes(FILE *out, const Figure *figure, const PetscReal *min, const PetscReal *max)
{
  write_title(out, figure);
  write_label(out, "xlabel", figure->x_label, letters_across(figure));
  write_label(out, "ylabel", figure->y_label, letters_beside(figure, min, max));
  /* gnuplot's own has five decimals, in which small numbers are the same */
  fprintf(out, "set format '%%g'\nset format x '%%.%dg'\nset format y '%%.%dg'\n", ticks_digits(min[0], max[0]),
          ticks_digits(min[1], max[1]));
  if (!figure->log_x) write_x_ticks(out, figure, min, max);
  if (figure->log_x) fputs("set logscale x\nset format x '%g'\n", out);
  if (figure->log_y) fputs("set logscale y\nset format y '%.0e'\n", out);
  if (figure->log_y && max[1] / min[1] < 1e3) fputs("set format y '%g'\n", out);
  write_range(out, "x", figure->log_x, min[0], max[0], figure->log_x ? 0.06 : 0);
  write_range(out, "y", figure->log_y, min[1], max[1], 0.06);
  write_right_axis(out, figure, min, max);
  fputs(
    "set border lw 1 lc rgb '#444444'\nset tics textcolor rgb '#000000'\n"
    "set grid xtics ytics lc rgb '#e2e2e2' lw 1 lt 1\nset tics nomirror\n"
    "set key Left reverse samplen 2 spacing 1.2 width 1 height 0.5 box lc rgb '#cccccc' opaque\n",
    out);
  write_key(out, figure, min, max);
}

/* Do all curves have their points at these places, as those of one sweep have? */
static PetscBool has_places(const FigureSeries *series, const FigureSeries *places)
{
  for (PetscInt i = 0, k = 0; i < series->n; ++i) {
    while (k < places->n && places->x[k] != series->x[i]) ++k;
    if (k == places->n) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* A logarithmic axis would name one or two numbers only: ticks at the curves' own places, or at 1, 2
 * and 5 of each decade. */
static void write_ticks(FILE *out, const Figure *figure, PetscReal min, PetscReal max)
{
  const FigureSeries *places = &figure->series[0];
  PetscBool common = places->n >= 2 && places->n <= 8;
  for (PetscInt s = 1; s < figure->n_series; ++s) common = common && has_places(&figure->series[s], places);
  fputs("set xtics (", out);
  for (PetscInt i = 0; common && i < places->n; ++i)
    fprintf(out, "%s'%.4g' %.15g", i ? ", " : "", (double)places->x[i], (double)places->x[i]);
  const char *separator = "";
  for (PetscInt k = (PetscInt)PetscFloorReal(PetscLog10Real(min)); !common && PetscPowReal(10, k) <= max; ++k)
    for (int i = 0; i < 3; ++i, separator = ", ")
      fprintf(out, "%s%.15g", separator, (double)((i == 2 ? 5 : i + 1) * PetscPowReal(10, k)));
  fputs(")\n", out);
}

static void write_data(FILE *out, const Figure *figure, const FigureSeries *series, PetscInt index)
{
  fprintf(out, "$s%" PetscInt_FMT " << EOD\n", index);
  for (PetscInt i = 0; i < series->n; ++i)
    if (figure_visible(figure, series, i)) fprintf(out, "%.15g %.15g\n", (double)series->x[i], (double)series->y[i]);
  fputs("EOD\n", out);
}

static PetscBool any_visible(const Figure *figure, const FigureSeries *series)
{
  for (PetscInt i = 0; i < series->n; ++i)
    if (figure_visible(figure, series, i)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void write_curve(FILE *out, const FigureSeries *series, PetscInt index)
{
  static const char *const with[] = {"lines lw 2", "points", "linespoints lw 2", "lines lw 2 dt 2",
                                     "points pt 7 ps 0.35"};
  const char *colour = colours[index % N_COLOURS];
  fprintf(out, "$s%" PetscInt_FMT " %swith %s", index, series->right ? "axes x1y2 " : "", with[series->style]);
  /* the colours come again */
  if (index >= N_COLOURS && (series->style == FIGURE_LINE || series->style == FIGURE_LINE_MARKS))
    fprintf(out, " dt %d", 1 + (int)(index / N_COLOURS) % 5);
  if (series->style == FIGURE_MARKS || series->style == FIGURE_LINE_MARKS)
    fprintf(out, " pt %d ps %g", marks[index % N_COLOURS], index ? 2. : 1.2);
  fprintf(out, " lc rgb '%s' ", colour);
  if (series->name) fputs("title ", out), gnuplot_quote(out, series->name);
  else fputs("notitle", out);
}

/* A filled strip behind the curves, from edge to edge, with the colour of its number from the end:
 * the first colours are those of the first curves. */
static void write_band(FILE *out, const FigureBand *band, PetscInt index)
{
  const char *colour = colours[N_COLOURS - 1 - index % N_COLOURS];
  if (band->high > band->low)
    fprintf(out, "$b%" PetscInt_FMT " using 1:2:3 with filledcurves fs solid 0.18 noborder lc rgb '%s' title ", index,
            colour);
  else fprintf(out, "$b%" PetscInt_FMT " using 1:2 with lines lw 1.5 dt 3 lc rgb '%s' title ", index, colour);
  gnuplot_quote(out, band->name);
}

static void write_band_data(FILE *out, const FigureBand *band, PetscInt index, PetscReal from, PetscReal to)
{
  fprintf(out, "$b%" PetscInt_FMT " << EOD\n", index);
  for (int end = 0; end < 2; ++end)
    fprintf(out, "%.15g %.15g %.15g\n", (double)(end ? to : from), (double)band->low, (double)band->high);
  fputs("EOD\n", out);
}

/* The reference line, which lies below the middle of the curves. */
static PetscReal slope_value(PetscReal slope, const PetscReal min[2], const PetscReal max[2], PetscReal x)
{
  return 0.4 * PetscSqrtReal(min[1] * max[1]) * PetscPowReal(x / PetscSqrtReal(min[0] * max[0]), slope);
}

static void write_slope(FILE *out, PetscReal slope, const PetscReal min[2], const PetscReal max[2])
{
  fprintf(out, "$slope << EOD\n%.15g %.15g\n%.15g %.15g\nEOD\n", (double)min[0],
          (double)slope_value(slope, min, max, min[0]), (double)max[0], (double)slope_value(slope, min, max, max[0]));
}

static void write_figure(FILE *out, const Figure *figure, const PetscReal *min, const PetscReal *max)
{
  PetscBool first = PETSC_TRUE;
  PetscBool named = figure->slope != 0 || figure->n_bands;
  for (PetscInt s = 0; s < figure->n_series; ++s)
    if (figure->series[s].name) named = PETSC_TRUE;
  const PetscBool slope = figure->slope != 0 && figure->log_x && figure->log_y;
  PetscReal low[N_AXES] = {min[0], min[1], min[2]}, high[N_AXES] = {max[0], max[1], max[2]};
  for (int end = 0; end < 2 && slope; ++end) {
    const PetscReal y = slope_value(figure->slope, min, max, end ? max[0] : min[0]);
    low[1] = PetscMin(low[1], y), high[1] = PetscMax(high[1], y);
  }
  write_axes(out, figure, low, high);
  if (!named) fputs("unset key\n", out);
  if (figure->log_x && max[0] / min[0] < 100) write_ticks(out, figure, min[0], max[0]);
  for (PetscInt s = 0; s < figure->n_series; ++s) write_data(out, figure, &figure->series[s], s);
  if (slope) write_slope(out, figure->slope, min, max);
  for (PetscInt b = 0; b < figure->n_bands; ++b) write_band_data(out, &figure->bands[b], b, min[0], max[0]);
  fputs("plot ", out);
  for (PetscInt b = 0; b < figure->n_bands; ++b, first = PETSC_FALSE) {
    if (!first) fputs(", ", out);
    write_band(out, &figure->bands[b], b);
  }
  for (PetscInt s = 0; s < figure->n_series; ++s) {
    if (!any_visible(figure, &figure->series[s])) continue;
    if (!first) fputs(", ", out);
    write_curve(out, &figure->series[s], s);
    first = PETSC_FALSE;
  }
  if (slope)
    fprintf(out, ", $slope with lines lw 1.5 dt 2 lc rgb '#888888' title 'order %g'",
            (double)PetscAbsReal(figure->slope));
  fputc('\n', out);
}

PetscErrorCode FigureWrite(const Figure *figure, const char *png, Diag *diag, PetscBool *done)
{
  PetscReal min[N_AXES] = {0}, max[N_AXES] = {0};
  GnuplotScript script;

  PetscFunctionBeginUser;
  *done = PETSC_FALSE;
  if (bounds(figure, min, max) == 0) {
    diag_error(diag, NULL, "there is nothing to draw in '%s'", png);
    PetscFunctionReturn(0);
  }
  PetscCall(
    GnuplotBegin(&script, png, figure->width ? figure->width : WIDTH, figure->height ? figure->height : HEIGHT));
  write_figure(script.out, figure, min, max);
  PetscCall(GnuplotEnd(&script, png, diag, done));
  PetscFunctionReturn(0);
}

PetscErrorCode FigureSheet(const char *title, PetscInt n, const Figure *figures, PetscInt columns, const char *png,
                           Diag *diag, PetscBool *done)
{
  const int rows = (int)((n + columns - 1) / columns);
  GnuplotScript script;

  PetscFunctionBeginUser;
  PetscCall(GnuplotBegin(&script, png, SHEET_WIDTH * (int)columns, SHEET_HEIGHT * rows));
  fprintf(script.out, "set multiplot layout %d,%d", rows, (int)columns);
  if (title && title[0]) fputs(" title ", script.out), gnuplot_quote(script.out, title);
  fputc('\n', script.out);
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal min[N_AXES] = {0}, max[N_AXES] = {0};
    Figure figure = figures[k];
    figure.width = SHEET_WIDTH, figure.height = SHEET_HEIGHT;
    fputs("reset\n", script.out);
    if (bounds(&figure, min, max)) write_figure(script.out, &figure, min, max);
    else fputs("set multiplot next\n", script.out);
  }
  fputs("unset multiplot\n", script.out);
  PetscCall(GnuplotEnd(&script, png, diag, done));
  PetscFunctionReturn(0);
}

/* Units with a prefix of their own, powers and reciprocals stay as they are. */
static PetscBool takes_prefix(const char *unit)
{
  static const char *const units[] = {"m", "m/s", "m/s2", "Pa", "N", "N/m", "N/m2", "J", "J/m", "J/m3", "W", NULL};
  for (int i = 0; units[i]; ++i)
    if (!strcmp(unit, units[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscReal figure_unit(const char *unit, PetscReal largest, char prefixed[64])
{
  static const char *const prefixes[] = {"n", "µ", "m", "", "k", "M", "G", "T"};
  int k = 3;
  PetscReal size = PetscAbsReal(largest), factor = 1;
  const PetscBool far = size >= 1e4 || (size > 0 && size < 1e-2);
  if (far && takes_prefix(unit) && !PetscIsInfOrNanReal(size)) {
    for (; size >= 1e3 && k < 7; ++k) size *= 1e-3, factor *= 1e-3;
    for (; size < 1 && k > 0; --k) size *= 1e3, factor *= 1e3;
  }
  snprintf(prefixed, 64, "%s%s", prefixes[k], unit);
  return factor;
}
