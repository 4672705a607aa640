/* Kernels of linear algebra as fast as the processor. */
#pragma once

/* OpenBLAS tells processors by their numbers, and takes one that is newer than itself for one of 2004, whose kernels
 * factorise at half the speed and less. Where it has done so, gives it kernels by what the processor can do, unless the
 * user set OPENBLAS_CORETYPE. Before anything is computed. Does nothing with another BLAS. */
void blas_know_processor(void);
