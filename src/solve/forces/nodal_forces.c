/* The list of the nodal forces that a case asks for, and one call for all of them. */
#include "solve/forces/nodal_force.h"

PetscErrorCode NodalForcesCreate(const NodalScene *scene, Diag *diag, NodalForces *forces)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  while (nodal_forces[n]) ++n;
  forces->n = 0;
  PetscCall(PetscCalloc1(n, &forces->one));
  for (PetscInt k = 0; k < n; ++k) {
    void *data = NULL;
    PetscCall(nodal_forces[k]->create(scene, diag, &data));
    if (!data) continue;
    forces->one[forces->n].kind = nodal_forces[k];
    forces->one[forces->n++].data = data;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode NodalForcesDestroy(NodalForces *forces)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->destroy) PetscCall(forces->one[k].kind->destroy(&forces->one[k].data));
  PetscCall(PetscFree(forces->one));
  forces->n = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode NodalForcesCouple(const NodalForces *forces, const NodalScene *scene, NodeGroups *groups)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->couple) PetscCall(forces->one[k].kind->couple(forces->one[k].data, scene, groups));
  PetscFunctionReturn(0);
}

void nodal_forces_hold(const NodalForces *forces, const NodalScene *scene, unsigned char *held)
{
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->hold) forces->one[k].kind->hold(forces->one[k].data, scene, held);
}

PetscBool nodal_forces_find_slots(const NodalForces *forces, const System *system)
{
  PetscBool complete = PETSC_TRUE;
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->find_slots) complete &= forces->one[k].kind->find_slots(forces->one[k].data, system);
  return complete;
}

const Constraints *nodal_forces_constraints(const NodalForces *forces)
{
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->constraints) return forces->one[k].kind->constraints(forces->one[k].data);
  return NULL;
}

PetscBool nodal_forces_are_local(const NodalForces *forces)
{
  for (PetscInt k = 0; k < forces->n; ++k)
    if (!forces->one[k].kind->dead && !forces->one[k].kind->mark) return PETSC_FALSE;
  return PETSC_TRUE;
}

void nodal_forces_mark(const NodalForces *forces, unsigned char *node)
{
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->mark) forces->one[k].kind->mark(forces->one[k].data, node);
}

PetscErrorCode NodalForcesAssemble(const NodalForces *forces, const NodalScene *scene, const NodalOutput *out)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < forces->n; ++k)
    if (!forces->one[k].kind->dead) PetscCall(forces->one[k].kind->assemble(forces->one[k].data, scene, out));
  PetscFunctionReturn(0);
}

PetscErrorCode NodalForcesExternal(const NodalForces *forces, const NodalScene *scene, PetscBool all,
                                   PetscReal *external)
{
  const PetscInt dofs = scene->grid->n_nodes * scene->grid->dim, owned = scene->grid->n_owned * scene->grid->dim;
  const NodalOutput out = {.force = external};
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(external, dofs));
  for (PetscInt k = 0; k < forces->n; ++k) {
    const NodalForce *kind = forces->one[k].kind;
    if (!kind->dead && (!all || kind->constraints || kind->apart)) continue;
    PetscCall(kind->assemble(forces->one[k].data, scene, &out));
    any = PETSC_TRUE;
  }
  if (!any) PetscFunctionReturn(0);
  PetscCall(GridSumToOwners(scene->grid, scene->grid->dim, external));
  for (PetscInt i = 0; i < dofs; ++i) external[i] = i < owned ? -external[i] : 0;
  PetscFunctionReturn(0);
}

PetscErrorCode NodalForcesBegin(const NodalForces *forces, const NodalScene *scene)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->begin) PetscCall(forces->one[k].kind->begin(forces->one[k].data, scene));
  PetscFunctionReturn(0);
}

PetscErrorCode NodalForcesAssembleAugmented(const NodalForces *forces, const NodalScene *scene, const NodalOutput *out)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->augment) PetscCall(forces->one[k].kind->assemble(forces->one[k].data, scene, out));
  PetscFunctionReturn(0);
}

PetscErrorCode NodalForcesAugment(const NodalForces *forces, const NodalScene *scene, PetscInt change, PetscBool *again)
{
  PetscFunctionBeginUser;
  *again = PETSC_FALSE;
  for (PetscInt k = 0; k < forces->n; ++k) {
    PetscBool wants = PETSC_FALSE;
    if (!forces->one[k].kind->augment) continue;
    PetscCall(forces->one[k].kind->augment(forces->one[k].data, scene, change, &wants));
    *again = *again || wants;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode NodalForcesCommit(const NodalForces *forces, const NodalScene *scene)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->commit) PetscCall(forces->one[k].kind->commit(forces->one[k].data, scene));
  PetscFunctionReturn(0);
}

PetscErrorCode NodalForcesToTables(const NodalForces *forces, const NodalScene *scene, Tables *tables)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind->to_tables) PetscCall(forces->one[k].kind->to_tables(forces->one[k].data, scene, tables));
  PetscFunctionReturn(0);
}

PetscErrorCode NodalForcesFromTables(const NodalForces *forces, const NodalScene *scene, const Tables *tables,
                                     char reason[256])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < forces->n && !reason[0]; ++k)
    if (forces->one[k].kind->from_tables)
      PetscCall(forces->one[k].kind->from_tables(forces->one[k].data, scene, tables, reason));
  PetscFunctionReturn(0);
}
