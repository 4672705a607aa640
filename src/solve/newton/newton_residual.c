/* What SNES asks for: the residual and the tangent of the increments that its unknowns stand
 * for. */
#include "solve/contact/contact.h"
#include "solve/newton/newton_private.h"
#include <petsctime.h>

/* On dof i. */
static PetscReal external_force(const StepProblem *p, PetscInt i)
{
  const LoadBorder *b = p->border;
  return p->external[i] + (b && !b->follows ? (b->factor - b->start) * b->load[i] : 0);
}

/* On dof i, of a load that follows the surface: it is assembled with what else acts, and yet one of the loads that a
 * residual is measured by, on the surface of the step's start. */
static PetscReal following_force(const StepProblem *p, PetscInt i)
{
  const LoadBorder *b = p->border;
  return b && b->follows ? b->factor * b->load[i] : 0;
}

/* Internal and inertia forces -> residual. Nodes without unknowns have no forces: they are often most of a grid, and
 * are left alone. */
static void balance(const StepProblem *p)
{
  const PetscInt dim = p->grid->dim;
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * dim; d < dim; ++d, ++i) p->force[i] -= external_force(p, i);
}

PetscErrorCode NewtonWeigh(Newton *n)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  PetscReal local[3] = {contact_square(p->scene.contact), 0, p->asked && p->asked() ? 1 : 0}, sum[3];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * dim; d < dim; ++d, ++i) {
      const PetscReal external = external_force(p, i) + following_force(p, i);
      if (p->fixed[i]) local[0] += p->force[i] * p->force[i];
      else local[1] += external * external;
    }
  PetscCall(MPIU_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, n->comm));
  n->asked = sum[2] > 0;
  n->reaction = PetscSqrtReal(sum[0]);
  n->external = PetscSqrtReal(sum[1]);
  PetscFunctionReturn(0);
}

/* The first row of a symmetric tangent that somebody reads in full. */
static PetscInt whole_from(const Newton *n)
{
  const System *s = n->problem->system;
  return !n->lift && (s->single || s->form == SYSTEM_GATHERED) ? s->n_active : 0;
}

PetscErrorCode NewtonAssemble(Newton *n, PetscBool tangent)
{
  StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  double start, end;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(SystemZeroNodes(p->system, p->force));
  if (p->volume) PetscCall(PetscArrayzero(p->volume, p->grid->n_nodes));
  if (tangent) PetscCall(SystemWantSlots(p->system, p->in.half && !p->pressure));
  if (tangent && p->in.half) PetscCall(SystemZeroHalf(p->system));
  else if (tangent) PetscCall(SystemZero(p->system));
  n->tangent = tangent;
  n->report->tangents += tangent;
  WeakFormOutput out = {.force = p->force,
                        .volume = p->volume,
                        .values = tangent && !p->system->single ? p->system->values : NULL,
                        .singles = tangent && p->system->single ? p->system->singles : NULL,
                        .slot = p->system->slot};
  p->in.du = p->du;
  p->in.pressure = p->pressure;
  PetscCall(p->formulation->assemble(&p->in, &out));
  if (tangent && p->in.half) PetscCall(SystemMirror(p->system, whole_from(n)));
  if (p->border && p->border->follows) p->scene.t = p->border->time + p->border->factor;
  const NodalOutput acting = {.force = p->force, .system = tangent ? p->system : NULL};
  PetscCall(NodalForcesAssemble(p->forces, &p->scene, &acting));
  if (tangent) system_turn(p->system);
  newton_turn(p, p->force);
  if (n->lift) system_lift(p->system, p->fixed, n->lift, p->force, p->volume);
  PetscInt status = (PetscInt)out.status, worst;
  PetscCall(MPIU_Allreduce(&status, &worst, 1, MPIU_INT, MPI_MAX, n->comm));
  n->report->status = (LawStatus)worst;
  n->report->bad_point = out.bad_point;
  PetscCall(GridSumToOwners(p->grid, dim, p->force));
  if (p->volume) PetscCall(GridSumToOwners(p->grid, 1, p->volume));
  balance(p);
  PetscCall(NewtonWeigh(n));
  PetscCall(PetscTime(&end));
  n->t_points += end - start;
  PetscFunctionReturn(0);
}

