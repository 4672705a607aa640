/* What the files that make a run share. */
#pragma once
#include "model/stage/stage.h"
#include "run/output/output.h"
#include "run/run.h"
#include "run/strength/limit.h"
#include "run/strength/strength.h"
#include "run/watch/until.h"

/* When something happens again: every so many seconds (> 0), every so many steps (< 0), or at the
 * end only (0). */
typedef struct {
  PetscReal every;
  PetscInt count; /* how often it happened after the start */
} Schedule;

/* A time at which a step has to end, and how close to it what is due there may be, s. */
typedef struct {
  PetscReal time, close;
} Stop;

/* What a run remembers besides its model. It counts only what was due: the row and the state of a
 * run that was interrupted are extras. */
typedef struct {
  PetscInt states, rows;         /* counts of the schedules */
  PetscInt written;              /* state files */
  PetscInt state_step, row_step; /* of the newest state and row, -1 if none */
  PetscInt iterations_per_step;  /* most of one step */
  PetscReal seconds;             /* of the clock, spent by the run and those that it resumes */
  HistoryMark history;           /* what it was then; no lines: not known */
} RunMemory;

typedef struct {
  MPI_Comm comm;
  const Case *whole;      /* with all of its stages */
  PetscInt64 fingerprint; /* of the whole as it was read: stages that have begun know when */
  const Case *c;          /* of the present stage */
  PetscInt stage;
  PetscReal *starts; /* of all stages so far, s */
  Model *model;
  RunDir *dir;
  Output *output;
  Schedule states, rows;
  Stop stop;                     /* the next one */
  PetscInt state_step, row_step; /* step of the newest state and row, -1 if none */
  PetscReal *values;             /* of the measures of the present stage */
  PetscReal *row;                /* of the history: the stage, where there are any, and case_columns of the whole run */
  PetscBool *there;              /* which of these the present stage has */
  PetscInt *events;              /* per measure of the stage: how many of its events the run has told of */
  Until until;
  StrengthRun strength; /* of an analysis for a factor of safety */
  LimitRun limit;       /* of one for a limit load */
  PetscBool failed;     /* gave up */
  RunWatcher watcher;   /* NULL: nobody watches */
  void *watcher_context;
  RunSummary summary;
  double start;           /* of this process, on MPI's clock */
  Imbalance imbalance;    /* of the state of another run that it started from */
  HistoryMark history;    /* of the run that this one resumes; no lines: not known */
  PetscReal before;       /* seconds spent by the runs that this one resumes */
  double last_checkpoint; /* on MPI's clock */
  /* step of the newest checkpoint, -1 if none; how many there were */
  PetscInt checkpoint_step, n_written;
} Run;

/* The run ends early; the first reason counts. */
void run_stop(Run *r, const char *reason);
/* States and rows that were due until now, in this stage or before it, have been written. */
void run_count_from(Run *r);
/* A file that the disk refused ends the run; the log has said so. */
PetscErrorCode RunWritten(Run *r, PetscErrorCode code);
PetscErrorCode RunWriteRow(Run *r);
/* Collective. The last row of a stage or run: that of a search once more, with its answer. */
PetscErrorCode RunWriteLastRow(Run *r);
PetscErrorCode RunWriteState(Run *r);

/* equilibrium.c. Collective. The state before the first step, where the case asks for an equilibrium. */
PetscErrorCode RunEquilibrate(Run *r);
/* Collective. Directory, history, output and first row of a run from its start. */
PetscErrorCode RunOpen(Run *r, const RunOptions *options, Diag *diag);
/* Collective. The same for a run that goes on from its newest checkpoint that is whole. *complete:
 * there is nothing to do. */
PetscErrorCode RunResume(Run *r, const RunOptions *options, Diag *diag, PetscBool *complete);

/* stages/columns.c. Room for the measures of the present stage, and which columns they are. */
PetscErrorCode RunMeasuresBegin(Run *r);
PetscErrorCode RunMeasuresEnd(Run *r);
/* Values of the present stage into its columns; others keep what they had last. */
void run_fill_row(Run *r);
/* Values of all columns, as they were last, for who has called the run. */
void run_give_columns(const Run *r, PetscReal *columns);
/* Collective. What the columns had last, from the history of the run that is resumed. */
PetscErrorCode RunRecallColumns(Run *r);
/* stages/stages.c. Collective. Stage k begins: its times are those of the run from now on. */
void run_begin_stage(Run *r, PetscInt k);
/* Collective. The stage is over: a row, a state, a checkpoint to start from; then the next one from its state. */
PetscErrorCode RunEndStage(Run *r);
PetscErrorCode RunNextStage(Run *r, Diag *diag);
/* Collective. A run that is resumed: the model of stage k, which its state is to fill. */
PetscErrorCode RunEnterStage(Run *r, PetscInt k, const PetscReal *starts);
/* Collective. Models of all stages are made once, so that mistakes are told before anything runs. */
PetscErrorCode RunCheckStages(MPI_Comm comm, const Case *whole, Diag *diag);
/* Collective. stages.csv: the stages so far, and when each began. */
PetscErrorCode RunWriteStages(Run *r);
/* Collective. Where and how much is out of balance. */
PetscErrorCode RunTellImbalance(const Run *r, const Imbalance *imbalance);
/* Collective. Into another file than that of the newest state; a refusal is a warning in the log. */
PetscErrorCode CheckpointSaveAs(Run *r, const char *path);

/* functions.c. Collective. The run is begun with functions of the caller: its directory says for what. */
PetscErrorCode FunctionsWrite(Run *r, const RunOptions *options);
/* Collective. Has the run that is resumed the functions that it was begun with? An error if not. */
PetscErrorCode FunctionsCheck(const Run *r, const RunOptions *options, Diag *diag, PetscBool *same);

/* Ends of a run that is resumed, of its last stage where it has any, s: that of the case kept in its directory, and the
 * one that is asked for. */
typedef struct {
  PetscReal before, now;
  PetscInt stage; /* one before the last that would end at another time, -1: none */
} Extension;

/* Collective. */
PetscErrorCode ExtensionBegin(const Run *r, Extension *extension);
/* May the run have this end? An error if not. */
PetscBool extension_allowed(const Run *r, const Extension *extension, Diag *diag);
/* What to say of a run that is complete: an error if it was to go on to a later end and cannot. */
void extension_without_checkpoint(const Run *r, const Extension *extension, Diag *diag);
/* After the model is back: an error if it is past the end asked for, a warning if it is there. */
void extension_from_checkpoint(const Run *r, Diag *diag);

/* checkpoint.c. What a case must have in common with the one of a checkpoint. */
PetscErrorCode RunFingerprint(const Case *c, PetscInt64 *value);
/* Is it time for a checkpoint by the clock? On rank 0, who alone knows the time. */
PetscBool checkpoint_by_clock(const Run *r);
PetscBool checkpoint_by_step(const Run *r);
/* Collective. One that cannot be written is told in the log, and the run goes on. */
PetscErrorCode CheckpointSave(Run *r);
/* Collective. Bring the model and the run back to the newest checkpoint that is whole; *step = -1
 * if there is none. */
PetscErrorCode CheckpointLoad(Run *r, Diag *diag, PetscInt *step, PetscBool *fits);
