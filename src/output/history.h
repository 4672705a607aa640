/* Reading history.csv back. */
#pragma once
#include <petscsys.h>

typedef struct {
  PetscInt n_rows, n_columns;
  char **names;      /* n_columns, without their units: "time", "step", then the measures */
  char **units;      /* "" if none */
  PetscReal *values; /* n_rows x n_columns */
} History;

/* PETSC_ERR_FILE_OPEN (returned plainly, with a reason and nothing to free) if the file is missing,
 * is no history or has a row that is none. A last row that was cut off is left out. Times never fall: rows of a search
 * in a stage, whose steps are no time, have that of the row behind them. Not collective. */
PetscErrorCode HistoryRead(const char *path, History *history, char reason[256]);
PetscErrorCode HistoryFree(History *history);
/* Column of that name, -1 if there is none. */
PetscInt history_column(const History *history, const char *name);
/* The last number of a column that is one: cells are empty in stages that do not have the measure. nan: there is
 * none, or no such column (< 0). */
PetscReal history_last(const History *history, PetscInt column);
