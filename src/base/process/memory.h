/* PETSc's memory, so that a machine without any says so: PETSc 3.18 itself reports a line number as
 * the code and a function as the message. */
#pragma once
#include "base/diag/diag.h"

/* Before PetscInitialize, with the words that go to it (or 0, NULL). Nothing happens where PETSc is
 * to debug memory by itself. */
PetscErrorCode MemoryInstall(int argc, char **argv);
/* Collective. What the machines of the communicator hold together, or control groups let them use, bytes; the
 * environment's TALUS_MEMORY, in GB, instead where it is set (a warning where that is no such number). 0 where nothing
 * tells. The same at every call. */
PetscErrorCode MemoryHeld(MPI_Comm comm, Diag *diag, PetscReal *bytes);
