#include "solve/system/rigid_motions.h"

/* Into the frames of the nodes: they stay orthonormal. */
static PetscErrorCode TurnMotions(const System *s, MatNullSpace rigid)
{
  const Vec *motion;
  PetscInt n;
  PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(MatNullSpaceGetVecs(rigid, NULL, &n, &motion));
  for (PetscInt k = 0; s->frames && k < n; ++k) {
    PetscCall(VecGetArray(motion[k], &v));
    for (PetscInt f = 0; f < s->frames->n; ++f) {
      const PetscInt row = s->row[s->frames->node[f]];
      if (row >= 0 && row < s->n_active) frame_turn(s->dim, s->frames->w + 3 * f, v + row * s->dim);
    }
    PetscCall(VecRestoreArray(motion[k], &v));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode RigidMotions(const System *s, const Grid *grid, MatNullSpace *rigid)
{
  Vec places;
  PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(VecCreateMPI(s->comm, s->n_active * s->dim, PETSC_DETERMINE, &places));
  PetscCall(VecSetBlockSize(places, s->dim));
  PetscCall(VecGetArrayWrite(places, &v));
  for (PetscInt k = 0; k < s->n_active; ++k)
    for (PetscInt d = 0; d < s->dim; ++d) v[k * s->dim + d] = grid->x[s->active[k] * s->dim + d];
  PetscCall(VecRestoreArrayWrite(places, &v));
  PetscCall(MatNullSpaceCreateRigidBody(places, rigid));
  PetscCall(VecDestroy(&places));
  PetscCall(TurnMotions(s, *rigid));
  PetscFunctionReturn(0);
}
