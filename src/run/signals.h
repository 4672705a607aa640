/* SIGINT, SIGTERM, SIGQUIT, SIGHUP, SIGUSR1, SIGUSR2 and SIGXCPU ask a run to write its state and
 * leave. A SIGHUP that was ignored when the run began stays ignored (nohup). */
#pragma once
#include <petscsys.h>

/* Watch from now on; a second SIGINT, SIGTERM or SIGQUIT ends the program at once, but
 * for a SIGTERM within a second of the first: that is the same ask. */
void signals_watch(void);
/* All signals are again whose they were. */
void signals_forget(void);
/* Has one come to this rank? */
PetscBool signals_came(void);
/* Collective: has any rank been asked to stop? In the same message all learn what rank 0 says in
 * *due. */
PetscErrorCode SignalsAsked(MPI_Comm comm, PetscBool *due, PetscBool *asked);
