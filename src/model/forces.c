/* The list of nodal forces over the life of a model. */
#include "method/extend/extend.h"
#include "model/model_private.h"

NodalScene nodal_scene(const Model *m, PetscReal t, const PetscReal *du)
{
  return (NodalScene){
    .c = m->c,
    .grid = m->grid,
    .points = m->points,
    .support = m->space->support,
    .filled = m->space->filled,
    .touched = m->nodes->touched,
    .fixed = m->nodes->fixed,
    .prescribed = m->nodes->prescribed,
    .du = du,
    .soft = m->space->soft,
    .t = raised_time(m, t),
    .whole = 1 / time_solved(m->scheme),
    .end = m->time + (t - m->time) / time_solved(m->scheme),
    .first = (PetscBool)(m->step == 0 && m->initial.parts == 0),
    .moves = m->scheme->inertia,
    .passes = (PetscBool)(m->method->restores_grid || m->method->clouds),
    .stays = equilibrium_stays(m),
    .materials = m->materials,
    .bends = m->space->basis->bends ? extension_bends : NULL,
    .bends_context = m->space,
    .contact = m->contact,
    .loads = m->loads,
    .constraints = m->method->clouds ? m->space->constraints : NULL,
    .body_force = m->body_force,
    .body_force_context = m->body_force_context,
  };
}

PetscErrorCode ForcesCreate(Model *m, Diag *diag)
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);

  PetscFunctionBeginUser;
  PetscCall(NodalForcesDestroy(&m->forces));
  PetscCall(NodalForcesCreate(&scene, diag, &m->forces));
  PetscFunctionReturn(0);
}

PetscErrorCode ForcesToTables(const Model *m, Tables *tables)
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);

  PetscFunctionBeginUser;
  PetscCall(NodalForcesToTables(&m->forces, &scene, tables));
  PetscFunctionReturn(0);
}

PetscErrorCode ForcesFromTables(Model *m, const Tables *tables, char reason[256])
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);

  PetscFunctionBeginUser;
  PetscCall(NodalForcesFromTables(&m->forces, &scene, tables, reason));
  PetscFunctionReturn(0);
}

/* Before the first step nodes have accelerations of their own, which no points carry. */
static PetscErrorCode StartAgain(Model *m)
{
  PetscFunctionBeginUser;
  if (m->step > 0 || !m->scheme->inertia) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(m->points->real[POINT_A], m->points->n * m->dim));
  PetscCall(InitialAcceleration(m));
  PetscCall(ContactStand(m));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelPointsChanged(Model *m)
{
  PetscFunctionBeginUser;
  if (m->method->restores_grid) m->space->present = PETSC_FALSE; /* points tell the nodes again */
  PetscCall(ModelInitialise(m));
  PetscCall(StartAgain(m));
  PetscFunctionReturn(0);
}

/* What acts on the nodes has changed: the list is made anew, and what it remembers stays. */
static PetscErrorCode Renew(Model *m)
{
  Tables *kept;
  char reason[256] = "";

  PetscFunctionBeginUser;
  PetscCall(TablesCreate(&kept));
  PetscCall(ForcesToTables(m, kept));
  PetscCall(ForcesCreate(m, NULL));
  PetscCall(ForcesFromTables(m, kept, reason));
  PetscCall(TablesDestroy(&kept));
  PetscCheck(!reason[0], m->comm, PETSC_ERR_PLIB, "%s", reason);
  PetscCall(StartAgain(m));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelSetBodyForce(Model *m, BodyForce force, void *context)
{
  PetscFunctionBeginUser;
  m->body_force = force;
  m->body_force_context = context;
  PetscCall(Renew(m));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelSetLoadFactors(Model *m, PetscInt load, LoadFactors ask, void *context)
{
  PetscFunctionBeginUser;
  m->loads->asked[load] = (LoadAsked){ask, context};
  PetscCall(Renew(m));
  PetscFunctionReturn(0);
}
