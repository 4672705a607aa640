#include "base/process/mpi_end.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include "base/process/mpi_alone.h"

int mpi_begin(int *argc, char ***argv)
{
  int provided, code;
  mpi_alone_begin();
  code = MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
  mpi_alone_end();
  return code == MPI_SUCCESS ? 0 : 1;
}

/* Sanitizers look for leaks after main, and their findings are not to be hidden. */
#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif

#ifndef SANITIZED
static volatile sig_atomic_t last_code;

static void end_at_once(int number)
{
  (void)number;
  _exit((int)last_code);
}
#endif

void mpi_end(int exit_code)
{
#ifdef SANITIZED
  MPI_Finalize();
  exit(exit_code);
#else
  static const int crashes[] = {SIGSEGV, SIGBUS, SIGABRT};
  last_code = exit_code;
  fflush(NULL);
  for (size_t i = 0; i < sizeof crashes / sizeof *crashes; ++i) signal(crashes[i], end_at_once);
  MPI_Finalize();
  _exit(exit_code);
#endif
}
