#include "base/process/mpi_alone.h"
#include <stddef.h>
#include <stdlib.h>

static struct {
  const char *const name, *const value;
  int ours;
} words[] = {{"OMPI_MCA_ess_singleton_isolated", "1", 0},
             {"OMPI_MCA_orte_create_session_dirs", "0", 0}, /* all singletons would share one */
             {"OMPI_MCA_pml", "ob1", 0},
             {"OMPI_MCA_btl", "self", 0}};

/* By mpiexec, or by a batch system that speaks PMI or PMIx to its ranks. */
static int is_launched(void)
{
  static const char *const marks[] = {
    "OMPI_COMM_WORLD_SIZE", "PMIX_NAMESPACE", "PMIX_RANK", "PMI_SIZE", "PMI_RANK", "PMI_FD"};
  for (size_t i = 0; i < sizeof marks / sizeof *marks; ++i)
    if (getenv(marks[i])) return 1;
  return 0;
}

void mpi_alone_begin(void)
{
  if (is_launched()) return;
  for (size_t i = 0; i < sizeof words / sizeof *words; ++i)
    words[i].ours = !getenv(words[i].name) && !setenv(words[i].name, words[i].value, 0);
}

void mpi_alone_end(void)
{
  for (size_t i = 0; i < sizeof words / sizeof *words; ++i)
    if (words[i].ours) unsetenv(words[i].name);
}
