/* Updated Lagrangian finite elements: the mesh moves with the material, points are the Gauss points
 * of their cell. */
#include "method/method.h"
#include "method/transfer/transfer.h"
#include "solve/forces/weight.h"

static PetscErrorCode FemStart(Discretisation *s)
{
  PetscFunctionBeginUser;
  PetscCall(DiscretisationTouch(s));
  PetscCall(DiscretisationMass(s));
  if (s->nodes->pressure)
    PetscCall(DiscretisationPressure(s)); /* of the initial state; from then on nodes keep theirs */
  PetscCall(DiscretisationBodyVelocity(s));
  if (s->c->analysis.mass == MASS_LUMPED) {
    PetscCall(PetscMalloc1(s->support->n_groups, &s->lumping));
    for (PetscInt g = 0; g < s->support->n_groups; ++g) s->lumping[g] = 1;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FemInitialise(Discretisation *s)
{
  const BasisInput basis = {.spec = &s->c->basis, .grid = s->grid};
  NodalFields *n = s->nodes;

  PetscFunctionBeginUser;
  if (!s->started) PetscCall(PointsSort(s->points));
  PetscCall(s->basis->support(&basis, s->points, s->support)); /* gradients on the moved mesh */
  if (!s->started) PetscCall(FemStart(s));
  else if (weight_changes(s->c)) PetscCall(DiscretisationMass(s));
  s->started = PETSC_TRUE;
  PetscCall(PetscArraycpy(n->v_points, n->v, s->grid->n_nodes * s->grid->dim));
  PetscCall(PetscArraycpy(n->a_points, n->a, s->grid->n_nodes * s->grid->dim));
  PetscFunctionReturn(0);
}

static PetscErrorCode FemConvect(Discretisation *s)
{
  NodalFields *n = s->nodes;
  const PetscInt dim = s->grid->dim, dofs = s->grid->n_nodes * dim;

  PetscFunctionBeginUser;
  PetscCall(DiscretisationMoveCarried(s, s->points));
  PetscCall(DiscretisationMoveCarried(s, s->tracers));
  PetscCall(DiscretisationMoveCarried(s, s->loads->carriers));
  for (PetscInt i = 0; i < dofs; ++i) s->grid->x[i] += n->du[i];
  PetscCall(PetscArraycpy(n->v, n->v1, dofs));
  PetscCall(PetscArraycpy(n->a, n->a1, dofs));
  PetscFunctionReturn(0);
}

/* Free nodes feel no impulse when what is prescribed jumps. */
static PetscErrorCode FemHold(Discretisation *s)
{
  PetscFunctionBeginUser;
  PetscCall(transfer_find("consistent")->hold(s));
  PetscFunctionReturn(0);
}

const Method method_fem = {
  .name = "fem",
  .help = "updated Lagrangian finite elements: the grid moves with the material",
  .bases = {"cell"},
  .takes_pressure = PETSC_TRUE,
  .initialise = FemInitialise,
  .hold = FemHold,
  .convect = FemConvect,
  .carries = cell_carries,
};
