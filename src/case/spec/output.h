/* What is written, and how the work is shared. */
#pragma once
#include "case/kinematics/kinematics.h"

typedef struct {
  PetscInt n_fields;
  char **fields;
  PetscReal every;   /* s between states; 0: only the end; < 0: every |every| steps */
  PetscReal history; /* the same for history.csv; -1: every accepted step */
  PetscBool grid;    /* write the grid's fields too */
  PetscBool walls;   /* and walls, with what touches them */
} OutputSpec;

/* When the state is put away so that a run can go on after an accident. */
typedef struct {
  PetscInt steps;    /* after so many steps; 0: not by steps */
  PetscReal minutes; /* after so much time of the clock; 0: not by the clock */
  PetscInt keep;     /* how many checkpoints are kept */
} CheckpointSpec;

/* How the work is shared among the ranks. */
typedef struct {
  /* the largest share of a rank over the mean at which the grid is shared anew; 0: never */
  PetscReal imbalance;
} ParallelSpec;
