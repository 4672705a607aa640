#include <string.h>
#include "case/case.h"

/* t in s since the table began. */
static PetscInt point_behind(const Amplitude *a, PetscReal t)
{
  PetscInt low = 0, high = a->n;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (t < a->time[middle]) high = middle;
    else low = middle + 1;
  }
  return low;
}

PetscInt amplitude_behind(const Amplitude *a, PetscReal t) { return point_behind(a, t - a->origin); }

PetscReal amplitude_value(const Amplitude *a, PetscReal t, PetscReal fallback)
{
  if (a->n == 0) return fallback;
  t -= a->origin;
  if (t <= a->time[0]) return a->value[0];
  if (t >= a->time[a->n - 1]) return a->value[a->n - 1];
  const PetscInt high = point_behind(a, t), low = high - 1;
  if (a->value[low] == a->value[high]) return a->value[low]; /* what rounding would not leave as it is */
  const PetscReal s = (t - a->time[low]) / (a->time[high] - a->time[low]);
  return (1 - s) * a->value[low] + s * a->value[high];
}

PetscReal amplitude_size(const Amplitude *a)
{
  PetscReal largest = 0;
  for (PetscInt i = 0; i < a->n; ++i) largest = PetscMax(largest, PetscAbsReal(a->value[i]));
  return largest;
}

PetscBool case_raises(const Case *c, const Amplitude *amplitude)
{
  const LimitSpec *limit = &c->analysis.limit;
  switch (limit->kind) {
  case RAISE_GRAVITY: return amplitude == &c->gravity_amplitude;
  case RAISE_LOAD: return amplitude == &c->loads[limit->index].amplitude;
  case RAISE_BOUNDARY: return amplitude == &c->boundary[limit->index].amplitude;
  case RAISE_WALL: return amplitude == &case_raised_motion(c)->amplitude;
  case RAISE_NOTHING: break;
  }
  return PETSC_FALSE;
}

PetscBool case_raises_displacement(const Case *c)
{
  return c->analysis.limit.kind == RAISE_BOUNDARY || c->analysis.limit.kind == RAISE_WALL;
}

const MotionSpec *case_raised_motion(const Case *c)
{
  const LimitSpec *limit = &c->analysis.limit;
  return limit->kind == RAISE_WALL ? c->walls[limit->index].motions : &c->boundary[limit->index];
}

/* Loads of statics do, without a word of the user. What an earlier stage has brought is there, and stress that carries
 * the weight means that the weight is there. */
static PetscBool grows_by_itself(const Case *c, const Amplitude *amplitude)
{
  if (amplitude == &c->gravity_amplitude && case_starts_with_gravity(c)) return PETSC_FALSE;
  return (PetscBool)(case_is_static(&c->analysis) && amplitude->since == c->stage);
}

PetscReal case_factor(const Case *c, const Amplitude *amplitude, PetscReal t)
{
  const PetscBool grows = grows_by_itself(c, amplitude);
  /* what is sought when all loads are on: time goes on then, and they stay but for what is raised */
  if (case_raises(c, amplitude)) return PetscMax(0, t - c->analysis.end);
  t = case_time(c, t);
  return amplitude_value(amplitude, t, grows ? (t - c->start) / (c->analysis.end - c->start) : 1);
}

PetscErrorCode LoadPlaceValue(void *context, const char *name, PetscBool *known, PetscReal *value)
{
  const LoadPlace *place = context;
  const char axis = name[1] ? 0 : name[0];

  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  if (axis >= 'x' && axis < 'x' + place->dim) *value = place->x[axis - 'x'];
  else if (axis >= 'X' && axis < 'X' + place->dim) *value = place->X[axis - 'X'];
  else if (axis == 't') *value = place->t;
  else *known = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscReal case_material_factor(const Case *c, PetscInt i, const char *parameter, PetscReal t)
{
  const MaterialSpec *m = &c->materials[i];
  t = case_time(c, t);
  for (PetscInt k = 0; k < m->n_amplitudes; ++k)
    if (!strcmp(m->amplitudes[k].name, parameter)) return amplitude_value(&m->amplitudes[k].amplitude, t, 1);
  return 1;
}

/* Integral from the first entry's time to t, for any t; both count from the amplitude's origin. */
static PetscReal integral_from_first(const Amplitude *a, PetscReal t)
{
  PetscReal sum = 0;
  if (t <= a->time[0]) return (t - a->time[0]) * a->value[0];
  for (PetscInt i = 1; i < a->n; ++i) {
    if (t <= a->time[i])
      return sum + 0.5 * (t - a->time[i - 1]) * (a->value[i - 1] + amplitude_value(a, t + a->origin, 0));
    sum += 0.5 * (a->time[i] - a->time[i - 1]) * (a->value[i - 1] + a->value[i]);
  }
  return sum + (t - a->time[a->n - 1]) * a->value[a->n - 1];
}

PetscReal amplitude_integral(const Amplitude *a, PetscReal t, PetscReal fallback)
{
  t -= a->origin;
  return a->n == 0 ? fallback * t : integral_from_first(a, t) - integral_from_first(a, 0);
}
