/* What the last step of statics leaves out of balance, once points have moved and give other nodes what they bear. The
 * next step takes it in, whether a stage ends between them or not (docs/theory.md, "Stages"). And what is out of
 * balance in dynamics, since it accelerates: a stage that releases something holds what it changes, and no inertia. */
#include "grid/cloud/cloud.h"
#include "grid/search/directory.h"
#include "model/stage/stage_private.h"

PetscBool remainder_goes_on(const Case *c, const Case *from)
{
  if (from->analysis.type == ANALYSIS_STATIC) return case_is_static(&c->analysis);
  return (PetscBool)(c->release > 0 && !case_is_static(&from->analysis) && !case_is_static(&c->analysis));
}

static NodalField field_of(const Model *m)
{
  return (NodalField){.name = "remainder", .unit = "N", .components = m->dim, .values = m->remainder};
}

PetscErrorCode RemainderExpect(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(PetscMax(1, m->grid->n_nodes * m->dim), &m->remainder));
  if (!m->method->clouds) PetscFunctionReturn(0);
  const NodalField field = field_of(m);
  PetscCall(
    GridCloudFollow(m->grid, (CloudField){&m->remainder, field.components, field.name, field.unit, PETSC_TRUE}));
  PetscFunctionReturn(0);
}

/* Where nodes are held the boundary goes on bearing what it bore. */
static PetscErrorCode Find(Model *m, PetscReal *remainder)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  PetscReal *bore;

  PetscFunctionBeginUser;
  mark_fixed(m);
  PetscCall(Residual(m, remainder));
  PetscCall(PetscMalloc1(dofs, &bore));
  PetscCall(PetscArraycpy(bore, m->nodes->held, dofs));
  keep_held(m, bore);
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) remainder[i] -= bore[i];
  PetscCall(PetscFree(bore));
  PetscFunctionReturn(0);
}

PetscErrorCode RemainderFrom(Model *before, Tables *tables)
{
  PetscFunctionBeginUser;
  PetscCall(ModelInitialise(before));
  PetscCall(RemainderExpect(before));
  PetscCall(Find(before, before->remainder));
  if (before->method->clouds) PetscFunctionReturn(0); /* it follows the nodes */
  const NodalField field = field_of(before);
  PetscCall(NodesToTable(before->grid, NULL, 1, &field, "remainder", tables));
  PetscFunctionReturn(0);
}

static PetscBool some_go(const Case *c, const Case *from)
{
  for (PetscInt b = 0; b < from->n_bodies; ++b)
    if (!from->bodies[b].absent && body_comes(from, c, b)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The sum of the forces of nodes that material still reaches. */
static PetscErrorCode SumUp(const Model *m, PetscReal *all)
{
  PetscReal local = 0;

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    PetscReal square = 0;
    for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(m->remainder[node * m->dim + d]);
    if (m->nodes->touched[node]) local += PetscSqrtReal(square);
  }
  PetscCall(MPIU_Allreduce(&local, all, 1, MPIU_REAL, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* What nodes lack by the acceleration that they have, of owned nodes. */
static void take_inertia(Model *m)
{
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i)
    m->remainder[i] = -m->nodes->mass[i / m->dim] * m->nodes->a[i];
}

/* Where a body goes nobody can tell what it leaves from what the others do: nodes are of both, and neither part would
 * be in balance. There all is held, but for inertia where points or nodes remember it. */
PetscErrorCode RemainderTo(Model *m, const Case *from, const Tables *tables, PetscReal *held)
{
  char reason[256] = "";

  PetscFunctionBeginUser;
  *held = 0;
  if (!m->remainder) PetscFunctionReturn(0);
  const NodalField field = field_of(m);
  if (!m->method->clouds)
    PetscCall(NodesFromTable(m->grid, PETSC_FALSE, 1, &field, tables_find(tables, "remainder"), reason));
  PetscCheck(!reason[0], m->comm, PETSC_ERR_PLIB, "%s", reason);
  if (!some_go(m->c, from)) PetscFunctionReturn(0);
  if (case_is_static(&m->c->analysis)) PetscCall(SumUp(m, held));
  PetscCall(PetscArrayzero(m->remainder, m->grid->n_nodes * m->dim));
  if (m->scheme->inertia && inertia_is_known(m, from)) take_inertia(m);
  PetscFunctionReturn(0);
}

PetscErrorCode RemainderForget(Model *m)
{
  PetscFunctionBeginUser;
  if (!m->remainder) PetscFunctionReturn(0);
  if (m->method->clouds) grid_cloud_forget(m->grid);
  PetscCall(PetscFree(m->remainder));
  PetscFunctionReturn(0);
}
