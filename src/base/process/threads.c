#include "base/process/threads.h"
#include <dlfcn.h>
#include <stdlib.h>

void threads_one_per_rank(void)
{
  void (*set)(int) = NULL;
  if (getenv("OPENBLAS_NUM_THREADS")) return;
  *(void **)&set = dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
  if (set) set(1);
}
