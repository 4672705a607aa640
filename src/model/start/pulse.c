/* What an amplitude does between the ends of steps, where nobody looks: said before the first step. */
#include "model/explicit/critical.h"
#include "model/model_private.h"

#define BEYOND 0.1   /* of the largest value: by so much a point leaves what steps see around it */
#define IMPULSE 0.25 /* of that times a step: by so much integrals differ */
#define SHARE 0.05   /* of the integral of its size: by so much that over the run does */

/* When steps ask: at first + k step. */
typedef struct {
  PetscReal first, step;
} Pace;

/* Where warnings go to, and how fast the run is. */
typedef struct {
  const Model *m;
  PetscReal substep; /* of forces, s */
  PetscBool grows;   /* then steps longer than `step` end where a table turns */
  Diag *diag;
} Advice;

/* What is worst of an amplitude: a point, its value there and at the times around it, and the integral over three
 * steps around, exact and as steps take it. */
typedef struct {
  PetscReal worst, time, value, around[2], at[2], exact, taken;
} Missed;

/* Both neighbours of the point closer than a step: a jump has one that is not. */
static PetscBool is_narrow(const Amplitude *a, PetscInt i, PetscReal step)
{
  return (PetscBool)(PetscMax(a->time[i] - a->time[i - 1], a->time[i + 1] - a->time[i]) < step * (1 - 1e-6));
}

static void look_at(const Amplitude *a, PetscInt i, const Pace *pace, PetscBool integrates, PetscReal largest,
                    Missed *missed)
{
  const PetscReal h = pace->step, t = a->origin + a->time[i];
  const PetscReal before = pace->first + PetscFloorReal((t - pace->first) / h + 1e-9) * h;
  const PetscReal from = PetscMax(before - h, a->origin), to = before + 2 * h;
  Missed here = {.time = t, .value = a->value[i], .around = {before, before + h}};
  for (int k = 0; k < 2; ++k) here.at[k] = amplitude_value(a, here.around[k], 1);
  here.exact = amplitude_integral(a, to, 1) - amplitude_integral(a, from, 1);
  here.taken = (before - from) * (amplitude_value(a, from, 1) + here.at[0]) / 2 + h * (here.at[0] + here.at[1]) / 2 +
               h * (here.at[1] + amplitude_value(a, to, 1)) / 2;
  const PetscReal high = PetscMax(here.at[0], here.at[1]), low = PetscMin(here.at[0], here.at[1]);
  here.worst = PetscMax(here.value - high, low - here.value) / (BEYOND * largest);
  if (integrates) here.worst = PetscMax(here.worst, PetscAbsReal(here.exact - here.taken) / (IMPULSE * largest * h));
  if (here.worst > PetscMax(1, missed->worst)) *missed = here;
}

/* An integral over some time, and that of the size of what is integrated. */
typedef struct {
  PetscReal sum, size;
} Integral;

static Integral integral(const Amplitude *a, PetscReal from, PetscReal to)
{
  Integral all = {0, 0};
  PetscInt low = 0, high = a->n;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (a->origin + a->time[middle] > from) high = middle;
    else low = middle + 1;
  }
  for (PetscReal t = from, next; t < to; t = next, ++low) {
    next = low < a->n ? PetscMin(to, a->origin + a->time[low]) : to;
    const PetscReal f = amplitude_value(a, t, 1), g = amplitude_value(a, next, 1), h = next - t;
    all.sum += h * (f + g) / 2;
    all.size += f * g >= 0 ? h * PetscAbsReal(f + g) / 2 : h * (f * f + g * g) / (2 * PetscAbsReal(g - f));
  }
  return all;
}

/* The end of a step that begins at t. Steps that may grow end where a table turns, or go over it by a part of `step`:
 * on the way there they may be shorter, where nothing turns. */
static PetscReal step_from(const Advice *advice, PetscReal t)
{
  const Case *c = advice->m->c;
  const PetscReal way = advice->grows ? case_corner_after(c, t) - t : 0;
  return PetscMin(t + PetscMax(way, advice->substep), c->analysis.end);
}

/* The start of the step in which time t lies. */
static PetscReal step_before(const Advice *advice, PetscReal t)
{
  const PetscReal start = advice->m->c->start, h = advice->substep;
  return start + PetscFloorReal((t - start) / h + 1e-9) * h;
}

