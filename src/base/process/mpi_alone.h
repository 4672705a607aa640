/* A process that no launcher started talks to nobody, and need not wait for what it would talk through. */
#pragma once

/* Before MPI_Init: where no mpiexec started us, Open MPI neither starts its daemon nor looks for networks (their clocks
 * are measured by sleeping): a command begins in .1 s instead of .45. What the user set for MPI stays; other MPIs do
 * not know these words. */
void mpi_alone_begin(void);

/* After it: the words are taken back, since a program that we start may have many ranks. */
void mpi_alone_end(void);
