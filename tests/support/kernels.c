/* Tests compute with the kernels that the program has. */
#include "base/process/blas.h"

__attribute__((constructor)) static void know_processor(void) { blas_know_processor(); }
