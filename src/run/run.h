/* A run, from a case to a directory of results: the loop over steps, output, signals. */
#pragma once
#include "output/directory/run_dir.h"
#include "model/model.h"

/* How a run went, in numbers. */
typedef struct {
  PetscInt steps, halvings;
  PetscInt iterations, iterations_per_step; /* Newton's: all of the run, and most of one step */
  PetscReal seconds;                        /* from the model's first state to its last */
  PetscBool interrupted;                    /* by a signal, or by who called it */
  PetscBool resumable;                      /* ended early, and has a checkpoint... */
  PetscInt checkpoint_step;                 /* ...of this step */
  char ended[256];                          /* which condition ended it, empty if none */
  char reason[1024];                        /* why the run ended early, empty if it did not */
} RunSummary;

/* Told of every step on every rank. PETSC_TRUE on any of them ends the run as a signal does. */
typedef PetscBool (*RunWatcher)(void *context, PetscInt step, PetscReal time, PetscReal end);

typedef struct {
  const char *out;  /* run directory */
  PetscBool resume; /* go on in it, from its newest checkpoint; the case is that of the directory */
  PetscBool force;  /* replace a run that is there */
  PetscBool quiet;
  FILE *warnings;      /* gets what diag knows before the first step; NULL: the caller prints it */
  const char *log;     /* file, or NULL: log.txt in the run directory */
  RunSummary *summary; /* out: filled in unless NULL; the same on all ranks but for the seconds */
  RunWatcher watcher;  /* NULL: nobody watches */
  void *watcher_context;
  BodyForce body_force; /* NULL: gravity alone */
  void *body_force_context;
  const LoadAsked *load_factors; /* of each load of the case, which has no stages then; NULL: ones */
} RunOptions;

typedef enum { RUN_DONE = 0, RUN_GAVE_UP = 1, RUN_BAD_INPUT = 2 } RunResult;

/* Collective. Mistakes found while the model is built go to diag with RUN_BAD_INPUT, and nothing is
 * written then. A run that gives up or is interrupted (by a signal of run/signals.h: a step that
 * has not converged is given up) writes a checkpoint and its state and says why. A resumed run goes
 * on as if it had never been cut off: on the same number of ranks it ends with the same bits.
 * `measures` (case_columns numbers, or NULL) gets the last values; NaN where a run is resumed that
 * was complete and has left no checkpoint. */
PetscErrorCode RunCase(MPI_Comm comm, const Case *c, const RunOptions *options, Diag *diag, PetscReal *measures,
                       RunResult *result);
