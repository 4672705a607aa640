/* Members: runs of cases, each in a process, with a directory of its own, several at a time.
 *
 * A member's directory tells what is to be done: a run of this very case that is done is kept, one
 * that was cut off goes on from its checkpoint, one of another case is in the way. */
#pragma once
#include "case/case.h"
#include "input/settings.h"
#include "run/run.h"
#include "sweep/taken.h"

typedef enum {
  MEMBER_WAITING,
  MEMBER_RUNNING,
  MEMBER_DONE,
  MEMBER_INTERRUPTED,
  MEMBER_GAVE_UP,
  MEMBER_BAD_INPUT,
  MEMBER_CRASHED
} MemberState;
extern const char *const member_states[];

typedef struct {
  char name[256];                  /* also of its directory */
  char folder[PETSC_MAX_PATH_LEN]; /* the run directory; what the run said on stderr: <folder>.txt */
  const char *file;                /* the case */
  SettingList set;
  PetscInt n_taken; /* numbers of its history, */
  const Taken *taken;
  PetscInt n_stages;
  PetscBool *means;        /* n_taken x n_stages: is a row of it the mean since the row before? */
  PetscReal *values;       /* what they are: NaN until it is done */
  char (*units)[64];       /* and in which unit */
  char (*lack)[TAKEN_WHY]; /* why a value is missing, or not over all of its window; "" else */
  MemberState state;
  PetscBool kept;     /* done before */
  PetscBool resume;   /* goes on from a checkpoint */
  PetscBool replace;  /* what is there goes */
  PetscInt pid;       /* of its process */
  PetscReal end;      /* of the run, s */
  PetscReal begun;    /* the share of it that was done when the process began */
  RunSummary summary; /* from its timings.txt, of all sessions */
  char why[512];      /* if it did not come to its end */
} Member;

typedef struct {
  PetscInt n;
  Member *member;
  PetscInt jobs;
  PetscBool force, keep, trust;
  FILE *out;
  /* Told of every member that came to an end; NULL: nobody is. */
  PetscErrorCode (*Ended)(void *context);
  void *context;
  PetscBool stopped; /* by a signal */
} Members;

/* One more, in `folder`/name; taken stays the caller's. */
PetscErrorCode MembersAdd(Members *members, const char *folder, const char *name, const char *file, PetscInt n_taken,
                          const Taken *taken, Member **member);
PetscErrorCode MembersClear(Members *members);
/* Read the member's case, look at its directory, and take over what is done. Mistakes go to
 * diag. */
PetscErrorCode MemberPlan(const Members *members, Member *m, Diag *diag);
/* Take the values from the history of a run that is done. */
PetscErrorCode MemberRead(const Members *members, Member *m);
/* Run all that are not done; a signal (run/signals.h) lets them write their checkpoints and
 * leave. */
PetscErrorCode MembersRun(Members *members);
/* Say which values of runs that are done are missing (an error of slopes, else a warning), or not over all
 * of their windows: each number once. */
void members_tell_lacks(const Members *members, Diag *diag);
/* How many are in this state. */
PetscInt members_count(const Members *members, MemberState state);

/* members_folder.c. Make a directory ours to write into (a file `table` in one that talus has not signed is somebody's)
 * and nobody else's at this time: *lock >= 0 is to be closed. */
void members_prepare_folder(const char *path, const char *table, Diag *diag, int *lock);
/* So many at a time; as many as there are cores if `asked` is 0. */
PetscInt members_jobs(PetscInt asked);

/* members_process.c: start the member's process; a reason in m->why if that fails. */
PetscErrorCode MemberStart(const Members *members, Member *m);
/* Has its process ended (then its state is known)? */
PetscErrorCode MemberLook(const Members *members, Member *m, PetscBool *ended);
/* Ask all that run to leave. */
void members_stop(const Members *members);
/* The share of its run that is done, from the last row of its history. */
PetscReal member_share(const Member *m);

/* members_progress.c: the line of a member that came to an end; the line at the bottom of a
 * terminal, or nothing; take that away. elapsed: s since the
 * members began. */
void members_tell_end(const Members *members, const Member *m, PetscReal elapsed);
void members_show(const Members *members, PetscReal elapsed);
void members_wipe(const Members *members);
