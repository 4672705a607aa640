/* One step of any method, as algorithms 1 and 2 of the thesis have it. */
#include "model/model_private.h"

#define ROUNDING 1e-9 /* of a step: times are sums */
#define STRETCH 1e-3  /* of a step: by so much one may be longer, so that none is left over */

/* What searches try is no time. */
static PetscBool seeks(const Model *m)
{
  return (PetscBool)(m->raised.rising || m->strength.trying || m->initial.seeking);
}

/* Steps that have grown are no longer than `step` where a table begins to change, and grow anew from there. */
static void begin_anew(Model *m)
{
  const PetscReal step = m->c->analysis.step;
  if (seeks(m) || m->control.next <= (1 + ROUNDING) * step) return;
  if (case_begins_within(m->c, m->time, m->time + (1 - ROUNDING) * step)) m->control.next = step;
}

/* Should no step be much shorter than those beside it? In implicit dynamics it solves for light nodes with next to
 * nothing but their consistent mass, and for walls with what they have left of gaps, and the next one takes what they
 * get for their acceleration. */
static PetscBool steps_are_alike(const Model *m)
{
  return (PetscBool)(m->scheme->inertia && m->scheme != &time_scheme_explicit && !seeks(m));
}

/* The next step on the way to a time at which one must end: the last two have equal parts of the way, or the last one a
 * thousandth more. */
static PetscReal evenly(const Model *m, PetscReal way)
{
  const PetscReal dt = m->control.next;
  if (!steps_are_alike(m) || way <= (1 + ROUNDING) * dt || way >= 2 * dt) return PetscMin(way, dt);
  return way <= (1 + STRETCH) * dt ? way : way / 2;
}

/* What is passed by, since it is so close to the start of a step or, before it, to where one must end. */
static PetscReal passed_by(const Model *m) { return steps_are_alike(m) ? CLOSE_STEPS * m->control.next : 0; }

/* How long the next step of dt may be at most: one longer than `step` ends where a table turns, or it is of `step`, as
 * all are while a load goes by a formula of t, which may turn anywhere. */
static PetscReal until_corner(const Model *m, PetscReal dt)
{
  const PetscReal step = m->c->analysis.step;
  if (seeks(m) || dt <= (1 + ROUNDING) * step) return PETSC_MAX_REAL;
  if (case_has_timed_factor(m->c)) return step;
  const PetscReal way = case_corner_after(m->c, m->time) - m->time;
  if (way > dt && way < dt + step && way >= 2 * step) return way / 2;
  return PetscMax(way, step);
}

/* How long a step of dt may be at most: where it may grow, also one of `step` or less ends at a peak of what is asked
 * for at the ends of steps; in dynamics those of the step after it are seen, too. */
static PetscReal until_peak(const Model *m, PetscReal dt)
{
  const AnalysisSpec *a = &m->c->analysis;
  if (seeks(m) || a->largest <= (1 + ROUNDING) * a->step || a->type == ANALYSIS_EXPLICIT) return PETSC_MAX_REAL;
  const PetscReal end = m->time + (m->scheme->inertia ? 2 : 1) * dt;
  const PetscReal peak = case_peak_within(m->c, m->time + passed_by(m), end);
  return peak < end ? peak - m->time : PETSC_MAX_REAL;
}

/* In statics steps that were halved lead back to the times that were asked for: what changes with them has its corners
 * there. */
static PetscReal until_return(const Model *m)
{
  if (m->scheme->inertia || seeks(m)) return PETSC_MAX_REAL;
  return step_control_return(&m->control, &m->c->analysis, m->time - m->c->start);
}

PetscReal model_until_change(const Model *m)
{
  return m->walls ? walls_until_change(m->walls, m->time) : PETSC_MAX_REAL;
}

PetscErrorCode ModelStep(Model *m, PetscReal limit, StepReport *report)
{
  limit = PetscMin(limit, model_until_change(m)); /* no step goes over the time at which a wall appears or vanishes */
  const PetscReal stop = limit;
  begin_anew(m);
  limit = PetscMin(limit, until_corner(m, PetscMin(limit, m->control.next)));
  const PetscReal back = until_return(m);
  const PetscReal peak = until_peak(m, PetscMin(back, PetscMin(limit, m->control.next)));
  const PetscBool returning = (PetscBool)(back < PetscMin(PetscMin(limit, peak), m->control.next));
  limit = PetscMin(PetscMin(limit, back), peak);
  PetscReal dt = evenly(m, stop - limit <= passed_by(m) ? stop : limit);
  const PetscBool shortened = dt < m->control.next;
  StepStart start;
  EnergyStep energy;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(report, sizeof *report));
  PetscCall(WallsAppear(m, report));
  if (report->outcome != STEP_ACCEPTED) PetscFunctionReturn(0);
  if (m->scheme == &time_scheme_explicit) {
    PetscCall(ExplicitStep(m, limit, report));
    PetscFunctionReturn(0);
  }
  PetscCall(ModelInitialise(m)); /* (a) nodes learn from where points are */
  /*     which of them have unknowns, and which are held */
  PetscCall(NonlocalStep(m)); /*     and points of what is around them */
  places_step(m);             /*     and where they are */
  PetscCall(PrepareUnknowns(m, &start, report));
  /* (b) their increments, in a shorter step if need be */
  PetscCall(SolveStep(m, &dt, report));
  if (report->newton.converged) {
    /*     stress and history of the points, reactions */
    PetscCall(CommitStep(m, dt, &energy));
    PetscCall(ConvectStep(m, dt, &energy, report)); /* (c) points move, and nodes or not */
    PetscCall(MaterialsSettle(m, report));
    PetscCall(ChooseNextStep(m, shortened && !report->cuts, returning && !report->cuts, report));
    outside_judge(m, report);
    if (!m->initial.seeking) PetscCall(MeasuresRemember(m, report->dt));
  } else PetscCall(StepStartRestore(m, &start, report));
  materials_step(m->c->n_materials, m->materials, case_time(m->c, m->time), 0, m->scheme->inertia);
  PetscFunctionReturn(0);
}

PetscErrorCode ModelInitialise(Model *m)
{
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  if (m->space->present) PetscFunctionReturn(0);
  PetscCall(PetscTime(&clock));
  /* who follows whom hangs on who is held now */
  if (m->method->restores_grid) PetscCall(ModelMovePlaces(m, m->time));
  PetscCall(m->method->initialise(m->space));
  m->space->present = PETSC_TRUE;
  if (m->step > 0 && !m->space->alone) PetscCall(FollowersEnd(m));
  PetscCall(PhaseEnd(m->seconds, PHASE_INITIALISE, &clock));
  PetscFunctionReturn(0);
}
