/* What acts jumps when a stage begins, and so do accelerations (docs/theory.md, "Stages"): by the difference between
 * those that balance the same state before and after. Newmark's first step would lack half a step of it. */
#include "grid/cloud/cloud.h"
#include "grid/search/directory.h"
#include "method/extend/extend.h"
#include "model/stage/stage_private.h"

#define SAME 1e-9 /* of what acts: beyond it all is round-off, and nothing jumps */
#define TOLD 1e-2 /* of an acceleration that held nodes are told: less comes of another step to read it by */

PetscBool accelerations_go_on(const Case *c, const Case *from)
{
  const TimeScheme *scheme = time_scheme_of(&c->analysis);
  if (!scheme || !scheme->inertia || scheme->middle || scheme == &time_scheme_explicit) return PETSC_FALSE;
  if (case_is_static(&from->analysis) || (c->spec && c->spec->reset.velocity)) return PETSC_FALSE;
  return (PetscBool)(c->release <= 0); /* else what is new comes bit by bit */
}

/* Of each node its acceleration, what it lacks where it is held, and what it is told to have there. */
enum { BALANCED, LACKS, IS_TOLD, PARTS };

static NodalField field_of(const Model *m)
{
  return (NodalField){
    .name = "acceleration_lack", .unit = "m/s2, N", .components = PARTS * m->dim, .values = m->balanced};
}

/* Where in such a field dof i is. */
static PetscInt place_of(PetscInt dim, int part, PetscInt i) { return (i / dim * PARTS + part) * dim + i % dim; }

PetscErrorCode JumpExpect(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(PetscMax(1, PARTS * m->grid->n_nodes * m->dim), &m->balanced));
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

/* Over which what is told is looked at, s. */
static PetscReal look_of(const Model *m) { return m->c->analysis.step > 0 ? m->c->analysis.step : m->control.next; }

/* Of all dofs their acceleration, and of held ones that which they are told for what follows, whatever they have: one
 * look of the same length before and after, by which nothing jumps that goes on. */
static PetscErrorCode Told(const Model *m, PetscReal *told)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  PetscReal *v, *given;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(dofs, &v, dofs, &given));
  PetscCall(PrescribedStart(m, look_of(m), v, given));
  PetscCall(PetscArraycpy(told, m->nodes->a, dofs));
  frames_turn(&m->boundary->frames, m->dim, told);
  for (PetscInt i = 0; i < dofs; ++i)
    if (m->boundary->fixed[i]) told[i] = given[i];
  frames_turn(&m->boundary->frames, m->dim, told);
  PetscCall(PetscFree2(v, given));
  PetscFunctionReturn(0);
}

/* Node by node. */
static PetscErrorCode Find(Model *m, PetscReal *all, PetscReal *size)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal *a, *lacks, *told;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(dofs, &a, dofs, &lacks, dofs, &told));
  PetscCall(Told(m, told));
  PetscCall(BalancedAcceleration(m, a, lacks, size));
  for (PetscInt i = 0; i < dofs; ++i) {
    all[place_of(dim, BALANCED, i)] = a[i];
    all[place_of(dim, LACKS, i)] = lacks[i];
    all[place_of(dim, IS_TOLD, i)] = told[i];
  }
  PetscCall(PetscFree3(a, lacks, told));
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
  for (PetscInt i = 0; i < dofs; ++i) a[i] = m->balanced[place_of(dim, BALANCED, i)];
  if (any) {
    accelerate_points(m, comes, a);
    m->space->present = PETSC_FALSE;
    PetscCall(ModelInitialise(m));
  }
  PetscCall(PetscFree2(comes, a));
  PetscFunctionReturn(0);
}

/* Do these differ by more than a look over other clocks does, of a node that moves by v? */
static PetscBool is_other(const Model *m, PetscReal now, PetscReal before, const PetscReal *v)
{
  const PetscReal larger = PetscMax(PetscAbsReal(now), PetscAbsReal(before));
  PetscReal speed = 0;
  for (PetscInt d = 0; d < m->dim; ++d) speed += PetscAbsReal(v[d]);
  return (PetscBool)(PetscAbsReal(now - before) > PetscMax(TOLD * larger, SAME * speed / look_of(m)));
}

/* Nodes of a mesh that are held from now on, or told another motion, have its acceleration at once: Newmark's formulas
 * would swing about it, and with them forces of a scheme that does not weigh two steps alike, as Bossak's. A grid that
 * is restored and constraints of a cloud have it in each step (prepare.c). */
static PetscErrorCode TakeTold(Model *m)
{
  const Frames *frames = &m->boundary->frames;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal *now, *before, *a = m->nodes->a;

  PetscFunctionBeginUser;
  if (m->method->restores_grid || m->method->clouds) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(dofs, &now, dofs, &before));
  PetscCall(Told(m, now));
  for (PetscInt i = 0; i < dofs; ++i) before[i] = m->balanced[place_of(dim, IS_TOLD, i)];
  frames_turn(frames, dim, now);
  frames_turn(frames, dim, before);
  frames_turn(frames, dim, a);
  for (PetscInt i = 0; i < dofs; ++i)
    if (m->boundary->fixed[i] && is_other(m, now[i], before[i], m->nodes->v + i / dim * dim))
      a[i] += now[i] - before[i];
  frames_turn(frames, dim, a);
  PetscCall(PetscFree2(now, before));
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
static PetscErrorCode Jump(Model *m, const PetscReal *all, PetscReal size)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal *a, *lacks;
  PetscBool matters;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(dofs, &a, dofs, &lacks));
  for (PetscInt i = 0; i < dofs; ++i) {
    a[i] = all[place_of(dim, BALANCED, i)];
    lacks[i] = all[place_of(dim, LACKS, i)];
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
  const PetscInt n = m->grid->n_nodes * PARTS * m->dim;
  PetscReal *all, size;

  PetscFunctionBeginUser;
  if (!m->method->clouds) {
    const NodalField field = field_of(m);
    PetscCall(NodesFromTable(m->grid, PETSC_FALSE, 1, &field, tables_find(tables, "jump"), reason));
  }
  PetscCall(LookAlone(m, PETSC_TRUE));
  PetscCall(ComeAlong(m, from));
  PetscCall(TakeTold(m));
  PetscCall(PetscMalloc1(n, &all));
  PetscCall(Find(m, all, &size));
  for (PetscInt i = 0; i < n; ++i) all[i] -= m->balanced[i];
  if (!reason[0]) PetscCall(Jump(m, all, size));
  PetscCall(LookAlone(m, PETSC_FALSE));
  PetscCall(PetscFree(all));
  PetscCall(Forget(m));
  PetscFunctionReturn(0);
}