/* What steps take too much for the integral of the table: only those that go over a corner of it do. */
static PetscReal excess(const Advice *advice, const Amplitude *a)
{
  const PetscReal start = advice->m->c->start, end = advice->m->c->analysis.end;
  PetscReal sum = 0, to;
  PetscInt i = 0;
  for (PetscReal t = start; t < end; t = to) {
    while (i < a->n && a->origin + a->time[i] <= t) ++i;
    if (i == a->n) break;
    if (!advice->grows) t = PetscMax(t, step_before(advice, a->origin + a->time[i]));
    if (t >= end) break;
    to = step_from(advice, t);
    const PetscReal f = amplitude_value(a, t, 1), g = amplitude_value(a, to, 1);
    sum += (to - t) * (advice->m->scheme->middle ? amplitude_value(a, (t + to) / 2, 1) : (f + g) / 2);
    sum -= integral(a, t, to).sum;
  }
  return sum;
}

static void advise_sum(const Advice *advice, const Amplitude *a, const char *path)
{
  const Case *c = advice->m->c;
  const Integral all = integral(a, c->start, c->analysis.end);
  const PetscReal more = excess(advice, a);
  if (!(PetscAbsReal(more) > SHARE * all.size)) return;
  diag_warning(advice->diag, path, "its integral over the run is %.3g s, and steps of %.3g s take %.3g s for it",
               (double)all.sum, (double)advice->substep, (double)(all.sum + more));
  diag_hint(advice->diag, "take shorter steps, or a table whose points lie where steps end");
}

static const char *what_to_take(TableUse use, PetscBool integrates)
{
  return integrates ? "a pulse of the same integral" : use == TABLE_PLACE ? "a motion" : "a table";
}

static void tell(const Advice *advice, const Missed *missed, const Pace *pace, PetscBool integrates, const char *path)
{
  if (integrates)
    diag_warning(
      advice->diag, path,
      "around t = %g s, where its points lie closer together than the step of %.3g s, its integral is %.3g s, "
      "and steps take %.3g s for it",
      (double)missed->time, (double)pace->step, (double)missed->exact, (double)missed->taken);
  else
    diag_warning(advice->diag, path,
                 "it goes to %g at t = %g s and back within a step of %.3g s: from %g to %g s, which is all that steps "
                 "see, it is %.3g and %.3g",
                 (double)missed->value, (double)missed->time, (double)pace->step, (double)missed->around[0],
                 (double)missed->around[1], (double)missed->at[0], (double)missed->at[1]);
}

/* Forces of dynamics act by their integral over time, in statics by what they are at the end of a step, as places
 * and parameters do. Velocities are integrated, whatever they do within a step. */
static void advise(void *context, const Amplitude *a, TableUse use, const char *path)
{
  const Advice *advice = context;
  const Case *c = advice->m->c;
  const PetscBool integrates = (PetscBool)(use == TABLE_FORCE && advice->m->scheme->inertia);
  const PetscReal step = integrates ? advice->substep : c->analysis.step;
  const Pace pace = {.first = c->start + (integrates && advice->m->scheme->middle ? step / 2 : 0), .step = step};
  PetscReal largest = 0, shortest = pace.step;
  Missed missed = {.worst = 0};
  if (a->since != c->stage || use == TABLE_SPEED) return; /* it was looked at when it began */
  for (PetscInt i = 0; i < a->n; ++i) largest = PetscMax(largest, PetscAbsReal(a->value[i]));
  for (PetscInt i = 1; i < a->n; ++i) shortest = PetscMin(shortest, a->time[i] - a->time[i - 1]);
  for (PetscInt i = 1; i < a->n - 1 && largest > 0; ++i)
    if (a->origin + a->time[i] > c->start && a->origin + a->time[i] < c->analysis.end &&
        (is_narrow(a, i, pace.step) || !(integrates || advice->grows)))
      look_at(a, i, &pace, integrates, largest, &missed);
  if (missed.worst > 1) {
    tell(advice, &missed, &pace, integrates, path);
    diag_hint(advice->diag, "take steps of %.2g s or less, or %s whose points lie a step apart", (double)shortest,
              what_to_take(use, integrates));
  } else if (integrates) advise_sum(advice, a, path);
}

PetscErrorCode AdvisePulses(const Model *m, Diag *diag)
{
  const AnalysisSpec *a = &m->c->analysis;
  Advice advice = {.m = m, .substep = a->step, .grows = (PetscBool)(a->largest > (1 + 1e-9) * a->step), .diag = diag};
  PetscReal critical, crossing, fastest;

  PetscFunctionBeginUser;
  if (!(a->step > 0)) PetscFunctionReturn(0);
  if (a->type == ANALYSIS_EXPLICIT) {
    PetscCall(ExplicitCritical(m, &critical, &crossing, &fastest));
    advice.substep /= PetscCeilReal(a->step / (case_courant(a) * critical)); /* equal substeps */
    advice.grows = PETSC_FALSE;
  }
  case_visit_tables(m->c, advise, &advice);
  PetscFunctionReturn(0);
}
