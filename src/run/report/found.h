/* A run directory that is there: whose it is, and how it ended. */
#pragma once
#include "case/case.h"

/* Collective. The case of a run directory without what changes no result, to be freed; NULL with a
 * reason if there is none. */
PetscErrorCode FoundCase(MPI_Comm comm, const char *folder, char **text, char reason[256]);
/* Is that text this case's? */
PetscErrorCode FoundIsCase(const Case *c, const char *text, PetscBool *is);
/* Collective. The first file that is not what the run in the folder has read any more; empty if they all are, or if it
 * has not told what it read. resumed: NULL, or the case of that run as it goes on: its files may have moved, and the
 * run that it started from does not count. */
PetscErrorCode FoundChanged(MPI_Comm comm, const char *folder, const Case *resumed, char file[PETSC_MAX_PATH_LEN]);
/* Of one process: the value of `key = value` in a file of the run; empty if there is none. */
void found_word(const char *folder, const char *name, const char *key, char word[64]);
/* Of one process: a measure in the last step of the run, where the last row of its history has another number of it, a
 * mean over several steps; *value stays as it was elsewhere. */
void found_last_step(const char *folder, const char *measure, PetscReal *value);
