/* What the user must know at the end of a run before believing its numbers. */
#pragma once
#include "model/model_private.h"

/* Share of the energy that came in: about what granular flows lose on usual grids. */
#define TRANSFER_ALLOWED 0.05

/* Is an energy, or what came in, more than steps leave open? J */
PetscBool energy_counts(const Model *model, PetscReal energy);
/* Of all that came in; 0 where neither counts. */
PetscReal energy_share(const Model *model, PetscReal energy);
/* Collective. What the run took or made on the way. */
PetscErrorCode WarnOfEnergy(Model *model, Diag *diag);

/* Tracers and loads that the material has left behind. */
void warn_of_followers(const Model *model, Diag *diag);
/* Collective. values: the last of the measures; those that are nan or infinite, and why. */
PetscErrorCode WarnOfEmpty(const Model *model, const PetscReal *values, Diag *diag);

/* Collective. Cells that hold more material than their room. */
PetscErrorCode WarnOfCrowd(Model *model, Diag *diag);
/* Collective. Grains under pressure that their law counts as farther apart than they are. */
PetscErrorCode WarnOfApart(Model *model, Diag *diag);

/* Collective. How far a loaded surface has come, in cells, where its loads are then not where the stress is that bears
 * them: functions that are not averaged over points and pieces of the surface (docs/theory.md, "Pieces of a loaded
 * surface"). 0: not so far that it shows. */
PetscErrorCode LoadsMoved(const Model *model, PetscReal *moved);
/* Collective. The same as a warning. */
PetscErrorCode WarnOfMovedLoads(const Model *model, Diag *diag);

/* Collective. Of implicit steps: matter whose stress depends on the rate of strain, which these shear too much. */
PetscErrorCode WarnOfShear(const Model *model, Diag *diag);
/* Collective. Of gmm: elastic material that is drawn out, among functions too wide to stay even there. */
PetscErrorCode WarnOfStretch(const Model *model, Diag *diag);
/* Of mpm: elastic bodies that bend or sway under a stress whose stiffness points without an extent lose. */
void warn_of_sway(const Model *model, Diag *diag);
/* That parts of gmm that no material joins have gone into each other. */
void warn_of_entered(const Model *model, Diag *diag);
/* Collective. Soil that bears a tension, of laws that must begin under pressure. */
PetscErrorCode WarnOfPull(const Model *model, Diag *diag);

/* Collective. Points that were taken through more than a piece of their tables of strength in one step. */
PetscErrorCode WarnOfPassed(const Model *model, Diag *diag);
/* Collective. Of statics: plastic flow beyond all that settles. */
PetscErrorCode WarnOfFailed(Model *model, Diag *diag);
/* Searches that found no limit load, or no factor of safety. */
void warn_of_search(const Model *model, Diag *diag);
/* Of statics: steps that ended in an equilibrium in which nothing stays. */
void warn_of_unstable(const Model *model, Diag *diag);

/* Of explicit dynamics: walls and interfaces into which material has sunk by more than a hundredth of a cell, and open
 * walls through which it has gone. goes_on: stages that are not explicit follow, and take surfaces where they are. */
void warn_of_sunk(const Model *model, PetscBool goes_on, Diag *diag);
/* Walls with mass that are inside of other walls, or have left the grid. */
void warn_of_walls_through(const Model *model, Diag *diag);
