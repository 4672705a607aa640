/* What the directions of nodes bear that are held for want of anything else (start/unheld.c), when a step has been
 * solved: nothing, or loads are out of balance, or turn the body (docs/theory.md, section 60). */
#include "model/model_private.h"

/* rad: how far a step may turn a body that is let go; beyond, it may have fallen over to another balance */
#define TURN 0.05

static void let_turn(Model *m, PetscBool free)
{
  for (PetscInt k = 0; k < m->unheld.n; ++k)
    if (m->unheld.turns[k]) m->nodes->fixed[m->unheld.dof[k]] = !free;
}

/* What goes along with the body, as pressures do, is none of the external forces: the sum of its sizes on this rank. */
static PetscErrorCode GoingAlong(const Model *m, const StepProblem *p, PetscReal *sum)
{
  PetscReal *force;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &force));
  const NodalOutput acting = {.force = force};
  PetscCall(NodalForcesAssemble(p->forces, &p->scene, &acting));
  PetscCall(GridSumToOwners(m->grid, m->dim, force));
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) *sum += PetscAbsReal(force[i]);
  PetscCall(PetscFree(force));
  PetscFunctionReturn(0);
}

/* What the directions bear that are held, N, and is it too much? */
static PetscErrorCode Borne(const Model *m, const StepProblem *p, PetscReal *borne, PetscBool *much)
{
  const NodalFields *n = m->nodes;
  const PetscInt owned = m->grid->n_owned * m->dim;
  PetscReal pull[3], sums[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(GoingAlong(m, p, sums + 2));
  gravity_at(m->c, raised_time(m, m->time + m->c->analysis.step), pull);
  for (PetscInt i = 0; i < owned; ++i)
    if (n->touched[i / m->dim])
      sums[1] +=
        PetscAbsReal(n->force[i]) + PetscAbsReal(n->external[i]) + n->mass[i / m->dim] * PetscAbsReal(pull[i % m->dim]);
  for (PetscInt k = 0; k < m->unheld.n; ++k)
    if (m->unheld.dof[k] < owned && n->fixed[m->unheld.dof[k]]) sums[0] += PetscAbsReal(n->force[m->unheld.dof[k]]);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sums, 3, MPIU_REAL, MPIU_SUM, m->comm));
  *borne = sums[0];
  *much = sums[0] > UNHELD_BALANCE * sums[1] + unheld_open_surface(m) * sums[2] + p->round_off;
  PetscFunctionReturn(0);
}

/* Where loads that keep their direction have a moment about the body as it has come to lie, they turn it: it is let go
 * from there, since stress now resists its turning. *much stays where that leads nowhere, or too far. */
static PetscErrorCode LetTurn(Model *m, StepProblem *p, const LinearProblem *linear, StepReport *report,
                              PetscReal *borne, PetscBool *much)
{
  const NewtonReport first = report->newton;
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  PetscReal *du, moved = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(dofs, &du));
  PetscCall(PetscArraycpy(du, m->nodes->du, dofs));
  let_turn(m, PETSC_TRUE);
  PetscCall(NewtonSolve(m->newton, p, linear, &report->newton));
  for (PetscInt i = 0; i < dofs; ++i) moved = PetscMax(moved, PetscAbsReal(m->nodes->du[i] - du[i]));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &moved, 1, MPIU_REAL, MPIU_MAX, m->comm));
  PetscCall(PetscFree(du));
  report->newton.iterations += first.iterations;
  report->newton.linear_iterations += first.linear_iterations;
  if (!report->newton.converged || moved > TURN * m->unheld.size) PetscFunctionReturn(0);
  PetscCall(Borne(m, p, borne, much));
  PetscFunctionReturn(0);
}

PetscErrorCode UnheldJudge(Model *m, StepProblem *p, const LinearProblem *linear, StepReport *report)
{
  PetscReal borne;
  PetscBool much;

  PetscFunctionBeginUser;
  if (m->c->analysis.unheld != UNHELD_HOLD) PetscFunctionReturn(0);
  PetscCall(Borne(m, p, &borne, &much));
  if (much && m->unheld.turning) PetscCall(LetTurn(m, p, linear, report, &borne, &much));
  if (!much || report->newton.interrupted) PetscFunctionReturn(0);
  let_turn(m, PETSC_FALSE);
  snprintf(report->leap, sizeof report->leap,
           "%.3g N are out of balance along motions that nothing holds (analysis.unheld)", (double)borne);
  report->newton.converged = PETSC_FALSE;
  report->newton.reason = report->leap;
  PetscFunctionReturn(0);
}
