/* Runs of earlier verifications, whose results are taken over. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "output/history.h"
#include "run/report/found.h"
#include "run/report/summary.h"
#include "verify/verify_private.h"

/* Of one rank: did the run come to its end, on as many ranks as now, and with which numbers? */
static PetscErrorCode ReadFinished(const Verification *v, const char *folder, VerifyRow *r, const Case *c,
                                   PetscBool *finished)
{
  char path[PETSC_MAX_PATH_LEN], reason[256], outcome[64], ranks[64];
  History history;

  PetscFunctionBeginUser;
  *finished = PETSC_FALSE;
  found_word(folder, "timings.txt", "outcome", outcome);
  found_word(folder, "version.txt", "ranks", ranks);
  found_word(folder, "version.txt", "sources", r->sources);
  if (strcmp(outcome, "done") || strtol(ranks, NULL, 10) != v->size) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", folder));
  if (HistoryRead(path, &history, reason)) PetscFunctionReturn(0);
  const PetscReal *last = history.n_rows ? history.values + (history.n_rows - 1) * history.n_columns : NULL;
  summary_read(folder, &r->summary);
  *finished = last && (r->summary.ended[0] || c->n_stages || last[0] >= c->analysis.end * (1 - 1e-9));
  for (PetscInt k = 0; k < r->n_measures && *finished; ++k) {
    const char *name = case_column(c, k)->name;
    const PetscInt column = history_column(&history, name);
    const PetscBool stays = case_measure_of(case_stage(c, case_stages(c) - 1), name) >= 0;
    r->measures[k] = column >= 0 && stays ? last[column] : history_last(&history, column);
    found_last_step(folder, name, &r->measures[k]);
  }
  PetscCall(HistoryFree(&history));
  PetscFunctionReturn(0);
}

/* From one folder; read by rank 0 for all. */
static PetscErrorCode TakeFrom(const Verification *v, const char *folder, VerifyRow *r, const Case *c, PetscBool *found)
{
  char *text, reason[256], changed[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(FoundCase(v->comm, folder, &text, reason));
  if (text) PetscCall(FoundIsCase(c, text, found));
  PetscCall(PetscFree(text));
  if (*found) PetscCall(FoundChanged(v->comm, folder, NULL, changed));
  if (*found && changed[0]) *found = PETSC_FALSE;
  if (*found && v->rank == 0) PetscCall(ReadFinished(v, folder, r, c, found));
  PetscCallMPI(MPI_Bcast(found, 1, MPIU_BOOL, 0, v->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyShareRow(const Verification *v, VerifyRow *r)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(r->measures, (PetscMPIInt)r->n_measures, MPIU_REAL, 0, v->comm));
  PetscCallMPI(MPI_Bcast(&r->summary, sizeof r->summary, MPI_BYTE, 0, v->comm));
  PetscCallMPI(MPI_Bcast(r->sources, sizeof r->sources, MPI_CHAR, 0, v->comm));
  r->seconds = r->summary.seconds;
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyTakeOver(const Verification *v, VerifyRow *r, const Case *c, PetscBool *found)
{
  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  for (const VerifyRow *other = v->rows; other < v->rows + v->n && !*found; ++other) {
    if (!setting_lists_equal(&other->set, &r->set)) continue;
    PetscCall(TakeFrom(v, other->folder, r, c, found));
    if (*found && other != r) PetscCall(PetscStrncpy(r->folder, other->folder, sizeof r->folder));
  }
  if (!*found) PetscFunctionReturn(0);
  PetscCall(VerifyShareRow(v, r));
  r->result = RUN_DONE;
  r->ran = r->taken = PETSC_TRUE;
  PetscFunctionReturn(0);
}
