/* What the files of a sweep share. */
#pragma once
#include "sweep/members/members.h"
#include "sweep/sweep_spec.h"

typedef struct {
  const SweepOptions *options;
  char file[PETSC_MAX_PATH_LEN];   /* case.yaml */
  char folder[PETSC_MAX_PATH_LEN]; /* in which it stands */
  char out[PETSC_MAX_PATH_LEN];
  SweepFile *sweeps;
  SweepSpecification *sweep; /* the one that is run */
  PetscInt n_taken;
  Taken *taken; /* shallow: of the sweep's measures */
  Members members;
  Diag *diag;
  FILE *told;
} SweepRun;

/* sweep_plan.c: the members, last axis fastest. */
PetscErrorCode SweepPlan(SweepRun *s);
/* Which value of an axis a member has. */
PetscInt sweep_at(const SweepSpecification *sweep, PetscInt member, PetscInt axis);
/* Keys of all axes, with those along; *key = NULL behind the last. */
const SweepKey *sweep_key(const SweepSpecification *sweep, PetscInt k, PetscInt *axis);

/* sweep_table.c: <out>/sweep.csv. */
PetscErrorCode SweepTable(const SweepRun *s);
/* sweep_figure.c: <out>/<measure>.png of each measure. */
PetscErrorCode SweepFigures(const SweepRun *s);
