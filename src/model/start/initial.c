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

/* Accelerations by the lumped mass, of a method whose nodes are those of this step alone; those of held dofs are given,
 * and `left` is then what is not balanced there. Both are components in the frames. */
static void accelerate_lumped(const Model *m, PetscReal *left, PetscReal *a)
{
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    const PetscReal mass = m->nodes->mass[i / m->dim];
    if (m->boundary->fixed[i]) left[i] -= mass * a[i];
    else a[i] = mass > 1e-300 ? left[i] / mass : 0;
  }
}

/* x = accelerations that are given, 0 at the other dofs. */
static PetscErrorCode TakeGiven(const Model *m, const PetscReal *a, MassSolve *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i)
    c->x[mass_at(c, i / m->dim, ACCELERATION, i % m->dim)] = m->boundary->fixed[i] ? a[i] : 0;
  PetscCall(MassSubtract(c));
  PetscFunctionReturn(0);
}

/* The same by the mass matrix that the steps have. Else nodes that go on would swing against each other, and the first
 * step would lose energy. */
static PetscErrorCode AccelerateByMatrix(const Model *m, PetscReal *left, PetscReal *a)
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
  PetscCall(TakeGiven(m, a, &c));
  PetscCall(MassLack(&c, enough));
  enough[ACCELERATION] *= PetscSqr(BALANCED);
  PetscCall(MassSolveRun(&c, enough, MOST_SWEEPS));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) {
    const PetscInt at = mass_at(&c, i / dim, ACCELERATION, i % dim);
    if (!m->boundary->fixed[i]) a[i] = c.x[at];
    left[i] = c.lack[at];
  }
  PetscCall(MassSolveDestroy(&c));
  PetscFunctionReturn(0);
}

/* What acts on nodes as they begin less what the stress of points needs there, components in the frames: what
 * accelerates them, or what holds them the other way. goes_on: after a step, and not before the first one. */
static PetscErrorCode Unbalanced(Model *m, PetscBool goes_on)
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal g[3];

  PetscFunctionBeginUser;
  gravity_at(m->c, m->time, g);
  PetscCall(PetscArrayzero(n->du, dofs));
  for (PetscInt i = 0; i < dofs; ++i) n->history[i] = m->c->analysis.damping * n->v[i] - g[i % dim];
  const NodalScene scene = nodal_scene(m, m->time, n->du);
  if (goes_on) PetscCall(NodalForcesBegin(&m->forces, &scene)); /* what carries them has moved since */
  PetscCall(NodalForcesExternal(&m->forces, &scene, PETSC_TRUE, n->external));
  PetscCall((goes_on ? ContactRemembered : ContactGoOn)(m, n->external));
  if (!goes_on) PetscCall(ContactBegin(m, PETSC_FALSE));
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

/* Does the run begin with the stress that it is given, for which nobody seeks an equilibrium? */
static PetscBool begins_as_given(const Case *c)
{
  return (PetscBool)(!case_goes_on(c) && case_has_stress(c) && !case_equilibrates(c));
}

/* What the given stress lacks of balance then. Constraints of a cloud bear what would count so. */
static PetscErrorCode TellLack(Model *m)
{
  const Case *c = m->c;
  PetscInt constrained = 0;
  PetscReal *acting;
  StepProblem p;

  PetscFunctionBeginUser;
  if (!begins_as_given(c)) PetscFunctionReturn(0);
  PetscCall(MPIU_Allreduce(&m->space->constraints->n, &constrained, 1, MPIU_INT, MPI_SUM, m->comm));
  if (constrained) PetscFunctionReturn(0);
  gravity_at(c, m->time, m->gravity);
  mark_fixed(m);
  PetscCall(ForceScales(m, m->gravity, 1, &p));
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  PetscCall(PetscMalloc1(m->grid->n_nodes * m->dim, &acting));
  PetscCall(NodalForcesExternal(&m->forces, &scene, PETSC_TRUE, acting));
  frames_turn(&m->boundary->frames, m->dim, acting);
  const AtRest at = {m->nodes->fixed, m->nodes->force, m->nodes->external, acting, p.weight};
  PetscCall(LackOfBalance(m, &at, &m->initial.lacked));
  PetscCall(PetscFree(acting));
  PetscFunctionReturn(0);
}

