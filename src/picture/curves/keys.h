/* In which keys the resolved cases of runs differ. */
#pragma once
#include <petscsys.h>

typedef struct {
  PetscInt n, n_runs;
  char **key;   /* n: "materials.sand.friction_angle" */
  char **value; /* n x n_runs, in the unit of the case file; NULL: that run's case has no such key */
} DifferingKeys;

/* Of n_runs folders with a case.yaml each; all lists of plain values count as one ("[0, -9.81]"). Runs whose case
 * cannot be read differ in nothing. Keys that change no number of a run (title, output, checkpoint) are left out. */
PetscErrorCode KeysDiffer(PetscInt n_runs, const char *const *folders, DifferingKeys *keys);
PetscErrorCode DifferingKeysFree(DifferingKeys *keys);
/* "friction_angle = 24 deg" of a run; "" where the legend would be too long to be read. */
void keys_legend(const DifferingKeys *keys, PetscInt run, char legend[128]);
