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

/* Of each node twice: where it was free, and where it was held. */
enum { FREE, HELD, PARTS };

static PetscReal *part_of(const Model *m, PetscInt node, int part)
{
  return m->remainder + (node * PARTS + part) * m->dim;
}

static NodalField field_of(const Model *m)
{
  return (NodalField){.name = "remainder", .unit = "N", .components = PARTS * m->dim, .values = m->remainder};
}

static void give(const Model *m, const PetscReal *values, int part)
{
  for (PetscInt node = 0; node < m->grid->n_owned; ++node)
    for (PetscInt d = 0; d < m->dim; ++d) part_of(m, node, part)[d] = values[node * m->dim + d];
}

PetscErrorCode RemainderExpect(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(PetscMax(1, m->grid->n_nodes * PARTS * m->dim), &m->remainder));
  if (!m->method->clouds) PetscFunctionReturn(0);
  const NodalField field = field_of(m);
  PetscCall(
    GridCloudFollow(m->grid, (CloudField){&m->remainder, field.components, field.name, field.unit, PETSC_TRUE}));
  PetscFunctionReturn(0);
}

/* Where nodes are held the boundary goes on bearing what it bore. */
static PetscErrorCode Find(Model *m)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim, owned = m->grid->n_owned * m->dim;
  PetscReal *lacks, *held;

  PetscFunctionBeginUser;
  mark_fixed(m);
  PetscCall(PetscMalloc2(dofs, &lacks, dofs, &held));
  PetscCall(Residual(m, lacks));
  PetscCall(PetscArraycpy(held, lacks, dofs));
  keep_held(m, held);
  for (PetscInt i = 0; i < owned; ++i) lacks[i] -= held[i];
  give(m, lacks, FREE);
  PetscCall(PetscArraycpy(lacks, m->nodes->held, dofs));
  keep_held(m, lacks);
  for (PetscInt i = 0; i < owned; ++i) held[i] -= lacks[i];
  give(m, held, HELD);
  PetscCall(PetscFree2(lacks, held));
  PetscFunctionReturn(0);
}

PetscErrorCode RemainderFrom(Model *before, Tables *tables)
{
  PetscFunctionBeginUser;
  PetscCall(ModelInitialise(before));
  PetscCall(RemainderExpect(before));
  PetscCall(Find(before));
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
    for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(part_of(m, node, FREE)[d] + part_of(m, node, HELD)[d]);
    if (m->nodes->touched[node]) local += PetscSqrtReal(square);
  }
  PetscCall(MPIU_Allreduce(&local, all, 1, MPIU_REAL, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* What nodes lack by the acceleration that they have, of owned nodes. */
static void take_inertia(Model *m)
{
  for (PetscInt node = 0; node < m->grid->n_owned; ++node)
    for (PetscInt d = 0; d < m->dim; ++d)
      part_of(m, node, FREE)[d] = -m->nodes->mass[node] * m->nodes->a[node * m->dim + d];
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
  PetscCall(PetscArrayzero(m->remainder, m->grid->n_nodes * PARTS * m->dim));
  if (m->scheme->inertia && inertia_is_known(m, from)) take_inertia(m);
  PetscFunctionReturn(0);
}

/* What points that moved ask of the boundary it would have borne, however much that is. No node has felt it yet: one
 * that statics let go would have it at once, and material that flows there may bear nothing of the kind. It is held
 * with all that it lacks. In dynamics what a held node lacks is inertia. */
PetscErrorCode RemainderTakeOff(const Model *m, PetscReal *residual)
{
  PetscReal *held;

  PetscFunctionBeginUser;
  if (!m->remainder) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &held));
  for (PetscInt node = 0; node < m->grid->n_owned; ++node)
    for (PetscInt d = 0; d < m->dim; ++d) {
      residual[node * m->dim + d] -= part_of(m, node, FREE)[d];
      held[node * m->dim + d] = part_of(m, node, HELD)[d];
    }
  if (case_is_static(&m->c->analysis)) keep_held(m, held);
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) residual[i] -= held[i];
  PetscCall(PetscFree(held));
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
