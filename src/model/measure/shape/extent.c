/* How far a body reaches, and when that last changed fast. */
#include "model/measure/measure.h"

#define EXTENT_PARTS 64

/* Mass of the body in equal parts of [low, high] along an axis (sign -1: turned round); what is
 * less than `low` counts to the first, what is more than `high` to none. */
static PetscErrorCode MassAlong(const Model *m, const MeasureSpec *s, PetscReal sign, PetscReal low, PetscReal high,
                                PetscReal mass[EXTENT_PARTS])
{
  const PetscInt body = measure_body(m, s);
  PetscReal local[EXTENT_PARTS] = {0};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal at = (sign * point_real(m->points, POINT_X, p)[s->component] - low) / (high - low) * EXTENT_PARTS;
    if (!measure_takes_point(m, body, p) || at > EXTENT_PARTS) continue;
    local[PetscMin(EXTENT_PARTS - 1, (int)PetscMax(0, at))] += m->points->real[POINT_MASS][p];
  }
  PetscCall(MPIU_Allreduce(local, mass, EXTENT_PARTS, MPIU_REAL, MPIU_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* The place within which all but a share of the mass lies: as good as the farthest point for a
 * front, without its chance. Each round finds the part that holds it. */
static PetscErrorCode InnerExtent(const Model *m, const MeasureSpec *s, PetscReal sign, PetscReal *farthest)
{
  PetscReal low = sign > 0 ? m->grid->min[s->component] : -m->grid->max[s->component], high = *farthest;
  PetscReal mass[EXTENT_PARTS], total = 0, outside = 0;

  PetscFunctionBeginUser;
  for (int round = 0; round < 6 && high > low; ++round) {
    const PetscReal part = (high - low) / EXTENT_PARTS;
    int k = EXTENT_PARTS - 1;
    PetscCall(MassAlong(m, s, sign, low, high, mass));
    for (int i = 0; i < EXTENT_PARTS && !round; ++i) total += mass[i];
    while (k > 0 && outside + mass[k] <= s->beyond * total * (1 + 1e-12)) outside += mass[k--];
    high = low + (PetscReal)(k + 1) * part;
    low += (PetscReal)k * part;
  }
  *farthest = high;
  PetscFunctionReturn(0);
}

PetscErrorCode MeasureExtent(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const PetscInt body = measure_body(m, s);
  const PetscReal sign = s->maximum ? 1 : -1;
  PetscReal local = -PETSC_MAX_REAL, largest;

  (void)index;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (!measure_takes_point(m, body, p)) continue;
    local = PetscMax(local, sign * point_real(m->points, POINT_X, p)[s->component]);
  }
  PetscCall(MPIU_Allreduce(&local, &largest, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (s->beyond > 0 && largest > -PETSC_MAX_REAL) PetscCall(InnerExtent(m, s, sign, &largest));
  *value = largest > -PETSC_MAX_REAL ? sign * largest : NAN; /* no point, no place */
  PetscFunctionReturn(0);
}

/* What a run-out time keeps: the position of the front, counted outwards, m; the last time at which
 * it was fast, s. */
enum { FRONT, MOVED };

static PetscErrorCode RememberFront(Model *m, const MeasureSpec *s, PetscReal dt, PetscReal kept[MEASURE_KEPT])
{
  PetscReal front;

  PetscFunctionBeginUser;
  if (s->front == FRONT_SURFACE) PetscCall(MeasureSurface(m, s, 0, &front));
  else PetscCall(MeasureExtent(m, s, 0, &front));
  if (!s->maximum) front = -front;
  if (front - kept[FRONT] > s->speed * dt) kept[MOVED] = m->time;
  kept[FRONT] = front;
  PetscFunctionReturn(0);
}

static PetscErrorCode RunOutTime(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const PetscReal *kept = m->memory[index].kept;

  (void)s;
  PetscFunctionBeginUser;
  *value = PetscIsNanReal(kept[FRONT]) ? NAN : kept[MOVED];
  PetscFunctionReturn(0);
}

const Measure measure_extent = {
  .key = "extent",
  .takes = MEASURE_EXTENT,
  .number = {.unit = "m", .help = "largest or smallest coordinate of a body: {max: x}", .value = MeasureExtent}};
const Measure measure_run_out_time = {
  .key = "run_out_time",
  .takes = MEASURE_FRONT,
  .number = {.unit = "s", .help = "when a body's front came to rest: {max: x, speed: 0.01}", .value = RunOutTime},
  .remember = RememberFront};
