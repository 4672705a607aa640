#include <math.h>
#include <string.h>
#include "base/text.h"
#include "picture/figure.h"
#include "output/history.h"
#include "picture/plot.h"
#include "output/directory/run_dir_files.h"

static PetscReal at(const History *history, PetscInt row, PetscInt column)
{
  return history->values[(size_t)row * (size_t)history->n_columns + (size_t)column];
}

/* A measure that never had a value is no curve. */
static PetscBool has_values(const History *history, PetscInt column)
{
  for (PetscInt i = 0; i < history->n_rows; ++i)
    if (!PetscIsInfOrNanReal(at(history, i, column))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* One measure over time, in a unit that suits. */
static PetscErrorCode DrawMeasure(const History *history, PetscInt column, const char *png, Diag *diag, PetscBool *done)
{
  const PetscInt n = history->n_rows;
  PetscReal *time, *value, largest = 0;
  char unit[64], label[TEXT_LABEL];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &time, n, &value));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal v = at(history, i, column);
    if (fabs(v) < 1e300) largest = PetscMax(largest, fabs(v));
  }
  const PetscReal factor = figure_unit(history->units[column], largest, unit);
  for (PetscInt i = 0; i < n; ++i) {
    time[i] = at(history, i, 0);
    value[i] = factor * at(history, i, column);
  }
  text_with_unit(history->names[column], unit, label);
  const FigureSeries series = {.style = n > 40 ? FIGURE_LINE : FIGURE_LINE_MARKS, .n = n, .x = time, .y = value};
  const Figure figure = {
    .title = history->names[column], .x_label = "time [s]", .y_label = label, .n_series = 1, .series = &series};
  PetscCall(FigureWrite(&figure, png, diag, done));
  PetscCall(PetscFree2(time, value));
  PetscFunctionReturn(0);
}

static PetscErrorCode DrawAll(const PlotOptions *options, const History *history, Diag *diag,
                              void (*said)(const char *path))
{
  PetscBool done = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt column = 2; column < history->n_columns && done; ++column) {
    char name[192], png[FILE_PATH + 256];
    if (!has_values(history, column)) {
      diag_warning(diag, NULL, "the measure '%s' has no value in any row: it is not drawn", history->names[column]);
      continue;
    }
    snprintf(name, sizeof name, "history_%.150s.png", history->names[column]);
    plot_file_name(name);
    PetscCall(PetscSNPrintf(png, sizeof png, "%s/pictures/%s", options->run, name));
    PetscCall(DrawMeasure(history, column, png, diag, &done));
    if (done && said) said(png);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PlotHistories(const PlotOptions *options, Diag *diag, void (*said)(const char *path))
{
  char path[FILE_PATH], reason[256];
  History history;

  PetscFunctionBeginUser;
  if (!file_exists(options->run, "history.csv")) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", options->run));
  if (HistoryRead(path, &history, reason)) {
    diag_error(diag, NULL, "cannot read '%s': %s", path, reason);
    PetscFunctionReturn(0);
  }
  /* a single row is a number, not a curve */
  if (history.n_rows > 1 && history.n_columns > 2 && plot_folder(options->run, diag))
    PetscCall(DrawAll(options, &history, diag, said));
  PetscCall(HistoryFree(&history));
  PetscFunctionReturn(0);
}
