#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include "output/history.h"
#include "output/directory/run_dir_files.h"

/* The next entry of a CSV line, quotes resolved, in place; NULL after the last. */
static char *next_entry(char **next)
{
  char *from = *next, *to = *next, *entry = *next;
  PetscBool quoted = PETSC_FALSE;
  if (!from) return NULL;
  for (; *from && (quoted || *from != ','); ++from) {
    if (*from != '"') *to++ = *from;
    else if (quoted && from[1] == '"') *to++ = *++from;
    else quoted = !quoted;
  }
  *next = *from ? from + 1 : NULL;
  *to = 0;
  return entry;
}

/* "tip [m]" -> "tip", "m" */
static PetscErrorCode SplitName(char *entry, char **name, char **unit)
{
  char *open = strrchr(entry, '['), *close = strrchr(entry, ']');

  PetscFunctionBeginUser;
  const PetscBool has_unit = open && close && open > entry && open[-1] == ' ' && close > open && !close[1];
  if (has_unit) open[-1] = *close = 0;
  PetscCall(PetscStrallocpy(has_unit ? open + 1 : "", unit));
  PetscCall(PetscStrallocpy(entry, name));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadHeader(char *line, History *history)
{
  PetscInt n = 1;

  PetscFunctionBeginUser;
  for (const char *c = line; *c; ++c) n += *c == ',';
  PetscCall(PetscCalloc2(n, &history->names, n, &history->units));
  for (char *entry = next_entry(&line); entry; entry = next_entry(&line)) {
    PetscCall(SplitName(entry, &history->names[history->n_columns], &history->units[history->n_columns]));
    ++history->n_columns;
  }
  PetscFunctionReturn(0);
}

/* An empty cell is of a measure that the stage does not have: nan. */
static PetscReal parse_cell(const char *text, char **end)
{
  const PetscReal value = (PetscReal)strtod(text, end);
  if (*end != text || (*text != ',' && *text != '\n')) return value;
  return NAN;
}

static PetscBool parse_row(const char *line, PetscInt n, PetscReal *row)
{
  char *end;
  for (PetscInt i = 0; i < n; ++i) {
    row[i] = parse_cell(line, &end);
    if (*end != (i + 1 < n ? ',' : '\n')) return PETSC_FALSE;
    line = end + 1;
  }
  return PETSC_TRUE;
}

/* Room for one more row. A damaged header may hold a million columns: then rows are few. */
static PetscErrorCode Grow(History *history, PetscInt64 *capacity)
{
  PetscFunctionBeginUser;
  if (history->n_rows < *capacity) PetscFunctionReturn(0);
  *capacity = 2 * *capacity + 1;
  PetscCall(PetscRealloc((size_t)*capacity * (size_t)history->n_columns * sizeof(PetscReal), &history->values));
  PetscFunctionReturn(0);
}

/* Only what stands last, without its newline, may be cut off. */
static PetscErrorCode ReadRows(FILE *in, History *history, char reason[256])
{
  PetscInt64 capacity = 0;
  char *line = NULL;
  size_t size = 0;

  PetscFunctionBeginUser;
  for (ssize_t n; !reason[0] && (n = getline(&line, &size, in)) > 0 && line[n - 1] == '\n';) {
    PetscCall(Grow(history, &capacity));
    PetscReal *row = history->values + (size_t)history->n_rows * (size_t)history->n_columns;
    if (!parse_row(line, history->n_columns, row) || PetscIsInfOrNanReal(row[0]) || PetscIsInfOrNanReal(row[1]))
      snprintf(reason, 256, "line %" PetscInt_FMT " is no row of %" PetscInt_FMT " numbers", history->n_rows + 2,
               history->n_columns);
    else ++history->n_rows;
  }
  free(line);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadAll(FILE *in, History *history, char reason[256])
{
  char *line = NULL;
  size_t size = 0;

  PetscFunctionBeginUser;
  if (getline(&line, &size, in) > 0 && !strncmp(line, "time [s],step", 13) && strchr(",\r\n", line[13])) {
    line[strcspn(line, "\r\n")] = 0;
    PetscCall(ReadHeader(line, history));
    PetscCall(ReadRows(in, history, reason));
  } else {
    snprintf(reason, 256, "it does not start with the header 'time [s],step'");
  }
  free(line);
  PetscFunctionReturn(0);
}

/* A search counts its tries from its end on, and the stage behind it goes on from there: its rows are of the time to
 * which the run comes back. */
static void let_time_rise(History *history)
{
  PetscReal next = PETSC_MAX_REAL;
  for (PetscInt row = history->n_rows - 1; row >= 0; --row) {
    PetscReal *time = history->values + (size_t)row * (size_t)history->n_columns;
    if (*time > next) *time = next;
    else next = *time;
  }
}

PetscErrorCode HistoryRead(const char *path, History *history, char reason[256])
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(history, sizeof *history));
  reason[0] = 0;
  FILE *in = file_open_read(path);
  if (!in) {
    snprintf(reason, 256, "%s", strerror(errno));
    PetscFunctionReturn(PETSC_ERR_FILE_OPEN);
  }
  PetscCall(ReadAll(in, history, reason));
  fclose(in);
  if (!reason[0]) {
    let_time_rise(history);
    PetscFunctionReturn(0);
  }
  PetscCall(HistoryFree(history));
  PetscFunctionReturn(PETSC_ERR_FILE_OPEN);
}

PetscErrorCode HistoryFree(History *history)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < history->n_columns; ++i) {
    PetscCall(PetscFree(history->names[i]));
    PetscCall(PetscFree(history->units[i]));
  }
  PetscCall(PetscFree2(history->names, history->units));
  PetscCall(PetscFree(history->values));
  history->n_rows = history->n_columns = 0;
  PetscFunctionReturn(0);
}

PetscInt history_column(const History *history, const char *name)
{
  for (PetscInt i = 0; i < history->n_columns; ++i)
    if (!strcmp(history->names[i], name)) return i;
  return -1;
}

PetscReal history_last(const History *history, PetscInt column)
{
  for (PetscInt row = history->n_rows - 1; row >= 0 && column >= 0; --row) {
    const PetscReal value = history->values[(size_t)row * (size_t)history->n_columns + (size_t)column];
    if (!PetscIsNanReal(value)) return value;
  }
  return NAN;
}
