/* In which keys the resolved cases of runs differ. */
#pragma once
#include <petscsys.h>

typedef struct {
  PetscInt n, n_runs;
  char **key;   /* n: "materials.sand.friction_angle" */
  char **value; /* n x n_runs, in the unit of the case file; NULL: that run's case has no such key */
} DifferingKeys;

/* Of n_runs folders with a case.yaml each; all lists of plain values count as one ("[0, -9.81]"). Runs whose case
 * cannot be read differ in nothing. Keys that change no number of a run (title, output, checkpoint) are left out. A
 * table (`amplitude`, corners) is one key: where it is long, its value is how many points it has and the first that is
 * not alike in all runs. */
PetscErrorCode KeysDiffer(PetscInt n_runs, const char *const *folders, DifferingKeys *keys);
PetscErrorCode DifferingKeysFree(DifferingKeys *keys);
/* Is the measure of that name in the case of this run `kind: word`? Not where there is none, or no case. */
PetscErrorCode KeysMeasureIs(const char *folder, const char *name, const char *kind, const char *word, PetscBool *is);
/* "friction_angle = 24 deg" of a run; "" where the legend would be too long to be read. */
void keys_legend(const DifferingKeys *keys, PetscInt run, char legend[128]);
