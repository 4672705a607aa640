/* Avalanches: a powder that creeps along with its container slides, and comes to rest again.
 *
 * What counts is the energy of motion relative to the container. An event begins when it exceeds a
 * low threshold, if it then reaches a high one before it falls back; it is over when it has stayed
 * below the low one, or below a small share of its own peak, for a while, and its end is when it
 * came there. In between gravity works on the relative motion, and every point is carried some way.
 * Where too little mass was carried far, single grains leapt: that is none. */
#include "case/motion.h"
#include "model/measure/measure.h"
#include "model/model_private.h"

/* What the list of the measure begins with; behind it rows of EVENT_N numbers. */
enum {
  STATE_PHASE, /* one of the phases below */
  STATE_CALM,  /* since when it has been calm, s; < 0: it is not */
  STATE_CREEP, /* the usual energy while nothing slides, J; < 0: not known yet */
  STATE_HIGH,  /* thresholds, J */
  STATE_LOW,
  STATE_POWER,    /* of gravity on the relative motion at the end of the last step, W */
  STATE_RELEASED, /* work of gravity on it since the beginning, J */
  STATE_EVENT     /* what would be its row now */
};
enum { QUIET, SLIDING, STIRRING }; /* STIRRING: more than the low threshold, so far */
enum {
  EVENT_START,
  EVENT_END,
  EVENT_SURFACE_BEFORE,
  EVENT_SURFACE_AFTER,
  EVENT_MASS_BEFORE,
  EVENT_MASS_AFTER,
  EVENT_MOVED,
  EVENT_RELEASED,
  EVENT_KINETIC,
  EVENT_N
};
#define STATE_N (STATE_EVENT + EVENT_N)

/* Of all points that count, at the end of a step. */
typedef struct {
  PetscReal relative, carried; /* kinetic energy relative to the container, and of moving with it, J */
  PetscReal power;             /* of gravity on the relative motion, W */
} Motion;

/* Of a step: its last part, over whose parabola velocities are those of its end. */
#define INSTANT (1. / 16)

/* Velocity of the container where the point is, at the end of the step, as nodes that are held have it. */
static void container_velocity(const Model *m, const MeasureSpec *s, PetscInt p, PetscReal dt, PetscReal v[3])
{
  const MotionSpec *container = &m->c->boundary[s->avalanche.container];
  const PetscReal *x = point_real(m->points, POINT_X, p), part = INSTANT * dt, begin = m->time - part;
  for (PetscInt d = 0; d < m->dim; ++d) v[d] = 0;
  for (PetscInt d = 0; s->avalanche.has_container && dt > 0 && d < m->dim; ++d)
    v[d] = (3 * motion_increment(m->c, container, x, d, begin, m->time) -
            4 * motion_increment(m->c, container, x, d, begin, begin + part / 2)) /
           part;
}

/* Collective. carry >= 0: what the points go in the step relative to the container is added to this
 * component of POINT_CARRIED. */
static PetscErrorCode FindMotion(Model *m, const MeasureSpec *s, PetscReal dt, PetscInt carry, Motion *motion)
{
  const PetscInt body = measure_body(m, s);
  PetscReal g[3], sum[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  gravity_at(m->c, m->time, g);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal mass = measure_share(m, s, body, p) * m->points->real[POINT_MASS][p];
    const PetscReal *v = point_real(m->points, POINT_V, p);
    PetscReal with[3], square = 0;
    container_velocity(m, s, p, dt, with);
    for (PetscInt d = 0; d < m->dim; ++d) {
      square += PetscSqr(v[d] - with[d]);
      sum[1] += 0.5 * mass * PetscSqr(with[d]);
      sum[2] += mass * g[d] * (v[d] - with[d]);
    }
    sum[0] += 0.5 * mass * square;
    if (carry >= 0) point_real(m->points, POINT_CARRIED, p)[carry] += dt * PetscSqrtReal(square);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  *motion = (Motion){sum[0], sum[1], sum[2]};
  PetscFunctionReturn(0);
}

/* Which component of POINT_CARRIED is this measure's? */
static PetscInt carried_component(const Model *m, const MeasureSpec *s)
{
  PetscInt component = 0;
  for (const MeasureSpec *other = m->c->measures; other < s; ++other)
    component += measure_find(other->kind)->events != NULL;
  return component;
}

/* Collective. Inclinations of the surface and of the centre of mass about the middle of a drum, deg;
 * nan where there is none. */
static PetscErrorCode Angles(const Model *m, const MeasureSpec *s, PetscReal *surface, PetscReal *mass)
{
  const MotionSpec *container = s->avalanche.has_container ? &m->c->boundary[s->avalanche.container] : NULL;
  MeasureSpec in_container = *s;
  PetscReal deviation;

  PetscFunctionBeginUser;
  *surface = *mass = NAN;
  if (m->dim == 3) PetscFunctionReturn(0);
  if (!s->has_about && container && container->kind == MOTION_ROTATION) {
    in_container.has_about = PETSC_TRUE;
    PetscCall(PetscArraycpy(in_container.about, container->centre, 3));
  }
  PetscCall(SurfaceFit(m, &in_container, surface, &deviation));
  if (in_container.has_about) PetscCall(MassAngle(m, &in_container, mass));
  *mass *= 180 / PETSC_PI;
  PetscFunctionReturn(0);
}

static PetscErrorCode Begin(Model *m, const MeasureSpec *s, const Motion *motion, PetscReal *state)
{
  const PetscInt component = carried_component(m, s);

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(state + STATE_EVENT, EVENT_N));
  for (PetscInt p = 0; p < m->points->n; ++p) point_real(m->points, POINT_CARRIED, p)[component] = 0;
  state[STATE_PHASE] = STIRRING;
  state[STATE_CALM] = -1;
  state[STATE_POWER] = motion->power;
  state[STATE_RELEASED] = 0;
  state[STATE_EVENT + EVENT_START] = m->time;
  state[STATE_EVENT + EVENT_KINETIC] = motion->relative;
  PetscCall(Angles(m, s, state + STATE_EVENT + EVENT_SURFACE_BEFORE, state + STATE_EVENT + EVENT_MASS_BEFORE));
  PetscFunctionReturn(0);
}

