#include "picture/compare/compare_private.h"
#include <math.h>
#include <string.h>
#include "input/case_file.h"
#include "output/directory/run_dir_files.h"
#include "picture/compare/found.h"
#include "picture/compare/rows.h"
#include "picture/plot.h"

static PetscBool is_empty(const Curve *c)
{
  for (PetscInt i = 0; i < c->n; ++i)
    if (!PetscIsInfOrNanReal(c->value[i])) return PETSC_FALSE;
  return PETSC_TRUE;
}

const Lack *compare_lack(const CompareRow *row)
{
  const Lack *a = &row->lacks[0], *b = &row->lacks[1];
  if (a->any && (!b->any || a->from <= b->from)) return a;
  return b->any ? b : NULL;
}

/* Where a run has lost what the other still has, there is no difference at the end. */
static void compare_curves(const Curve *a, const Curve *b, CompareRow *row)
{
  row->found = curve_found_difference(a, b, &row->difference);
  row->met = (PetscBool)(row->found || curve_difference(a, b, &row->difference));
  row->empty = (PetscBool)(is_empty(a) && is_empty(b));
  if (row->found) return;
  if (curve_lack(a, b, &row->lacks[0]) && row->lacks[0].to > row->difference.to) row->difference.last = NAN;
  if (curve_lack(b, a, &row->lacks[1]) && row->lacks[1].to > row->difference.to) row->difference.last = NAN;
}

static PetscBool is_energy(const char *unit) { return (PetscBool)!strcmp(unit, "J"); }

/* Of all energies in the history of a run. */
static PetscReal largest_energy(const CurveRun *run)
{
  PetscReal largest = 0;
  for (PetscInt column = 0; column < run->history.n_columns; ++column)
    for (PetscInt i = 0; i < run->history.n_rows && is_energy(run->history.units[column]); ++i) {
      const PetscReal value = PetscAbsReal(curve_run_value(run, i, column));
      if (!PetscIsInfOrNanReal(value)) largest = PetscMax(largest, value);
    }
  return largest;
}

/* What an energy is made of, or told by a balance, is known to the round-off of the largest of them. */
static PetscErrorCode ChooseScale(const Comparison *c, CompareRow *row)
{
  const CurveRun *a = &c->runs[0], *b = &c->runs[row->run];
  PetscBool balance = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!row->unit[0]) PetscCall(KeysMeasureIs(a->folder, row->measure, "energy", "balance", &balance));
  if (is_energy(row->unit)) row->scale = PetscMax(largest_energy(a), largest_energy(b));
  else if (balance) row->scale = 1;
  if (row->scale > 0 && row->met && !row->found)
    row->difference.relative = difference_relative_to(&row->difference, row->scale);
  PetscFunctionReturn(0);
}

/* As its rows have it. time and value: as many entries as the history has rows. */
static Curve curve_of(const RowsOf *of, PetscReal *time, PetscReal *value)
{
  const PetscInt n = of->run->history.n_rows, column = history_column(&of->run->history, of->measure);
  for (PetscInt i = 0; i < n; ++i) {
    time[i] = curve_run_value(of->run, i, 0);
    value[i] = curve_run_value(of->run, i, column);
  }
  return (Curve){.n = n, .time = time, .value = value};
}

/* Of what is a mean over steps, rows as long as each other are compared. */
static PetscErrorCode Compare(const Comparison *c, CompareRow *row)
{
  const RowsOf of[2] = {{&c->runs[0], c->cases[0], row->measure},
                        {&c->runs[row->run], c->cases[row->run], row->measure}};
  const PetscInt most = of[0].run->history.n_rows + of[1].run->history.n_rows;
  PetscReal *times[2], *values[2];
  PetscBool means = PETSC_FALSE;
  Curve curves[2];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(most, &times[0], most, &times[1], most, &values[0], most, &values[1]));
  for (int k = 0; k < 2 && !means; ++k) PetscCall(RowsAreMeans(&of[k], &means));
  for (int k = 0; k < 2; ++k) curves[k] = curve_of(&of[k], times[k], values[k]);
  if (means && of[0].c && of[1].c) {
    PetscCall(RowsInCommon(of, &curves[0].n, times[0], values));
    curves[1].time = times[0], curves[1].n = curves[0].n;
  }
  compare_curves(&curves[0], &curves[1], row);
  PetscCall(PetscFree4(times[0], times[1], values[0], values[1]));
  PetscFunctionReturn(0);
}

