/* One state goes on as that of another case: of the next stage, or of a case that names another run.
 *
 * Points keep what they know; bodies that are gone lose theirs, new ones bring what they are seeded with, in cells of
 * fem as these are now. A body of another law, or of other elastic constants, keeps its stress, and of its history what
 * the new law calls by the same names; its F and undeformed volume become those of the new elastic strain, and its mass
 * goes with the density. Nodes of fem keep their places. */
#pragma once
#include "base/table/table.h"
#include "model/model.h"

/* What is out of balance at the start. */
typedef struct {
  PetscReal all, most; /* the sum of the forces of nodes, and the largest, N */
  PetscReal where[3];  /* of the largest, m */
  /* sum of those that points which moved have left, where a body goes and they are held with the rest, N */
  PetscReal moved;
} Imbalance;

/* Which measures, walls and interfaces cannot come or go; next: with a stage, else with the state of another run. */
PetscErrorCode RenameCheck(const Case *c, const Case *from, PetscBool next, Diag *diag);
/* Loads of stage c that the material carries, and of which the stage before it knows nothing, wait in that: it gets
 * them as further loads that do not act. From the last stage to the first. */
PetscErrorCode LoadsWait(const Case *c, Case *before);
/* Collective. Take the state of `from`, as tables, into a model that was just created. before: the model of that state,
 * which goes on in time, with its account of energies, measures and carried loads; NULL: everything begins now. What
 * does not fit goes to diag. */
PetscErrorCode ModelTake(Model *model, Tables *tables, const Case *from, const Model *before, Diag *diag,
                         Imbalance *imbalance);
/* Collective. ModelTake of a run's tables, which it may replace. Accelerations that go on jump with what acts, from
 * the end of that run to the start of this one, where its model can be made again. */
PetscErrorCode ModelTakeRun(Model *model, Tables **tables, const Case *from, Diag *diag, Imbalance *imbalance);
/* Collective. The model of the next stage, from the state of *model, which it replaces; on a mistake (in diag)
 * *model stays as it is, but can take no more steps. */
PetscErrorCode ModelSucceed(const Case *stage, Diag *diag, Model **model, Imbalance *imbalance);
