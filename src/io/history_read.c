#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include "io/history.h"

/* The next entry of a CSV line, quotes resolved, in place; NULL after the last. */
static char *NextEntry(char **next)
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
  const PetscBool has_unit =
    open && close && open > entry && open[-1] == ' ' && close > open && !close[1] ? PETSC_TRUE : PETSC_FALSE;
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
  for (char *entry = NextEntry(&line); entry; entry = NextEntry(&line)) {
    PetscCall(SplitName(entry, &history->names[history->n_columns], &history->units[history->n_columns]));
    ++history->n_columns;
  }
  PetscFunctionReturn(0);
}

static PetscBool ParseRow(const char *line, PetscInt n, PetscReal *row)
{
  char *end;
  for (PetscInt i = 0; i < n; ++i) {
    row[i] = (PetscReal)strtod(line, &end);
    if (end == line || *end != (i + 1 < n ? ',' : '\n')) return PETSC_FALSE;
    line = end + 1;
  }
  return PETSC_TRUE;
}

static PetscErrorCode ReadRows(FILE *in, History *history)
{
  const PetscInt n = history->n_columns;
  PetscInt capacity = 0;
  char *line = NULL;
  size_t size = 0;

  PetscFunctionBeginUser;
  while (getline(&line, &size, in) > 0) {
    if (history->n_rows == capacity) {
      capacity = 2 * capacity + 64;
      PetscCall(PetscRealloc((size_t)capacity * (size_t)n * sizeof(PetscReal), &history->values));
    }
    if (ParseRow(line, n, history->values + (size_t)history->n_rows * (size_t)n)) ++history->n_rows;
  }
  free(line);
  PetscFunctionReturn(0);
}

PetscErrorCode HistoryRead(const char *path, History *history, char reason[256])
{
  char *line = NULL;
  size_t size = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(history, sizeof *history));
  reason[0] = 0;
  FILE *in = fopen(path, "r");
  if (!in) {
    snprintf(reason, 256, "%s", strerror(errno));
    PetscFunctionReturn(PETSC_ERR_FILE_OPEN);
  }
  if (getline(&line, &size, in) > 0 && !strncmp(line, "time [s],step", 13)) {
    line[strcspn(line, "\r\n")] = 0;
    PetscCall(ReadHeader(line, history));
    PetscCall(ReadRows(in, history));
  } else {
    snprintf(reason, 256, "it does not start with the header 'time [s],step'");
  }
  free(line);
  fclose(in);
  if (reason[0]) PetscFunctionReturn(PETSC_ERR_FILE_OPEN);
  PetscFunctionReturn(0);
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

PetscInt HistoryColumn(const History *history, const char *name)
{
  for (PetscInt i = 0; i < history->n_columns; ++i)
    if (!strcmp(history->names[i], name)) return i;
  return -1;
}
