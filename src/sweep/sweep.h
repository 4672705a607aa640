/* A sweep: a case over the product of values of some of its keys; a table and pictures of what came
 * out. */
#pragma once
#include <stdio.h>
#include "base/diag/diag.h"

/* An option of the command line that says what is swept, in the order in which it was given. */
typedef enum { SWEEP_OVER, SWEEP_ALONG, SWEEP_MEASURE, SWEEP_BAND } SweepWordKind;
typedef struct {
  SweepWordKind kind;
  const char *text;
} SweepWord;

typedef struct {
  const char *file; /* the case, or its folder */
  const char *name; /* of a sweep in the folder's sweep.yaml; NULL: the words say it */
  PetscInt n_words;
  const SweepWord *words;
  PetscInt n_set; /* path=value, for all members */
  const char *const *set;
  const char *out; /* NULL: runs/sweep/<case>[/<name>] */
  PetscInt jobs;   /* members at a time; 0: as many as there are cores */
  PetscBool quick; /* the shorter version that sweep.yaml tells */
  PetscBool force; /* run members again that are there */
  PetscBool keep;  /* the states (.hdf) of members that are done */
  PetscBool trust; /* the case's .geo may act on the system */
  PetscBool dry;   /* say what would be run */
} SweepOptions;

/* The same numbers as the exit codes of the program. SWEEP_FAILED: not all members came to their
 * end. */
typedef enum { SWEEP_DONE = 0, SWEEP_FAILED = 1, SWEEP_BAD_INPUT = 2 } SweepOutcome;

/* Of one process. Everything is read and checked before anything is run; members are processes of
 * their own (talus run), found again when the same sweep is called again. What happens goes to
 * `out`. */
PetscErrorCode SweepCase(const SweepOptions *options, FILE *out, Diag *diag, SweepOutcome *outcome);
