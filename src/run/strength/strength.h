/* A factor of safety: tries of ever larger factors, their table, and what it says in the end. */
#pragma once
#include "base/table/table.h"
#include "model/model.h"
#include "output/directory/run_dir.h"
#include "run/strength/search.h"

/* What slides goes so many of its heights times the share of strength that it loses; what stands does not. */
#define STRENGTH_SLIDES 0.1

/* The share of strength that goes as the factor grows by `more` to this; below 1 no more than that. */
static inline PetscReal strength_share(PetscReal more, PetscReal factor) { return more / PetscMax(1, factor); }

/* One factor that was tried; row 0 is the state before the first: all loads on, nothing yields. */
typedef struct {
  PetscReal factor;
  PetscReal outcome; /* a TryOutcome */
  PetscReal iterations;
  PetscReal moved;        /* largest increment of a node; where Newton gave up, its last one, m */
  PetscReal displacement; /* the largest of a point since the start, in the last stable state, m */
  PetscReal dissipated;   /* by plastic flow and friction since the start, there, J */
  PetscReal work;         /* of loads and gravity since the start, there, J */
  PetscReal height;       /* of what moves, against gravity, m */
  PetscReal anew;         /* what of `moved` does not grow with the factor, as far as that is known, m */
} Try;
#define TRY_NUMBERS 9

typedef struct {
  Search search;
  PetscReal height; /* of the material, against gravity, m */
  PetscInt n, capacity;
  Try *tries;
} StrengthRun;

/* Collective. Of a point since the start, m. */
PetscErrorCode LargestDisplacement(const Model *model, PetscReal *largest);
PetscErrorCode StrengthRunDestroy(StrengthRun *run);
/* Collective. The row of the state before the first try. */
PetscErrorCode StrengthBegin(StrengthRun *run, Model *model);
/* Collective. One try; it and its line in the log are kept. The next factor: search_next. */
PetscErrorCode StrengthTry(StrengthRun *run, Model *model, RunDir *dir, StepReport *report);
/* Collective. factor.csv, as far as it goes. What the disk refuses comes back as
 * PETSC_ERR_FILE_WRITE, without a trace. */
PetscErrorCode StrengthWrite(const StrengthRun *run, RunDir *dir);
/* Collective. The answer: into the model for its measures, and into the log. */
PetscErrorCode StrengthEnd(const StrengthRun *run, Model *model, RunDir *dir);
/* answer.c. Of what is sought with points that do not balance a uniform stress. */
PetscErrorCode StrengthTellUneven(const Model *model, RunDir *dir);
/* answer.c. The last that stood before try i > 0. */
PetscInt strength_stood_before(const StrengthRun *run, PetscInt i);
/* What is known of the factor so far, for measures. */
void strength_know_bracket(const StrengthRun *run, Model *model);
PetscErrorCode StrengthToTables(const StrengthRun *run, Tables *tables);
PetscErrorCode StrengthFromTables(StrengthRun *run, const Tables *tables, char reason[256]);
