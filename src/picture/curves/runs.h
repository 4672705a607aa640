/* Runs whose histories stand beside each other. */
#pragma once
#include <petscsys.h>
#include "base/diag/diag.h"
#include "case/case.h"
#include "output/history.h"

typedef struct {
  const char *folder;
  char name[128]; /* for legends: the last part of the folder, all of it where two runs share that */
  History history;
} CurveRun;

/* Read the histories of n runs. What is wrong goes to diag; free the runs all the same. */
PetscErrorCode CurveRunsOpen(PetscInt n, const char *const *folders, Diag *diag, CurveRun **runs);
PetscErrorCode CurveRunsClose(PetscInt n, CurveRun **runs);

/* Column of a measure, `time` or `step`; -1, with a complaint that names the nearest, if the run has none. */
PetscErrorCode CurveRunColumn(const CurveRun *run, const char *name, Diag *diag, PetscInt *column);
PetscReal curve_run_value(const CurveRun *run, PetscInt row, PetscInt column);
/* Is it a number of the run itself (time, step, stage) rather than a measure? */
PetscBool curve_run_counts(const CurveRun *run, PetscInt column);
