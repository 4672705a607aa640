/* How a run begins with forces that balance, and what it says of those that did not. */
#include "output/directory/run_dir_files.h"
#include "run/run_private.h"

/* of the weight: what increments too small to count may leave */
#define ROUND_OFF 1e-6

/* of the weight: what quadrature among the functions of a cloud leaves of a stress that balances */
#define OF_CLOUDS 1e-2

/* of what acts: no stress at all lacks 1; and of what holds where nothing acts: none lacks nothing */
#define MORE_THAN_NONE 1.05
#define HELD_BY_NOTHING 0.5

/* Where most of a body was to begin with a stress that it cannot bear, something else was meant. */
static PetscErrorCode TellStress(const Model *m, RunDir *dir)
{
  const PetscReal beyond = m->initial.beyond;
  PetscInt points;

  PetscFunctionBeginUser;
  PetscCall(ModelCountPoints(m, &points));
  if (beyond > 0)
    PetscCall(RunDirLog(dir, "%s beyond the strength at %d of %d points, and brought back to it there%s",
                        beyond > points / 2. ? "warning = the initial stress is" : "initial stress =", (int)beyond,
                        (int)points, m->c->analysis.type == ANALYSIS_FACTOR ? " once it yields" : ""));
  else PetscCall(RunDirLog(dir, "initial stress = within the strength everywhere"));
  PetscFunctionReturn(0);
}

static PetscBool gives_stress(const Case *c)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    for (int k = 0; k < 6; ++k)
      if (c->bodies[b].stress[k]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* By what the lack of balance is measured (LackOfBalance). */
static const char *measured_by(const Run *r)
{
  const Case *c = r->c;
  const PetscBool weighs = (PetscBool)(c->gravity[0] != 0 || c->gravity[1] != 0 || c->gravity[2] != 0);
  return r->model->initial.acts && weighs && !case_acting_loads(c) ? "the weight" : "the forces that act";
}

static PetscErrorCode TellLack(const Run *r, PetscReal lacked)
{
  const PetscBool acts = r->model->initial.acts;

  PetscFunctionBeginUser;
  if (lacked <= (acts ? MORE_THAN_NONE : HELD_BY_NOTHING) || !case_has_stress(r->c)) PetscFunctionReturn(0);
  PetscCall(RunDirLog(
    r->dir, "warning = the initial stress leaves %.3g of %s out of balance, more than no stress would%s%s",
    (double)lacked, measured_by(r), gives_stress(r->c) ? ": compression is negative" : "",
    acts ? "" : "; neither weight nor load acts at the start (loads of statics grow from 0 without an `amplitude`)"));
  PetscFunctionReturn(0);
}

/* A method that cannot seek one says so where statics will move the body; others were told not to. */
static PetscErrorCode TellNone(const Run *r)
{
  const PetscReal lacked = r->model->initial.lacked; /* nan: not known where constraints hold a cloud */
  const PetscBool moves = (PetscBool) !(lacked <= ROUND_OFF), unasked = r->model->method->clouds;
  const PetscBool warns = (PetscBool)(unasked && case_is_static(&r->c->analysis) && !(lacked <= OF_CLOUDS));
  char what[128] = "what is out of balance";

  PetscFunctionBeginUser;
  if (!case_has_stress(r->c)) PetscFunctionReturn(0);
  if (!PetscIsNanReal(lacked))
    snprintf(what, sizeof what, "%.3g of %s is out of balance%s", (double)lacked, measured_by(r), moves ? " and" : "");
  PetscCall(RunDirLog(
    r->dir, "%s: %s%s",
    warns ? "warning = this method seeks no equilibrium before the first step" : "initial equilibrium = none is sought",
    what, moves ? " moves the body from there on" : ""));
  PetscFunctionReturn(0);
}

PetscErrorCode RunEquilibrate(Run *r)
{
  Model *m = r->model;
  const InitialState *s = &m->initial;
  StepReport report;
  char text[1024];

  PetscFunctionBeginUser;
  if (case_has_stress(r->c)) PetscCall(TellStress(m, r->dir));
  if (r->c->initial.equilibrium <= EQUILIBRIUM_NONE) {
    PetscCall(TellNone(r));
    PetscFunctionReturn(0);
  }
  PetscCall(ModelEquilibrate(m, &report));
  if (report.outcome == STEP_ACCEPTED) {
    PetscCall(RunDirLog(r->dir,
                        "initial equilibrium = lacked %.3g of %s, left %.2g; moved %.3g m at most; parts = %d "
                        "iterations = %d",
                        (double)s->lacked, measured_by(r), (double)s->left, (double)s->moved, (int)s->parts,
                        (int)s->iterations));
    PetscCall(TellLack(r, s->lacked));
    if (s->left > ROUND_OFF)
      PetscCall(RunDirLog(r->dir, "warning = points that move still bring %.2g of %s out of balance", (double)s->left,
                          measured_by(r)));
    PetscFunctionReturn(0);
  }
  snprintf(text, sizeof text,
           "there is no equilibrium to begin with: %.3g of %s was out of balance, %.3g still is (%s): smaller "
           "cells lack less, and `initial: {equilibrium: none}` begins without one",
           (double)s->lacked, measured_by(r), (double)s->left,
           report.outcome == STEP_TOO_SMALL ? report.newton.reason : "points left the grid");
  PetscCall(TellLack(r, s->lacked));
  PetscCall(RunDirLog(r->dir, "gave up = %s", text));
  run_stop(r, text);
  PetscFunctionReturn(0);
}
