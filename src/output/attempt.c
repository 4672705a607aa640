#include "output/attempt.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define MOST_MEMORY ((rlim_t)256 << 20)
#define MOST_SECONDS 10

/* AddressSanitizer needs a terabyte of addresses for itself. */
#if !defined(__SANITIZE_ADDRESS__) && defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif

static rlim_t addresses_now(void)
{
  char text[64] = "";
  FILE *in = fopen("/proc/self/statm", "r");
  if (!in) return 0;
  if (!fgets(text, sizeof text, in)) text[0] = 0;
  fclose(in);
  return (rlim_t)strtoul(text, NULL, 10) * (rlim_t)sysconf(_SC_PAGESIZE);
}

static void limit_memory(void)
{
#ifndef __SANITIZE_ADDRESS__
  struct rlimit limit;
  const rlim_t now = addresses_now();
  if (now == 0 || getrlimit(RLIMIT_AS, &limit)) return;
  if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur > now + MOST_MEMORY) limit.rlim_cur = now + MOST_MEMORY;
  (void)setrlimit(RLIMIT_AS, &limit);
#else
  (void)addresses_now;
#endif
}

/* A crash here is nobody's business: no trace, no core. */
static void isolate(void)
{
  static const int deadly[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM, SIGINT};
  const struct rlimit no_core = {0, 0}, seconds = {MOST_SECONDS, MOST_SECONDS};
  const int nowhere = open("/dev/null", O_WRONLY);
  for (size_t i = 0; i < sizeof deadly / sizeof *deadly; ++i) (void)signal(deadly[i], SIG_DFL);
  if (nowhere >= 0) (void)dup2(nowhere, STDOUT_FILENO), (void)dup2(nowhere, STDERR_FILENO);
  (void)setrlimit(RLIMIT_CORE, &no_core);
  (void)setrlimit(RLIMIT_CPU, &seconds);
  limit_memory();
}

static void work_in_child(int out, void (*work)(void *context, char reason[256]), void *context)
{
  char reason[256] = "";
  isolate();
  work(context, reason);
  _exit(write(out, reason, sizeof reason) == sizeof reason ? 0 : 1);
}

/* Did the child get to its end? */
static PetscBool await(pid_t child, int in, char reason[256])
{
  size_t n = 0;
  ssize_t got;
  int status = 0;
  while (n < 256 && ((got = read(in, reason + n, 256 - n)) > 0 || (got < 0 && errno == EINTR)))
    n += got > 0 ? (size_t)got : 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return n == 256 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void attempt(void (*work)(void *context, char reason[256]), void *context, char reason[256])
{
  int ends[2];
  reason[0] = 0;
  if (pipe2(ends, O_CLOEXEC)) {
    snprintf(reason, 256, "%s", strerror(errno));
    return;
  }
  const pid_t child = fork();
  if (child == 0) work_in_child(ends[1], work, context);
  close(ends[1]);
  if (child < 0) snprintf(reason, 256, "%s", strerror(errno));
  else if (!await(child, ends[0], reason))
    snprintf(reason, 256, "its structure is damaged: the library that reads it crashes or finds no end");
  close(ends[0]);
}
