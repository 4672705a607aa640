/* Measures of the present stage as columns of the history of the whole run. */
#include <string.h>
#include "output/history.h"
#include "run/run_private.h"

/* A run with stages says in its first column which it is in. */
static PetscInt first_column(const Run *r) { return r->whole->n_stages ? 1 : 0; }

PetscErrorCode RunMeasuresEnd(Run *r)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(r->values));
  PetscCall(PetscFree(r->row));
  PetscCall(PetscFree(r->there));
  PetscCall(PetscFree(r->events));
  PetscFunctionReturn(0);
}

PetscErrorCode RunMeasuresBegin(Run *r)
{
  const PetscInt n = first_column(r) + case_columns(r->whole);

  PetscFunctionBeginUser;
  PetscCall(PetscFree(r->values));
  PetscCall(PetscFree(r->events));
  PetscCall(PetscCalloc1(r->c->n_measures, &r->values));
  PetscCall(PetscCalloc1(r->c->n_measures, &r->events));
  if (!r->row) {
    PetscCall(PetscMalloc1(n, &r->row));
    PetscCall(PetscMalloc1(n, &r->there));
    for (PetscInt k = 0; k < n; ++k) r->row[k] = NAN;
  }
  for (PetscInt k = 0; k < n; ++k)
    r->there[k] = k < first_column(r) || case_measure_of(r->c, case_column(r->whole, k - first_column(r))->name) >= 0;
  PetscFunctionReturn(0);
}

void run_fill_row(Run *r)
{
  const PetscInt first = first_column(r);
  if (first) r->row[0] = (PetscReal)(r->stage + 1);
  for (PetscInt k = 0; k < case_columns(r->whole); ++k) {
    const PetscInt measure = case_measure_of(r->c, case_column(r->whole, k)->name);
    if (measure >= 0) r->row[first + k] = r->values[measure];
  }
}

void run_give_columns(const Run *r, PetscReal *columns)
{
  const PetscInt first = first_column(r);
  for (PetscInt k = 0; k < case_columns(r->whole); ++k) {
    const PetscInt measure = case_measure_of(r->c, case_column(r->whole, k)->name);
    columns[k] = measure >= 0 ? r->values[measure] : r->row[first + k];
  }
}

PetscErrorCode RunRecallColumns(Run *r)
{
  const PetscInt first = first_column(r), n = case_columns(r->whole);
  char path[PETSC_MAX_PATH_LEN], reason[256];
  PetscMPIInt rank;
  History history;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(r->comm, &rank));
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", run_dir_path(r->dir)));
  if (!rank && !HistoryRead(path, &history, reason)) {
    for (PetscInt k = 0; k < n; ++k)
      r->row[first + k] = history_last(&history, history_column(&history, case_column(r->whole, k)->name));
    PetscCall(HistoryFree(&history));
  }
  PetscCallMPI(MPI_Bcast(r->row + first, (PetscMPIInt)n, MPIU_REAL, 0, r->comm));
  PetscFunctionReturn(0);
}
