/* A material point on a path, as a test in the laboratory: table, picture, a few numbers. */
#pragma once
#include <stdio.h>
#include "base/diag/diag.h"

typedef struct {
  const char *file;      /* a path with its material, or a case */
  const char *test;      /* of the material of a case: the name of a test; NULL: the file tells its path */
  const char *material;  /* of the case; NULL: its only one */
  const char *to;        /* "0.1,0.05": where the test goes */
  const char *confining; /* Pa, compression positive; NULL: 0 */
  const char *steps;     /* increments on each way; NULL: 100 */
  PetscBool undrained;
  PetscInt n_set; /* path=value */
  const char *const *set;
  const char *out; /* directory; NULL: runs/element/<name of the file> */
} ElementOptions;

/* The same numbers as the exit codes of the program. ELEMENT_STUCK: the path could not be followed to
 * its end; what was reached is written. */
typedef enum { ELEMENT_DONE = 0, ELEMENT_STUCK = 1, ELEMENT_BAD_INPUT = 2 } ElementOutcome;

/* Of one process. What the point did goes to `out`. */
PetscErrorCode ElementRun(const ElementOptions *options, FILE *out, Diag *diag, ElementOutcome *outcome);
