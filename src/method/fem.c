/* Updated Lagrangian finite elements: the mesh moves with the material, points are the Gauss points of their cell. */
#include "method/method.h"

/* Nodes keep their history; at the start they take the velocity of their body where they stand (a projection from points would flatten
 * a rotation at the boundary). A node of several bodies takes the mean by mass. */
static PetscErrorCode FemStart(Stage *s)
{
  const PetscInt dim = s->grid->dim;
  PetscReal *q, v[3];

  PetscFunctionBeginUser;
  PetscCall(PointsSort(s->points));
  PetscCall(SupportFromCells(s->support, s->points, s->grid));
  PetscCall(StageTouch(s));
  PetscCall(StageNodalMass(s));
  if (s->pressure) PetscCall(StageNodalPressure(s)); /* of the initial state; from then on nodes keep theirs */
  PetscCall(PetscCalloc1(s->grid->n_nodes * dim, &q));
  for (PetscInt g = 0, nn = s->support->uniform; g < s->support->n_groups; ++g)
    for (PetscInt p = s->support->point_start[g]; p < s->support->point_start[g + 1]; ++p)
      for (PetscInt I = 0; I < nn; ++I) {
        const PetscInt node = s->support->node[g * nn + I];
        body_velocity(&s->c->bodies[s->points->body[p]], dim, s->grid->x + node * dim, v);
        for (PetscInt d = 0; d < dim; ++d)
          q[node * dim + d] += s->support->N[p * nn + I] * s->points->real[POINT_MASS][p] * v[d];
      }
  PetscCall(GridSumToOwners(s->grid, dim, q));
  PetscCall(GridToGhosts(s->grid, dim, q));
  for (PetscInt i = 0; i < s->grid->n_nodes * dim; ++i) s->v[i] = s->mass[i / dim] > 0 ? q[i] / s->mass[i / dim] : 0;
  PetscCall(PetscFree(q));
  PetscFunctionReturn(0);
}

static PetscErrorCode FemInitialise(Stage *s)
{
  PetscFunctionBeginUser;
  if (!s->started) PetscCall(FemStart(s));
  else PetscCall(SupportFromCells(s->support, s->points, s->grid)); /* gradients on the moved mesh */
  s->started = PETSC_TRUE;
  PetscCall(PetscArraycpy(s->v_points, s->v, s->grid->n_nodes * s->grid->dim));
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
  .points_move = PETSC_FALSE,
  .initialise = FemInitialise,
  .convect = FemConvect,
  .fields = fields,
};