static PetscBool is_wanted(const CompareOptions *o, const char *name)
{
  for (PetscInt k = 0; k < o->n_measures; ++k)
    if (!strcmp(o->measures[k], name)) return PETSC_TRUE;
  return o->n_measures == 0;
}

/* Has every run this column of the first, in the same unit? */
static PetscBool is_common(const Comparison *c, PetscInt column)
{
  const History *h = &c->runs[0].history;
  for (PetscInt r = 1; r < c->options->n_runs; ++r) {
    const History *other = &c->runs[r].history;
    const PetscInt its = history_column(other, h->names[column]);
    if (its < 0 || strcmp(h->units[column], other->units[its]) != 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* "load, tip": the measures of one run; without those that `but`, if there is one, has in the same unit. */
static void list_measures(const CurveRun *run, const CurveRun *but, char list[300])
{
  list[0] = 0;
  for (PetscInt i = 0; i < run->history.n_columns; ++i) {
    const char *name = run->history.names[i];
    const PetscInt its = but ? history_column(&but->history, name) : -1;
    const size_t used = strlen(list);
    if (curve_run_counts(run, i) || (its >= 0 && !strcmp(run->history.units[i], but->history.units[its]))) continue;
    if (used + strlen(name) < 280) snprintf(list + used, 300 - used, "%s%s", used ? ", " : "", name);
    else if (used < 290 && list[used - 1] != '.') snprintf(list + used, 300 - used, ", ...");
  }
}

/* What only one of two runs measures. */
static void tell_missing(const CurveRun *run, const CurveRun *other, Diag *diag)
{
  char list[300];
  list_measures(run, other, list);
  if (list[0]) diag_warning(diag, NULL, "not compared, as '%s' has no such measure: %s", other->folder, list);
}

/* A row for each measure that all runs have, and each run but the first. */
static PetscErrorCode FillRows(Comparison *c)
{
  const History *h = &c->runs[0].history;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(h->n_columns * c->options->n_runs, &c->rows));
  for (PetscInt column = 0; column < h->n_columns; ++column) {
    if (curve_run_counts(&c->runs[0], column) || !is_wanted(c->options, h->names[column])) continue;
    if (!is_common(c, column)) continue;
    for (PetscInt r = 1; r < c->options->n_runs; ++r) {
      CompareRow *row = &c->rows[c->n_rows++];
      *row = (CompareRow){.measure = h->names[column], .unit = h->units[column], .run = r};
      PetscCall(Compare(c, row));
      PetscCall(ChooseScale(c, row));
    }
  }
  PetscFunctionReturn(0);
}

/* Measures that were asked for by name must be there. */
static PetscErrorCode CheckMeasures(const Comparison *c, Diag *diag)
{
  PetscInt column;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->options->n_measures; ++k)
    for (PetscInt r = 0; r < c->options->n_runs; ++r)
      PetscCall(CurveRunColumn(&c->runs[r], c->options->measures[k], diag, &column));
  PetscFunctionReturn(0);
}

static PetscBool times_meet(const CurveRun *a, const CurveRun *b)
{
  return (PetscBool)(a->history.values[0] <= curve_run_value(b, b->history.n_rows - 1, 0) &&
                     b->history.values[0] <= curve_run_value(a, a->history.n_rows - 1, 0));
}

/* Is there anything to compare? */
static void check_rows(const Comparison *c, Diag *diag)
{
  const CurveRun *first = &c->runs[0], *second = &c->runs[1];
  char list[2][300];
  if (c->n_rows == 0) {
    list_measures(first, NULL, list[0]), list_measures(second, NULL, list[1]);
    diag_error(diag, NULL, "the runs have no measure in common");
    diag_hint(diag, "'%s' has: %s; '%s' has: %s", first->folder, list[0], second->folder, list[1]);
    return;
  }
  for (PetscInt r = 1; r < c->options->n_runs && !c->options->n_measures; ++r) {
    tell_missing(first, &c->runs[r], diag);
    tell_missing(&c->runs[r], first, diag);
  }
  for (PetscInt i = 0; i < c->n_rows; ++i)
    if (c->rows[i].met || compare_lack(&c->rows[i])) return;
  diag_error(diag, NULL, "the runs have no time in common%s: '%s' goes from %g to %g s, '%s' from %g to %g s",
             times_meet(first, second) ? " at which both have values" : "", first->folder,
             (double)first->history.values[0], (double)curve_run_value(first, first->history.n_rows - 1, 0),
             second->folder, (double)second->history.values[0],
             (double)curve_run_value(second, second->history.n_rows - 1, 0));
}

/* runs/compare/A-B, if no folder is given. */
static void choose_folder(Comparison *c)
{
  char name[256] = "";
  for (PetscInt r = 0; r < c->options->n_runs; ++r)
    snprintf(name + strlen(name), sizeof name - strlen(name), "%s%s", r ? "-" : "", c->runs[r].name);
  plot_file_name(name);
  if (c->options->out) snprintf(c->folder, sizeof c->folder, "%s", c->options->out);
  else snprintf(c->folder, sizeof c->folder, "runs/compare/%s", name);
}

static PetscErrorCode Draw(const Comparison *c, Diag *diag, void (*said)(const char *path))
{
  const CompareOptions *o = c->options;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n_rows && !diag_errors(diag); ++i) {
    char name[192], path[FILE_PATH + 256];
    if (!c->rows[i].met || c->rows[i].found ||
        (i > 0 && c->rows[i - 1].met && !c->rows[i - 1].found && c->rows[i].measure == c->rows[i - 1].measure))
      continue;
    snprintf(name, sizeof name, "history_%.150s.%s", c->rows[i].measure, plot_ending(o->format));
    plot_file_name(name);
    snprintf(path, sizeof path, "%s/%s", c->folder, name);
    const PlotXYOptions curves = {
      .n_runs = o->n_runs, .n_y = 1, .runs = o->runs, .y = &c->rows[i].measure, .legend = o->legend, .out = path};
    PetscCall(PlotXY(&curves, diag, said));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Report(Comparison *c, FILE *table, Diag *diag, void (*said)(const char *path))
{
  PetscFunctionBeginUser;
  compare_print(table, c);
  choose_folder(c);
  const int error = file_make_folders(c->folder);
  if (error) diag_error(diag, NULL, "cannot create the folder '%s': %s", c->folder, strerror(error));
  if (!error) PetscCall(CompareTables(c, diag, said));
  if (!diag_errors(diag)) PetscCall(Draw(c, diag, said));
  PetscFunctionReturn(0);
}

/* Beyond all tolerances is what one of the runs has and the other has not. */
static PetscReal difference_of(const CompareRow *row)
{
  if (row->empty) return 0;
  return row->met && !compare_lack(row) ? row->difference.relative : INFINITY;
}

static PetscErrorCode OpenCases(Comparison *c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(c->options->n_runs, &c->cases));
  for (PetscInt r = 0; r < c->options->n_runs; ++r)
    PetscCall(CaseReadKept(PETSC_COMM_SELF, c->options->runs[r], &c->cases[r]));
  PetscFunctionReturn(0);
}

static PetscErrorCode CloseCases(Comparison *c)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < c->options->n_runs; ++r) PetscCall(CaseDestroy(&c->cases[r]));
  PetscCall(PetscFree(c->cases));
  PetscFunctionReturn(0);
}

PetscErrorCode CompareRuns(const CompareOptions *options, FILE *table, Diag *diag, void (*said)(const char *path),
                           PetscReal *worst)
{
  Comparison c = {.options = options};

  PetscFunctionBeginUser;
  *worst = 0;
  PetscCall(CurveRunsOpen(options->n_runs, options->runs, diag, &c.runs));
  PetscCall(OpenCases(&c));
  PetscCall(KeysDiffer(options->n_runs, options->runs, &c.keys));
  if (!diag_errors(diag)) PetscCall(CheckMeasures(&c, diag));
  if (!diag_errors(diag)) PetscCall(FillRows(&c));
  if (!diag_errors(diag)) check_rows(&c, diag);
  if (!diag_errors(diag)) PetscCall(Report(&c, table, diag, said));
  for (PetscInt i = 0; i < c.n_rows; ++i) *worst = PetscMax(*worst, difference_of(&c.rows[i]));
  PetscCall(PetscFree(c.rows));
  PetscCall(DifferingKeysFree(&c.keys));
  PetscCall(CloseCases(&c));
  PetscCall(CurveRunsClose(options->n_runs, &c.runs));
  PetscFunctionReturn(0);
}
