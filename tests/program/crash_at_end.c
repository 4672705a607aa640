/* To be loaded before MPI: its end crashes in a thread of its own, as Open MPI's now and then does
 * on a busy machine.
 */
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

int MPI_Finalize(void);

static void *Crash(void *nothing)
{
  (void)nothing;
  raise(SIGSEGV);
  return NULL;
}

int MPI_Finalize(void)
{
  pthread_t thread;
  if (!pthread_create(&thread, NULL, Crash, NULL)) pthread_join(thread, NULL);
  for (;;) pause();
}
