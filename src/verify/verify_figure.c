/* A picture of a study: errors over refinement or over time of computing, or values beside their
 * references. */
#include <math.h>
#include <string.h>
#include "base/text.h"
#include "picture/figure.h"
#include "verify/verify_private.h"

typedef struct {
  PetscInt n;
  FigureSeries *series;
  PetscReal *x, *y; /* of all series, one behind the other */
  PetscInt used;
} Curves;

/* Do the rows refine towards small values, as cell sizes do? Then 1/x is drawn. */
static PetscBool refines_downwards(const Verification *v, PetscInt first, PetscInt last)
{
  const VerifyRow *a = &v->rows[first], *b = a;
  for (PetscInt k = first; k < last && v->rows[k].series == a->series; ++k) b = &v->rows[k];
  return b->row->x < a->row->x;
}

/* Does each row's place stand well apart from the last by a factor, as in a series of meshes? Then
 * the axis is logarithmic. */
static PetscBool grows_by_factors(const Curves *c)
{
  for (PetscInt k = 0; k < c->n; ++k) {
    const FigureSeries *s = &c->series[k];
    if (s->n < 4) return PETSC_FALSE;
    for (PetscInt i = 0; i + 1 < s->n; ++i)
      if (!(s->x[i] > 0) || s->x[i + 1] < 1.7 * s->x[i]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static void add_curve(Curves *c, const Verification *v, PetscInt first, PetscInt last, PetscBool inverse,
                      PetscBool reference, FigureStyle style)
{
  const PetscBool errors = verify_draws_errors(v->rows[first].study);
  const PetscBool cost = v->rows[first].study->figure == VERIFY_FIGURE_COST;
  const SeriesSpec *spec = v->rows[first].series;
  const char *title = spec->title ? spec->title : spec->name;
  FigureSeries *s = &c->series[c->n++];
  *s = (FigureSeries){.name = reference ? NULL : title, .style = style, .x = c->x + c->used, .y = c->y + c->used};
  for (PetscInt k = first; k < last; ++k) {
    const VerifyRow *r = &v->rows[k];
    if (!r->ran || r->result != RUN_DONE || PetscIsNanReal(r->row->x)) continue;
    c->x[c->used] = cost ? r->summary.seconds : inverse ? 1 / r->row->x : r->row->x;
    c->y[c->used++] = errors ? r->error : reference ? r->reference : r->value;
    ++s->n;
  }
}

static void collect(Curves *c, const Verification *v, PetscInt first, PetscInt last, PetscBool inverse)
{
  const PetscBool values = v->rows[first].study->figure == VERIFY_FIGURE_VALUES;
  for (PetscInt from = first, to; from < last; from = to) {
    for (to = from; to < last && v->rows[to].series == v->rows[from].series;) ++to;
    add_curve(c, v, from, to, inverse, PETSC_FALSE, FIGURE_LINE_MARKS);
    if (values) add_curve(c, v, from, to, inverse, PETSC_TRUE, FIGURE_DASHES);
  }
}

static PetscErrorCode Draw(const Verification *v, PetscInt first, const Curves *c, PetscBool inverse, Diag *diag,
                           PetscBool *done)
{
  const StudySpec *study = v->rows[first].study;
  const SweepSpec *sweep = &study->sweep;
  const char *unit = sweep->unit ? sweep->unit : "";
  const PetscBool errors = verify_draws_errors(study), cost = study->figure == VERIFY_FIGURE_COST;
  char png[PETSC_MAX_PATH_LEN], x_label[200], y_label[TEXT_LABEL];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(png, sizeof png, "%s/%s.png", v->out, study->name));
  if (cost) PetscCall(PetscStrncpy(x_label, "time of the run [s]", sizeof x_label));
  else
    PetscCall(PetscSNPrintf(x_label, sizeof x_label, inverse ? "1/%s%s%s%s" : "%s%s%s%s", sweep->symbol,
                            unit[0] ? inverse ? " [1/" : " [" : "", unit, unit[0] ? "]" : ""));
  if (errors)
    PetscCall(PetscSNPrintf(y_label, sizeof y_label, study->exact.value == 0 ? "error: %s" : "relative error of %s",
                            study->measure));
  else text_with_unit(study->measure, v->rows[first].unit, y_label);
  const Figure figure = {.title = study->title,
                         .x_label = x_label,
                         .y_label = y_label,
                         .log_x = errors || grows_by_factors(c),
                         .log_y = errors,
                         .n_series = c->n,
                         .series = c->series,
                         .slope = errors && !cost ? (inverse ? -1 : 1) * study->exact.order : 0};
  PetscCall(FigureWrite(&figure, png, diag, done));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyFigureDraw(const Verification *v, PetscInt first, PetscInt last, Diag *diag, PetscBool *done)
{
  const StudySpec *study = v->rows[first].study;
  const PetscBool inverse =
    study->figure == VERIFY_FIGURE_CONVERGENCE ? refines_downwards(v, first, last) : PETSC_FALSE;
  const size_t n = 2 * (size_t)(last - first);
  Curves c = {.n = 0};

  PetscFunctionBeginUser;
  *done = PETSC_FALSE;
  if (study->figure == VERIFY_FIGURE_NONE) PetscFunctionReturn(0);
  if (study->figure >= VERIFY_FIGURE_HISTORY) {
    PetscCall(VerifyHistoryDraw(v, first, last, diag, done));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc3((size_t)(2 * study->n_series), &c.series, n, &c.x, n, &c.y));
  collect(&c, v, first, last, inverse);
  PetscCall(Draw(v, first, &c, inverse, diag, done));
  PetscCall(PetscFree3(c.series, c.x, c.y));
  PetscFunctionReturn(0);
}
