/* A picture of histories: the measure of a study over time, a curve for each of its rows. */
#include <string.h>
#include "io/figure.h"
#include "io/history.h"
#include "run/verify_private.h"

/* The curve of one row, whose numbers *values holds (to be freed); an empty one if there is no such history. */
static PetscErrorCode ReadCurve(const VerifyRow *r, FigureSeries *s, PetscReal **values)
{
  const PetscReal unit = r->series->time_scale;
  char path[PETSC_MAX_PATH_LEN], reason[256];
  History history;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", r->folder));
  if (HistoryRead(path, &history, reason)) PetscFunctionReturn(0);
  const PetscInt column = HistoryColumn(&history, r->study->measure), n = column < 0 ? 0 : history.n_rows;
  PetscCall(PetscMalloc1(2 * n + 1, values));
  const PetscReal last = n > 0 ? history.values[(n - 1) * history.n_columns + column] : 1;
  const PetscReal scale = r->study->figure == VERIFY_FIGURE_NORMAL_HISTORY && last != 0 ? last : 1;
  PetscReal *x = *values;
  for (PetscInt i = 0; i < n; ++i) {
    x[i] = history.values[i * history.n_columns] / unit;
    x[n + i] = history.values[i * history.n_columns + column] / scale;
  }
  s->n = n;
  s->x = x;
  s->y = x + n;
  PetscCall(HistoryFree(&history));
  PetscFunctionReturn(0);
}

/* "a3, mesh = 2", or the series alone if the study has one row. */
static void name_curve(const VerifyRow *r, char *name, size_t size)
{
  const char *title = r->series->title ? r->series->title : r->series->name;
  if (r->study->n_rows == 1) PetscSNPrintf(name, size, "%s", title);
  else PetscSNPrintf(name, size, "%s, %s = %s", title, r->study->sweep.symbol, r->row->at);
}

static PetscErrorCode Draw(const Verification *v, const VerifyRow *r, PetscInt n, const FigureSeries *series,
                           Diag *diag, PetscBool *done)
{
  const PetscBool normal = r->study->figure == VERIFY_FIGURE_NORMAL_HISTORY ? PETSC_TRUE : PETSC_FALSE;
  char png[PETSC_MAX_PATH_LEN], y_label[200];
  PetscBool scaled = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < r->study->n_series; ++s)
    if (r->study->series[s].time_scale != 1) scaled = PETSC_TRUE;
  PetscCall(PetscSNPrintf(png, sizeof png, "%s/%s.png", v->out, r->study->name));
  PetscCall(
    PetscSNPrintf(y_label, sizeof y_label, normal ? "%s over its last value" : "%s [%s]", r->study->measure, r->unit));
  const Figure figure = {.title = r->study->title,
                         .x_label = scaled ? "time over its scale" : "time [s]",
                         .y_label = y_label,
                         .n_series = n,
                         .series = series};
  PetscCall(FigureWrite(&figure, png, diag, done));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyHistoryDraw(const Verification *v, PetscInt first, PetscInt last, Diag *diag, PetscBool *done)
{
  const PetscInt n = last - first;
  FigureSeries *series;
  PetscReal **values;
  char(*name)[128];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &series));
  PetscCall(PetscCalloc1(n, &values));
  PetscCall(PetscCalloc1(n, &name));
  for (PetscInt k = 0; k < n; ++k) {
    const VerifyRow *r = &v->rows[first + k];
    name_curve(r, name[k], sizeof name[k]);
    series[k] = (FigureSeries){.name = name[k], .style = FIGURE_LINE};
    if (r->ran && r->result == RUN_DONE) PetscCall(ReadCurve(r, &series[k], &values[k]));
  }
  PetscCall(Draw(v, &v->rows[first], n, series, diag, done));
  for (PetscInt k = 0; k < n; ++k) PetscCall(PetscFree(values[k]));
  PetscCall(PetscFree(values));
  PetscCall(PetscFree(name));
  PetscCall(PetscFree(series));
  PetscFunctionReturn(0);
}
