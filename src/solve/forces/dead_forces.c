/* Nodal forces that do not depend on the step's motion: the loads of the case, and a body force
 * that a caller gives. */
#include "solve/forces/nodal_force.h"

static PetscErrorCode CreateLoads(const NodalScene *scene, Diag *diag, void **data)
{
  (void)diag;
  PetscFunctionBeginUser;
  if (scene->c->n_loads) *data = (void *)scene->loads;
  PetscFunctionReturn(0);
}

static PetscErrorCode AssembleLoads(void *data, const NodalScene *scene, const NodalOutput *out)
{
  PetscFunctionBeginUser;
  loads_push(data, scene->grid, scene->t, scene->filled, scene->touched, out->force);
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_loads = {
  .name = "loads",
  .help = "tractions and point forces",
  .dead = PETSC_TRUE,
  .create = CreateLoads,
  .assemble = AssembleLoads,
};

static PetscErrorCode CreateBody(const NodalScene *scene, Diag *diag, void **data)
{
  (void)diag;
  PetscFunctionBeginUser;
  if (scene->body_force) *data = (void *)scene->points;
  PetscFunctionReturn(0);
}

/* Of the places where the points were at the start. */
static PetscErrorCode AssembleBody(void *data, const NodalScene *scene, const NodalOutput *out)
{
  const PetscInt dim = scene->grid->dim;
  const Points *points = data;
  const Support *w = scene->support;
  PetscReal X[3], b[3];

  PetscFunctionBeginUser;
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      for (PetscInt d = 0; d < dim; ++d) X[d] = point_real(points, POINT_X, p)[d] - point_real(points, POINT_U, p)[d];
      scene->body_force(scene->body_force_context, X, scene->t, b);
      for (PetscInt i = 0; i < nn * dim; ++i)
        out->force[node[i / dim] * dim + i % dim] -=
          support_N(w, g, p)[i / dim] * points->real[POINT_MASS][p] * b[i % dim];
    }
  }
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_body = {
  .name = "body",
  .help = "a force per mass that the caller of the library gives",
  .dead = PETSC_TRUE,
  .create = CreateBody,
  .assemble = AssembleBody,
};
