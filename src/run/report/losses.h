/* What a run has lost on the way: tracers, loads, points, energy between points and grid. */
#pragma once
#include "output/directory/run_dir.h"
#include "model/model.h"

/* Collective. After an accepted step: a line in the log for what ended or left the grid in it. */
PetscErrorCode LossesLogStep(Model *model, RunDir *dir, const StepReport *report);
/* Collective. At the end: how much it was. */
PetscErrorCode LossesLogEnd(const Model *model, RunDir *dir);
/* Collective. How far a loaded surface has come, in cells, where its loads are then not where the stress is that bears
 * them: functions that are not averaged over points and pieces of the surface (docs/theory.md, "Pieces of a loaded
 * surface"). 0: not so far that it shows. */
PetscErrorCode LoadsMoved(const Model *model, PetscReal *moved);
/* Collective. At the end: soil that bears a tension, of laws that must begin under pressure (pulled.c). */
PetscErrorCode WarnOfPull(const Model *model, Diag *diag);
/* Collective. At the end, with the last values of the measures: what the user must know before
 * believing them. */
PetscErrorCode LossesWarn(Model *model, const PetscReal *values, Diag *diag);
