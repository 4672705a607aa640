#pragma once
#include "model/model_private.h"

/* Of statics at their end: steps that ended in an equilibrium in which nothing stays. */
void warn_of_unstable(const Model *model, Diag *diag);
