/* Runs beside each other: how far their histories are apart, and in which keys their cases differ. */
#pragma once
#include <petscsys.h>
#include <stdio.h>
#include "base/diag/diag.h"

typedef struct {
  PetscInt n_runs, n_measures;
  const char *const *runs;     /* run directories; the others are compared with the first */
  const char *const *measures; /* n_measures of these; 0: all that the runs have in common */
  const char *out;             /* the folder of tables and pictures; NULL: runs/compare/A-B */
  const char *legend, *format; /* as in PlotXYOptions */
} CompareOptions;

/* Table to `table`, and in the folder differences.csv, keys.csv and a picture of each measure, whose paths go to
 * `said`. *worst: the largest relative difference, infinite where one run has values and the other has none. What is
 * wrong goes to diag. One process. */
PetscErrorCode CompareRuns(const CompareOptions *options, FILE *table, Diag *diag, void (*said)(const char *path),
                           PetscReal *worst);
