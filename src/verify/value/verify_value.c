/* The number of a row that is compared. */
#include <math.h>
#include "output/history.h"
#include "verify/verify_private.h"

/* The column at time t, linear between rows; NaN outside them. */
static PetscReal moment(const History *history, PetscInt column, PetscReal t)
{
  for (PetscInt i = 0; i < history->n_rows; ++i) {
    const PetscReal *after = history->values + i * history->n_columns;
    const PetscReal *before = after - (i ? history->n_columns : 0), span = after[0] - before[0];
    if (after[0] < t - 1e-9 * PetscAbsReal(t)) continue;
    if (!i) return after[0] > t ? NAN : after[column];
    return after[column] - (after[0] > t && span > 0 ? (after[0] - t) / span : 0) * (after[column] - before[column]);
  }
  return NAN;
}

/* t: since the course began. */
static PetscReal off_course(const CourseSpec *course, PetscReal t, PetscReal value)
{
  return value - (course->constant + t * (course->linear + t * course->quadratic));
}

/* Root of the sum of squared distances, over all rows after the course's start, or at the times that the
 * course names. */
static PetscReal distance(const History *history, PetscInt column, const CourseSpec *course)
{
  const PetscReal end = history->n_rows ? history->values[(history->n_rows - 1) * history->n_columns] : 0;
  const PetscReal span = end - course->start;
  const PetscInt n = course->every > 0 ? (PetscInt)(span / course->every + 1e-6) : history->n_rows;
  PetscReal sum = 0;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal *row = history->values + i * history->n_columns;
    const PetscReal t = course->every > 0 ? PetscMin((i + 1) * course->every, span) : row[0] - course->start;
    const PetscReal value = course->every > 0 ? moment(history, column, course->start + t) : row[column];
    if (t > 0) sum += PetscSqr(off_course(course, t, value));
  }
  return course->factor * PetscSqrtReal(sum);
}

/* Of one rank; NaN if there is no such history. */
static PetscErrorCode ReadValue(const VerifyRow *r, Diag *diag, PetscReal *value)
{
  char path[PETSC_MAX_PATH_LEN], reason[256];
  History history;

  PetscFunctionBeginUser;
  *value = NAN;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", r->folder));
  if (HistoryRead(path, &history, reason)) {
    diag_error(diag, NULL, "cannot read '%s': %s", path, reason);
    PetscFunctionReturn(0);
  }
  const PetscInt column = history_column(&history, r->study->measure);
  if (column >= 0)
    *value = r->study->moments ? moment(&history, column, r->row->x) : distance(&history, column, &r->study->course);
  PetscCall(HistoryFree(&history));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyValue(const Verification *v, VerifyRow *r, Diag *diag)
{
  PetscFunctionBeginUser;
  r->value = r->measures[r->measure];
  if (!(r->study->has_course || r->study->moments) || r->result != RUN_DONE) PetscFunctionReturn(0);
  if (v->rank == 0) PetscCall(ReadValue(r, diag, &r->value));
  PetscCallMPI(MPI_Bcast(&r->value, 1, MPIU_REAL, 0, v->comm));
  PetscFunctionReturn(0);
}
