/* How far a run is and how long it will take: arithmetic and text, no streams. */
#pragma once
#include "output/directory/run_dir.h"

/* Does a person watch standard output? Open MPI gives the first rank a terminal of its own wherever
 * mpiexec's output goes, so there the output of the parent counts: mpiexec, or a daemon. */
PetscBool progress_on_terminal(void);

/* Remembers how fast the simulated time moves. */
typedef struct {
  PetscBool started;
  PetscReal wall; /* at the newest step, s since the start of the run */
  PetscReal time; /* simulated, at the newest step */
  PetscReal rate; /* simulated seconds a second, smoothed; 0: not known yet */
} ProgressClock;

/* Take note of a step that ended `wall` seconds after the start of the run. */
void progress_update(ProgressClock *clock, const RunProgress *progress, PetscReal wall);
/* Seconds left; < 0: not known yet. */
PetscReal progress_left(const ProgressClock *clock, const RunProgress *progress);

/* 1:02:03, or 3 d 01:02:03 from a day on; `?` for a negative number. */
void progress_duration(PetscReal seconds, char text[32]);
/* `step = 12 time = 0.012 ...`; left < 0: not said. */
void progress_line(const RunProgress *progress, PetscReal left, char text[256]);
/* The bar and its numbers in at most `width` columns: what matters less is left out first. */
void progress_bar(const RunProgress *progress, PetscReal elapsed, PetscReal left, int width, char text[512]);
