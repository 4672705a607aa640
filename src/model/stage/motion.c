/* How velocities and accelerations begin with a stage. */
#include "model/stage/stage_private.h"

static PetscBool stands_still(const Model *m)
{
  return (PetscBool)(!m->scheme->inertia || (m->c->spec && m->c->spec->reset.velocity));
}

/* Accelerations of the state before, if it had any, mean nothing: they are those of the balance. */
static PetscBool begins_anew(const Model *m, const Case *from)
{
  return (PetscBool)(stands_still(m) || case_is_static(&from->analysis));
}

PetscErrorCode ResetMotion(Model *m, const Case *from, PetscBool next)
{
  const PetscBool stands = stands_still(m), anew = !next || (m->c->spec && m->c->spec->reset.displacement);
  NodalFields *n = m->nodes;
  const PetscInt dofs = m->grid->n_nodes * m->dim, numbers = m->points->n * m->dim;

  PetscFunctionBeginUser;
  if (anew) PetscCall(PetscArrayzero(m->points->real[POINT_U], numbers));
  if (anew) PetscCall(PetscArrayzero(m->tracers->real[POINT_U], m->tracers->n * m->dim));
  if (stands && !m->method->restores_grid) PetscCall(PetscArrayzero(n->v, dofs));
  if (stands) PetscCall(PetscArrayzero(m->points->real[POINT_V], numbers));
  if (stands) rigid_halt(m, from);
  if (!begins_anew(m, from)) PetscFunctionReturn(0);
  if (m->points->components[POINT_SLOPE])
    PetscCall(PetscArrayzero(m->points->real[POINT_SLOPE], m->points->n * m->points->components[POINT_SLOPE]));
  PetscCall(PetscArrayzero(m->points->real[POINT_A], numbers));
  PetscCall(PetscArrayzero(n->a, dofs));
  PetscCall(PetscArrayzero(n->echo, dofs));
  PetscCall(PetscArrayzero(n->rate, dofs));
  PetscFunctionReturn(0);
}

/* Gravity that changes at once accelerates all that is free at once: what moves would else lack half a step of it. */
static PetscErrorCode FeelGravity(Model *m, const PetscReal more[3])
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal *jump, *points = m->points->real[POINT_A];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->points->n * dim; ++i) points[i] += more[i % dim];
  PetscCall(PetscMalloc1(dofs, &jump));
  for (PetscInt i = 0; i < dofs; ++i) jump[i] = more[i % dim];
  keep_free(m, jump);
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) n->a[i] += jump[i];
  PetscCall(PetscFree(jump));
  PetscCall(GridToGhosts(m->grid, dim, n->a));
  PetscCall(PetscArraycpy(n->a_points, n->a, dofs));
  PetscFunctionReturn(0);
}

PetscErrorCode BeginAcceleration(Model *m, const Case *from, PetscBool next)
{
  PetscReal before[3], now[3], change = 0;

  PetscFunctionBeginUser;
  if (!m->scheme->inertia) PetscFunctionReturn(0);
  if (begins_anew(m, from)) {
    PetscCall(InitialAcceleration(m));
    PetscFunctionReturn(0);
  }
  if (!next || m->c->release > 0) PetscFunctionReturn(0); /* what is new comes bit by bit */
  gravity_at(from, m->time, before);
  gravity_at(m->c, m->time, now);
  for (int d = 0; d < 3; ++d) now[d] -= before[d], change += PetscAbsReal(now[d]);
  if (change > 0) PetscCall(FeelGravity(m, now));
  PetscFunctionReturn(0);
}
