/* What an amplitude does between the ends of steps, where nobody looks: said before the first step. */
#include "model/explicit/critical.h"
#include "model/model_private.h"

#define BEYOND 0.1   /* of the largest value: by so much a force leaves what steps see around it */
#define PASSED 0.05  /* the same of what is asked for at the ends of steps */
#define IMPULSE 0.25 /* of that times a step: by so much integrals differ */
#define SHARE 0.05   /* of the integral of its size: by so much that over the run does */

/* Where warnings go to, and how fast the run is. */
typedef struct {
  const Model *m;
  PetscReal substep; /* of forces, s */
  PetscBool grows;   /* then steps longer than `step` end where a table turns */
  Diag *diag;
} Advice;

/* Both neighbours of the point closer than a step: a jump has one that is not. */
static PetscBool is_narrow(const Amplitude *a, PetscInt i, PetscReal step)
{
  return (PetscBool)(PetscMax(a->time[i] - a->time[i - 1], a->time[i + 1] - a->time[i]) < step * (1 - 1e-6));
}

/* An integral over some time, and that of the size of what is integrated. */
typedef struct {
  PetscReal sum, size;
} Integral;

static Integral integral(const Amplitude *a, PetscReal from, PetscReal to)
{
  Integral all = {0, 0};
  PetscInt low = amplitude_behind(a, from);
  for (PetscReal t = from, next; t < to; t = next, ++low) {
    next = low < a->n ? PetscMin(to, a->origin + a->time[low]) : to;
    const PetscReal f = amplitude_value(a, t, 1), g = amplitude_value(a, next, 1), h = next - t;
    all.sum += h * (f + g) / 2;
    all.size += f * g >= 0 ? h * PetscAbsReal(f + g) / 2 : h * (f * f + g * g) / (2 * PetscAbsReal(g - f));
  }
  return all;
}

/* Is the step that begins at t of `step`, and goes over whatever turns within it? So are the first two of a run, those
 * in which a table begins to change, and all while a load goes by a formula of t. */
static PetscBool has_not_grown(const Advice *advice, PetscReal t)
{
  const Case *c = advice->m->c;
  const PetscReal h = advice->substep;
  if (!advice->grows || case_has_timed_factor(c)) return PETSC_TRUE;
  return (PetscBool)(t < c->start + 1.5 * h || case_begins_within(c, t, t + (1 - 1e-9) * h));
}

/* The end of a step that begins at t. Steps that have grown end where a table turns, or go over it by a part of `step`
 * but for a peak: on the way there they may be shorter, where nothing turns. */
static PetscReal step_from(const Advice *advice, PetscReal t)
{
  const Case *c = advice->m->c;
  const PetscReal way = has_not_grown(advice, t) ? 0 : case_corner_after(c, t) - t;
  const PetscReal to = PetscMin(t + PetscMax(way, advice->substep), c->analysis.end);
  return advice->grows ? case_peak_within(c, t, to) : to;
}

/* The start of the step in which time t lies. */
static PetscReal step_before(const Advice *advice, PetscReal t)
{
  const PetscReal start = advice->m->c->start, h = advice->substep;
  return start + PetscFloorReal((t - start) / h + 1e-9) * h;
}

/* What a step takes for the integral of the table. */
static PetscReal taken(const Advice *advice, const Amplitude *a, PetscReal t, PetscReal to)
{
  if (advice->m->scheme->middle) return (to - t) * amplitude_value(a, (t + to) / 2, 1);
  return (to - t) * (amplitude_value(a, t, 1) + amplitude_value(a, to, 1)) / 2;
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
    sum += taken(advice, a, t, to) - integral(a, t, to).sum;
  }
  return sum;
}

