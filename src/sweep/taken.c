#include "sweep/taken.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

const SchemaWord take_words[] = {
  {"end", TAKE_END, "its value at the end"},
  {"max", TAKE_MAX, "the largest value"},
  {"min", TAKE_MIN, "the smallest value"},
  {"mean", TAKE_MEAN, "the mean over time"},
  {"slope", TAKE_SLOPE, "the slope over time, by least squares"},
  {NULL, 0, NULL},
};

const char *taken_name(const Taken *taken, char name[128])
{
  if (taken->take == TAKE_END) PetscSNPrintf(name, 128, "%s", taken->measure);
  else PetscSNPrintf(name, 128, "%s %s", taken->measure, take_words[taken->take].word);
  return name;
}

static PetscBool same_window(const Taken *a, const Taken *b)
{
  if (a->has_window != b->has_window) return PETSC_FALSE;
  return (PetscBool)(!a->has_window || (a->from == b->from && a->to == b->to));
}

const char *taken_name_among(const Taken *taken, PetscInt n, const Taken *others, char name[128])
{
  PetscBool alone = PETSC_TRUE;
  for (PetscInt k = 0; k < n && alone; ++k)
    if (others[k].take == taken->take && !strcmp(others[k].measure, taken->measure))
      alone = same_window(&others[k], taken);
  taken_name(taken, name);
  const size_t used = strlen(name);
  if (!alone && taken->has_window)
    (void)snprintf(name + used, 128 - used, " %.15g to %.15g s", (double)taken->from, (double)taken->to);
  return name;
}

const char *taken_unit(const Taken *taken, const char *measure, char unit[64])
{
  if (taken->unit) PetscSNPrintf(unit, 64, "%s", taken->unit);
  else if (taken->take == TAKE_SLOPE) PetscSNPrintf(unit, 64, "%s/s", measure[0] ? measure : "1");
  else PetscSNPrintf(unit, 64, "%s", measure);
  return unit;
}

/* A measure over the window, or as much of it as the history has: a line between rows, or steps of means, so that the
 * window cuts both ends where no row stands there. */
typedef struct {
  const History *history;
  const TakenMeans *means;
  PetscInt column, stage; /* stage: its column, -1 without stages */
  PetscInt first, last;   /* rows in the window; first > last: none */
  PetscReal from, to;     /* what of the window is in the history */
} Span;

static PetscReal time_of(const Span *s, PetscInt i) { return s->history->values[i * s->history->n_columns]; }
static PetscReal value_of(const Span *s, PetscInt i)
{
  return s->history->values[i * s->history->n_columns + s->column];
}

/* Is the value of a row the mean since the row before? */
static PetscBool is_mean(const Span *s, PetscInt row)
{
  const PetscReal stage = s->stage < 0 ? 1 : s->history->values[row * s->history->n_columns + s->stage];
  return (PetscBool)(stage >= 1 && stage <= (PetscReal)s->means->n && s->means->is[(PetscInt)stage - 1]);
}

/* times are sums of steps */
static PetscReal air_of(const Taken *taken)
{
  return taken->has_window ? 1e-9 * PetscMax(PetscAbsReal(taken->from), PetscAbsReal(taken->to)) : 0;
}

/* Ends within air of a row are that row's. */
static Span span_of(const Taken *taken, const TakenMeans *means, const History *history)
{
  Span s = {.history = history,
            .means = means,
            .column = history_column(history, taken->measure),
            .stage = history_column(history, "stage"),
            .last = history->n_rows - 1};
  const PetscReal air = air_of(taken), begin = time_of(&s, 0), end = time_of(&s, s.last);
  s.from = taken->has_window ? PetscMax(taken->from, begin) : begin;
  s.to = taken->has_window ? PetscMin(taken->to, end) : end;
  while (s.first <= s.last && time_of(&s, s.first) < s.from - air) ++s.first;
  while (s.last >= s.first && time_of(&s, s.last) > s.to + air) --s.last;
  if (s.first <= s.last && time_of(&s, s.first) <= s.from + air) s.from = time_of(&s, s.first);
  if (s.first <= s.last && time_of(&s, s.last) >= s.to - air) s.to = time_of(&s, s.last);
  return s;
}

/* Entry i of its n: the rows in the window, and before and behind them the ends where no row is. */
static PetscInt entries(const Span *s)
{
  const PetscInt n = s->last - s->first + 1;
  if (!n) return s->to > s->from ? 2 : 1;
  return n + (s->from < time_of(s, s->first)) + (s->to > time_of(s, s->last));
}

static PetscReal between(const Span *s, PetscInt row, PetscReal t)
{
  if (is_mean(s, row + 1)) return value_of(s, row + 1);
  const PetscReal t0 = time_of(s, row), y0 = value_of(s, row);
  return y0 + (t - t0) / (time_of(s, row + 1) - t0) * (value_of(s, row + 1) - y0);
}

