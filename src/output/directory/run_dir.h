/* The run directory: created once, never overwritten by mistake; log, timings, history.
 *
 *   made-by-talus.txt   the signature, written first: without it nothing is removed or overwritten
 *   case.yaml     the resolved case (every key with its value)      history.csv   measures
 *   events.csv    what measures that count events noted of them
 *   factor.csv    factors that were tried, of a factor of safety
 *   files.txt     the files that the case reads, and what they were (output/inputs.h)
 *   functions.txt for what functions of the caller act, if any do
 *   log.txt       what the run said                                 timings.txt   where the time
 *   went version.txt   talus, PETSc, MPI, compiler, number of ranks      pictures/     of talus
 *   plot points_000000.hdf ... points.hdf.series, likewise grid_..., walls_..., contact_...
 *   checkpoint_000000100.h5 ...   the state after so many steps (output/checkpoint/checkpoint.h)
 *
 * As long as a run is at work the directory is locked: a second one in the same place is
 * refused. */
#pragma once
#include <petscsys.h>
#include <stdio.h>
#include "base/diag/diag.h"

typedef struct RunDir RunDir;

/* Collective. Refuses a directory that holds a run unless `force` (which removes that run's files,
 * and nothing else), one that holds somebody's files of the same names
 * (output/directory/run_dir_mark.h), and one that cannot be written: a diagnostic, *dir stays NULL.
 * quiet: nothing on the terminal; log: the file of --log, or NULL for log.txt. */
PetscErrorCode RunDirCreate(MPI_Comm comm, const char *path, PetscBool force, PetscBool quiet, const char *log,
                            Diag *diag, RunDir **dir);
/* Collective. Go on in the directory of an earlier run: nothing is removed, the log grows. A
 * diagnostic if there is no run. */
PetscErrorCode RunDirOpen(MPI_Comm comm, const char *path, PetscBool quiet, const char *log, Diag *diag, RunDir **dir);
/* Collective. Does the new run spare the file, or would it replace the file with one of its own?
 * Then a diagnostic. */
PetscErrorCode RunDirSpares(MPI_Comm comm, const char *path, const char *file, Diag *diag, PetscBool *spares);
PetscErrorCode RunDirDestroy(RunDir **dir);
/* Collective. Take a run back that could not start: its files go, and *dir with them. */
PetscErrorCode RunDirDiscard(RunDir **dir);
const char *run_dir_path(const RunDir *dir);

/* A line for the log and the terminal (rank 0): plain `key = value` text. */
PetscErrorCode RunDirLog(RunDir *dir, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(2, 3);

/* For the log alone (rank 0): what was printed elsewhere, lines as they are. */
void run_dir_keep(RunDir *dir, const char *text);

/* Collective. Did all lines get into the log? Errors as for the history. */
PetscErrorCode RunDirCheckLog(RunDir *dir);

/* Progress after an accepted step: a bar with the time left on a terminal, otherwise a plain line
 * now and then. */
typedef struct {
  PetscInt step, iterations;
  PetscReal time, end, dt; /* s */
  PetscReal residual;      /* relative, at the end of Newton */
  PetscInt points;         /* global */
  PetscBool earlier;       /* may the run be over before `end`... */
  PetscBool last;          /* ...and is it now? */
} RunProgress;
PetscErrorCode RunDirProgress(RunDir *dir, const RunProgress *progress);

/* history.csv: `time [s],step,name [unit],...`. Rank 0 writes, flushed row by row. Collective. What
 * the disk refuses comes back plainly as PETSC_ERR_FILE_WRITE on every rank, after a line in the
 * log that says why. */
PetscErrorCode HistoryOpen(RunDir *dir, PetscInt n, const char *const *names, const char *const *units);
/* What tells whether a history is still the one that was written: lines (with the header), bytes,
 * CRC-32 of all. */
typedef struct {
  PetscInt64 lines, bytes, crc;
} HistoryMark;
/* Collective. Of the history as far as it is written. */
PetscErrorCode HistoryGetMark(const RunDir *dir, HistoryMark *mark);
/* Resume: keep the rows up to that of `step`, which must be there unless it is negative, and drop
 * the others. A history of other measures, or one that has lost rows, or whose kept rows do not
 * have the mark `was` (NULL: not known), is a diagnostic, and the file stays as it is. */
PetscErrorCode HistoryOpenFrom(RunDir *dir, PetscInt n, const char *const *names, const char *const *units,
                               PetscInt step, const HistoryMark *was, Diag *diag);
/* Rows on the disk, not only with the system: what a checkpoint counts on. */
PetscErrorCode HistorySync(RunDir *dir);
/* there: which of the values there are, the cells of others stay empty; NULL: all. */
PetscErrorCode HistoryWrite(RunDir *dir, PetscReal time, PetscInt step, const PetscReal *values,
                            const PetscBool *there);

/* A text file written atomically (case.yaml, version.txt, timings.txt). Rank 0 writes. Collective.
 * Errors as for the history. */
PetscErrorCode RunDirWriteText(RunDir *dir, const char *name, const char *text);

/* Collective. Is the directory still there under its name? If it was removed, renamed or replaced,
 * errors as for the history. */
PetscErrorCode RunDirPresent(RunDir *dir);

/* After PETSC_ERR_FILE_WRITE, on every rank: which file could not be written, and why. */
const char *run_dir_reason(const RunDir *dir);

/* Where the checkpoint after so many steps stands. */
#define CHECKPOINT_PATH (PETSC_MAX_PATH_LEN + 64)
void run_dir_checkpoint_path(const RunDir *dir, PetscInt step, char path[CHECKPOINT_PATH]);
/* Where that of the end of a stage (its number, from 0) stands. */
void run_dir_stage_path(const char *folder, PetscInt stage, char path[CHECKPOINT_PATH]);
/* Collective. The newest checkpoint of any run directory; empty if it has none. */
PetscErrorCode RunDirNewest(MPI_Comm comm, const char *folder, char path[CHECKPOINT_PATH]);
/* Collective. Steps of the checkpoints that are there, newest first; free with PetscFree. */
PetscErrorCode RunDirCheckpoints(RunDir *dir, PetscInt *n, PetscInt **steps);
/* Collective. Remove all but the newest. */
PetscErrorCode RunDirKeepCheckpoints(RunDir *dir, PetscInt keep);
/* Collective. Take back what a run did after a checkpoint: states from number `states` on and
 * unfinished files go, checkpoints after `step` are set aside as `.damaged`. Errors as for the
 * history. */
PetscErrorCode RunDirRewind(RunDir *dir, PetscInt states, PetscInt step);
