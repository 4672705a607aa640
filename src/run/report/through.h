#pragma once
#include "model/model_private.h"

/* At the end of a run: walls with mass that are inside of other walls, or have left the grid. */
void warn_of_walls_through(const Model *model, Diag *diag);
