/* A run that is there already, beside those rows of reference.yaml whose case it is. */
#include "verify/verify.h"
#include <math.h>
#include <string.h>
#include "input/case_file.h"
#include "output/history.h"
#include "output/directory/run_dir_files.h"
#include "run/report/summary.h"
#include "run/report/found.h"
#include "verify/verify_private.h"

/* The case of the run. NULL and a message if there is none. */
static PetscErrorCode ReadRunCase(const Verification *v, Diag *diag, char **text)
{
  char reason[256], changed[PETSC_MAX_PATH_LEN] = "";

  PetscFunctionBeginUser;
  PetscCall(FoundCase(v->comm, v->options->run, text, reason));
  if (!*text)
    diag_error(diag, NULL, "'%s' is no run directory: %s/case.yaml: %s", v->options->run, v->options->run, reason);
  else PetscCall(FoundChanged(v->comm, v->options->run, NULL, changed));
  if (changed[0]) diag_error(diag, NULL, "'%s' has changed since the run in '%s' read it", changed, v->options->run);
  PetscFunctionReturn(0);
}

/* Keep of the planned rows those of this run; *end is when it should end. */
static PetscErrorCode KeepRows(Verification *v, const char *text, Diag *diag, PetscReal *end)
{
  const PetscInt planned = v->n;
  PetscBool is;
  Case *c;

  PetscFunctionBeginUser;
  v->n = 0;
  for (PetscInt k = 0; k < planned; ++k) {
    VerifyRow *r = &v->rows[k];
    is = PETSC_FALSE;
    if (!diag_errors(diag)) {
      PetscCall(VerifyPlanRow(v, r, diag, &c));
      if (c) PetscCall(FoundIsCase(c, text, &is));
      if (is) *end = c->analysis.end;
      PetscCall(CaseDestroy(&c));
    }
    if (is) v->rows[v->n++] = *r;
    else PetscCall(VerifyRowClear(r));
  }
  PetscFunctionReturn(0);
}

/* Of one rank: the values at the end of the run, and the numbers that it reported. */
static PetscErrorCode ReadResults(Verification *v, PetscReal end, Diag *diag)
{
  char path[PETSC_MAX_PATH_LEN], reason[256];
  History history;
  RunSummary summary;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", v->options->run));
  if (HistoryRead(path, &history, reason)) {
    diag_error(diag, NULL, "cannot read '%s': %s", path, reason);
    PetscFunctionReturn(0);
  }
  summary_read(v->options->run, &summary);
  const PetscReal *last = history.n_rows ? history.values + (history.n_rows - 1) * history.n_columns : NULL;
  if (!last || (!summary.ended[0] && last[0] < end * (1 - 1e-9)))
    diag_error(diag, NULL, "the run in '%s' ended at %g s, before its %g s: there is nothing to compare",
               v->options->run, last ? (double)last[0] : 0., (double)end);
  for (PetscInt k = 0; k < v->n && last; ++k) {
    VerifyRow *r = &v->rows[k];
    const PetscInt column = history_column(&history, r->study->measure);
    r->summary = summary;
    r->measures[r->measure] = column < 0 ? NAN : last[column];
    found_last_step(v->options->run, r->study->measure, &r->measures[r->measure]);
  }
  PetscCall(HistoryFree(&history));
  PetscFunctionReturn(0);
}

static PetscErrorCode Judge(Verification *v, Diag *diag)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < v->n; ++k) {
    VerifyRow *r = &v->rows[k];
    PetscCall(VerifyShareRow(v, r));
    PetscCall(PetscStrncpy(r->folder, v->options->run, sizeof r->folder));
    r->result = RUN_DONE;
    r->ran = PETSC_TRUE;
    PetscCall(VerifyValue(v, r, diag));
    verify_judge(v->rows, k);
  }
  PetscFunctionReturn(0);
}

/* Everything up to the verdicts; v->n is 0 if no row is of this run. */
static PetscErrorCode Compare(Verification *v, Diag *diag)
{
  char file[PETSC_MAX_PATH_LEN], *text = NULL;
  PetscReal end = 0;
  PetscInt errors;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(v->file, sizeof v->file, "%s/case.yaml", v->options->folder));
  PetscCall(PetscSNPrintf(file, sizeof file, "%s/reference.yaml", v->options->folder));
  PetscCall(ReadRunCase(v, diag, &text));
  if (text) PetscCall(ReferenceRead(v->comm, file, diag, &v->reference));
  if (v->reference) PetscCall(VerifyPlanAll(v, diag));
  if (!diag_errors(diag)) PetscCall(KeepRows(v, text, diag, &end));
  PetscCall(PetscFree(text));
  PetscCall(DiagSetResolver(diag, NULL, NULL)); /* what follows is about no line of a case */
  if (v->rank == 0 && v->n && !diag_errors(diag)) PetscCall(ReadResults(v, end, diag));
  PetscCall(DiagReduce(v->comm, diag, &errors));
  if (errors || !v->n) PetscFunctionReturn(0);
  PetscCall(Judge(v, diag));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyRun(MPI_Comm comm, const VerifyOptions *options, FILE *out, Diag *diag, PetscInt *n,
                         VerifyOutcome *outcome)
{
  Verification v = {.comm = comm, .options = options};
  PetscInt errors;

  PetscFunctionBeginUser;
  *outcome = VERIFY_BAD_INPUT;
  *n = 0;
  PetscCallMPI(MPI_Comm_rank(comm, &v.rank));
  PetscCallMPI(MPI_Comm_size(comm, &v.size));
  PetscCall(Compare(&v, diag));
  PetscCall(DiagReduce(comm, diag, &errors));
  if (!errors) {
    *n = v.n;
    *outcome = VERIFY_PASSED;
    for (PetscInt k = 0; k < v.n; ++k)
      if (!v.rows[k].pass) *outcome = VERIFY_OFF;
    if (v.rank == 0 && v.n) verify_table_run(out, &v);
  }
  PetscCall(VerifyPlanClear(&v));
  PetscCall(ReferenceDestroy(&v.reference));
  PetscFunctionReturn(0);
}