/* Is its integral over the run off, and by more than twice what `local` is? Then that is told. */
static PetscBool advise_sum(const Advice *advice, const Amplitude *a, PetscReal local, const char *path)
{
  const Case *c = advice->m->c;
  const Integral all = integral(a, c->start, c->analysis.end);
  const PetscReal more = excess(advice, a);
  if (!(PetscAbsReal(more) > PetscMax(SHARE * all.size, 2 * local))) return PETSC_FALSE;
  diag_warning(advice->diag, path, "its integral over the run is %.3g s, and steps of %.3g s take %.3g s for it",
               (double)all.sum, (double)advice->substep, (double)(all.sum + more));
  diag_hint(advice->diag, "take shorter steps, or a table whose points lie where steps end");
  return PETSC_TRUE;
}

/* The ends of three steps in a row: a time lies in the second. */
typedef struct {
  PetscReal end[4];
} Around;

/* Of equal steps, at first + k step. */
static Around equal_around(PetscReal t, PetscReal first, PetscReal step)
{
  const PetscReal before = first + PetscFloorReal((t - first) / step + 1e-9) * step;
  return (Around){{before - step, before, before + step, before + 2 * step}};
}

/* Of steps that may grow: on from an earlier time. */
static void go_on(const Advice *advice, PetscReal t, Around *around)
{
  PetscReal *end = around->end;
  while (end[2] <= t && end[2] < end[3]) {
    for (int k = 0; k < 3; ++k) end[k] = end[k + 1];
    end[3] = step_from(advice, end[2]);
  }
}

/* What is worst of an amplitude: a point, its value there and at the times around it, and the integral over three
 * steps around, exact and as steps take it. */
typedef struct {
  PetscReal worst, time, value, around[2], at[2], exact, taken;
} Missed;

/* A value there, and those at two times around it, which are all that steps see. */
static Missed value_at(const Amplitude *a, PetscInt i, const PetscReal around[2], PetscReal allowed)
{
  Missed here = {.time = a->origin + a->time[i], .value = a->value[i], .around = {around[0], around[1]}};
  for (int k = 0; k < 2; ++k) here.at[k] = amplitude_value(a, around[k], 1);
  const PetscReal high = PetscMax(here.at[0], here.at[1]), low = PetscMin(here.at[0], here.at[1]);
  here.worst = PetscMax(here.value - high, low - here.value) / allowed;
  return here;
}

/* When steps ask for a force around time t: at their ends or in their middle. */
static void asked_around(const Advice *advice, PetscReal t, const Around *steps, PetscReal asked[2])
{
  const PetscReal *end = steps->end;
  const int first = advice->m->scheme->middle && t < (end[1] + end[2]) / 2 ? 0 : 1;
  for (int k = 0; k < 2; ++k)
    asked[k] = advice->m->scheme->middle ? (end[first + k] + end[first + k + 1]) / 2 : end[first + k];
}

/* A step longer than `step` has no corner inside: of it so much is enough. */
static Around shortened(const Advice *advice, const Around *around)
{
  Around s = *around;
  s.end[0] = PetscMax(s.end[0], s.end[1] - advice->substep);
  s.end[3] = PetscMin(s.end[3], s.end[2] + advice->substep);
  return s;
}

/* Integrals count where they differ by more than a digit or two. */
static Missed integral_at(const Advice *advice, const Amplitude *a, PetscInt i, const Around *steps, PetscReal largest)
{
  const Around around = shortened(advice, steps);
  const PetscReal from = PetscMax(around.end[0], advice->m->c->start);
  const Integral exact = integral(a, from, around.end[3]);
  PetscReal asked[2];
  asked_around(advice, a->origin + a->time[i], &around, asked);
  Missed here = value_at(a, i, asked, BEYOND * largest);
  here.exact = exact.sum;
  for (int k = 0; k < 3; ++k) here.taken += taken(advice, a, PetscMax(from, around.end[k]), around.end[k + 1]);
  const PetscReal error = PetscAbsReal(here.exact - here.taken);
  here.worst = PetscMax(here.worst, error / (IMPULSE * largest * advice->substep));
  if (error <= SHARE * exact.size) here.worst = 0;
  return here;
}

