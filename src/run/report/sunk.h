#pragma once
#include "model/model_private.h"

/* Of explicit runs at their end: walls and interfaces into which material has sunk by more than a hundredth of a
 * cell. */
void warn_of_sunk(const Model *model, Diag *diag);
