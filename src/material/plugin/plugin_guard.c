/* A library may end the process, by STOP of Fortran or exit: in the middle of a run, without a word,
 * with the exit code of success. What the process does at its exit can reach nothing but a global. */
#include <stdio.h>
#include <unistd.h>
#include <stdlib.h>
#include "material/plugin/plugin.h"

const Plugin *volatile plugin_busy;

static void tell(void)
{
  const Plugin *g = plugin_busy;
  if (!g) return;
  fflush(NULL);
  fprintf(stderr,
          "error: the library of the law %s has ended the program in the middle: %s\n  hint: STOP in Fortran and exit "
          "do that; what has no answer sets %s\n",
          g->name, g->file, g->umat.call ? "PNEWDT below 1, which halves the step" : "its return value");
  fflush(stderr);
  _exit(1);
}

void plugin_watch(void)
{
  static PetscBool watched;
  if (!watched) watched = (PetscBool)!atexit(tell);
}
