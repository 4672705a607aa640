/* What a step starts out of balance: work of the forces of its start that no longer balance there what nodes remember
 * as acceleration, by the trapezoidal rule (docs/theory.md, "Energy"). Nodes of a grid that is restored know of no
 * step before: there it is what all other works leave over (energy.c). */
#include "model/measure/energy/mass_product.h"
#include "model/model_private.h"

static PetscBool is_twin(const Model *m, PetscInt node) { return m->method->clouds && cloud_is_twin(m->grid, node); }

/* At nodes, with the motion and the stress that the step starts with. `external`: of nodes at the step's start, whose
 * pressures they still have beside those of its end. */
static PetscErrorCode Balanced(const Model *m, const PetscReal *g, const PetscReal *external, PetscReal *work)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  const PetscReal damping = m->c->analysis.damping;
  const NodalFields *n = m->nodes;
  WeakFormInput in = weak_form_of(m, 0);
  PetscReal *zero, *force, *history, *pressure;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(dofs, &zero, dofs, &force, dofs, &history, m->grid->n_nodes, &pressure));
  for (PetscInt node = 0; n->pressure && node < m->grid->n_nodes; ++node)
    pressure[node] = n->pressure[node] / m->pressure_scale;
  in.pressure = n->pressure ? pressure : NULL;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i)
    if (n->touched[i / m->dim] && !is_twin(m, i / m->dim))
      history[i] = (m->scheme->inertia ? n->a[i] - n->echo[i] + damping * n->v[i] : 0) - g[i % m->dim];
  PetscCall(GridToGhosts(m->grid, m->dim, history));
  in.du = zero;
  in.history = history;
  WeakFormOutput out = {.force = force};
  PetscCall(m->formulation->assemble(&in, &out));
  PetscCall(GridSumToOwners(m->grid, m->dim, force));
  *work = 0;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    if (!is_twin(m, i / m->dim)) *work += 0.5 * m->nodes->du[i] * (force[i] - (external ? external[i] : 0));
    if (m->boundary->fixed[i]) *work -= 0.5 * m->nodes->prescribed[i] * m->nodes->held[i];
  }
  PetscCall(PetscFree4(zero, force, history, pressure));
  PetscFunctionReturn(0);
}

/* With the stress of the points as it is: materials are as strong as they were at the start, and no time passes, in
 * which what flows at a rate would go on. */
static PetscErrorCode BalancedAtStart(Model *m, PetscReal dt, const PetscReal *g, const PetscReal *external,
                                      PetscReal *work)
{
  PetscFunctionBeginUser;
  PetscCall(MaterialsAt(m, m->time));
  materials_step(m->c->n_materials, m->materials, case_time(m->c, m->time), 0, m->scheme->inertia);
  PetscCall(Balanced(m, g, external, work));
  PetscCall(MaterialsAt(m, m->time + dt));
  materials_step(m->c->n_materials, m->materials, case_time(m->c, m->time), dt * time_solved(m->scheme),
                 m->scheme->inertia);
  PetscFunctionReturn(0);
}

/* Of nodes that go on as the last step has left them all that can be out of balance is what prescribed motion has set
 * anew, and what went along (prepare.c). */
static PetscReal set_anew(const Model *m)
{
  const NodalFields *n = m->nodes;
  const NodalField du = {{n->du, n->du}, {1, 0}};
  const NodalField dv = {{n->v, n->v_points}, {1, -1}}, da = {{n->a, n->a_points}, {1, -1}};
  PetscBool any = PETSC_FALSE;
  if (!m->scheme->inertia) return 0;
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim && !any; ++i)
    any = (PetscBool)(n->v[i] != n->v_points[i] || n->a[i] != n->a_points[i]);
  return any ? 0.5 * (mass_product(m, du, da) + model_damping(m) * mass_product(m, du, dv)) : 0;
}

/* Clouds are new in every step, walls have another force than the last step's, and a stage may bring other loads,
 * strengths and boundaries than those whose forces nodes remember. */
static PetscBool may_differ(const Model *m)
{
  if (m->method->begin || m->contact) return PETSC_TRUE;
  return (PetscBool)(m->scheme->inertia && m->time == m->c->start);
}

PetscErrorCode UnbalancedWork(Model *m, PetscReal dt, const PetscReal *g, const PetscReal *external, PetscReal *work)
{
  PetscFunctionBeginUser;
  *work = 0;
  if (m->method->restores_grid) PetscFunctionReturn(0);
  if (may_differ(m)) PetscCall(BalancedAtStart(m, dt, g, external, work));
  else *work = set_anew(m);
  PetscFunctionReturn(0);
}
