/* A limit load: steps in which a load is raised, their table, and what it says in the end. */
#pragma once
#include "base/table/table.h"
#include "model/model.h"
#include "output/directory/run_dir.h"

/* A state on the way; row 0 is the one before the first step: all other loads on. */
typedef struct {
  PetscReal control;      /* factor of the displacement, or of the work at the first stiffness */
  PetscReal load;         /* factor of forces; of a prescribed displacement the force along it, N */
  PetscReal displacement; /* m */
  PetscReal iterations;
  PetscReal largest;    /* displacement of a point since the start, m */
  PetscReal stored;     /* elastic energy, J */
  PetscReal dissipated; /* by plastic flow since the start, J */
  PetscReal work;       /* of what is raised since row 0, J */
} LimitRow;
#define LIMIT_NUMBERS 8

/* Why nothing more is tried. */
typedef enum {
  LIMIT_RISES,
  LIMIT_HOLDS,
  LIMIT_FALLS,
  LIMIT_MOST,
  LIMIT_LOST,
  LIMIT_FLOWS,
  LIMIT_CREEPS,
  LIMIT_LONG,
  LIMIT_N
} LimitOutcome;

typedef struct {
  PetscReal step;    /* the next */
  PetscReal outcome; /* a LimitOutcome */
  PetscReal rises;   /* the last step's rise of the load, over what hardening explains; 0: nothing hardens */
  PetscInt n, capacity;
  LimitRow *rows;
} LimitRun;
#define LIMIT_SEARCH 3 /* numbers of it */

PetscErrorCode LimitRunDestroy(LimitRun *run);
/* Is there something left to try? */
PetscBool limit_goes_on(const LimitRun *run);
/* Collective. The row of the state before the first step. */
PetscErrorCode LimitBegin(LimitRun *run, Model *model);
/* Collective. One step; it and its line in the log are kept. */
PetscErrorCode LimitStep(LimitRun *run, Model *model, RunDir *dir, StepReport *report);
/* Collective. limit.csv, as far as it goes. What the disk refuses comes back as PETSC_ERR_FILE_WRITE,
 * without a trace. */
PetscErrorCode LimitWrite(const LimitRun *run, const Model *model, RunDir *dir);
/* Collective. The answer: into the model for its measures, and into the log. */
PetscErrorCode LimitEnd(const LimitRun *run, Model *model, RunDir *dir);
PetscErrorCode LimitToTables(const LimitRun *run, Tables *tables);
PetscErrorCode LimitFromTables(LimitRun *run, const Tables *tables, char reason[256]);
