/* Updated Lagrangian finite elements: the mesh moves with the material, points are the Gauss points of their cell. */
#include "method/method.h"

static PetscErrorCode FemStart(Stage *s)
{
  PetscFunctionBeginUser;
  PetscCall(StageTouch(s));
  PetscCall(StageNodalMass(s));
  if (s->pressure) PetscCall(StageNodalPressure(s)); /* of the initial state; from then on nodes keep theirs */
  PetscCall(StageBodyVelocity(s));
  if (s->c->analysis.mass == MASS_LUMPED) {
    PetscCall(PetscMalloc1(s->support->n_groups, &s->lumping));
    for (PetscInt g = 0; g < s->support->n_groups; ++g) s->lumping[g] = 1;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FemInitialise(Stage *s)
{
  const BasisInput basis = {.spec = &s->c->basis, .grid = s->grid};

  PetscFunctionBeginUser;
  if (!s->started) PetscCall(PointsSort(s->points));
  PetscCall(s->basis->support(&basis, s->points, s->support)); /* gradients on the moved mesh */
  if (!s->started) PetscCall(FemStart(s));
  s->started = PETSC_TRUE;
  PetscCall(PetscArraycpy(s->v_points, s->v, s->grid->n_nodes * s->grid->dim));
  PetscCall(PetscArraycpy(s->a_points, s->a, s->grid->n_nodes * s->grid->dim));
  PetscFunctionReturn(0);
}

static PetscErrorCode FemConvect(Stage *s, const PetscReal *du)
{
  const PetscInt dim = s->grid->dim, dofs = s->grid->n_nodes * dim;

  PetscFunctionBeginUser;
  PetscCall(StageMoveCarried(s, s->points, du));
  PetscCall(StageMoveCarried(s, s->tracers, du));
  PetscCall(StageMoveCarried(s, s->loads->carriers, du));
  for (PetscInt i = 0; i < dofs; ++i) s->grid->x[i] += du[i];
  PetscCall(PetscArraycpy(s->v, s->v1, dofs));
  PetscCall(PetscArraycpy(s->a, s->a1, dofs));
  PetscFunctionReturn(0);
}

static PetscReal *node_position(Stage *s) { return s->grid->x; }
static PetscReal *node_velocity(Stage *s) { return s->v; }
static PetscReal *node_acceleration(Stage *s) { return s->a; }
static PetscReal *node_pressure(Stage *s) { return s->pressure; }

static const MethodField fields[] = {
  {"position", "m", 0, node_position},
  {"velocity", "m/s", 0, node_velocity},
  {"acceleration", "m/s2", 0, node_acceleration},
  {"pressure", "Pa", 1, node_pressure},
  {NULL, NULL, 0, NULL},
};

const Method method_fem = {
  .name = "fem",
  .help = "updated Lagrangian finite elements: the mesh moves with the body",
  .basis = "cell",
  .points_move = PETSC_FALSE,
  .initialise = FemInitialise,
  .convect = FemConvect,
  .fields = fields,
};
