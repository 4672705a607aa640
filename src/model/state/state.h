/* All that a model must remember from one step to the next, as tables: what a checkpoint holds.
 *
 * Whatever can be computed again from it (support, nodal fields of a grid that is restored, the
 * matrix) is left out. A model that was brought back takes the same next step as the one that was
 * put away, bit by bit on the same number of ranks. */
#pragma once
#include "base/table/table.h"
#include "model/model.h"

/* Collective. The state at the end of a step, of which there must have been one: the first starts
 * from accelerations of its own. Tables may stand over the model's own arrays: use them before the
 * next step. */
PetscErrorCode ModelToTables(Model *model, Tables *tables);
/* Collective. Put a model that was just created where the tables say. If they do not fit the model,
 * reason (256 characters) says why on every rank and the model is fit for nothing but ModelDestroy;
 * else it is left empty. Tables of a cloud may be sent to other ranks on the way. */
PetscErrorCode ModelFromTables(Model *model, Tables *tables, char reason[256]);
/* Collective. Of such tables what goes on from one stage to the next: time, counts, the account of energies,
 * what measures keep. */
PetscErrorCode StateGoOn(Model *model, const Tables *tables, char reason[256]);
/* Is the grid that of the model? */
void state_check_grid(const Model *model, const Tables *tables, char reason[256]);
