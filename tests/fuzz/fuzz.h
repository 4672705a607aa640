/* What the fuzzers share: PETSc started once, a second of processor time for each input, and inputs
 * as files in memory. */
#pragma once
#include <petscsys.h>
#include <sanitizer/lsan_interface.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t n);

/* What a fuzzer does with one input. */
static void fuzz_one(const uint8_t *data, size_t n);

#define FUZZ_SECONDS 1

static inline void fuzz_too_slow(int number)
{
  static const char text[] = "an input that takes over a second of processor time\n";
  (void)number;
  if (write(STDERR_FILENO, text, sizeof text - 1) > 0) abort();
  abort();
}

/* The clock is that of the process: a busy machine makes no input slow. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t n)
{
  const struct itimerval limit = {.it_value = {.tv_sec = FUZZ_SECONDS}}, none = {0};
  if (setitimer(ITIMER_PROF, &limit, NULL)) abort();
  fuzz_one(data, n);
  if (setitimer(ITIMER_PROF, &none, NULL)) abort();
  return 0;
}

static inline void fuzz_start(void)
{
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 1);
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  __lsan_disable(); /* MPI keeps what it starts with */
  if (PetscInitializeNoArguments()) abort();
  __lsan_enable();
  PetscPopSignalHandler(); /* crashes belong to the fuzzer */
  signal(SIGPROF, fuzz_too_slow);
}

/* An internal error of PETSc is a finding, whatever the input. */
#define FUZZ_CALL(call) \
  do {                  \
    if (call) abort();  \
  } while (0)

/* The input as a file that can be opened by name; returns its descriptor. */
static inline int fuzz_file(const uint8_t *data, size_t n, char path[64])
{
  const int fd = memfd_create("fuzz", MFD_CLOEXEC);
  if (fd < 0 || write(fd, data, n) != (ssize_t)n) abort();
  snprintf(path, 64, "/proc/self/fd/%d", fd);
  return fd;
}
