/* How fast any measure changes in a window: the slope of the line through its values by least
 * squares; and their mean.
 *
 * A difference of two values would be all noise. A value counts with the time that it stands for,
 * half of the steps before and behind it, so that short steps do not count more than long ones. The
 * memory holds time and value in turn. */
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

static PetscBool slides(const MeasureSpec *s) { return s->window[0] == s->window[1]; }

/* Forget what is older than a sliding window. */
static void forget(const MeasureSpec *s, MeasureMemory *memory)
{
  const PetscReal from = memory->list[memory->n_list - 2] - s->window[0] * (1 + 1e-9);
  PetscInt old = 0;
  while (memory->list[old] < from) old += 2;
  memory->n_list -= old;
  if (old) memmove(memory->list, memory->list + old, sizeof(PetscReal) * (size_t)memory->n_list);
}

PetscErrorCode WindowRemember(Model *m, const MeasureSpec *s, MeasureMemory *memory, PetscReal value)
{
  const PetscReal slack = 1e-9 * s->window[1], t = m->time;

  PetscFunctionBeginUser;
  if (PetscIsNanReal(value)) PetscFunctionReturn(0);
  if (!slides(s) && (t < s->window[0] - slack || t > s->window[1] + slack)) PetscFunctionReturn(0);
  PetscCall(MemoryAppend(memory, 2, (PetscReal[]){t, value}));
  if (slides(s)) forget(s, memory);
  PetscFunctionReturn(0);
}

/* Weight of value i of n: the time that it stands for. */
static PetscReal weight(const PetscReal *list, PetscInt i, PetscInt n)
{
  return list[2 * PetscMin(i + 1, n - 1)] - list[2 * PetscMax(i - 1, 0)];
}

PetscReal window_value(const MeasureSpec *s, const MeasureMemory *memory)
{
  const PetscInt n = memory->n_list / 2;
  const PetscReal *list = memory->list;
  PetscReal sum = 0, time = 0, value = 0, up = 0, square = 0;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal w = weight(list, i, n);
    sum += w, time += w * list[2 * i], value += w * list[2 * i + 1];
  }
  if (s->has_mean) return sum > 0 ? value / sum : NAN; /* one value stands for no time */
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal w = weight(list, i, n), dt = list[2 * i] - time / sum;
    up += w * dt * (list[2 * i + 1] - value / sum), square += w * dt * dt;
  }
  return square > 0 ? up / square : NAN; /* one value has no slope */
}

const char *rate_unit(const char *unit)
{
  static const char *const rates[][2] = {
    {"m", "m/s"},      {"m/s", "m/s2"},     {"kg", "kg/s"}, {"m3", "m3/s"},   {"J", "W"},   {"kg m/s", "N"},
    {"kg m2/s", "Nm"}, {"rad/s", "rad/s2"}, {"N", "N/s"},   {"deg", "deg/s"}, {"s", "s/s"}, {"", "1/s"},
  };
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(rates); ++k)
    if (!strcmp(rates[k][0], unit)) return rates[k][1];
  return "per s";
}
