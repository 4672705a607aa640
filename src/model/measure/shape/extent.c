/* How far a body reaches, and when that last changed fast. */
#include "model/measure/measure.h"

#define EXTENT_PARTS 64
/* Sums of masses of the same points are no farther apart than this part of them, in whatever order. */
#define NOTHING 1e-9

/* Points of a body: where they are along an axis, counted outwards, m, and their mass. */
typedef struct {
  PetscInt n;
  PetscReal *at, *mass;
} Places;

/* Now, or at the start. To be freed with PetscFree2. */
static PetscErrorCode FindPlaces(const Model *m, const MeasureSpec *s, PetscBool start, Places *places)
{
  const PetscInt body = measure_body(m, s), n = m->points->n;
  const PetscReal sign = s->maximum ? 1 : -1;

  PetscFunctionBeginUser;
  places->n = 0;
  PetscCall(PetscMalloc2(n, &places->at, n, &places->mass));
  for (PetscInt p = 0; p < n; ++p) {
    if (!measure_takes_point(m, body, p)) continue;
    const PetscReal way = start ? point_real(m->points, POINT_U, p)[s->component] : 0;
    places->at[places->n] = sign * (point_real(m->points, POINT_X, p)[s->component] - way);
    places->mass[places->n++] = m->points->real[POINT_MASS][p];
  }
  PetscFunctionReturn(0);
}

/* In which of equal parts of [low, high] a place lies. */
static int part_of(PetscReal low, PetscReal high, PetscReal at)
{
  const PetscReal part = (at - low) / (high - low) * EXTENT_PARTS;
  return PetscMin(EXTENT_PARTS - 1, (int)PetscMax(0, part));
}

static PetscErrorCode MassAlong(MPI_Comm comm, PetscReal low, PetscReal high, const Places *places,
                                PetscReal mass[EXTENT_PARTS])
{
  PetscReal local[EXTENT_PARTS] = {0};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < places->n; ++p) local[part_of(low, high, places->at[p])] += places->mass[p];
  PetscCall(MPIU_Allreduce(local, mass, EXTENT_PARTS, MPIU_REAL, MPIU_SUM, comm));
  PetscFunctionReturn(0);
}

/* Those of one part alone; [low, high] becomes what they take of it. */
static PetscErrorCode KeepPart(MPI_Comm comm, int part, Places *places, PetscReal *low, PetscReal *high)
{
  PetscReal local[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL}, ends[2]; /* less the lowest, and the highest */
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < places->n; ++p) {
    if (part >= 0 && part_of(*low, *high, places->at[p]) != part) continue;
    places->at[kept] = places->at[p];
    places->mass[kept++] = places->mass[p];
  }
  places->n = kept;
  for (PetscInt p = 0; p < kept; ++p) {
    local[0] = PetscMax(local[0], -places->at[p]);
    local[1] = PetscMax(local[1], places->at[p]);
  }
  PetscCall(MPIU_Allreduce(local, ends, 2, MPIU_REAL, MPIU_MAX, comm));
  *low = -ends[0];
  *high = ends[1];
  PetscFunctionReturn(0);
}

/* The place of the farthest point beyond which no more than a share of the mass lies: as good as the farthest of all
 * for a front, without its chance. Each round keeps the part that holds it, and points that round-off alone parts stay
 * together to the end. */
static PetscErrorCode InnerExtent(const Model *m, const MeasureSpec *s, Places *places, PetscReal *farthest)
{
  PetscReal mass[EXTENT_PARTS], total = 0, outside = 0, low = 0, high = 0;

  PetscFunctionBeginUser;
  PetscCall(KeepPart(m->comm, -1, places, &low, &high));
  for (int round = 0; round < 6 && high > low; ++round) {
    int k = EXTENT_PARTS - 1;
    PetscCall(MassAlong(m->comm, low, high, places, mass));
    for (int i = 0; i < EXTENT_PARTS && !round; ++i) total += mass[i];
    while (k > 0 && outside + mass[k] <= s->beyond * total * (1 + NOTHING)) outside += mass[k--];
    PetscCall(KeepPart(m->comm, k, places, &low, &high));
  }
  *farthest = high;
  PetscFunctionReturn(0);
}

/* The farthest place of the body now, or at the start, counted outwards; nan without a point. */
static PetscErrorCode Farthest(const Model *m, const MeasureSpec *s, PetscBool start, PetscReal *farthest)
{
  PetscReal local = -PETSC_MAX_REAL;
  Places places;

  PetscFunctionBeginUser;
  PetscCall(FindPlaces(m, s, start, &places));
  for (PetscInt p = 0; p < places.n; ++p) local = PetscMax(local, places.at[p]);
  PetscCall(MPIU_Allreduce(&local, farthest, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (*farthest == -PETSC_MAX_REAL) *farthest = NAN;
  else if (s->beyond > 0) PetscCall(InnerExtent(m, s, &places, farthest));
  PetscCall(PetscFree2(places.at, places.mass));
  PetscFunctionReturn(0);
}

PetscErrorCode MeasureExtent(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscReal now, start = 0;

  (void)index;
  PetscFunctionBeginUser;
  PetscCall(Farthest(m, s, PETSC_FALSE, &now));
  if (s->advance) PetscCall(Farthest(m, s, PETSC_TRUE, &start));
  *value = s->advance ? now - start : s->maximum ? now : -now;
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
  if (front - kept[FRONT] > s->speed * dt) kept[MOVED] = case_time(m->c, m->time);
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
