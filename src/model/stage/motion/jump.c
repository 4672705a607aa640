/* What acts jumps when a stage begins, and so do accelerations (docs/theory.md, "Stages"): by the difference between
 * those that balance the same state before and after. Newmark's first step would lack half a step of it. */
#include "grid/cloud/cloud.h"
#include "grid/search/directory.h"
#include "method/extend/extend.h"
#include "model/stage/stage_private.h"

#define SAME 1e-9 /* of what acts: beyond it all is round-off, and nothing jumps */

PetscBool accelerations_go_on(const Case *c, const Case *from)
{
  const TimeScheme *scheme = time_scheme_of(&c->analysis);
  if (!scheme || !scheme->inertia || scheme->middle || scheme == &time_scheme_explicit) return PETSC_FALSE;
  if (case_is_static(&from->analysis) || (c->spec && c->spec->reset.velocity)) return PETSC_FALSE;
  return (PetscBool)(c->release <= 0); /* else what is new comes bit by bit */
}

/* Of each node its acceleration, and what it lacks where it is held. */
static NodalField field_of(const Model *m)
{
  return (NodalField){.name = "acceleration_lack", .unit = "m/s2, N", .components = 2 * m->dim, .values = m->balanced};
}

PetscErrorCode JumpExpect(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(PetscMax(1, 2 * m->grid->n_nodes * m->dim), &m->balanced));
  if (!m->method->clouds) PetscFunctionReturn(0);
  const NodalField field = field_of(m);
  PetscCall(GridCloudFollow(m->grid, (CloudField){&m->balanced, field.components, field.name, field.unit, PETSC_TRUE}));
  PetscFunctionReturn(0);
}

static PetscErrorCode Forget(Model *m)
{
  PetscFunctionBeginUser;
  if (m->method->clouds) grid_cloud_forget(m->grid);
  PetscCall(PetscFree(m->balanced));
  PetscFunctionReturn(0);
}

/* Which nodes follow others is another in each stage: in explicit steps, with other loads, other nodes that are held.
 * Of the same points all have the same mass where none does, and forces that did not change cancel. */
static PetscErrorCode LookAlone(Model *m, PetscBool alone)
{
  Discretisation *s = m->space;

  PetscFunctionBeginUser;
  s->alone = PETSC_FALSE;
  const PetscBool works = (PetscBool)(m->method->restores_grid && extension_works(s));
  s->alone = alone;
  if (works) s->present = PETSC_FALSE;
  PetscCall(ModelInitialise(m));
  if (works) mark_fixed(m);
  PetscFunctionReturn(0);
}

/* Components of both, node by node. */
static PetscErrorCode Find(Model *m, PetscReal *both, PetscReal *size)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal *a, *lacks;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(dofs, &a, dofs, &lacks));
  PetscCall(BalancedAcceleration(m, a, lacks, size));
  for (PetscInt i = 0; i < dofs; ++i) {
    both[2 * i - i % dim] = a[i];
    both[2 * i - i % dim + dim] = lacks[i];
  }
  PetscCall(PetscFree2(a, lacks));
  PetscFunctionReturn(0);
}

PetscErrorCode JumpFrom(Model *before, Tables *tables)
{
  PetscReal size;

  PetscFunctionBeginUser;
  PetscCall(LookAlone(before, PETSC_TRUE));
  PetscCall(JumpExpect(before));
  PetscCall(Find(before, before->balanced, &size));
  PetscCall(LookAlone(before, PETSC_FALSE));
  if (before->method->clouds) PetscFunctionReturn(0); /* it follows the nodes */
  const NodalField field = field_of(before);
  PetscCall(NodesToTable(before->grid, NULL, 1, &field, "jump", tables));
  PetscFunctionReturn(0);
}

/* Points that come have the acceleration that their nodes had, and jump with these to what balances them. Nodes of a
 * mesh keep it (bring.c). */
