/* What the files of a calibration share. */
#pragma once
#include "calibrate/calibrate.h"
#include "calibrate/region.h"
#include "sweep/members/members.h"

typedef struct {
  const CalibrateOptions *options;
  Calibration *c;
  char folder[PETSC_MAX_PATH_LEN]; /* of the file */
  char out[PETSC_MAX_PATH_LEN];
  char (*cases)[PETSC_MAX_PATH_LEN]; /* of each instrument */
  Diag *diag;
  FILE *told;
  Members members;    /* instruments of each point side by side */
  PetscInt n;         /* points: sets of parameters that were run */
  PetscReal *x;       /* n x parameters, in [0, 1] */
  PetscInt n_targets; /* of all instruments */
  const Target **target;
  PetscInt *instrument, *number; /* of each target: whose it is, and which of its own */
  Surrogate **surrogate;
  Region region;
  PetscInt confirmed; /* the point that was run at the best of the region; -1: none */
} CalibrateRun;

/* calibrate_runs.c */
/* Plan runs of all instruments at x, which is rounded, unless they are there. `meets`: not so far that targets are
 * missed. *point: their number. Mistakes go to diag. */
PetscErrorCode CalibrateAdd(CalibrateRun *r, const PetscReal *x, PetscBool meets, PetscInt *point);
/* The first points: the corners of the ranges if there are enough, the others evenly. */
PetscErrorCode CalibrateDesign(CalibrateRun *r);
/* What target k is at a point; NaN if its run did not come to its end. */
PetscReal calibrate_found(const CalibrateRun *r, PetscInt point, PetscInt k);
/* Surrogates of all targets and the region from what was run. An error if there is too little. */
PetscErrorCode CalibrateFit(CalibrateRun *r);

/* calibrate_report.c: region.csv, runs.csv, pictures, and the report as text. */
PetscErrorCode CalibrateReport(CalibrateRun *r);
/* Does the run at the best point meet all targets? */
PetscBool calibrate_is_confirmed(const CalibrateRun *r);
/* "friction" or its label; "friction [deg]" with its unit. */
const char *calibrate_label(const Parameter *p);
