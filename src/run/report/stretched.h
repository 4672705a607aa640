#pragma once
#include "model/model_private.h"

/* Collective. At the end of a run by gmm: elastic material that is drawn out, among functions too wide to stay even
 * there. */
PetscErrorCode WarnOfStretch(const Model *model, Diag *diag);
