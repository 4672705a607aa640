#include "run/signals.h"
#include <signal.h>

/* A signal handler can reach nothing but a global. */
static volatile sig_atomic_t asked_by;

static void on_signal(int number)
{
  asked_by = number;
  signal(number, SIG_DFL);
}

void signals_watch(void)
{
  asked_by = 0;
  signal(SIGINT, on_signal);
  signal(SIGTERM, on_signal);
}

void signals_forget(void)
{
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
}

PetscErrorCode SignalsAsked(MPI_Comm comm, PetscBool *asked)
{
  int mine = asked_by != 0, any;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, comm));
  *asked = any ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}
