/* The state of another run: as that of a stage before, but all that is counted begins now. */
#include "model/stage/stage_private.h"
#include "model/state/state.h"

/* Is what acts told by the cases alone? Walls and interfaces remember what presses on them, and no run hands that
 * over. */
static PetscBool acts_by_case(const Model *m, const Case *from)
{
  const Case *c = m->c;
  if (m->body_force || c->n_walls || c->n_interfaces || from->n_walls || from->n_interfaces) return PETSC_FALSE;
  for (PetscInt k = 0; k < c->n_loads; ++k)
    if (m->loads->asked[k].ask) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* The model of that run, and its tables once more, with what balances it; NULL: it cannot be made any more. */
static PetscErrorCode Revive(const Case *from, Tables **tables, MPI_Comm comm, Model **before)
{
  char reason[256] = "";
  Diag *unheard;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&unheard));
  PetscCall(ModelCreate(comm, from, unheard, before));
  PetscCall(DiagDestroy(&unheard));
  if (!*before) PetscFunctionReturn(0);
  PetscCall(ModelFromTables(*before, *tables, reason));
  PetscCheck(!reason[0], comm, PETSC_ERR_FILE_UNEXPECTED, "%s", reason);
  PetscCall(TablesDestroy(tables));
  PetscCall(TablesCreate(tables));
  PetscCall(JumpFrom(*before, *tables));
  PetscCall(ModelToTables(*before, *tables)); /* some stand over its arrays */
  PetscFunctionReturn(0);
}

PetscErrorCode ModelTakeRun(Model *m, Tables **tables, const Case *from, Diag *diag, Imbalance *imbalance)
{
  Model *before = NULL;
  char other[256] = "";

  PetscFunctionBeginUser;
  state_check_grid(m, *tables, other);
  if (!other[0] && !strcmp(m->c->method, from->method) && accelerations_go_on(m->c, from) && acts_by_case(m, from))
    PetscCall(Revive(from, tables, m->comm, &before));
  if (before) PetscCall(JumpExpect(m));
  PetscCall(ModelTake(m, *tables, from, PETSC_FALSE, diag, imbalance));
  if (before) PetscCall(ModelDestroy(&before));
  PetscFunctionReturn(0);
}
