/* How fast any measure changes in a window: the slope of the line through its values by least
 * squares; and their mean.
 *
 * A difference of two values would be all noise. Between two values the measure is taken to go along a line, and what
 * is the mean over a step to be it all the step; ends of the window cut both. So means are exact for what is linear in
 * time, those of forces are the impulse over the window's length, and short steps do not count more than long ones. */
#include "model/measure/measure.h"
#include <string.h>

PetscErrorCode MemoryAppend(MeasureMemory *memory, PetscInt n, const PetscReal *numbers)
{
  PetscFunctionBeginUser;
  if (memory->n_list + n > memory->capacity) {
    memory->capacity = 2 * (memory->n_list + n);
    PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)memory->capacity, &memory->list));
  }
  PetscCall(PetscArraycpy(memory->list + memory->n_list, numbers, n));
  memory->n_list += n;
  PetscFunctionReturn(0);
}

/* Numbers kept of a value: since when and until when it is meant, s, and it. */
#define OF_VALUE 3

static PetscBool slides(const MeasureSpec *s) { return s->window[0] == s->window[1]; }

/* The window that ends at or before t. */
static void window_of(const MeasureSpec *s, PetscReal t, PetscReal window[2])
{
  window[0] = slides(s) ? t - s->window[0] : s->window[0];
  window[1] = slides(s) ? t : s->window[1];
}

/* Forget what ends before the window; but the last of it is one end of the line that enters it. */
static void forget(const MeasureSpec *s, MeasureMemory *memory)
{
  PetscReal window[2];
  PetscInt old = 0;
  window_of(s, memory->list[memory->n_list - 2], window);
  while (old + OF_VALUE < memory->n_list && memory->list[old + OF_VALUE + 1] <= window[0]) old += OF_VALUE;
  memory->n_list -= old;
  if (old) memmove(memory->list, memory->list + old, sizeof(PetscReal) * (size_t)memory->n_list);
}

PetscErrorCode WindowRemember(Model *m, const MeasureSpec *s, MeasureMemory *memory, PetscReal dt, PetscReal value)
{
  const PetscReal t = case_time(m->c, m->time); /* what a search tries takes none */
  PetscBool over_step;

  PetscFunctionBeginUser;
  if (PetscIsNanReal(value)) PetscFunctionReturn(0);
  if (!slides(s) && memory->n_list && memory->list[memory->n_list - 2] >= s->window[1]) PetscFunctionReturn(0);
  PetscCall(MeasureOverStep(m->c, (PetscInt)(s - m->c->measures), &over_step));
  if (over_step && !dt) PetscFunctionReturn(0);
  PetscCall(MemoryAppend(memory, OF_VALUE, (PetscReal[]){over_step ? t - dt : t, t, value}));
  forget(s, memory);
  PetscFunctionReturn(0);
}

PetscBool window_list_fits(PetscInt64 length) { return (PetscBool)(length >= 0 && length % OF_VALUE == 0); }

typedef struct {
  PetscReal weight, time, value;
} Sample;

/* What value i says of the window, at two times: a mean over a step that of its middle, for the share of the step in
 * the window; a value at an instant the line from the one before it, cut by the window. */
static PetscBool sample(const MeasureMemory *memory, PetscInt i, const PetscReal window[2], Sample of[2])
{
  const PetscReal *at = memory->list + OF_VALUE * i, *last = i ? at - OF_VALUE : at;
  const PetscBool over_step = at[0] < at[1];
  const PetscReal from = over_step ? at[0] : last[1], to = at[1];
  const PetscReal cut[2] = {PetscMax(from, window[0]), PetscMin(to, window[1])};
  if (cut[1] - cut[0] <= 1e-12 * (window[1] - window[0])) return PETSC_FALSE;
  for (int k = 0; k < 2; ++k) {
    const PetscReal time = over_step ? (from + to) / 2 : cut[k];
    const PetscReal value = over_step ? at[2] : last[2] + (time - from) / (to - from) * (at[2] - last[2]);
    of[k] = (Sample){.weight = (cut[1] - cut[0]) / 2, .time = time, .value = value};
  }
  return PETSC_TRUE;
}

PetscReal window_value(const MeasureSpec *s, const MeasureMemory *memory)
{
  const PetscInt n = memory->n_list / OF_VALUE;
  PetscReal sum = 0, time = 0, value = 0, up = 0, square = 0, window[2] = {0, 0};
  Sample of[2];
  if (n) window_of(s, memory->list[memory->n_list - 2], window);
  for (PetscInt i = 0; i < n; ++i)
    for (int k = 0; k < 2 && sample(memory, i, window, of); ++k)
      sum += of[k].weight, time += of[k].weight * of[k].time, value += of[k].weight * of[k].value;
  if (s->has_mean) return sum > 0 ? value / sum : NAN; /* one value stands for no time */
  for (PetscInt i = 0; i < n; ++i)
    for (int k = 0; k < 2 && sample(memory, i, window, of); ++k) {
      const PetscReal dt = of[k].time - time / sum;
      up += of[k].weight * dt * (of[k].value - value / sum), square += of[k].weight * dt * dt;
    }
  /* one value has no slope, and neither has one step */
  return square > 1e-18 * sum * PetscSqr(window[1] - window[0]) ? up / square : NAN;
}

const char *rate_unit(const char *unit)
{
  static const char *const rates[][2] = {
    {"m", "m/s"},      {"m/s", "m/s2"},     {"kg", "kg/s"},   {"m3", "m3/s"},   {"J", "W"},   {"kg m/s", "N"},
    {"kg m2/s", "Nm"}, {"rad/s", "rad/s2"}, {"N", "N/s"},     {"deg", "deg/s"}, {"s", "s/s"}, {"", "1/s"},
    {"Pa", "Pa/s"},    {"m2", "m2/s"},      {"rad", "rad/s"}, {"N m", "N m/s"},
  };
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(rates); ++k)
    if (!strcmp(rates[k][0], unit)) return rates[k][1];
  return "per s";
}
