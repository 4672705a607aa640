/* What the files that put a model's state away share. */
#pragma once
#include "grid/cloud/cloud.h"
#include "grid/search/directory.h"
#include "model/state/state.h"

/* What was lost on the way: energy, points, tracers, carried loads. Checkpoints of older programs
 * do not have it. */
PetscErrorCode StateLostToTables(Model *model, Tables *tables);
void state_lost_from_tables(Model *model, const Tables *tables, char reason[256]);

/* What an analysis knows besides how things move, where it does; materials have the strength that it left. */
PetscErrorCode StateAnalysisToTables(Model *model, Tables *tables);
PetscErrorCode StateAnalysisFromTables(Model *model, const Tables *tables, char reason[256]);
/* What the state before the first step was like. */
void state_initial_from_tables(Model *model, const Tables *tables, char reason[256]);

/* Lists of measures. */
PetscErrorCode StateListsToTables(const Model *model, Tables *tables);
PetscErrorCode StateListsFromTables(Model *model, const Tables *tables, char reason[256]);

/* Collective. After all other tables: nodes of a cloud, and which rows are whose. */
PetscErrorCode StateCloudToTables(const Model *model, Tables *tables);
/* Collective. First of all: rows to the ranks that wrote them, if these are as many (*home), and
 * the nodes. */
PetscErrorCode StateCloudNodes(Model *model, Tables *tables, PetscBool *home, char reason[256]);
/* Collective. Last of all: everything to its rank, the pattern, and phase a. */
PetscErrorCode StateCloudSettle(Model *model, const Tables *tables, PetscBool home, char reason[256]);
