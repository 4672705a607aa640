/* The first acceleration, and gravity from the start on. */
#include "model/model_private.h"

void gravity_at(const Case *c, PetscReal t, PetscReal g[3])
{
  const PetscReal factor = case_factor(c, &c->gravity_amplitude, t);
  for (PetscInt d = 0; d < 3; ++d) g[d] = factor * c->gravity[d];
}

PetscErrorCode InitialAcceleration(Model *m)
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  Discretisation *s = m->space;
  PetscReal g[3];

  PetscFunctionBeginUser;
  gravity_at(m->c, m->time, g);
  PetscCall(PetscArrayzero(n->du, dofs));
  for (PetscInt i = 0; i < dofs; ++i) n->history[i] = m->c->analysis.damping * n->v[i] - g[i % dim];
  const NodalScene scene = nodal_scene(m, m->time, n->du);
  PetscCall(NodalForcesExternal(&m->forces, &scene, PETSC_TRUE, n->external));
  PetscCall(ContactGoOn(m, n->external));
  PetscCall(PetscArrayzero(n->force, dofs));
  pressure_guess(m);
  WeakFormInput in = weak_form_of(m, 0);
  WeakFormOutput out = {.force = n->force};
  PetscCall(m->formulation->assemble(&in, &out));
  PetscCall(GridSumToOwners(m->grid, dim, n->force));
  frames_turn(&m->boundary->frames, dim, n->external);
  frames_turn(&m->boundary->frames, dim, n->force);
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) {
    const PetscReal mass = n->mass[i / dim];
    const PetscReal free = n->external[i] - n->force[i];
    n->a[i] = mass > 1e-300 && !m->boundary->fixed[i] ? free / mass : 0;
    n->held[i] = n->rate[i] = m->boundary->fixed[i] ? -free : 0;
  }
  frames_turn(&m->boundary->frames, dim, n->a);
  frames_turn(&m->boundary->frames, dim, n->held);
  frames_turn(&m->boundary->frames, dim, n->rate);
  PetscCall(GridToGhosts(m->grid, dim, n->a));
  PetscCall(PetscArraycpy(n->a_points, n->a, dofs));
  for (PetscInt q = 0; q < s->support->n_groups; ++q) {
    const PetscInt nn = support_nodes(s->support, q), *node = s->support->node + s->support->node_start[q];
    for (PetscInt p = s->support->point_start[q]; p < s->support->point_start[q + 1]; ++p)
      for (PetscInt i = 0; i < nn * dim; ++i)
        point_real(m->points, POINT_A, p)[i % dim] +=
          support_N(s->support, q, p)[i / dim] * n->a[node[i / dim] * dim + i % dim];
  }
  PetscFunctionReturn(0);
}
