/* SIGINT and SIGTERM ask a run to finish its step, write its state and leave. */
#pragma once
#include <petscsys.h>

/* Watch from now on; a second signal ends the program at once. */
void signals_watch(void);
void signals_forget(void);
/* Collective: has any rank been asked to stop? In the same message all learn what rank 0 says in *due. */
PetscErrorCode SignalsAsked(MPI_Comm comm, PetscBool *due, PetscBool *asked);
