/* Histories whose rows hold means over steps, row by row of the coarser one. */
#pragma once
#include "case/case.h"
#include "picture/curves/runs.h"

/* A measure of a run and its case. */
typedef struct {
  const CurveRun *run;
  const Case *c; /* NULL: it cannot be read */
  const char *measure;
} RowsOf;

/* Has the history rows of it, in one stage or another, that are means since the row before? */
PetscErrorCode RowsAreMeans(const RowsOf *of, PetscBool *are);
/* What two histories would have of the measure with the rows alone that they have in common: at n times, each the first
 * at which both have had a row since the one before, the mean since then of what their rows have as means (a row that a
 * time cuts has its share of it), the value there of all else, and a formula of these. nan: there is none, and at the
 * first time where not both begin there. time, values: as many entries each as both have rows. */
PetscErrorCode RowsInCommon(const RowsOf of[2], PetscInt *n, PetscReal *time, PetscReal *const values[2]);
