/* What the fuzzers share: PETSc started once, and inputs as files in memory. */
#pragma once
#include <petscsys.h>
#include <sanitizer/lsan_interface.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t n);

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
