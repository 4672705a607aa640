/* Parts of `talus check`: for the files of check*.c alone. */
#pragma once
#include "base/text.h"
#include "run/check/check.h"

/* check_openings.c. Collective. Warn of openings of less than two cells between held faces. */
PetscErrorCode CheckOpenings(const Model *m, Diag *diag);
