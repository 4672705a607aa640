/* A picture of histories: the measure of a study over time, a curve for each of its rows. Where the
 * rows are moments of one run, a curve for each series, with marks where its references are. */
#include <string.h>
#include "base/text.h"
#include "picture/figure.h"
#include "output/history.h"
#include "verify/verify_private.h"

/* The curve of one row, whose numbers *values holds (to be freed); an empty one if there is no such
 * history. */
static PetscErrorCode ReadCurve(const VerifyRow *r, FigureSeries *s, PetscReal **values)
{
  const PetscReal unit = r->series->time_scale;
  char path[PETSC_MAX_PATH_LEN], reason[256];
  History history;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", r->folder));
  if (HistoryRead(path, &history, reason)) PetscFunctionReturn(0);
  const PetscInt column = history_column(&history, r->study->measure), n = column < 0 ? 0 : history.n_rows;
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
  if (r->study->n_rows == 1 || r->study->moments) PetscSNPrintf(name, size, "%s", title);
  else PetscSNPrintf(name, size, "%s, %s = %s", title, r->study->sweep.symbol, r->row->at);
}

static PetscErrorCode Draw(const Verification *v, const VerifyRow *r, PetscInt n, const FigureSeries *series,
                           Diag *diag, PetscBool *done)
{
  const PetscBool normal = r->study->figure == VERIFY_FIGURE_NORMAL_HISTORY;
  const SweepSpec *sweep = &r->study->sweep;
  char png[PETSC_MAX_PATH_LEN], x_label[200] = "time [s]", y_label[TEXT_LABEL];
  PetscBool scaled = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < r->study->n_series; ++s)
    if (r->study->series[s].time_scale != 1) scaled = PETSC_TRUE;
  PetscCall(PetscSNPrintf(png, sizeof png, "%s/%s.png", v->out, r->study->name));
  if (normal) PetscCall(PetscSNPrintf(y_label, sizeof y_label, "%s over its last value", r->study->measure));
  else text_with_unit(r->study->measure, r->unit, y_label);
  if (scaled) PetscCall(PetscSNPrintf(x_label, sizeof x_label, "time over its scale"));
  else if (r->study->moments)
    PetscCall(PetscSNPrintf(x_label, sizeof x_label, "%s [%s]", sweep->symbol,
                            sweep->unit && sweep->unit[0] ? sweep->unit : "1"));
  const Figure figure = {
    .title = r->study->title, .x_label = x_label, .y_label = y_label, .n_series = n, .series = series};
  PetscCall(FigureWrite(&figure, png, diag, done));
  PetscFunctionReturn(0);
}

/* What the rows first .. last - 1 of one series must give at their moments; an empty curve if they
 * are not compared. */
static PetscErrorCode ReadReferences(const VerifyRow *first, const VerifyRow *last, FigureSeries *s, PetscReal **values)
{
  const PetscInt n = (PetscInt)(last - first);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, values));
  for (const VerifyRow *r = first; r < last; ++r) {
    if (!r->ran || PetscIsNanReal(r->reference)) continue;
    (*values)[s->n] = r->row->x;
    (*values)[n + s->n++] = r->reference;
  }
  s->x = *values;
  s->y = *values + n;
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyHistoryDraw(const Verification *v, PetscInt first, PetscInt last, Diag *diag, PetscBool *done)
{
  const PetscBool moments = v->rows[first].study->moments;
  const PetscInt most = 2 * (last - first);
  PetscInt n = 0;
  FigureSeries *series;
  PetscReal **values;
  char(*name)[128];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(most, &series));
  PetscCall(PetscCalloc1(most, &values));
  PetscCall(PetscCalloc1(most, &name));
  for (PetscInt k = first, next; k < last; k = next) {
    const VerifyRow *r = &v->rows[k];
    for (next = k + 1; moments && next < last && v->rows[next].series == r->series;) ++next;
    name_curve(r, name[n], sizeof name[n]);
    series[n] = (FigureSeries){.name = name[n], .style = FIGURE_LINE};
    if (r->ran && r->result == RUN_DONE) PetscCall(ReadCurve(r, &series[n], &values[n]));
    ++n;
    if (!moments) continue;
    PetscCall(PetscSNPrintf(name[n], sizeof name[n], "%s, reference", name[n - 1]));
    series[n] = (FigureSeries){.name = name[n], .style = FIGURE_MARKS};
    PetscCall(ReadReferences(r, &v->rows[next], &series[n], &values[n]));
    if (series[n].n) ++n;
    else PetscCall(PetscFree(values[n]));
  }
  PetscCall(Draw(v, &v->rows[first], n, series, diag, done));
  for (PetscInt k = 0; k < n; ++k) PetscCall(PetscFree(values[k]));
  PetscCall(PetscFree(values));
  PetscCall(PetscFree(name));
  PetscCall(PetscFree(series));
  PetscFunctionReturn(0);
}
