/* A run directory that is there: whose it is, and how it ended. */
#pragma once
#include "case/case.h"

/* Collective. The case of a run directory without what changes no result, to be freed; NULL with a
 * reason if there is none. */
PetscErrorCode FoundCase(MPI_Comm comm, const char *folder, char **text, char reason[256]);
/* Is that text this case's? */
PetscErrorCode FoundIsCase(const Case *c, const char *text, PetscBool *is);
/* Of one process: the value of `key = value` in a file of the run; empty if there is none. */
void found_word(const char *folder, const char *name, const char *key, char word[64]);
