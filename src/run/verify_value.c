/* The number of a row that is compared. */
#include <math.h>
#include "io/history.h"
#include "run/verify_private.h"

/* Root of the sum of squared distances, over all rows after the start. */
static PetscReal distance(const History *history, PetscInt column, const CourseSpec *course)
{
  PetscReal sum = 0;
  for (PetscInt i = 0; i < history->n_rows; ++i) {
    const PetscReal *row = history->values + i * history->n_columns, t = row[0];
    const PetscReal off = row[column] - (course->constant + t * (course->linear + t * course->quadratic));
    if (t > 0) sum += off * off;
  }
  return PetscSqrtReal(sum);
}

/* Of one rank; NaN if there is no such history. */
static PetscErrorCode ReadDistance(const VerifyRow *r, Diag *diag, PetscReal *value)
{
  char path[PETSC_MAX_PATH_LEN], reason[256];
  History history;

  PetscFunctionBeginUser;
  *value = NAN;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", r->folder));
  if (HistoryRead(path, &history, reason)) {
    DiagError(diag, NULL, "cannot read '%s': %s", path, reason);
    PetscFunctionReturn(0);
  }
  const PetscInt column = HistoryColumn(&history, r->study->measure);
  if (column >= 0) *value = distance(&history, column, &r->study->course);
  PetscCall(HistoryFree(&history));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyValue(const Verification *v, VerifyRow *r, Diag *diag)
{
  PetscFunctionBeginUser;
  r->value = r->measures[r->measure];
  if (!r->study->has_course || r->result != RUN_DONE) PetscFunctionReturn(0);
  if (v->rank == 0) PetscCall(ReadDistance(r, diag, &r->value));
  PetscCallMPI(MPI_Bcast(&r->value, 1, MPIU_REAL, 0, v->comm));
  PetscFunctionReturn(0);
}
