/* What a run has lost on the way: tracers, loads, points, energy between points and grid. */
#pragma once
#include "output/directory/run_dir.h"
#include "model/model.h"

/* Collective. After an accepted step: a line in the log for what ended or left the grid in it. */
PetscErrorCode LossesLogStep(Model *model, RunDir *dir, const StepReport *report);
/* Collective. At the end: how much it was. */
PetscErrorCode LossesLogEnd(const Model *model, RunDir *dir);
/* Collective. At the end, with the last values of the measures: what the user must know before believing them
 * (warn/). */
PetscErrorCode LossesWarn(Model *model, const PetscReal *values, Diag *diag);
