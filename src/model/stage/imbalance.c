/* The balance at the start of a stage: what of it is held. */
#include "model/stage/stage_private.h"
#include "solve/forces/release.h"

PetscErrorCode Residual(Model *m, PetscReal *residual)
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal *g = m->gravity;

  PetscFunctionBeginUser;
  gravity_at(m->c, m->time, g);
  PetscCall(PetscArrayzero(n->du, dofs));
  for (PetscInt i = 0; i < dofs; ++i) n->history[i] = -g[i % dim];
  const NodalScene scene = nodal_scene(m, m->time, n->du);
  PetscCall(NodalForcesBegin(&m->forces, &scene)); /* what carries them has moved since it was made */
  PetscCall(NodalForcesExternal(&m->forces, &scene, PETSC_TRUE, n->external));
  PetscCall(ContactGoOn(m, n->external));
  PetscCall(PetscArrayzero(residual, dofs));
  pressure_guess(m);
  WeakFormInput in = weak_form_of(m, 0);
  WeakFormOutput out = {.force = residual};
  PetscCall(m->formulation->assemble(&in, &out));
  PetscCall(GridSumToOwners(m->grid, dim, residual));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) residual[i] -= n->external[i];
  PetscFunctionReturn(0);
}

static PetscErrorCode Report(const Model *m, const PetscReal *residual, Imbalance *imbalance)
{
  PetscReal local[2] = {0, 0}, where[3] = {0, 0, 0}, most;
  PetscMPIInt rank, mine, first;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    PetscReal square = 0;
    for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(residual[node * m->dim + d]);
    local[0] += PetscSqrtReal(square);
    if (PetscSqrtReal(square) <= local[1]) continue;
    local[1] = PetscSqrtReal(square);
    for (PetscInt d = 0; d < m->dim; ++d) where[d] = m->grid->x[node * m->dim + d];
  }
  PetscCall(MPIU_Allreduce(local, &imbalance->all, 1, MPIU_REAL, MPI_SUM, m->comm));
  PetscCall(MPIU_Allreduce(local + 1, &most, 1, MPIU_REAL, MPIU_MAX, m->comm));
  mine = local[1] == most ? rank : PETSC_MPI_INT_MAX;
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, m->comm));
  PetscCallMPI(MPI_Bcast(where, 3, MPIU_REAL, first, m->comm));
  imbalance->most = most;
  PetscCall(PetscArraycpy(imbalance->where, where, 3));
  PetscFunctionReturn(0);
}

void keep_held(const Model *m, PetscReal *values)
{
  frames_turn(&m->boundary->frames, m->dim, values);
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i)
    if (!m->boundary->fixed[i] || !m->nodes->fixed[i] || m->nodes->idle[i / m->dim]) values[i] = 0;
  frames_turn(&m->boundary->frames, m->dim, values);
}

/* Forces fade at held nodes, too: at the start the boundary bears what it bore, and h is what the state lacks to it.
 * Where no node knows of a reaction, nothing was held; but points that another run hands to other nodes bring none, and
 * there it is what the state asks for. */
static PetscErrorCode HoldReactions(const Model *m, const Case *from, const PetscReal *residual, PetscReal *held)
{
  const PetscReal *bore = from->analysis.type == ANALYSIS_EXPLICIT ? m->nodes->reaction : m->nodes->held;
  const PetscInt owned = m->grid->n_owned * m->dim;
  PetscBool any = PETSC_FALSE;
  PetscReal *lacks;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < owned; ++i) any |= bore[i] != 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPIU_BOOL, MPI_LOR, m->comm));
  if (!any && (m->c->stage > 0 || from->n_boundary == 0)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &lacks));
  for (PetscInt i = 0; i < owned; ++i) lacks[i] = residual[i] - bore[i];
  keep_held(m, lacks);
  for (PetscInt i = 0; i < owned && !any; ++i) m->nodes->held[i] = m->nodes->rate[i] = m->nodes->reaction[i] = lacks[i];
  for (PetscInt i = 0; i < owned && any && held; ++i) held[i] += lacks[i];
  PetscCall(PetscFree(lacks));
  PetscFunctionReturn(0);
}

/* What is missing to balance, but for what the next step takes in anyway. */
static PetscErrorCode Lack(Model *m, PetscReal *residual)
{
  PetscFunctionBeginUser;
  PetscCall(Residual(m, residual));
  PetscCall(RemainderTakeOff(m, residual));
  PetscFunctionReturn(0);
}

/* Once contact has taken over what it can of it. */
static PetscErrorCode Remains(Model *m, const Case *from, PetscReal *residual)
{
  PetscBool taken;

  PetscFunctionBeginUser;
  PetscCall(Lack(m, residual));
  PetscCall(ContactTakesOver(m, from, residual, &taken));
  if (!taken) PetscFunctionReturn(0);
  PetscCall(Lack(m, residual));
  PetscCall(ContactBegin(m, PETSC_TRUE));
  PetscFunctionReturn(0);
}

void keep_free(const Model *m, PetscReal *values)
{
  frames_turn(&m->boundary->frames, m->dim, values);
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i)
    if (i >= m->grid->n_owned * m->dim || m->boundary->fixed[i] || m->nodes->fixed[i]) values[i] = 0;
  frames_turn(&m->boundary->frames, m->dim, values);
}

PetscErrorCode HoldImbalance(Model *m, const Case *from, Imbalance *imbalance)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  PetscReal *residual, *lacks, *held = release_forces(&m->forces);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(dofs, &residual));
  if (held) PetscCall(PetscArrayzero(held, dofs)); /* that of the stage before is over */
  mark_fixed(m);
  PetscCall(Remains(m, from, residual));
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  PetscCall(RigidHold(m->contact, &scene));
  PetscCall(PetscMalloc1(dofs, &lacks));
  PetscCall(PetscArraycpy(lacks, residual, dofs));
  keep_free(m, residual);
  PetscCall(Report(m, residual, imbalance));
  if (held) PetscCall(PetscArraycpy(held, residual, dofs));
  PetscCall(HoldReactions(m, from, lacks, held));
  PetscCall(PetscFree(lacks));
  PetscCall(PetscFree(residual));
  PetscFunctionReturn(0);
}