/* a, in: of held dofs; all of it then, and in n->force what these lack. In the frames. first: before the first step. */
static PetscErrorCode Accelerate(Model *m, PetscBool first, PetscReal *a)
{
  PetscFunctionBeginUser;
  if (m->method->restores_grid || (m->method->clouds && first)) accelerate_lumped(m, m->nodes->force, a);
  else PetscCall(AccelerateByMatrix(m, m->nodes->force, a));
  PetscFunctionReturn(0);
}

/* What boundaries, walls and interfaces bear before the first step, where no equilibrium tells it. */
static void tell_forces(Model *m)
{
  if (!begins_as_given(m->c)) return;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) m->nodes->reaction[i] = m->nodes->held[i];
  for (PetscInt k = 0; m->contact && k < m->contact->n_partners; ++k)
    m->contact->wall[k].mean = m->contact->wall[k].rate;
}

PetscErrorCode InitialReactions(Model *m)
{
  NodalFields *n = m->nodes;

  PetscFunctionBeginUser;
  if (!begins_as_given(m->c)) PetscFunctionReturn(0);
  PetscCall(Unbalanced(m, PETSC_FALSE));
  PetscCall(TellLack(m));
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) n->held[i] = m->boundary->fixed[i] ? -n->force[i] : 0;
  frames_turn(&m->boundary->frames, m->dim, n->held);
  tell_forces(m);
  PetscFunctionReturn(0);
}

void accelerate_points(const Model *m, const PetscBool *bodies, const PetscReal *a)
{
  const Support *w = m->space->support;
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      if (bodies && !bodies[m->points->body[p]]) continue;
      for (PetscInt i = 0; i < nn * m->dim; ++i)
        point_real(m->points, POINT_A, p)[i % m->dim] +=
          support_N(w, g, p)[i / m->dim] * a[node[i / m->dim] * m->dim + i % m->dim];
    }
  }
}

PetscErrorCode InitialAcceleration(Model *m)
{
  NodalFields *n = m->nodes;
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(Unbalanced(m, PETSC_FALSE));
  PetscCall(TellLack(m));
  PetscCall(PetscMalloc1(dofs, &v));
  PetscCall(PrescribedStart(m, m->control.next, v, n->a));
  PetscCall(PetscFree(v));
  PetscCall(Accelerate(m, PETSC_TRUE, n->a));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i)
    n->held[i] = n->rate[i] = m->boundary->fixed[i] ? -n->force[i] : 0;
  frames_turn(&m->boundary->frames, dim, n->a);
  frames_turn(&m->boundary->frames, dim, n->held);
  frames_turn(&m->boundary->frames, dim, n->rate);
  tell_forces(m);
  PetscCall(GridToGhosts(m->grid, dim, n->a));
  PetscCall(PetscArraycpy(n->a_points, n->a, dofs));
  accelerate_points(m, NULL, n->a);
  PetscFunctionReturn(0);
}

static PetscErrorCode SizeOfForces(const Model *m, PetscReal *size)
{
  const NodalFields *n = m->nodes;
  PetscReal local = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) local += PetscSqr(n->external[i]) + PetscSqr(n->force[i]);
  PetscCall(MPIU_Allreduce(&local, size, 1, MPIU_REAL, MPI_SUM, m->comm));
  *size = PetscSqrtReal(*size);
  PetscFunctionReturn(0);
}

PetscErrorCode BalancedAcceleration(Model *m, PetscReal *a, PetscReal *lacks, PetscReal *size)
{
  const Frames *frames = &m->boundary->frames;
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(a, m->nodes->a, dofs));
  frames_turn(frames, m->dim, a);
  PetscCall(Unbalanced(m, PETSC_TRUE));
  PetscCall(SizeOfForces(m, size));
  PetscCall(Accelerate(m, PETSC_FALSE, a));
  for (PetscInt i = 0; i < dofs; ++i)
    lacks[i] = i < m->grid->n_owned * m->dim && m->boundary->fixed[i] ? m->nodes->force[i] : 0;
  frames_turn(frames, m->dim, a);
  frames_turn(frames, m->dim, lacks);
  PetscCall(GridToGhosts(m->grid, m->dim, a));
  PetscFunctionReturn(0);
}
