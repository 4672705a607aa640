#pragma once
#include "model/model_private.h"

/* Collective. At the end of a run by implicit steps: matter whose stress depends on the rate of strain, which these
 * shear too much. */
PetscErrorCode WarnOfShear(const Model *model, Diag *diag);