void newton_turn(const StepProblem *p, PetscReal *vectors)
{
  if (p->system->frames) frames_turn(p->system->frames, p->grid->dim, vectors);
}

PetscErrorCode NewtonGetUnknowns(const Newton *n, Vec x)
{
  const StepProblem *p = n->problem;

  PetscFunctionBeginUser;
  newton_turn(p, p->du);
  PetscCall(SystemFromNodes(p->system, p->du, 0, p->system->dim, x));
  newton_turn(p, p->du);
  if (p->pressure) PetscCall(SystemFromNodes(p->system, p->pressure, p->system->dim, 1, x));
  PetscFunctionReturn(0);
}

void newton_rest_without_unknowns(const StepProblem *p)
{
  const PetscInt dim = p->grid->dim;
  for (PetscInt node = 0; node < p->grid->n_nodes; ++node) {
    if (p->system->row[node] >= 0) continue;
    for (PetscInt d = 0, i = node * dim; d < dim; ++d, ++i) {
      p->force[i] = 0;
      if (p->fixed[i]) p->du[i] = p->prescribed[i];
    }
  }
}

PetscErrorCode NewtonSetIncrements(Newton *n, Vec x)
{
  StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  const PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(x, &v));
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * dim; d < dim; ++d, ++i)
      p->du[i] = p->fixed[i] ? p->prescribed[i] : v[k * p->system->block + d];
  PetscCall(VecRestoreArrayRead(x, &v));
  newton_turn(p, p->du); /* of nodes without unknowns it is zero, and ghosts follow */
  PetscCall(GridToGhosts(p->grid, dim, p->du));
  if (p->pressure) PetscCall(SystemToNodes(p->system, p->grid, x, dim, 1, p->pressure));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonGetResidual(Newton *n, Vec f)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim, block = p->system->block;
  PetscReal *v;

  PetscFunctionBeginUser;
  if (n->report->status != LAW_OK) {
    PetscCall(VecSet(f, PETSC_INFINITY));
    PetscFunctionReturn(0);
  }
  PetscCall(VecGetArrayWrite(f, &v));
  for (PetscInt k = 0; k < p->system->n_active; ++k) {
    const PetscInt node = p->system->active[k];
    for (PetscInt d = 0; d < dim; ++d) v[k * block + d] = p->fixed[node * dim + d] ? 0 : p->force[node * dim + d];
    if (p->pressure) v[k * block + dim] = p->idle[node] ? 0 : p->volume[node];
  }
  PetscCall(VecRestoreArrayWrite(f, &v));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonFunction(SNES snes, Vec x, Vec f, void *context)
{
  Newton *n = context;
  (void)snes;
  PetscFunctionBeginUser;
  PetscCall(NewtonSetIncrements(n, x));
  PetscCall(NewtonAssemble(n, !newton_is_last(n) && !newton_will_keep(n)));
  PetscCall(NewtonGetResidual(n, f));
  PetscCall(PetscTime(&n->solving)); /* for a solve that asks for no tangent: -snes_lag_jacobian */
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonFillMatrix(Newton *n)
{
  PetscFunctionBeginUser;
  /* first: the blocks take its shift */
  if (n->projects) PetscCall(ProjectionFactor(n->projection));
  PetscCall(SystemToMatrix(n->problem->system));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonJacobian(SNES snes, Vec x, Mat matrix, Mat preconditioner, void *context)
{
  Newton *n = context;
  double start, end;

  (void)snes, (void)matrix, (void)preconditioner;
  PetscFunctionBeginUser;
  const PetscBool keeps = newton_keeps(n);
  /* du is still where the residual was taken */
  if (!n->tangent && !keeps) PetscCall(NewtonAssemble(n, PETSC_TRUE));
  PetscCall(PetscTime(&start));
  if (!keeps) PetscCall(NewtonFillMatrix(n));
  PetscCall(NewtonForcing(n));
  PetscCall(PetscTime(&end));
  n->t_matrix += end - start;
  n->solving = end; /* what SNES does next */
  (void)x;
  PetscFunctionReturn(0);
}
