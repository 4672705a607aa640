/* A case that starts from the state of another run. */
#pragma once
#include "model/stage/stage.h"

/* Collective. Put the state that c->initial names into a model that was just created; mistakes go to diag. */
PetscErrorCode InitialTake(Model *model, Diag *diag, Imbalance *imbalance);
