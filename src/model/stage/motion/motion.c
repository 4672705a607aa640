/* How velocities and accelerations begin with a stage. */
#include "model/stage/stage_private.h"

PetscBool stands_still(const Model *m)
{
  return (PetscBool)(!m->scheme->inertia || (m->c->spec && m->c->spec->reset.velocity));
}

/* Accelerations of the state before, if it had any, mean nothing: they are those of the balance. */
static PetscBool begins_anew(const Model *m, const Case *from)
{
  return (PetscBool)(stands_still(m) || case_is_static(&from->analysis));
}

/* Points that come were accelerated as in a first step when they were drawn; here they jump with what acts, or what is
 * new comes bit by bit. */
static void let_come(Model *m, const Case *from)
{
  if (!m->balanced && m->c->release <= 0) return;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (!body_comes(m->c, from, m->points->body[p])) continue;
    for (PetscInt d = 0; d < m->dim; ++d) point_real(m->points, POINT_A, p)[d] = 0;
  }
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
  let_come(m, from);
  if (!begins_anew(m, from)) PetscFunctionReturn(0);
  if (m->points->components[POINT_SLOPE])
    PetscCall(PetscArrayzero(m->points->real[POINT_SLOPE], m->points->n * m->points->components[POINT_SLOPE]));
  PetscCall(PetscArrayzero(m->points->real[POINT_A], numbers));
  PetscCall(PetscArrayzero(n->a, dofs));
  PetscCall(PetscArrayzero(n->echo, dofs));
  PetscCall(PetscArrayzero(n->rate, dofs));
  PetscFunctionReturn(0);
}

PetscErrorCode BeginAcceleration(Model *m, const Case *from, const Tables *tables)
{
  char reason[256] = "";

  PetscFunctionBeginUser;
  if (m->scheme->inertia && begins_anew(m, from)) PetscCall(InitialAcceleration(m));
  if (m->balanced) PetscCall(JumpTo(m, from, tables, reason));
  else PetscCall(BodiesBeginAcceleration(m, from));
  PetscCheck(!reason[0], m->comm, PETSC_ERR_PLIB, "%s", reason);
  PetscFunctionReturn(0);
}
