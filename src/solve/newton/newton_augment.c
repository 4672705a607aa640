/* What new multipliers change where nothing has moved: forces and tangent of what has them, and nothing of the
 * material points, which take most of the time of an assembly. */
#include "solve/newton/newton_private.h"
#include <petsctime.h>

/* force += what has multipliers, as it is now, and the tangent likewise; away: -=. */
static PetscErrorCode Gather(const StepProblem *p, PetscBool away, PetscReal *force)
{
  const NodalOutput out = {.force = force, .system = p->system, .away = away};

  PetscFunctionBeginUser;
  PetscCall(NodalForcesAssembleAugmented(p->forces, &p->scene, &out));
  PetscFunctionReturn(0);
}

/* The tangent must be that of this du, and as it was put in: not turned into frames. */
PetscErrorCode NewtonAugment(Newton *n, PetscBool *again)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  const PetscBool stays = n->tangent && p->scene.contact && !p->system->n_turned && n->report->status == LAW_OK;
  PetscReal *change;
  double start, end;

  PetscFunctionBeginUser;
  if (!stays) {
    PetscCall(NodalForcesAugment(p->forces, &p->scene, n->changes, again));
    if (*again) PetscCall(NewtonAssemble(n, PETSC_TRUE));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscTime(&start));
  PetscCall(PetscCalloc1(p->grid->n_nodes * dim, &change));
  PetscCall(Gather(p, PETSC_TRUE, change));
  PetscCall(NodalForcesAugment(p->forces, &p->scene, n->changes, again));
  PetscCall(Gather(p, PETSC_FALSE, change));
  PetscCall(GridSumToOwners(p->grid, dim, change));
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt i = p->system->active[k] * dim; i < (p->system->active[k] + 1) * dim; ++i) p->force[i] += change[i];
  PetscCall(PetscFree(change));
  PetscCall(NewtonWeigh(n));
  PetscCall(PetscTime(&end));
  n->t_points += end - start;
  PetscFunctionReturn(0);
}