static PetscReal shortest_piece(const Amplitude *a)
{
  PetscReal shortest = PETSC_MAX_REAL;
  for (PetscInt i = 1; i < a->n; ++i) shortest = PetscMin(shortest, a->time[i] - a->time[i - 1]);
  return shortest;
}

static void hint(const Advice *advice, TableUse use, PetscReal shortest)
{
  const AnalysisSpec *analysis = &advice->m->c->analysis;
  const PetscBool integrates = (PetscBool)!case_counts_at_ends(analysis, use);
  const char *other = integrates ? "a pulse of the same integral" : use == TABLE_PLACE ? "a motion" : "a table";
  if (integrates || analysis->type == ANALYSIS_EXPLICIT)
    diag_hint(advice->diag, "take steps of %.2g s or less, or %s whose points lie a step apart", (double)shortest,
              other);
  else
    diag_hint(advice->diag,
              "take steps that end at its points, as those do that may grow (`analysis: {largest: ...}`, more than "
              "`step`), or %s whose points lie a step apart",
              other);
}

static void tell(const Advice *advice, const Missed *missed, PetscReal step, PetscBool integrates, const char *path)
{
  if (integrates)
    diag_warning(
      advice->diag, path,
      "around t = %g s, where its points lie closer together than the step of %.3g s, its integral is %.3g s, "
      "and steps take %.3g s for it",
      (double)missed->time, (double)step, (double)missed->exact, (double)missed->taken);
  else
    diag_warning(advice->diag, path,
                 "it goes to %g at t = %g s and back within a step of %.3g s: from %g to %g s, which is all that steps "
                 "see, it is %.3g and %.3g",
                 (double)missed->value, (double)missed->time, (double)step, (double)missed->around[0],
                 (double)missed->around[1], (double)missed->at[0], (double)missed->at[1]);
}

/* The worst of the points that lie in the run: of integrals those alone that lie close together. */
static Missed worst_of(const Advice *advice, const Amplitude *a, PetscBool integrates, PetscReal step)
{
  const Case *c = advice->m->c;
  const PetscReal largest = amplitude_size(a);
  PetscReal to = advice->grows ? step_from(advice, c->start) : 0;
  Around around = {{c->start, c->start, to, advice->grows ? step_from(advice, to) : 0}};
  Missed worst = {.worst = 0};
  for (PetscInt i = 1; i < a->n - 1 && largest > 0; ++i) {
    const PetscReal t = a->origin + a->time[i];
    if (t <= c->start || t >= c->analysis.end || (integrates && !is_narrow(a, i, step))) continue;
    if (advice->grows) go_on(advice, t, &around);
    else around = equal_around(t, c->start, step);
    const Missed here =
      integrates ? integral_at(advice, a, i, &around, largest) : value_at(a, i, around.end + 1, PASSED * largest);
    if (here.worst > worst.worst) worst = here;
  }
  return worst;
}

/* Forces of dynamics act by their integral over time, in statics by what they are at the end of a step, as places
 * and parameters do, at whose peaks steps that may grow end. Velocities are integrated, whatever they do within a
 * step. */
static void advise(void *context, const Amplitude *a, TableUse use, const char *path)
{
  const Advice *advice = context;
  const Case *c = advice->m->c;
  const PetscBool integrates = (PetscBool)!case_counts_at_ends(&c->analysis, use);
  const PetscReal step = integrates ? advice->substep : c->analysis.step;
  if (a->since != c->stage || use == TABLE_SPEED) return; /* it was looked at when it began */
  if (advice->grows && !integrates) return;
  const Missed worst = worst_of(advice, a, integrates, step);
  const PetscBool told = worst.worst > 1;
  if (integrates && advise_sum(advice, a, told ? PetscAbsReal(worst.exact - worst.taken) : 0, path)) return;
  if (!told) return;
  tell(advice, &worst, step, integrates, path);
  hint(advice, use, PetscMin(step, shortest_piece(a)));
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
