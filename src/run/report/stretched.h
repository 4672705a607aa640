#pragma once
#include "model/model_private.h"

/* Collective. At the end of a run by gmm: elastic material that is drawn out, among functions too wide to stay even
 * there. */
PetscErrorCode WarnOfStretch(const Model *model, Diag *diag);
/* That parts of gmm that no material joins have gone into each other. */
void warn_of_entered(const Model *model, Diag *diag);
