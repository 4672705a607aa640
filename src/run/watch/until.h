/* Conditions that end a run before its latest time: analysis.until.
 *
 * A measure is below a value from when it has fallen there: it must have been at or above it before,
 * since a run that starts from rest would be over at once. `above` is the mirror image. */
#pragma once
#include "base/table/table.h"
#include "model/model.h"

typedef struct {
  PetscInt n;
  /* n: has the condition not held since it counts, or just before that? A step may cross the value and the time from
   * which it counts. 1 or 0 */
  PetscReal *was_off;
  PetscReal *since; /* n: time from which on it has held, s; < 0: it does not */
  PetscInt ended;   /* number of the condition that ended the run, from 1; 0: none has */
} Until;

PetscErrorCode UntilCreate(const Case *c, Until *until);
PetscErrorCode UntilDestroy(Until *until);
/* Collective. Look at the model after a step, or at the start. */
PetscErrorCode UntilLook(Until *until, Model *model);
/* "kinetic fell below 0.001 J for 0.1 s": why it ended. */
void until_reason(const Until *until, const Case *c, char reason[256]);

PetscErrorCode UntilToTables(const Until *until, const Case *c, Tables *tables);
/* Conditions that are not those of the run that is resumed begin anew. */
void until_from_tables(Until *until, const Case *c, const Tables *tables, char reason[256]);
