/* What run_dir.c, progress.c and history.c share. Streams are open on rank 0 only. */
#pragma once
#include "output/progress.h"
#include "output/directory/run_dir.h"

struct RunDir {
  MPI_Comm comm;
  PetscMPIInt rank;
  char path[PETSC_MAX_PATH_LEN];
  char reason[PETSC_MAX_PATH_LEN + 128]; /* of the last refusal */
  FILE *log, *history;
  char log_path[PETSC_MAX_PATH_LEN];
  int log_error; /* errno of the first line that did not get into the log */
  int lock;      /* the open directory, -1: none */
  PetscInt n_measures;
  HistoryMark mark; /* of history.csv, on rank 0 */
  PetscBool quiet, terminal;
  PetscBool bar;   /* a progress bar stands on the terminal's last line */
  PetscReal start; /* of the run, on MPI's clock, s */
  ProgressClock clock;
  PetscReal last_shown; /* when progress was last printed, s since the clock's start; < 0: never */
};

/* Rank 0. 0, or ESTALE if the directory's name no longer leads to the directory in which the run
 * began. */
int run_dir_present(const RunDir *dir);
/* Share rank 0's errno for the file of this name; a refusal is logged and kept for run_dir_reason.
 * Collective. */
PetscErrorCode RunDirAgree(RunDir *dir, const char *name, int error);

/* After a line for the log: did it get there? */
void run_dir_note_log(RunDir *dir);
