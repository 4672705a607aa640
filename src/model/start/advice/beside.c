/* What is prescribed where no material is: no node there has an unknown, and nothing tells. */
#include "model/model_private.h"

PetscErrorCode ModelCountPrescribed(const Model *m, PetscInt entry, PetscInt count[2])
{
  const MotionNodes *nodes = &m->boundary->motion[entry];
  PetscInt local[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < nodes->n; ++i) {
    if (nodes->node[i] >= m->grid->n_owned) continue;
    ++local[0];
    local[1] += m->nodes->touched[nodes->node[i]] != 0;
  }
  PetscCall(MPIU_Allreduce(local, count, 2, MPIU_INT, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

static PetscBool goes_anywhere(const MotionSpec *motion)
{
  PetscBool goes = (PetscBool)(motion->kind == MOTION_ROTATION && motion->rate != 0);
  for (int d = 0; d < 3; ++d) goes |= motion->kind != MOTION_FIXED && motion->component[d] && motion->value[d] != 0;
  return goes;
}

/* A mesh goes with its body, and no other comes there; but of gmm its nodes are obstacles for what flies. To nodes of a
 * grid that is restored material may come: of dynamics that is what walls and floors are for, of statics what holds it
 * and what moves itself; what else would move it there was meant for material that is there. */
static PetscBool is_meant_for_now(const Model *m, const MotionSpec *motion)
{
  if (!m->method->restores_grid) return (PetscBool) !(m->method->clouds && m->scheme->inertia);
  return (PetscBool)(!m->scheme->inertia && !motion->moves && goes_anywhere(motion));
}

PetscErrorCode AdviseBeside(const Model *m, Diag *diag)
{
  PetscInt count[2];
  char path[64];

  PetscFunctionBeginUser;
  if (m->c->staged) PetscFunctionReturn(0); /* bodies come later */
  for (PetscInt k = 0; k < m->c->n_boundary; ++k) {
    const MotionSpec *motion = m->c->boundary + k;
    if (motion->absent || !is_meant_for_now(m, motion)) continue;
    PetscCall(ModelCountPrescribed(m, k, count));
    if (count[1] > 0) continue;
    snprintf(path, sizeof path, "boundary[%d].on", (int)k);
    diag_warning(diag, path,
                 "no material is beside the %d nodes that boundary[%d] takes: what it prescribes does nothing",
                 (int)count[0], (int)k);
    diag_hint(diag, "it acts on nodes of cells that hold a body: let the place begin where the body ends");
  }
  PetscFunctionReturn(0);
}
