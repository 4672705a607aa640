/* Values that a history would have if it had fewer rows: forces of dynamic steps are means since the row before, so
 * that a row times the time since then is the impulse (model/measure/rows.c); rows are added up as such. */
#include "picture/compare/rows.h"
#include <math.h>
#include <string.h>
#include "base/formula.h"
#include "model/measure/measure.h"

/* From one time to another, of the stage that the latter lies in. */
typedef struct {
  const RowsOf *of;
  const Case *c;
  PetscInt row, before; /* the first row at `to` or behind it; how many measures of the stage may be asked for */
  PetscReal from, to;
} Span;

static PetscReal time_of(const CurveRun *run, PetscInt row) { return curve_run_value(run, row, 0); }

/* times are sums of steps */
static PetscReal air_at(PetscReal t) { return 1e-9 * PetscAbsReal(t); }

/* The first row at t or behind it; the number of rows: there is none. */
static PetscInt row_at(const CurveRun *run, PetscReal t)
{
  PetscInt low = 0, high = run->history.n_rows;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (time_of(run, middle) < t - air_at(t)) low = middle + 1;
    else high = middle;
  }
  return low;
}

/* The case of the stage that a row is of. */
static const Case *case_of_row(const RowsOf *of, PetscInt row)
{
  const PetscInt column = history_column(&of->run->history, "stage");
  const PetscReal stage = column < 0 ? 1 : curve_run_value(of->run, row, column);
  return stage >= 1 && stage <= (PetscReal)case_stages(of->c) ? case_stage(of->c, (PetscInt)stage - 1) : NULL;
}

/* The mean over the span of a column whose rows are means. Rows without length count for nothing. */
static PetscReal mean_over(const Span *s, PetscInt column)
{
  const CurveRun *run = s->of->run;
  PetscReal mean = 0, length = 0;
  for (PetscInt i = PetscMax(row_at(run, s->from), 1); i <= s->row; ++i) {
    const PetscReal share = PetscMin(time_of(run, i), s->to) - PetscMax(time_of(run, i - 1), s->from);
    if (share <= air_at(s->to)) continue;
    length += share;
    mean += share / length * (curve_run_value(run, i, column) - mean);
  }
  return length > 0 ? mean : curve_run_value(run, s->row, column);
}

/* On the line between rows. */
static PetscReal value_at(const Span *s, PetscInt column)
{
  const CurveRun *run = s->of->run;
  const PetscReal t = time_of(run, s->row), y = curve_run_value(run, s->row, column);
  if (s->row == 0 || t - s->to <= air_at(t)) return y;
  const PetscReal t0 = time_of(run, s->row - 1), y0 = curve_run_value(run, s->row - 1, column);
  return y0 + (s->to - t0) / (t - t0) * (y - y0);
}

static PetscErrorCode ValueOf(const Span *s, PetscInt k, PetscReal *value);

static PetscErrorCode Other(void *context, const char *name, PetscBool *known, PetscReal *value)
{
  const Span *s = context;
  const PetscInt k = case_measure_of(s->c, name);

  PetscFunctionBeginUser;
  *known = (PetscBool)(k >= 0 && k < s->before);
  if (*known) PetscCall(ValueOf(s, k, value));
  PetscFunctionReturn(0);
}

/* Of measure k of the stage; nan where the history does not have it. */
static PetscErrorCode ValueOf(const Span *s, PetscInt k, PetscReal *value)
{
  const MeasureSpec *spec = s->c->measures + k;
  const PetscInt column = history_column(&s->of->run->history, spec->name);
  Span above = *s;
  Formula formula = {.value = Other, .context = &above, .at = spec->word};
  PetscBool mean;

  PetscFunctionBeginUser;
  above.before = k;
  PetscCall(MeasureRowIsMean(s->c, k, &mean));
  if (column < 0) *value = NAN;
  else if (!mean) *value = value_at(s, column);
  else if (!strcmp(spec->kind, "formula")) PetscCall(FormulaValue(&formula, value));
  else *value = mean_over(s, column);
  PetscFunctionReturn(0);
}

PetscErrorCode RowsAreMeans(const RowsOf *of, PetscBool *are)
{
  PetscFunctionBeginUser;
  *are = PETSC_FALSE;
  for (PetscInt k = 0; of->c && k < case_stages(of->c) && !*are; ++k) {
    const Case *c = case_stage(of->c, k);
    PetscCall(MeasureRowIsMean(c, case_measure_of(c, of->measure), are));
  }
  PetscFunctionReturn(0);
}

/* The first row behind t; NaN: there is none. */
static PetscReal time_behind(const CurveRun *run, PetscReal t)
{
  for (PetscInt i = row_at(run, t); i < run->history.n_rows; ++i)
    if (time_of(run, i) > t + air_at(t)) return time_of(run, i);
  return NAN;
}

/* From the later begin of both on; NaN behind the last. */
static PetscReal common_behind(const RowsOf of[2], PetscReal t)
{
  const PetscReal first = time_behind(of[0].run, t), second = time_behind(of[1].run, t);
  if (PetscIsNanReal(first) || PetscIsNanReal(second)) return NAN;
  const PetscReal later = PetscMax(first, second);
  for (int k = 0; k < 2; ++k)
    if (row_at(of[k].run, later) == of[k].run->history.n_rows) return NAN;
  return later;
}

static PetscErrorCode RowsAt(const RowsOf *of, PetscInt n, const PetscReal *time, PetscReal *value)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt row = row_at(of->run, time[i]);
    const Span s = {.of = of, .c = case_of_row(of, row), .row = row, .from = time[PetscMax(i - 1, 0)], .to = time[i]};
    const PetscInt k = s.c ? case_measure_of(s.c, of->measure) : -1;
    value[i] = NAN;
    if (k >= 0) PetscCall(ValueOf(&s, k, value + i));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode RowsInCommon(const RowsOf of[2], PetscInt *n, PetscReal *time, PetscReal *const values[2])
{
  const PetscReal begin[2] = {time_of(of[0].run, 0), time_of(of[1].run, 0)}, from = PetscMax(begin[0], begin[1]);

  PetscFunctionBeginUser;
  *n = 0;
  for (PetscReal t = from; !PetscIsNanReal(t); t = common_behind(of, t)) time[(*n)++] = t;
  for (int k = 0; k < 2; ++k) PetscCall(RowsAt(&of[k], *n, time, values[k]));
  /* a row in the middle of a run is a mean over what the other one has not seen */
  if (PetscAbsReal(begin[1] - begin[0]) > air_at(from)) values[0][0] = values[1][0] = NAN;
  PetscFunctionReturn(0);
}
