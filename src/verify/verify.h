/* A verification: every row of a case's reference.yaml is run, and compared with what it must
 * give. */
#pragma once
#include <stdio.h>
#include "base/diag/diag.h"

typedef struct {
  const char *folder; /* of the case: case.yaml and reference.yaml */
  const char *out;    /* directory of the results; NULL: runs/verify/<case> */
  const char *only;   /* one study; NULL: all */
  const char *run;    /* a run that is there, to be compared (VerifyRun) */
  PetscBool full;     /* the rows and series marked so, too */
  PetscBool keep;     /* the states (.hdf) of all runs, not only their logs and histories */
  /* take over what earlier verifications into the same directory have finished */
  PetscBool resume;
  PetscBool record; /* write the tables into docs/verification.md as well */
  PetscBool trust;  /* the case's .geo may act on the system */
} VerifyOptions;

/* The same numbers as the exit codes of the program. */
typedef enum { VERIFY_PASSED = 0, VERIFY_GAVE_UP = 1, VERIFY_BAD_INPUT = 2, VERIFY_OFF = 3 } VerifyOutcome;

/* Collective. Everything is read and checked before anything is run. Tables go to `out` (rank 0) as
 * the rows are done, and as Markdown into the directory of the results. */
PetscErrorCode VerifyCase(MPI_Comm comm, const VerifyOptions *options, FILE *out, Diag *diag, VerifyOutcome *outcome);

/* Collective. Compare the run in options->run with the rows whose case it is; those marked `full`
 * count too. *n says how many rows that were: if any, their table goes to `out` (rank 0). Nothing
 * is run or written. */
PetscErrorCode VerifyRun(MPI_Comm comm, const VerifyOptions *options, FILE *out, Diag *diag, PetscInt *n,
                         VerifyOutcome *outcome);
