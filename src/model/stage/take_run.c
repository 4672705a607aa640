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

/* What the model of that run would have told. */
static const char *missed(const Case *from)
{
  return case_is_static(&from->analysis) ? "what points that moved left out of balance in that run is held, and fades"
                                         : "loads that are others than in that run act half a step late";
}

/* The model of that run where its tables say; NULL: it cannot be made any more, or is none of theirs (its case was
 * changed, its mesh has gone). */
static PetscErrorCode Revive(MPI_Comm comm, const Case *from, Tables *tables, Diag *diag, Model **before)
{
  char reason[256] = "no model can be made of its case";
  Diag *unheard;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&unheard));
  PetscCall(ModelCreate(comm, from, unheard, before));
  PetscCall(DiagDestroy(&unheard));
  if (*before) PetscCall(ModelFromTables(*before, tables, reason));
  if (!reason[0]) PetscFunctionReturn(0);
  if (*before && (*before)->method->clouds) /* whose tables may be on their way */
    diag_error(diag, "initial.run", "the state cannot be taken over: %s", reason);
  else diag_warning(diag, "initial.run", "%s: %s", missed(from), reason);
  if (*before) PetscCall(ModelDestroy(before));
  PetscFunctionReturn(0);
}

/* That which a stage takes from the model of the one before, and its tables. */
static PetscErrorCode TakeModel(Model *m, Model *before, Tables **tables)
{
  const PetscBool jumps = accelerations_go_on(m->c, before->c), rests = remainder_goes_on(m->c, before->c);

  PetscFunctionBeginUser;
  PetscCall(TablesDestroy(tables));
  PetscCall(TablesCreate(tables));
  if (jumps) PetscCall(JumpFrom(before, *tables));
  if (rests) PetscCall(RemainderFrom(before, *tables));
  PetscCall(ModelToTables(before, *tables)); /* some stand over its arrays */
  if (jumps) PetscCall(JumpExpect(m));
  if (rests) PetscCall(RemainderExpect(m));
  PetscFunctionReturn(0);
}

/* Is the model of that run asked for more than its tables tell? Nodes of fem go where points go, and leave nothing out
 * of balance. */
static PetscBool asks_more(const Model *m, const Case *from)
{
  const PetscBool parts = (PetscBool)(m->method->restores_grid || m->method->clouds);
  if (strcmp(m->c->method, from->method) || !acts_by_case(m, from)) return PETSC_FALSE;
  const PetscBool left = (PetscBool)((parts || !case_is_static(&m->c->analysis)) && remainder_goes_on(m->c, from));
  return (PetscBool)(left || accelerations_go_on(m->c, from));
}

PetscErrorCode ModelTakeRun(Model *m, Tables **tables, const Case *from, Diag *diag, Imbalance *imbalance)
{
  Model *before = NULL;
  char other[256] = "";
  const PetscInt errors = diag_errors(diag);

  PetscFunctionBeginUser;
  state_check_grid(m, *tables, other);
  if (!other[0] && asks_more(m, from)) PetscCall(Revive(m->comm, from, *tables, diag, &before));
  if (diag_errors(diag) > errors) PetscFunctionReturn(0);
  if (before) PetscCall(TakeModel(m, before, tables));
  PetscCall(ModelTake(m, *tables, from, NULL, diag, imbalance));
  if (before) PetscCall(ModelDestroy(&before));
  PetscFunctionReturn(0);
}
