/* A step of explicit dynamics: the material point method as it was first written, with the stress updated
 * last (docs/theory.md, "Explicit dynamics").
 *
 * Who knows the method reads Substep; the rest divides the run's step and keeps its accounts. */
#include <math.h>
#include "model/explicit/explicit.h"

/* In the time in which a wave crosses a cell (docs/theory.md, "Gradients that points carry"): who follows faster than
 * the unseen fades becomes unstable where a node is hardly reached. */
#define UNSEEN 0.02
#define FOLLOW 0.01
#define SLOW 1e-3 /* damping in a kick that its series has to as many digits */

/* v' = a - rate v with the same a all through the kick: v = kept v + act a, and what m rate v v takes meanwhile. */
static void damp(PetscReal rate, Explicit *e)
{
  const PetscReal s = rate * e->kick, fade = -expm1(-s);
  e->fade = fade;
  e->act = s > 0 ? fade / rate : e->kick;
  e->fading[0] = fade * (1 - 0.5 * fade);
  e->fading[1] = fade;
  e->fading[2] = s > SLOW ? (s - fade) / PetscSqr(fade) - 0.5 : s / 3;
}

/* Forces of where points are now act from the middle of the last substep to that of this one. */
static PetscErrorCode Kick(Model *m, Explicit *e)
{
  PetscFunctionBeginUser;
  e->kick = (e->before + e->dt) / 2;
  damp(m->c->analysis.damping, e);
  e->unseen = e->slopes ? 1 - PetscExpReal(-UNSEEN * e->kick / e->crossing) : 0;
  e->follow = 1 - PetscExpReal(-FOLLOW * e->dt / e->crossing);
  if (e->begins || !e->box) points_gather(m, e); /* mass, momentum and forces of the nodes */
  PetscCall(ForcesBegin(m, e));
  PetscCall(NodesShare(m, e->width, e->sum));
  PetscCall(NodesMove(m, e)); /* their velocities before and after */
  nodes_hold(m, e);           /* the boundary's are given */
  PetscCall(NodesTake(m, e, 2 * m->dim, e->motion));
  points_gain(m, e); /* points take the change, and give nodes their momentum anew */
  PetscFunctionReturn(0);
}

static PetscErrorCode Substep(Model *m, Explicit *e)
{
  PetscFunctionBeginUser;
  PetscCall(Kick(m, e));
  PetscCall(NodesStrain(m, e));
  walls_follow(m, e);
  PetscCall(NodesCarry(m, e));
  materials_step(m->c->n_materials, m->materials, e->time, e->dt, PETSC_TRUE);
  points_strain(m, e); /* strain, stress; points move, and give what comes first in the next substep */
  nodes_forget(m, e);
  e->before = e->dt;
  e->time += e->dt;
  ++e->taken;
  ++e->since;
  PetscFunctionReturn(0);
}

static PetscErrorCode Lap(Model *m, Explicit *e, PetscReal left)
{
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(LapBegin(m, e, left));
  PetscCall(PetscTime(&clock));
  for (PetscInt k = 0; k < e->substeps; ++k) {
    e->begins = k == 0;
    e->ends = k == e->substeps - 1;
    PetscCall(Substep(m, e));
  }
  lap_displace(m, e, 1);
  PetscCall(PhaseEnd(m->seconds, PHASE_POINTS, &clock));
  PetscFunctionReturn(0);
}

/* The half of a kick that is missing at the end of the run's step. */
static PetscErrorCode Close(Model *m, Explicit *e)
{
  PetscFunctionBeginUser;
  PetscCall(LapBegin(m, e, 0));
  e->begins = e->ends = PETSC_TRUE;
  PetscCall(Kick(m, e));
  walls_follow(m, e);
  PetscCall(NodesCarry(m, e));
  nodes_forget(m, e);
  lap_displace(m, e, 1);
  PetscFunctionReturn(0);
}

/* Did all laws find a stress? */
static PetscErrorCode Judge(Model *m, const Explicit *e, StepReport *report)
{
  PetscInt status = (PetscInt)e->status;

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &status, 1, MPIU_INT, MPI_MAX, m->comm));
  if (status == (PetscInt)LAW_OK) PetscFunctionReturn(0);
  report->outcome = STEP_POINTS_LOST;
  const PetscBool whole = (PetscBool)(e->dt > (1 - 1e-6) * e->step); /* no shorter than the step of the run */
  snprintf(report->reason, sizeof report->reason, "%s near t = %g s in a substep of %g s: make analysis.%s smaller",
           law_status_text((LawStatus)status), (double)e->time, (double)e->dt, whole ? "step" : "courant");
  PetscFunctionReturn(0);
}

/* Of walls with mass, whether they are there or not: what comes or goes as a step begins is none of its losses. */
static PetscReal all_motion(const Model *m) { return rigid_motion(m) + rigid_away(m); }

