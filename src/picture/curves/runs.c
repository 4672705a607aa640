#include "picture/curves/runs.h"
#include <string.h>
#include <sys/stat.h>
#include "output/directory/run_dir_files.h"

/* The last part of a path, slashes at its end apart: its first character, and how many. */
static const char *last_part(const char *path, size_t *length)
{
  size_t end = strlen(path), from;
  while (end > 1 && path[end - 1] == '/') --end;
  for (from = end; from > 0 && path[from - 1] != '/';) --from;
  *length = end - from;
  return path + from;
}

static void name_runs(PetscInt n, CurveRun *runs)
{
  for (PetscInt i = 0; i < n; ++i) {
    size_t length, other;
    const char *name = last_part(runs[i].folder, &length);
    PetscBool alone = strcmp(name, ".") != 0;
    for (PetscInt k = 0; k < n; ++k) {
      const char *its = last_part(runs[k].folder, &other);
      if (k != i && other == length && !strncmp(name, its, length)) alone = PETSC_FALSE;
    }
    if (alone) snprintf(runs[i].name, sizeof runs[i].name, "%.*s", (int)length, name);
    else snprintf(runs[i].name, sizeof runs[i].name, "%s", runs[i].folder);
  }
}

static PetscErrorCode Open(CurveRun *run, Diag *diag)
{
  char path[FILE_PATH], reason[256];
  struct stat status;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", run->folder));
  if (stat(run->folder, &status) || !S_ISDIR(status.st_mode))
    diag_error(diag, NULL, "there is no run directory '%s'", run->folder);
  else if (HistoryRead(path, &run->history, reason)) diag_error(diag, NULL, "cannot read '%s': %s", path, reason);
  else if (run->history.n_rows < 2)
    diag_error(diag, NULL, "'%s' has %s: there is no curve", path, run->history.n_rows ? "a single row" : "no rows");
  PetscFunctionReturn(0);
}

PetscErrorCode CurveRunsOpen(PetscInt n, const char *const *folders, Diag *diag, CurveRun **runs)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, runs));
  for (PetscInt i = 0; i < n; ++i) {
    (*runs)[i].folder = folders[i];
    PetscCall(Open(&(*runs)[i], diag));
  }
  name_runs(n, *runs);
  PetscFunctionReturn(0);
}

PetscErrorCode CurveRunsClose(PetscInt n, CurveRun **runs)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) PetscCall(HistoryFree(&(*runs)[i].history));
  PetscCall(PetscFree(*runs));
  PetscFunctionReturn(0);
}

PetscErrorCode CurveRunColumn(const CurveRun *run, const char *name, Diag *diag, PetscInt *column)
{
  const History *h = &run->history;
  const char **names;

  PetscFunctionBeginUser;
  *column = history_column(h, name);
  if (*column >= 0) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(h->n_columns + 1, &names));
  for (PetscInt i = 0; i < h->n_columns; ++i) names[i] = h->names[i];
  diag_error(diag, NULL, "the history of '%s' has no measure '%s'", run->folder, name);
  diag_hint_names(diag, name, names);
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

PetscReal curve_run_value(const CurveRun *run, PetscInt row, PetscInt column)
{
  return run->history.values[(size_t)row * (size_t)run->history.n_columns + (size_t)column];
}

PetscBool curve_run_counts(const CurveRun *run, PetscInt column)
{
  return column < 2 || !strcmp(run->history.names[column], "stage");
}