/* That of entry i, or the one behind it. */
static PetscInt row_of(const Span *s, PetscInt i)
{
  const PetscBool cut = (PetscBool)(s->first > s->last || s->from < time_of(s, s->first));
  return s->first + i - cut;
}

static void entry(const Span *s, PetscInt i, PetscReal *t, PetscReal *y)
{
  const PetscInt row = row_of(s, i);
  if (row < s->first) *t = s->from, *y = between(s, s->first - 1, s->from);
  else if (row > s->last) *t = s->to, *y = between(s, s->last, s->to);
  else *t = time_of(s, row), *y = value_of(s, row);
}

static PetscReal mean_of(const Span *s)
{
  PetscReal area = 0, t, y, next_t, next_y;
  entry(s, 0, &t, &y);
  if (!(s->to > s->from)) return y;
  for (PetscInt i = 1; i < entries(s); ++i, t = next_t, y = next_y) {
    entry(s, i, &next_t, &next_y);
    area += (next_t - t) * (is_mean(s, row_of(s, i)) ? value_of(s, row_of(s, i)) : 0.5 * (y + next_y));
  }
  return area / (s->to - s->from);
}

/* Of the rows alone. */
static PetscReal slope_of(const Span *s)
{
  const PetscReal n = (PetscReal)(s->last - s->first + 1);
  PetscReal t = 0, y = 0, tt = 0, ty = 0;
  for (PetscInt i = s->first; i <= s->last; ++i) t += time_of(s, i) / n, y += value_of(s, i) / n;
  for (PetscInt i = s->first; i <= s->last; ++i) {
    tt += (time_of(s, i) - t) * (time_of(s, i) - t);
    ty += (time_of(s, i) - t) * (value_of(s, i) - y);
  }
  return tt > 0 ? ty / tt : NAN;
}

/* NaN in a row is NaN in all. */
static PetscReal extreme_of(const Span *s, PetscReal sign)
{
  PetscReal most, t, y;
  entry(s, 0, &t, &most);
  for (PetscInt i = 1; i < entries(s); ++i) {
    entry(s, i, &t, &y);
    if (PetscIsNanReal(y) || sign * y > sign * most) most = y;
  }
  return most;
}

static PetscReal end_of(const Span *s)
{
  PetscReal t, y;
  entry(s, entries(s) - 1, &t, &y);
  return y;
}

static PetscReal take_from(const Taken *taken, const Span *s)
{
  switch (taken->take) {
  case TAKE_MAX: return extreme_of(s, 1);
  case TAKE_MIN: return extreme_of(s, -1);
  case TAKE_MEAN: return mean_of(s);
  case TAKE_SLOPE: return slope_of(s);
  default: return end_of(s);
  }
}

/* A value at the end of a run is missing there, which the run itself has told. */
static void tell_missing(const Taken *taken, const Span *s, char why[TAKEN_WHY])
{
  PetscReal t, y;
  if (taken->take == TAKE_SLOPE && !(s->last > s->first && time_of(s, s->last) > time_of(s, s->first))) {
    (void)snprintf(why, TAKEN_WHY, "a slope needs two rows of the history, and from %g to %g s there is less",
                   (double)s->from, (double)s->to);
    return;
  }
  for (PetscInt i = 0; i < entries(s) && (taken->has_window || taken->take != TAKE_END); ++i) {
    entry(s, i, &t, &y);
    if (!PetscIsNanReal(y)) continue;
    (void)snprintf(why, TAKEN_WHY, "it has no value (nan) at %g s", (double)t);
    return;
  }
}

PetscReal taken_value(const Taken *taken, const TakenMeans *means, const History *history, char why[TAKEN_WHY])
{
  const PetscReal begin = history->n_rows ? history->values[0] : 0, air = air_of(taken),
                  end = history->n_rows ? history->values[(history->n_rows - 1) * history->n_columns] : 0;
  why[0] = '\0';
  if (!history->n_rows || history_column(history, taken->measure) < 0) {
    (void)snprintf(why, TAKEN_WHY, "the history has no values of it");
    return NAN;
  }
  const PetscBool beyond = (PetscBool)(taken->has_window && (taken->from < begin - air || taken->to > end + air));
  if (beyond && (taken->to < begin - air || taken->from > end + air)) {
    (void)snprintf(why, TAKEN_WHY, "its window, %g to %g s, lies outside of the history, which goes from %g to %g s",
                   (double)taken->from, (double)taken->to, (double)begin, (double)end);
    return NAN;
  }
  const Span s = span_of(taken, means, history);
  const PetscReal value = take_from(taken, &s);
  if (PetscIsNanReal(value)) tell_missing(taken, &s, why);
  else if (beyond)
    (void)snprintf(why, TAKEN_WHY, "its window, %g to %g s, reaches beyond the history: taken from %g to %g s alone",
                   (double)taken->from, (double)taken->to, (double)s.from, (double)s.to);
  return taken->times * value;
}
