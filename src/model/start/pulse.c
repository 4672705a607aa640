/* What an amplitude does between the ends of steps, where nobody looks: said before the first step of dynamics. */
#include "model/explicit/critical.h"
#include "model/model_private.h"

#define BEYOND 0.1   /* of the largest value: by so much a point leaves what steps see around it */
#define IMPULSE 0.25 /* of that times a step: by so much integrals differ */

/* When steps ask: at first + k step. */
typedef struct {
  PetscReal first, step;
} Pace;

/* What is worst of an amplitude: a point, its value there and at the times around it, and the integral over three
 * steps around, exact and as steps take it. */
typedef struct {
  PetscReal worst, time, value, around[2], at[2], exact, taken;
} Missed;

/* A point with both neighbours closer than a step: a jump has one that is not. */
static void look_at(const Amplitude *a, PetscInt i, const Pace *pace, PetscBool integrates, PetscReal largest,
                    Missed *missed)
{
  const PetscReal h = pace->step, t = a->origin + a->time[i];
  const PetscReal before = pace->first + PetscFloorReal((t - pace->first) / h + 1e-9) * h;
  const PetscReal from = PetscMax(before - h, a->origin), to = before + 2 * h;
  Missed here = {.time = t, .value = a->value[i], .around = {before, before + h}};
  if (i == 0 || i == a->n - 1 || PetscMax(a->time[i] - a->time[i - 1], a->time[i + 1] - a->time[i]) >= h * (1 - 1e-6))
    return;
  for (int k = 0; k < 2; ++k) here.at[k] = amplitude_value(a, here.around[k], 1);
  here.exact = amplitude_integral(a, to, 1) - amplitude_integral(a, from, 1);
  here.taken = (before - from) * (amplitude_value(a, from, 1) + here.at[0]) / 2 + h * (here.at[0] + here.at[1]) / 2 +
               h * (here.at[1] + amplitude_value(a, to, 1)) / 2;
  const PetscReal high = PetscMax(here.at[0], here.at[1]), low = PetscMin(here.at[0], here.at[1]);
  here.worst = PetscMax(here.value - high, low - here.value) / (BEYOND * largest);
  if (integrates) here.worst = PetscMax(here.worst, PetscAbsReal(here.exact - here.taken) / (IMPULSE * largest * h));
  if (here.worst > PetscMax(1, missed->worst)) *missed = here;
}

/* integrates: its integral over time counts, and not only what it is at the end. */
static void advise(const Model *m, const Amplitude *a, const Pace *pace, PetscBool integrates, const char *path,
                   Diag *diag)
{
  PetscReal largest = 0, shortest = pace->step;
  Missed missed = {.worst = 0};
  if (a->since != m->c->stage) return; /* it was looked at when it began */
  for (PetscInt i = 0; i < a->n; ++i) largest = PetscMax(largest, PetscAbsReal(a->value[i]));
  for (PetscInt i = 1; i < a->n; ++i) shortest = PetscMin(shortest, a->time[i] - a->time[i - 1]);
  for (PetscInt i = 0; i < a->n && largest > 0; ++i)
    if (a->origin + a->time[i] > m->c->start && a->origin + a->time[i] < m->c->analysis.end)
      look_at(a, i, pace, integrates, largest, &missed);
  if (!(missed.worst > 1)) return;
  if (integrates)
    diag_warning(
      diag, path,
      "around t = %g s, where its points lie closer together than the step of %.3g s, its integral is %.3g s, "
      "and steps take %.3g s for it",
      (double)missed.time, (double)pace->step, (double)missed.exact, (double)missed.taken);
  else
    diag_warning(diag, path,
                 "it goes to %g at t = %g s and back within a step of %.3g s: from %g to %g s, which is all that steps "
                 "see, it is %.3g and %.3g",
                 (double)missed.value, (double)missed.time, (double)pace->step, (double)missed.around[0],
                 (double)missed.around[1], (double)missed.at[0], (double)missed.at[1]);
  diag_hint(diag, "take steps of %.2g s or less, or %s whose points lie a step apart", (double)shortest,
            integrates ? "a pulse of the same integral" : "a motion");
}

/* Velocities are integrated, whatever they do within a step. */
static void advise_motion(const Model *m, const MotionSpec *motion, PetscReal step, const char *path, Diag *diag)
{
  const Pace ends = {.first = m->c->start, .step = step};
  if (motion->kind == MOTION_DISPLACEMENT && !motion->absent)
    advise(m, &motion->amplitude, &ends, PETSC_FALSE, path, diag);
}

static void advise_wall(const Model *m, PetscInt k, const Pace *forces, Diag *diag)
{
  const WallSpec *wall = m->c->walls + k;
  char path[96];
  for (PetscInt i = 0; i < wall->n_motions; ++i) {
    snprintf(path, sizeof path, "walls[%d].motion[%d].amplitude", (int)k, (int)i);
    advise_motion(m, wall->motions + i, forces->step, path, diag);
  }
  snprintf(path, sizeof path, "walls[%d].mass.amplitude", (int)k);
  if (wall->has_mass) advise(m, &wall->mass.amplitude, forces, PETSC_TRUE, path, diag);
}

PetscErrorCode AdvisePulses(const Model *m, Diag *diag)
{
  const Case *c = m->c;
  PetscReal step = c->analysis.step, critical, crossing, fastest;
  char path[96], load[64];

  PetscFunctionBeginUser;
  if (!m->scheme->inertia || !(step > 0)) PetscFunctionReturn(0);
  if (c->analysis.type == ANALYSIS_EXPLICIT) {
    PetscCall(ExplicitCritical(m, &critical, &crossing, &fastest));
    step /= PetscCeilReal(step / (case_courant(&c->analysis) * critical)); /* equal substeps */
  }
  const Pace forces = {.first = c->start + (m->scheme->middle ? step / 2 : 0), .step = step};
  advise(m, &c->gravity_amplitude, &forces, PETSC_TRUE, "loads.gravity_amplitude", diag);
  for (PetscInt k = 0; k < c->n_loads; ++k) {
    snprintf(path, sizeof path, "%s.amplitude", case_load_path(c, k, load));
    advise(m, &c->loads[k].amplitude, &forces, PETSC_TRUE, path, diag);
  }
  for (PetscInt k = 0; k < c->n_boundary; ++k) {
    snprintf(path, sizeof path, "boundary[%d].amplitude", (int)k);
    advise_motion(m, c->boundary + k, step, path, diag);
  }
  for (PetscInt k = 0; k < c->n_walls; ++k) advise_wall(m, k, &forces, diag);
  PetscFunctionReturn(0);
}
