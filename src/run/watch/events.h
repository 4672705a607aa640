/* Events that measures count: a table in the run directory, and lines in the log. */
#pragma once
#include "model/model.h"
#include "output/directory/run_dir.h"

/* Collective, after every step: lines for events that are over and that known[k] (one number per
 * measure) does not count yet, and events.csv anew if there are any, or if `first`. A case without
 * measures that count has no such file. What the disk refuses comes back as PETSC_ERR_FILE_WRITE,
 * without a trace. */
PetscErrorCode EventsWatch(const Model *model, RunDir *dir, PetscBool first, PetscInt *known);
/* At the end: means over events, and what is still under way. */
PetscErrorCode EventsSummary(const Model *model, RunDir *dir);
