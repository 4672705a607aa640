/* What a run has lost on the way is said: in the log when it happens, in the summary, and as
 * warnings at the end. */
#include "run/report/losses.h"
#include "base/text.h"
#include "run/report/warn/warn.h"

/* Has a count that grew by `more` at least doubled, or passed a power of two? So a thousand points
 * take ten lines, not a thousand. */
static PetscBool is_worth_a_line(PetscReal count, PetscReal more)
{
  PetscReal power = 1;
  while (2 * power <= count) power *= 2;
  return more > 0 && count - more < power;
}

static PetscErrorCode LogOutside(const Model *m, RunDir *dir, const StepReport *report)
{
  const Outside *o = &m->outside;
  const LostPoint *first = &report->first_outside;
  char at[80];

  PetscFunctionBeginUser;
  if (is_worth_a_line(o->removed, (PetscReal)report->removed))
    PetscCall(
      RunDirLog(dir,
                "outside = step %d time = %.9g removed = %d since the start = %.0f mass = %.6g kg, the first of the "
                "step is point %lld at %s m",
                (int)m->step, (double)m->time, (int)report->removed, (double)o->removed, (double)o->mass,
                (long long)first->id, text_position(m->dim, first->x, at)));
  if (is_worth_a_line(o->held, (PetscReal)report->held))
    PetscCall(
      RunDirLog(dir,
                "outside = step %d time = %.9g kept on the boundary = %d times since the start = %.0f, the first of "
                "the step is point %lld at %s m",
                (int)m->step, (double)m->time, (int)report->held, (double)o->held, (long long)first->id,
                text_position(m->dim, first->x, at)));
  PetscFunctionReturn(0);
}

PetscErrorCode LossesLogStep(Model *m, RunDir *dir, const StepReport *report)
{
  char at[80];

  PetscFunctionBeginUser;
  if (m->c->n_measures + m->c->n_loads) PetscCall(ModelInitialise(m)); /* which finds what ended */
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (m->memory[k].ended > 0 && m->memory[k].ended == m->time)
      PetscCall(RunDirLog(
        dir,
        "ended = %s step %d time = %.9g: no node of the grid carries its tracer any more, last at %s m; nan from "
        "now on",
        m->c->measures[k].name, (int)m->step, (double)m->time, text_position(m->dim, m->memory[k].where, at)));
  for (PetscInt k = 0; k < m->c->n_loads; ++k) {
    const LoadMemory *l = &m->load_memory[k];
    if (l->ended > 0 && l->ended == m->time)
      PetscCall(
        RunDirLog(dir,
                  "ended = load %d step %d time = %.9g: the material has left %.0f of its carriers behind, about %s m; "
                  "their force so far is (%.6g, %.6g, %.6g) N at amplitude 1",
                  (int)k, (int)m->step, (double)m->time, (double)l->carriers, text_position(m->dim, l->where, at),
                  (double)l->force[0], (double)l->force[1], (double)l->force[2]));
  }
  PetscCall(LogOutside(m, dir, report));
  PetscFunctionReturn(0);
}

PetscErrorCode LossesLogEnd(const Model *m, RunDir *dir)
{
  const Outside *o = &m->outside;

  PetscFunctionBeginUser;
  if (o->removed > 0)
    PetscCall(
      RunDirLog(dir,
                "outside: %.0f points of %.6g kg left the grid and were removed between t = %.9g and %.9g s, with %.6g "
                "J and momentum (%.6g, %.6g, %.6g) kg m/s",
                (double)o->removed, (double)o->mass, (double)o->first, (double)o->last, (double)o->energy,
                (double)o->momentum[0], (double)o->momentum[1], (double)o->momentum[2]));
  if (o->held > 0)
    PetscCall(
      RunDirLog(dir,
                "outside: points were kept on the boundary of the grid %.0f times between t = %.9g and %.9g s, at most "
                "%.0f of %.6g kg in a step; that took %.6g J and momentum (%.6g, %.6g, %.6g) kg m/s",
                (double)o->held, (double)o->first, (double)o->last, (double)o->held_most, (double)o->held_most_mass,
                (double)o->energy, (double)o->momentum[0], (double)o->momentum[1], (double)o->momentum[2]));
  if (energy_counts(m, m->transfer_energy))
    PetscCall(RunDirLog(
      dir,
      "transfer = %.6g J between points and grid, %.2g %% of the %.6g J that came in (start, loads, gravity, "
      "prescribed motion)",
      (double)m->transfer_energy, (double)(100 * energy_share(m, m->transfer_energy)), (double)m->most_energy));
  const PetscReal numerical = energy_share(m, m->numerical_energy);
  if (PetscAbsReal(numerical) > TRANSFER_ALLOWED)
    PetscCall(RunDirLog(dir, "numerical = %.6g J taken by the damping of the time scheme%s, %.3g %% of what came in",
                        (double)m->numerical_energy,
                        m->c->stabilisation.room ? " less what stabilisation.room makes" : "",
                        (double)(100 * numerical)));
  PetscFunctionReturn(0);
}

/* Points that left the grid. */
static void warn_of_outside(const Outside *o, Diag *diag)
{
  if (o->removed > 0)
    diag_warning(diag, "grid.outside", "%.0f points of %.4g kg left the grid and were removed", (double)o->removed,
                 (double)o->mass);
  if (o->held > 0)
    diag_warning(diag, "grid.outside",
                 "points that left the grid were kept on its boundary %.0f times, at most %.0f of %.4g kg in a step",
                 (double)o->held, (double)o->held_most, (double)o->held_most_mass);
}

PetscErrorCode LossesWarn(Model *m, const PetscReal *values, Diag *diag)
{
  PetscFunctionBeginUser;
  warn_of_followers(m, diag);
  PetscCall(WarnOfEmpty(m, values, diag));
  warn_of_outside(&m->outside, diag);
  PetscCall(WarnOfEnergy(m, diag));
  PetscCall(WarnOfCrowd(m, diag));
  PetscCall(WarnOfApart(m, diag));
  PetscCall(WarnOfMovedLoads(m, diag));
  PetscCall(WarnOfShear(m, diag));
  PetscCall(WarnOfStretch(m, diag));
  warn_of_entered(m, diag);
  PetscCall(WarnOfPull(m, diag));
  warn_of_sway(m, diag);
  PetscCall(WarnOfPassed(m, diag));
  PetscCall(WarnOfFailed(m, diag));
  PetscCall(AdviseHangs(m, diag));
  astride_tell(m, diag);
  warn_of_sunk(m, PETSC_FALSE, diag);
  warn_of_search(m, diag);
  warn_of_unstable(m, diag);
  warn_of_walls_through(m, diag);
  PetscFunctionReturn(0);
}
