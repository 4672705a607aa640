/* Weight that comes or goes within a step, where densities change with time: masses are those of its start. */
#include "solve/forces/weight.h"
#include <string.h>
#include "solve/forces/nodal_force.h"

PetscBool weight_changes(const Case *c)
{
  for (PetscInt i = 0; i < c->n_materials; ++i)
    for (PetscInt k = 0; k < c->materials[i].n_amplitudes; ++k)
      if (!strcmp(c->materials[i].amplitudes[k].name, "density")) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode Create(const NodalScene *scene, Diag *diag, void **data)
{
  (void)diag;
  PetscFunctionBeginUser;
  if (weight_changes(scene->c)) *data = (void *)scene->points;
  PetscFunctionReturn(0);
}

static PetscErrorCode Assemble(void *data, const NodalScene *scene, const NodalOutput *out)
{
  const Case *c = scene->c;
  const PetscInt dim = scene->grid->dim;
  const Points *points = data;
  const Support *w = scene->support;
  const PetscReal gravity = case_factor(c, &c->gravity_amplitude, scene->t);
  PetscReal *more;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(c->n_materials, &more));
  for (PetscInt i = 0; i < c->n_materials; ++i) {
    const PetscReal density = c->materials[i].density * case_material_factor(c, i, "density", scene->t);
    more[i] = gravity * (density / scene->materials[i].density - 1);
  }
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal mass = points->real[POINT_MASS][p] * more[points->material[p]];
      for (PetscInt i = 0; i < nn * dim && mass != 0; ++i)
        out->force[node[i / dim] * dim + i % dim] -= support_N(w, g, p)[i / dim] * mass * c->gravity[i % dim];
    }
  }
  PetscCall(PetscFree(more));
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_weight = {
  .name = "weight",
  .help = "of densities that change with time",
  .dead = PETSC_TRUE,
  .create = Create,
  .assemble = Assemble,
};
