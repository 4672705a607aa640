/* One step of any method, as algorithms 1 and 2 of the thesis have it. */
#include "model/model_private.h"

static PetscErrorCode PrepareNodes(Model *m, StepStart *start, StepReport *report);
static PetscErrorCode ChooseNextStep(Model *m, PetscBool shortened, const StepReport *report);

PetscErrorCode ModelStep(Model *m, PetscReal limit, StepReport *report)
{
  const PetscBool shortened = limit < m->control.next;
  PetscReal dt = PetscMin(limit, m->control.next);
  StepStart start;
  EnergyStep energy;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(report, sizeof *report));
  PetscCall(ModelInitialise(m));              /* (a) nodes learn from where points are */
  PetscCall(PrepareNodes(m, &start, report)); /*     which of them have unknowns, and which are held */
  PetscCall(SolveStep(m, &dt, report));       /* (b) their increments, in a shorter step if need be */
  if (report->newton.converged) {
    PetscCall(CommitStep(m, dt, &energy));          /*     stress and history of the points, reactions */
    PetscCall(ConvectStep(m, dt, &energy, report)); /* (c) points move, and nodes or not */
    PetscCall(ChooseNextStep(m, shortened && !report->cuts, report));
    outside_judge(m, report);
  } else PetscCall(StepStartRestore(m, &start, report));
  PetscCall(StepStartForget(&start));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelInitialise(Model *m)
{
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  if (m->space->present) PetscFunctionReturn(0);
  PetscCall(PetscTime(&clock));
  PetscCall(m->method->initialise(m->space));
  m->space->present = PETSC_TRUE;
  if (m->step > 0) PetscCall(FollowersEnd(m));
  PetscCall(PhaseEnd(m->seconds, PHASE_INITIALISE, &clock));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrepareNodes(Model *m, StepStart *start, StepReport *report)
{
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  PetscCall(ModelBalance(m, report));
  PetscCall(PhaseEnd(m->seconds, PHASE_REPARTITION, &clock));
  PetscCall(ModelActivate(m));
  if (m->method->restores_grid) PetscCall(BoundaryMove(m->boundary, m->grid, m->time));
  mark_fixed(m);
  PetscCall(StepStartKeep(m, start));
  if (m->method->begin && m->scheme->inertia) PetscCall(m->method->begin(m->space));
  PetscCall(PhaseEnd(m->seconds, PHASE_PATTERN, &clock));
  PetscFunctionReturn(0);
}

/* The step in which the fastest point travels as far as it may; without limit where points stay in their cells. */
static PetscReal reach_of(const Model *m, PetscReal speed)
{
  const AnalysisSpec *a = &m->c->analysis;
  const PetscBool flows = m->method->restores_grid && m->scheme->inertia;
  return flows && a->travel > 0 && speed > 0 ? a->travel * m->grid->smallest / speed : PETSC_MAX_REAL;
}

static PetscErrorCode ChooseNextStep(Model *m, PetscBool shortened, const StepReport *report)
{
  PetscReal fastest = 0, speed;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *v = point_real(m->points, POINT_V, p);
    PetscReal square = 0;
    for (PetscInt d = 0; d < m->dim; ++d) square += v[d] * v[d];
    fastest = PetscMax(fastest, square);
  }
  PetscCall(MPIU_Allreduce(&fastest, &speed, 1, MPIU_REAL, MPIU_MAX, m->comm));
  const StepTaken taken = {.dt = report->dt,
                           .iterations = report->newton.iterations,
                           .shortened = shortened,
                           .reach = reach_of(m, PetscSqrtReal(speed))};
  step_control_accept(&m->control, &m->c->analysis, m->c->newton.ease, &taken);
  PetscFunctionReturn(0);
}

void model_times(const Model *m, PetscReal seconds[PHASE_N])
{
  for (int k = 0; k < PHASE_N; ++k) seconds[k] = m->seconds[k];
  newton_times(m->newton, &seconds[PHASE_POINTS], &seconds[PHASE_MATRIX], &seconds[PHASE_LINEAR],
               &seconds[PHASE_NEWTON]);
}
