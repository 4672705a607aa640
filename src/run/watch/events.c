#include "run/watch/events.h"
#include "base/text.h"
#include "model/measure/measure.h"
#include "output/directory/run_dir_files.h"

static const MeasureEvents *events_of(const Model *m, PetscInt k)
{
  return measure_find(m->c->measures[k].kind)->events;
}

/* The columns of the file: those of the first measure that counts. One with others has its lines in
 * the log alone. */
static const MeasureEvents *columns(const Model *m)
{
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (events_of(m, k)) return events_of(m, k);
  return NULL;
}

static void write_rows(const Model *m, PetscInt k, FILE *out)
{
  char number[32];
  for (PetscInt i = 0; i < measure_n_events(m, k); ++i) {
    fprintf(out, "%s,%" PetscInt_FMT, m->c->measures[k].name, i + 1);
    for (PetscInt j = 0; j < events_of(m, k)->n; ++j) {
      file_format_real(measure_event(m, k, i)[j], number);
      fprintf(out, ",%s", number);
    }
    fputc('\n', out);
  }
}

static PetscErrorCode WriteTable(const Model *m, RunDir *dir)
{
  const MeasureEvents *table = columns(m);
  TextStream stream;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  fputs("measure,event", stream.out);
  for (PetscInt j = 0; j < table->n; ++j) fprintf(stream.out, ",%s [%s]", table->names[j], table->units[j]);
  fputc('\n', stream.out);
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (events_of(m, k) == table) write_rows(m, k, stream.out);
  PetscCall(TextClose(&stream, &text));
  const PetscErrorCode status = RunDirWriteText(dir, "events.csv", text);
  PetscCall(PetscFree(text));
  PetscFunctionReturn(status);
}

/* "start = 1.2 s, end = 1.4 s, ..." of a row. */
static PetscErrorCode LogRow(RunDir *dir, const MeasureEvents *table, const char *what, const PetscReal *row)
{
  char text[640] = "";
  size_t end = 0;

  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < table->n && end < sizeof text; ++j)
    if (!PetscIsNanReal(row[j]))
      end += (size_t)snprintf(text + end, sizeof text - end, "%s%s = %.5g %s", end ? ", " : "", table->names[j],
                              (double)row[j], table->units[j]);
  PetscCall(RunDirLog(dir, "%s: %s", what, text));
  PetscFunctionReturn(0);
}

PetscErrorCode EventsWatch(const Model *m, RunDir *dir, PetscBool first, PetscInt *known)
{
  PetscBool write = first;
  char what[320];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    const PetscInt n = measure_n_events(m, k);
    for (PetscInt i = first ? n : known[k]; i < n; ++i) {
      PetscCall(PetscSNPrintf(what, sizeof what, "event = %s %d", m->c->measures[k].name, (int)i + 1));
      PetscCall(LogRow(dir, events_of(m, k), what, measure_event(m, k, i)));
      write = PETSC_TRUE;
    }
    known[k] = n;
  }
  const PetscErrorCode status = write && columns(m) ? WriteTable(m, dir) : 0;
  PetscFunctionReturn(status);
}

/* The mean of each column but the first two, which are times. */
static PetscErrorCode LogMeans(const Model *m, RunDir *dir, PetscInt k)
{
  const MeasureEvents *table = events_of(m, k);
  const PetscInt n = measure_n_events(m, k);
  PetscReal *mean;
  char what[320];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(table->n, &mean));
  for (PetscInt j = 0; j < table->n; ++j) {
    for (PetscInt i = 0; i < n; ++i) mean[j] += measure_event(m, k, i)[j] / (PetscReal)n;
    if (j < 2) mean[j] = NAN;
  }
  PetscCall(PetscSNPrintf(what, sizeof what, "mean of %d events of %s", (int)n, m->c->measures[k].name));
  PetscCall(LogRow(dir, table, what, mean));
  PetscCall(PetscFree(mean));
  PetscFunctionReturn(0);
}

PetscErrorCode EventsSummary(const Model *m, RunDir *dir)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    PetscReal since;
    if (!events_of(m, k)) continue;
    if (measure_n_events(m, k) > 1) PetscCall(LogMeans(m, dir, k));
    if (measure_under_way(m, k, &since))
      PetscCall(RunDirLog(dir, "under way = an event of %s since %.9g s: it counts when it is over",
                          m->c->measures[k].name, (double)since));
  }
  PetscFunctionReturn(0);
}
