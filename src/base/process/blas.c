#include "base/process/blas.h"
#include <dlfcn.h>
#include <stdlib.h>
#include <strings.h>

#define UNKNOWN "Prescott" /* what OpenBLAS calls a processor of Intel's that it does not know */
#define CHOICE "OPENBLAS_CORETYPE"

/* The newest kernels that the processor can run, as OpenBLAS calls them; NULL: none that are newer. */
static const char *newest_kernels(void)
{
#if defined(__x86_64__) && defined(__GNUC__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return NULL;
  if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512bw") ||
      !__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512vl"))
    return "Haswell";
  return "SkylakeX";
#else
  return NULL;
#endif
}

void blas_know_processor(void)
{
  char *(*name)(void) = NULL;
  void (*quit)(void) = NULL, (*init)(void) = NULL;
  const char *kernels = newest_kernels();
  if (!kernels || getenv(CHOICE)) return;
  *(void **)&name = dlsym(RTLD_DEFAULT, "openblas_get_corename");
  *(void **)&quit = dlsym(RTLD_DEFAULT, "gotoblas_dynamic_quit");
  *(void **)&init = dlsym(RTLD_DEFAULT, "gotoblas_dynamic_init");
  if (!name || !quit || !init || strcasecmp(name(), UNKNOWN) != 0) return;
  setenv(CHOICE, kernels, 1);
  quit();
  init();
}

void threads_one_per_rank(void)
{
  void (*set)(int) = NULL;
  if (getenv("OPENBLAS_NUM_THREADS")) return;
  *(void **)&set = dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
  if (set) set(1);
}
