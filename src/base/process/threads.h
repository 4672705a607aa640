/* One thread a rank. */
#pragma once

/* OpenBLAS would start a thread per core in every rank, and they would spin beside each other:
 * measured, a factorisation then takes up to twice as long. Asks it for one, unless the user set
 * OPENBLAS_NUM_THREADS. Does nothing with another BLAS. */
void threads_one_per_rank(void);
