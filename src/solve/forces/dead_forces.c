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
  PetscCall(LoadsPush(data, scene->grid, scene->t, scene->filled, scene->touched, out->force));
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

/* All points are asked for at once: a caller in another language pays for each call. */
PetscErrorCode BodyForceAsk(const NodalScene *scene, PetscReal *b)
{
  const PetscInt dim = scene->grid->dim;
  const Points *points = scene->points;
  const size_t n = 3 * (size_t)points->n;
  PetscReal *X, *x;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &X, n, &x));
  for (PetscInt i = 0; i < points->n * dim; ++i) {
    const PetscInt k = 3 * (i / dim) + i % dim;
    x[k] = points->real[POINT_X][i];
    X[k] = x[k] - points->real[POINT_U][i];
  }
  scene->body_force(scene->body_force_context, points->n, X, x, case_time(scene->c, scene->t), b);
  PetscCall(PetscFree2(X, x));
  PetscFunctionReturn(0);
}

static PetscErrorCode AssembleBody(void *data, const NodalScene *scene, const NodalOutput *out)
{
  const PetscInt dim = scene->grid->dim;
  const Points *points = data;
  const Support *w = scene->support;
  PetscReal *b;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(3 * (size_t)points->n, &b));
  PetscCall(BodyForceAsk(scene, b));
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt i = 0; i < nn * dim; ++i)
        out->force[node[i / dim] * dim + i % dim] -=
          support_N(w, g, p)[i / dim] * points->real[POINT_MASS][p] * b[3 * p + i % dim];
  }
  PetscCall(PetscFree(b));
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_body = {
  .name = "body",
  .help = "a force per mass that the caller of the library gives",
  .dead = PETSC_TRUE,
  .create = CreateBody,
  .assemble = AssembleBody,
};
