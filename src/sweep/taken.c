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

/* The rows of a window, t and y. */
typedef struct {
  PetscInt n, columns;
  const PetscReal *row; /* the first */
  PetscInt column;
} Rows;

static PetscReal time_of(const Rows *r, PetscInt i) { return r->row[i * r->columns]; }
static PetscReal value_of(const Rows *r, PetscInt i) { return r->row[i * r->columns + r->column]; }

static Rows rows_within(const Taken *taken, const History *history)
{
  Rows rows = {.columns = history->n_columns, .column = history_column(history, taken->measure)};
  for (PetscInt i = 0; i < history->n_rows && rows.column >= 0; ++i) {
    const PetscReal *row = history->values + i * history->n_columns;
    /* times are sums of steps */
    const PetscReal air = 1e-9 * PetscMax(PetscAbsReal(taken->from), PetscAbsReal(taken->to));
    if (taken->has_window && (row[0] < taken->from - air || row[0] > taken->to + air)) continue;
    if (!rows.n++) rows.row = row;
  }
  return rows;
}

static PetscReal mean_of(const Rows *r)
{
  PetscReal area = 0;
  const PetscReal length = time_of(r, r->n - 1) - time_of(r, 0);
  for (PetscInt i = 0; i + 1 < r->n; ++i)
    area += 0.5 * (time_of(r, i + 1) - time_of(r, i)) * (value_of(r, i) + value_of(r, i + 1));
  return length > 0 ? area / length : value_of(r, 0);
}

static PetscReal slope_of(const Rows *r)
{
  PetscReal t = 0, y = 0, tt = 0, ty = 0;
  for (PetscInt i = 0; i < r->n; ++i) t += time_of(r, i) / (PetscReal)r->n, y += value_of(r, i) / (PetscReal)r->n;
  for (PetscInt i = 0; i < r->n; ++i) {
    tt += (time_of(r, i) - t) * (time_of(r, i) - t);
    ty += (time_of(r, i) - t) * (value_of(r, i) - y);
  }
  return tt > 0 ? ty / tt : NAN;
}

/* NaN in a row is NaN in all. */
static PetscReal extreme_of(const Rows *r, PetscReal sign)
{
  PetscReal most = value_of(r, 0);
  for (PetscInt i = 1; i < r->n; ++i)
    if (PetscIsNanReal(value_of(r, i)) || sign * value_of(r, i) > sign * most) most = value_of(r, i);
  return most;
}

PetscReal taken_value(const Taken *taken, const History *history)
{
  const Rows rows = rows_within(taken, history);
  if (!rows.n) return NAN;
  switch (taken->take) {
  case TAKE_MAX: return taken->times * extreme_of(&rows, 1);
  case TAKE_MIN: return taken->times * extreme_of(&rows, -1);
  case TAKE_MEAN: return taken->times * mean_of(&rows);
  case TAKE_SLOPE: return taken->times * slope_of(&rows);
  default: return taken->times * value_of(&rows, rows.n - 1);
  }
}