/* Accounts: what came in and is neither kinetic nor work of the stress was lost between points and grid, or by
 * the substeps. `before`: kinetic energy and work of the stress. */
static PetscErrorCode Account(Model *m, const Explicit *e, const PetscReal before[2])
{
  PetscReal now[2], sum[5];

  PetscFunctionBeginUser;
  energy_of_points(m, now);
  PetscReal local[5] = {e->external, e->boundary, e->damped, 0, e->friction};
  local[3] = e->external + e->boundary - e->damped - e->friction - (now[0] - before[0]) - (now[1] - before[1]);
  PetscCall(MPIU_Allreduce(local, sum, 5, MPIU_REAL, MPI_SUM, m->comm));
  m->external_work += sum[0];
  m->boundary_work += sum[1];
  m->damped_energy += sum[2];
  m->transfer_energy += sum[3] + rigid_work(m) - all_motion(m) - e->driven;
  m->friction_energy += sum[4];
  energy_note_most(m);
  PetscFunctionReturn(0);
}

/* What the run's step has become for all others. */
static PetscErrorCode Accept(Model *m, Explicit *e, const PetscReal before[2], StepReport *report)
{
  PetscFunctionBeginUser;
  PetscCall(WallsAccount(m, e));
  PetscCall(Account(m, e, before));
  m->transfer_energy -= m->outside.energy - e->outside;
  note_flow(m, 1);
  m->space->present = PETSC_FALSE;
  m->time = report->outcome == STEP_ACCEPTED ? m->time + e->step : e->time;
  ++m->step;
  m->total_iterations += e->taken;
  report->newton.iterations = e->taken;
  report->newton.converged = PETSC_TRUE;
  report->dt = e->step;
  PetscFunctionReturn(0);
}

static PetscErrorCode Begin(Model *m, PetscReal step, Explicit *e, PetscReal before[2], StepReport *report)
{
  PetscFunctionBeginUser;
  e->time = m->time;
  e->step = step;
  e->taken = 0;
  e->critical = 0;
  e->before = 0;
  e->outside = m->outside.energy;
  e->status = LAW_OK;
  e->external = e->boundary = e->damped = 0;
  e->driven = rigid_work(m) - all_motion(m);
  for (PetscInt k = 0; m->contact && k < m->contact->n_rigid; ++k) e->ease[k] = 1;
  if (m->contact) PetscCall(PetscArrayzero(e->pushed, m->contact->n_partners));
  if (m->contact) PetscCall(PetscArrayzero(e->rubbed, m->contact->n_partners));
  if (m->contact) PetscCall(PetscArrayzero(e->sunk, m->contact->n_partners));
  PetscCall(PetscArrayzero(m->nodes->reaction, m->grid->n_nodes * m->dim));
  let_go_settle(m, &(TimeWeights){.mean = 1});
  energy_of_points(m, before);
  note_flow(m, -1);
  report->outcome = STEP_ACCEPTED;
  PetscFunctionReturn(0);
}

/* Points learn of the room that they have by the nodes' functions, which substeps go without. */
static PetscErrorCode Room(Model *m)
{
  PetscReal made;

  PetscFunctionBeginUser;
  if (!m->c->stabilisation.room) PetscFunctionReturn(0);
  PetscCall(ModelInitialise(m));
  PetscCall(ModelRoom(m, &made));
  PetscFunctionReturn(0);
}

PetscErrorCode ExplicitStep(Model *m, PetscReal limit, StepReport *report)
{
  const PetscReal step = PetscMin(limit, m->control.next), end = m->time + step;
  PetscReal before[2];

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(report, sizeof *report));
  PetscCall(ExplicitBalance(m, report));
  PetscCall(Room(m));
  if (!m->explicit) PetscCall(ExplicitCreate(m, &m->explicit));
  Explicit *e = m->explicit;
  PetscCall(Begin(m, step, e, before, report));
  PetscCall(MaterialsAt(m, end));
  while (report->outcome == STEP_ACCEPTED && end - e->time > 1e-9 * step) {
    PetscCall(Lap(m, e, end - e->time));
    PetscCall(Judge(m, e, report));
    if (report->outcome == STEP_ACCEPTED) PetscCall(LapEnd(m, report));
  }
  if (report->outcome == STEP_ACCEPTED) PetscCall(Close(m, e));
  if (report->outcome == STEP_ACCEPTED) PetscCall(NoteSway(m));
  PetscCall(Accept(m, e, before, report));
  PetscCall(MaterialsSettle(m, report));
  materials_step(m->c->n_materials, m->materials, m->time, 0, PETSC_TRUE);
  if (report->outcome == STEP_ACCEPTED) PetscCall(MeasuresRemember(m, report->dt));
  PetscFunctionReturn(0);
}
