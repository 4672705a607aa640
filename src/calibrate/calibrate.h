/* A calibration: the region of parameters in which the measures of several cases meet their
 * targets. */
#pragma once
#include <stdio.h>
#include "base/diag/diag.h"

typedef struct {
  const char *file;
  const char *out; /* NULL: runs/calibrate/<name of the file> */
  PetscInt jobs;   /* runs at a time; 0: as many as there are cores */
  PetscBool quick; /* with the settings for that */
  PetscBool force, keep, trust;
  PetscBool dry; /* say what would be run */
} CalibrateOptions;

/* The same numbers as the exit codes of the program. CALIBRATE_NONE: no parameters meet all targets,
 * or the run that should confirm them does not. */
typedef enum { CALIBRATE_DONE = 0, CALIBRATE_FAILED = 1, CALIBRATE_BAD_INPUT = 2, CALIBRATE_NONE = 3 } CalibrateOutcome;

/* Of one process. The report goes to `out` and into the directory. */
PetscErrorCode CalibrateFile(const CalibrateOptions *options, FILE *out, Diag *diag, CalibrateOutcome *outcome);
