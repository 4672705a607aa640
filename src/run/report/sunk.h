#pragma once
#include "model/model_private.h"

/* Of explicit dynamics at its end: walls and interfaces into which material has sunk by more than a hundredth of a
 * cell, and open walls through which it has gone. goes_on: stages that are not explicit follow, and take surfaces where
 * they are. */
void warn_of_sunk(const Model *model, PetscBool goes_on, Diag *diag);
