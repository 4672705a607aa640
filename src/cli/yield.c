/* How ranks wait for each other where there are more of them than cores. Open MPI calls sched_yield() then, again and
 * again. A core on which something else computes is gone for a slice of the scheduler each time, some milliseconds for
 * every message. So in talus's own programs this stands before the C library's: once a yield has taken that long, the
 * next ones nap, and what wakes up goes before what computes. Three runs of the self-weight on three ranks, two cores
 * beside one busy process: 17 s for 119 without naps. Two such rows at once: 10 s for 13. */
#ifdef __linux__
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#define LONG_YIELD 1e-3 /* s */
#define NAPS 100        /* before it tries to yield again; 1000: two runs of three ranks take 2.5 times as long */
#define NAP 50000       /* ns */

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int sched_yield(void)
{
  static _Thread_local int naps;
  const struct timespec nap = {0, NAP};
  if (naps > 0) {
    --naps;
    return nanosleep(&nap, NULL);
  }
  const double before = seconds();
  const int failed = (int)syscall(SYS_sched_yield);
  if (seconds() - before > LONG_YIELD) {
    prctl(PR_SET_TIMERSLACK, 1UL); /* naps are not 50 microseconds longer than they shall be */
    naps = NAPS;
  }
  return failed;
}
#endif
