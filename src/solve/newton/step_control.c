#include "solve/newton/step_control.h"

#define ROUNDING 1e-9 /* of a step: times are sums */
#define ASTRAY 1e-6   /* of a step: what is no sum of steps */

void step_control_start(StepControl *c, PetscReal step)
{
  *c = (StepControl){.next = step, .failed = PETSC_MAX_REAL, .patience = STEP_WAIT, .since = PETSC_MAX_INT};
}

/* Failures close to each other make the memory longer. */
PetscReal step_control_cut(StepControl *c, PetscReal dt)
{
  if (c->since > 0) {
    const PetscBool soon = c->since < 4 * c->patience;
    c->patience = soon ? PetscMin(2 * c->patience, STEP_WAIT_MOST) : STEP_WAIT;
  }
  c->since = 0;
  c->wait = c->patience;
  c->failed = dt;
  c->next = dt / 2;
  return c->next;
}

PetscReal step_control_return(const StepControl *c, const AnalysisSpec *a, PetscReal came)
{
  const PetscReal whole = PetscFloorReal(came / a->step + ROUNDING);
  const PetscReal rest = (whole + 1) * a->step - came;
  const PetscBool astray =
    (PetscBool)(came - whole * a->step > ASTRAY * a->step); /* by a wall that came, or an output */
  if ((c->since == PETSC_MAX_INT && !astray) || c->next > (1 + ROUNDING) * a->step) return PETSC_MAX_REAL;
  const PetscReal parts = PetscCeilReal((1 - ROUNDING) * rest / c->next);
  return parts <= 2 ? rest / parts : PETSC_MAX_REAL;
}

/* Twice as large after an easy step; a little larger as long as iterations stay below one and a
 * half times that; and, between `step` and `largest`, smaller before Newton fails. */
static PetscReal factor(const AnalysisSpec *a, PetscInt ease, PetscInt iterations)
{
  if (iterations <= ease) return 2;
  if (2 * iterations <= 3 * ease) return 1.2;
  return a->largest > a->step && 2 * iterations > 5 * ease ? 0.75 : 1;
}

void step_control_accept(StepControl *c, const AnalysisSpec *a, PetscInt ease, const StepTaken *taken)
{
  if (c->since < PETSC_MAX_INT) ++c->since;
  if (c->wait > 0 && --c->wait == 0) c->failed = PETSC_MAX_REAL;
  const PetscReal f = factor(a, ease, taken->iterations);
  PetscReal next = f * taken->dt;
  if (f < 1) next = PetscMax(next, PetscMin(a->step, taken->dt));
  if (c->since == 1 && f > 1) next = taken->dt; /* it was cut: not back at once */
  /* an output was due: that says nothing about larger steps */
  if (taken->shortened) next = PetscMax(next, c->next);
  if (taken->returning && f > 1) next = PetscMax(next, f * c->next); /* else two halves never became one again */
  if (c->failed < PETSC_MAX_REAL) next = PetscMin(next, PetscMax(0.75 * c->failed, taken->dt));
  if (a->largest > a->step) next = PetscMin(next, PetscMax(taken->reach, a->step));
  c->next = PetscMin(next, a->largest);
}