static PetscErrorCode ComeAlong(Model *m, const Case *from)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscBool *comes, any = PETSC_FALSE;
  PetscReal *a;

  PetscFunctionBeginUser;
  if (!m->method->restores_grid || m->method->clouds) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(m->c->n_bodies, &comes, dofs, &a));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    comes[b] = (PetscBool)(!m->c->bodies[b].absent && body_comes(m->c, from, b));
    any |= comes[b];
  }
  for (PetscInt i = 0; i < dofs; ++i) a[i] = m->balanced[2 * i - i % dim];
  if (any) {
    accelerate_points(m, comes, a);
    m->space->present = PETSC_FALSE;
    PetscCall(ModelInitialise(m));
  }
  PetscCall(PetscFree2(comes, a));
  PetscFunctionReturn(0);
}

/* Is it more than round-off of what acts? */
static PetscErrorCode Matters(const Model *m, const PetscReal *a, const PetscReal *lacks, PetscReal size, PetscBool *it)
{
  PetscReal local = 0, sum;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i)
    local += PetscSqr(m->nodes->mass[i / m->dim] * a[i]) + PetscSqr(lacks[i]);
  PetscCall(MPIU_Allreduce(&local, &sum, 1, MPIU_REAL, MPI_SUM, m->comm));
  *it = (PetscBool)(PetscSqrtReal(sum) > SAME * size);
  PetscFunctionReturn(0);
}

/* Nodes that are made of points learn it from these. Walls that are gone have nothing that acts on. */
static PetscErrorCode Add(Model *m, const PetscReal *a, const PetscReal *lacks)
{
  NodalFields *n = m->nodes;
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  accelerate_points(m, NULL, a);
  PetscCall(ContactBegin(m, PETSC_TRUE));
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    n->rate[i] -= lacks[i];
    n->held[i] -= lacks[i];
  }
  if (m->method->restores_grid) m->space->present = PETSC_FALSE;
  PetscCall(ModelInitialise(m));
  if (m->method->restores_grid) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < dofs; ++i) n->a[i] += a[i];
  PetscCall(PetscArraycpy(n->a_points, n->a, dofs));
  PetscFunctionReturn(0);
}

/* From the difference of both, node by node; held dofs have the acceleration that they are given. */
static PetscErrorCode Jump(Model *m, const PetscReal *both, PetscReal size)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal *a, *lacks;
  PetscBool matters;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(dofs, &a, dofs, &lacks));
  for (PetscInt i = 0; i < dofs; ++i) {
    a[i] = both[2 * i - i % dim];
    lacks[i] = both[2 * i - i % dim + dim];
  }
  keep_free(m, a);
  frames_turn(&m->boundary->frames, dim, lacks);
  for (PetscInt i = 0; i < dofs; ++i)
    if (i >= m->grid->n_owned * dim || !m->boundary->fixed[i]) lacks[i] = 0;
  frames_turn(&m->boundary->frames, dim, lacks);
  PetscCall(GridToGhosts(m->grid, dim, a));
  PetscCall(Matters(m, a, lacks, size, &matters));
  if (matters) PetscCall(Add(m, a, lacks));
  PetscCall(PetscFree2(a, lacks));
  PetscFunctionReturn(0);
}

PetscErrorCode JumpTo(Model *m, const Case *from, const Tables *tables, char reason[256])
{
  const PetscInt n = m->grid->n_nodes * 2 * m->dim;
  PetscReal *both, size;

  PetscFunctionBeginUser;
  if (!m->method->clouds) {
    const NodalField field = field_of(m);
    PetscCall(NodesFromTable(m->grid, PETSC_FALSE, 1, &field, tables_find(tables, "jump"), reason));
  }
  PetscCall(LookAlone(m, PETSC_TRUE));
  PetscCall(ComeAlong(m, from));
  PetscCall(PetscMalloc1(n, &both));
  PetscCall(Find(m, both, &size));
  for (PetscInt i = 0; i < n; ++i) both[i] -= m->balanced[i];
  if (!reason[0]) PetscCall(Jump(m, both, size));
  PetscCall(LookAlone(m, PETSC_FALSE));
  PetscCall(PetscFree(both));
  PetscCall(Forget(m));
  PetscFunctionReturn(0);
}
