/* How OpenBLAS computes: on one thread a rank, by kernels that fit the processor. */
#pragma once

/* OpenBLAS would start a thread per core in every rank, and they would spin beside each other:
 * measured, a factorisation then takes up to twice as long. Asks it for one, unless the user set
 * OPENBLAS_NUM_THREADS. Does nothing with another BLAS. */
void threads_one_per_rank(void);

/* OpenBLAS tells processors by their numbers, and takes one that is newer than itself for one of 2004, whose kernels
 * factorise at half the speed and less. Where it has done so, gives it kernels by what the processor can do, unless the
 * user set OPENBLAS_CORETYPE. Before anything is computed. Does nothing with another BLAS. */
void blas_know_processor(void);
