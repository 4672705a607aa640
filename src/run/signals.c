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

PetscBool signals_came(void) { return asked_by ? PETSC_TRUE : PETSC_FALSE; }

void signals_forget(void)
{
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
}

PetscErrorCode SignalsAsked(MPI_Comm comm, PetscBool *due, PetscBool *asked)
{
  PetscMPIInt rank;
  int any[2];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  any[0] = asked_by != 0;
  any[1] = !rank && *due;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 2, MPI_INT, MPI_MAX, comm));
  *asked = any[0] ? PETSC_TRUE : PETSC_FALSE;
  *due = any[1] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}
