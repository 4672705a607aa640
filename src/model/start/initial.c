/* The first acceleration, or what holds a given stress before the first step, and gravity from the start on. */
#include "method/transfer/mass.h"
#include "model/model_private.h"

#define BALANCED 1e-12 /* of the forces, what accelerations by the consistent mass may leave */
#define MOST_SWEEPS 500

void gravity_at(const Case *c, PetscReal t, PetscReal g[3])
{
  const PetscReal factor = case_factor(c, &c->gravity_amplitude, t);
  for (PetscInt d = 0; d < 3; ++d) g[d] = factor * c->gravity[d];
}

/* Accelerations by the lumped mass, of a method whose nodes are those of this step alone. Both are components in the
 * frames. */
static void accelerate_lumped(const Model *m, const PetscReal *left)
{
  const NodalFields *n = m->nodes;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    const PetscReal mass = n->mass[i / m->dim];
    n->a[i] = mass > 1e-300 && !m->boundary->fixed[i] ? left[i] / mass : 0;
  }
}

/* The same by the mass matrix that the steps have, `left` then: what is not balanced, as at held dofs. Else nodes that
 * go on would swing against each other, and the first step would lose energy. */
static PetscErrorCode AccelerateByMatrix(const Model *m, PetscReal *left)
{
  const PetscInt dim = m->dim;
  PetscReal enough[MOTIONS];
  MassSolve c;

  PetscFunctionBeginUser;
  PetscCall(MassSolveCreate(m->space, &c));
  c.framed = PETSC_TRUE;
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) {
    const PetscInt at = mass_at(&c, i / dim, ACCELERATION, i % dim);
    c.lack[at] = left[i];
    if (m->boundary->fixed[i]) c.inverse[at] = 0;
  }
  PetscCall(MassLack(&c, enough));
  enough[ACCELERATION] *= PetscSqr(BALANCED);
  PetscCall(MassSolveRun(&c, enough, MOST_SWEEPS));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) {
    const PetscInt at = mass_at(&c, i / dim, ACCELERATION, i % dim);
    m->nodes->a[i] = m->boundary->fixed[i] ? 0 : c.x[at];
    left[i] = c.lack[at];
  }
  PetscCall(MassSolveDestroy(&c));
  PetscFunctionReturn(0);
}

/* What acts on nodes as they begin less what the stress of points needs there, components in the frames: what
 * accelerates them, or what holds them the other way. */
static PetscErrorCode Unbalanced(Model *m)
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal g[3];

  PetscFunctionBeginUser;
  gravity_at(m->c, m->time, g);
  PetscCall(PetscArrayzero(n->du, dofs));
  for (PetscInt i = 0; i < dofs; ++i) n->history[i] = m->c->analysis.damping * n->v[i] - g[i % dim];
  const NodalScene scene = nodal_scene(m, m->time, n->du);
  PetscCall(NodalForcesExternal(&m->forces, &scene, PETSC_TRUE, n->external));
  PetscCall(ContactGoOn(m, n->external));
  PetscCall(ContactBegin(m));
  PetscCall(PetscArrayzero(n->force, dofs));
  pressure_guess(m);
  WeakFormInput in = weak_form_of(m, 0);
  WeakFormOutput out = {.force = n->force};
  PetscCall(m->formulation->assemble(&in, &out));
  PetscCall(GridSumToOwners(m->grid, dim, n->force));
  frames_turn(&m->boundary->frames, dim, n->external);
  frames_turn(&m->boundary->frames, dim, n->force);
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) n->force[i] = n->external[i] - n->force[i];
  PetscFunctionReturn(0);
}

PetscErrorCode InitialReactions(Model *m)
{
  NodalFields *n = m->nodes;

  PetscFunctionBeginUser;
  if (m->c->stage > 0 || !case_has_stress(m->c)) PetscFunctionReturn(0);
  if (m->c->initial.equilibrium > EQUILIBRIUM_NONE) PetscFunctionReturn(0); /* which tells them */
  PetscCall(Unbalanced(m));
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i)
    n->held[i] = n->reaction[i] = m->boundary->fixed[i] ? -n->force[i] : 0;
  frames_turn(&m->boundary->frames, m->dim, n->held);
  frames_turn(&m->boundary->frames, m->dim, n->reaction);
  PetscFunctionReturn(0);
}

PetscErrorCode InitialAcceleration(Model *m)
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  Discretisation *s = m->space;

  PetscFunctionBeginUser;
  PetscCall(Unbalanced(m));
  if (m->method->restores_grid || m->method->clouds) accelerate_lumped(m, n->force);
  else PetscCall(AccelerateByMatrix(m, n->force));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i)
    n->held[i] = n->rate[i] = m->boundary->fixed[i] ? -n->force[i] : 0;
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
