/* `talus check`, beyond the case file itself: the model is built but not run. */
#pragma once
#include <stdio.h>
#include "model/model.h"

/* Collective. Print sizes, estimated memory, regions and bodies (rank 0, to out); doubts become
 * warnings in diag. */
PetscErrorCode CheckModel(MPI_Comm comm, const Case *c, Diag *diag, FILE *out);
