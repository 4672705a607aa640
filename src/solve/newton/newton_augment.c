/* What new multipliers change where nothing has moved: forces and tangent of what has them, and nothing of the
 * material points, which take most of the time of an assembly. */
#include "solve/newton/newton_private.h"
#include <petsctime.h>

/* The tangent must be that of this du, and as it was put in: turned into frames on no rank. */
PetscErrorCode NewtonAugment(Newton *n, PetscBool *again)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim, owned = p->grid->n_owned * dim;
  PetscBool stays = n->tangent && p->scene.contact && !p->system->n_turned && n->report->status == LAW_OK;
  double start, end;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &stays, 1, MPIU_BOOL, MPI_LAND, n->comm));
  if (!stays) {
    PetscCall(NodalForcesAugment(p->forces, &p->scene, n->changes, again));
    if (*again) PetscCall(NewtonAssemble(n, PETSC_TRUE));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscTime(&start));
  PetscCall(PetscArrayzero(p->force + owned, p->grid->n_nodes * dim - owned)); /* owners have had them */
  NodalOutput out = {.force = p->force, .system = p->system, .away = PETSC_TRUE};
  PetscCall(NodalForcesAssembleAugmented(p->forces, &p->scene, &out));
  PetscCall(NodalForcesAugment(p->forces, &p->scene, n->changes, again));
  out.away = PETSC_FALSE;
  PetscCall(NodalForcesAssembleAugmented(p->forces, &p->scene, &out));
  PetscCall(GridSumToOwners(p->grid, dim, p->force));
  PetscCall(NewtonWeigh(n));
  PetscCall(PetscTime(&end));
  n->t_points += end - start;
  PetscFunctionReturn(0);
}