/* Collective. Mass that was carried so far that it has taken part, kg. */
static PetscErrorCode MassMoved(const Model *m, const MeasureSpec *s, PetscReal *moved)
{
  const PetscReal least = s->avalanche.carried > 0 ? s->avalanche.carried : m->grid->smallest;
  const PetscInt body = measure_body(m, s), component = carried_component(m, s);
  PetscReal sum = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p)
    if (point_real(m->points, POINT_CARRIED, p)[component] >= least)
      sum += measure_share(m, s, body, p) * m->points->real[POINT_MASS][p];
  PetscCall(MPIU_Allreduce(&sum, moved, 1, MPIU_REAL, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* It has become calm: if it stays so, this was the end. */
static PetscErrorCode NoteEnd(Model *m, const MeasureSpec *s, PetscReal *state)
{
  PetscReal *event = state + STATE_EVENT;

  PetscFunctionBeginUser;
  state[STATE_CALM] = event[EVENT_END] = m->time;
  event[EVENT_RELEASED] = state[STATE_RELEASED];
  PetscCall(MassMoved(m, s, event + EVENT_MOVED));
  PetscCall(Angles(m, s, event + EVENT_SURFACE_AFTER, event + EVENT_MASS_AFTER));
  PetscFunctionReturn(0);
}

/* While nothing slides: the usual energy, and the threshold that follows from it. */
static void follow_creep(const Model *m, const MeasureSpec *s, const Motion *motion, PetscReal dt, PetscReal *state)
{
  const AvalancheSpec *a = &s->avalanche;
  const PetscReal weight = state[STATE_CREEP] < 0 ? 1 : 1 - PetscExpReal(-dt / a->creep);
  state[STATE_CREEP] = (1 - weight) * PetscMax(0, state[STATE_CREEP]) + weight * motion->relative;
  if (state[STATE_PHASE] == SLIDING) return;
  const PetscReal usual = PetscMax(state[STATE_CREEP], motion->carried);
  const PetscReal high = a->times > 0 ? PetscMax(a->times * usual, energy_unresolved(m)) : a->kinetic;
  /* what is stirring must reach the threshold of its beginning, since creep follows it; creep that
   * stays higher ends it */
  if (state[STATE_PHASE] == QUIET) state[STATE_HIGH] = high;
  state[STATE_LOW] = a->ends * high;
}

/* Collective. A step within an event, or what may become one. */
static PetscErrorCode Slide(Model *m, const MeasureSpec *s, PetscReal dt, const Motion *motion, PetscReal *state)
{
  PetscReal *largest = state + STATE_EVENT + EVENT_KINETIC, low = state[STATE_LOW];

  PetscFunctionBeginUser;
  state[STATE_RELEASED] += 0.5 * dt * (state[STATE_POWER] + motion->power);
  state[STATE_POWER] = motion->power;
  *largest = PetscMax(*largest, motion->relative);
  if (state[STATE_PHASE] == STIRRING && motion->relative > state[STATE_HIGH]) state[STATE_PHASE] = SLIDING;
  if (state[STATE_PHASE] == SLIDING) low = PetscMax(low, s->avalanche.fades * *largest);
  if (motion->relative >= low) state[STATE_CALM] = -1;
  else if (state[STATE_PHASE] == STIRRING) state[STATE_PHASE] = QUIET;
  else if (state[STATE_CALM] < 0) {
    state[STATE_CREEP] = motion->relative; /* a powder that has slid may creep in another way */
    PetscCall(NoteEnd(m, s, state));
  }
  PetscFunctionReturn(0);
}

/* NOLINTNEXTLINE(readability-non-const-parameter): as the other measures have it */
static PetscErrorCode RememberAvalanches(Model *m, const MeasureSpec *s, PetscReal dt, PetscReal kept[MEASURE_KEPT])
{
  static const PetscReal start[STATE_N] = {[STATE_CREEP] = -1};
  MeasureMemory *memory = &m->memory[s - m->c->measures];
  Motion motion;

  (void)kept;
  PetscFunctionBeginUser;
  if (dt == 0) PetscCall(MemoryAppend(memory, STATE_N, start));
  if (dt == 0 || m->time < s->avalanche.from) PetscFunctionReturn(0);
  PetscReal *state = memory->list, row[EVENT_N];
  PetscCall(FindMotion(m, s, dt, state[STATE_PHASE] != QUIET ? carried_component(m, s) : -1, &motion));
  if (state[STATE_PHASE] != SLIDING || state[STATE_CALM] >= 0) follow_creep(m, s, &motion, dt, state);
  if (state[STATE_PHASE] != QUIET) PetscCall(Slide(m, s, dt, &motion, state));
  else if (motion.relative > state[STATE_LOW]) PetscCall(Begin(m, s, &motion, state));
  if (state[STATE_PHASE] != SLIDING || state[STATE_CALM] < 0) PetscFunctionReturn(0);
  if (m->time < state[STATE_CALM] + s->avalanche.calm * (1 - 1e-9)) PetscFunctionReturn(0);
  state[STATE_PHASE] = QUIET;
  PetscCall(PetscArraycpy(row, state + STATE_EVENT, EVENT_N)); /* the list may move */
  if (row[EVENT_MOVED] >= s->avalanche.least) PetscCall(MemoryAppend(memory, EVENT_N, row));
  PetscFunctionReturn(0);
}

static PetscErrorCode Count(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  (void)s;
  PetscFunctionBeginUser;
  *value = (PetscReal)measure_n_events(m, index);
  PetscFunctionReturn(0);
}

/* Mean over the avalanches that are over; nan if none is. */
static PetscErrorCode MeanOfEvents(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const PetscInt n = measure_n_events(m, index);

  PetscFunctionBeginUser;
  *value = n ? 0 : NAN;
  for (PetscInt i = 0; i < n; ++i) *value += measure_event(m, index, i)[measure_number(s)->which] / (PetscReal)n;
  PetscFunctionReturn(0);
}

/* Keeps what it was in the last step: its length is not known later. */
static PetscErrorCode RememberAgitation(Model *m, const MeasureSpec *s, PetscReal dt, PetscReal kept[MEASURE_KEPT])
{
  Motion motion;

  PetscFunctionBeginUser;
  PetscCall(FindMotion(m, s, dt, -1, &motion));
  kept[0] = motion.carried > 0 ? motion.relative / motion.carried : NAN;
  PetscFunctionReturn(0);
}

static PetscErrorCode Agitation(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  (void)s;
  PetscFunctionBeginUser;
  *value = m->memory[index].kept[0];
  PetscFunctionReturn(0);
}

const Measure measure_agitation = {
  .key = "agitation",
  .takes = MEASURE_CONTAINER,
  .number = {.unit = "",
             .help = "kinetic energy relative to a container that moves, over that of moving with it: what an "
                     "avalanche is told by",
             .in = PETSC_TRUE,
             .value = Agitation},
  .remember = RememberAgitation};

#define TOLD(...) WORD(.in = PETSC_TRUE, .middle = PETSC_TRUE, .may_about = PETSC_TRUE, __VA_ARGS__)
const MeasureNumber *const measure_avalanche_words[] = {
  TOLD(.word = "number", .help = "how many are over", .value = Count),
  TOLD(.word = "before", .help = "mean inclination of the surface before those that are over", .unit = "deg",
       .value = MeanOfEvents, .which = EVENT_SURFACE_BEFORE),
  TOLD(.word = "after", .help = "mean inclination of the surface after them", .unit = "deg", .value = MeanOfEvents,
       .which = EVENT_SURFACE_AFTER),
  NULL,
};

const Measure measure_avalanches = {
  .key = "avalanches",
  .takes = MEASURE_AVALANCHES,
  .number = {.unit = "",
             .help = "avalanches that are over, their number or mean angles; events.csv has a row for each"},
  .words = measure_avalanche_words,
  .remember = RememberAvalanches,
  .events = &(const MeasureEvents){
    .header = STATE_N,
    .begun = STATE_EVENT + EVENT_START,
    .n = EVENT_N,
    .names = (const char *const[]){"start", "end", "surface before", "surface after", "centre of mass before",
                                   "centre of mass after", "mass moved", "energy released", "largest kinetic energy"},
    .units = (const char *const[]){"s", "s", "deg", "deg", "deg", "deg", "kg", "J", "J"}}};
