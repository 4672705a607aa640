#include "run/signals.h"
#include <signal.h>
#include <time.h>

/* What asks a run to leave. A person who sends one of the first twice insists; the others come
 * again by themselves: a batch system's warnings, SIGXCPU every second, SIGHUP from shell and
 * terminal. */
static const struct {
  int number;
  PetscBool insists;  /* does the second one end the program at once? */
  PetscBool optional; /* stays ignored if it was: nohup */
} watched[] = {
  {SIGINT, PETSC_TRUE, PETSC_FALSE},   {SIGTERM, PETSC_TRUE, PETSC_FALSE},  {SIGQUIT, PETSC_TRUE, PETSC_FALSE},
  {SIGHUP, PETSC_FALSE, PETSC_TRUE},   {SIGUSR1, PETSC_FALSE, PETSC_FALSE}, {SIGUSR2, PETSC_FALSE, PETSC_FALSE},
  {SIGXCPU, PETSC_FALSE, PETSC_FALSE},
};
#define N_WATCHED PETSC_STATIC_ARRAY_LENGTH(watched)

/* A signal handler can reach nothing but a global. */
static volatile sig_atomic_t asked_by;
/* Signals are the process's: what was there, to be put back. */
static struct sigaction before[N_WATCHED];
static int watching; /* runs: one may begin another in what its caller watches it with */

static struct timespec first_term;

/* Linux tells of a parent's death once for each of its threads, so that SIGTERM comes two or three
 * times at once: within a second it is the same ask. */
static PetscBool is_echo(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (!first_term.tv_sec && !first_term.tv_nsec) first_term = now;
  return (PetscReal)(now.tv_sec - first_term.tv_sec) + 1e-9 * (PetscReal)(now.tv_nsec - first_term.tv_nsec) < 1;
}

static void on_signal(int number)
{
  asked_by = number;
  for (size_t k = 0; k < N_WATCHED; ++k)
    if (watched[k].number == number && watched[k].insists) signal(number, SIG_DFL);
}

static void on_term(int number)
{
  asked_by = number;
  if (is_echo()) return;
  signal(number, SIG_DFL);
  raise(number);
}

static void (*handler(size_t k))(int) { return watched[k].number == SIGTERM ? on_term : on_signal; }

/* Is the signal left to whoever had it? */
static PetscBool is_left(size_t k) { return watched[k].optional && before[k].sa_handler == SIG_IGN; }

void signals_watch(void)
{
  struct sigaction action = {.sa_flags = SA_RESTART};
  if (watching++) return;
  sigemptyset(&action.sa_mask);
  asked_by = 0;
  first_term = (struct timespec){0};
  for (size_t k = 0; k < N_WATCHED; ++k) {
    sigaction(watched[k].number, NULL, &before[k]);
    action.sa_handler = handler(k);
    if (!is_left(k)) sigaction(watched[k].number, &action, NULL);
  }
}

PetscBool signals_came(void) { return asked_by != 0; }

/* A program that embeds talus has its own handlers again, also of what has come and would insist; but one that it has
 * set meanwhile stays. */
void signals_forget(void)
{
  struct sigaction now;
  if (--watching) return;
  for (size_t k = 0; k < N_WATCHED; ++k) {
    sigaction(watched[k].number, NULL, &now);
    if (now.sa_handler == handler(k) || (now.sa_handler == SIG_DFL && watched[k].insists))
      sigaction(watched[k].number, &before[k], NULL);
  }
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
  *asked = any[0] != 0;
  *due = any[1] != 0;
  PetscFunctionReturn(0);
}
