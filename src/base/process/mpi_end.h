/* How the program begins and ends with MPI. */
#pragma once
#include <petscsys.h>

/* Before PetscInitialize, so that PetscFinalize leaves MPI up and MpiEnd can take it down. */
int mpi_begin(int *argc, char ***argv);

/* After PetscFinalize, as the last thing of all: everything is written and closed. Takes MPI down
 * and ends the process with this code.
 *
 * Open MPI 4.1 with PMIx can crash in MPI_Finalize: threads of its own ("progress threads") still
 * run while it takes down what they use
 * (open-mpi/ompi issue 10117: once in a thousand times, more often on a busy machine). Nothing of
 * talus is at stake by then, so such a crash must
 * not turn a good run into a bad one: it ends the process with the same code, without a word. Nor
 * are the libraries' destructors waited for. */
void mpi_end(int exit_code) __attribute__((noreturn));
