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
  PetscBool force; /* write there whatever it holds */
} ElementOptions;

/* The same numbers as the exit codes of the program. ELEMENT_STUCK: the path could not be followed to
 * its end; what was reached is written. */
typedef enum { ELEMENT_DONE = 0, ELEMENT_STUCK = 1, ELEMENT_BAD_INPUT = 2 } ElementOutcome;

/* What a path gives at its end (element_measures.c). */
#define ELEMENT_N_MEASURES 13
typedef struct {
  const char *name, *unit, *help;
} ElementMeasure;
extern const ElementMeasure element_measures[ELEMENT_N_MEASURES + 1]; /* ended by name = NULL */

typedef struct {
  PetscReal measures[ELEMENT_N_MEASURES];
  PetscInt increments, substeps, iterations, most_iterations; /* most: of one increment */
} ElementSummary;

/* Of one process. What the point did goes to `out` (NULL: nobody is told, and nothing is drawn), and
 * its numbers into `summary`, unless that is NULL. */
PetscErrorCode ElementRun(const ElementOptions *options, FILE *out, Diag *diag, ElementSummary *summary,
                          ElementOutcome *outcome);
/* Could it be run, as far as reading tells? If not diag says why. */
PetscErrorCode ElementCheck(const ElementOptions *options, Diag *diag, PetscBool *good);
