/* A measure: a number that is followed through the run, a column of history.csv.
 *
 * To add one: a file with a `const Measure measure_x` (reaction.c is the shortest) and its name in
 * measures.inc. What a case file may say, the reference, `talus list measures` and the units of
 * results are read from here. */
#pragma once
#include "model/model.h"

/* What stands behind the key: an axis, an axis of rotation, one of the words, or a mapping with a
 * side of a body and more. */
typedef enum {
  MEASURE_AXIS,
  MEASURE_SPIN_AXIS,
  MEASURE_WORD,
  MEASURE_EXTENT,
  MEASURE_FRONT,
  MEASURE_AVALANCHES,
  MEASURE_CONTAINER,
  MEASURE_TEXT /* in `word` */
} MeasureArgument;
/* What `of` names: a body, if not all; a tracer; an entry of the boundary; a wall; an interface;
 * nothing, since the number is of the whole model. */
typedef enum { OF_BODY, OF_TRACER, OF_BOUNDARY, OF_WALL, OF_INTERFACE, OF_MODEL } MeasureSubject;

/* A number, and one of three ways to it. */
typedef struct {
  const char *word, *help;
  const char *unit; /* NULL of a word: that of its key */
  MeasureSubject of;
  PetscBool at;        /* is it taken `at` a place? */
  PetscBool about;     /* is it taken `about` a centre? */
  PetscBool may_about; /* may it be? */
  PetscBool may_trace; /* may it be that at a tracer, in place of a body's? */
  PetscBool middle;    /* is it fitted to the `middle` of something? */
  PetscBool in;        /* may it be that of the points `in` a shape alone? Every sum may */
  PetscBool over_step; /* in dynamics it is the mean over the last step, else what it is now */
  /* Collective. index: of the spec among the measures of the case. */
  PetscErrorCode (*value)(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value);
  /* This rank's share of a sum over the points of a body (< 0: of all). A body that is gone has
   * none: nan. */
  PetscReal (*sum)(const Model *m, const MeasureSpec *s, PetscInt body);
  int which; /* tells a value function that several numbers share which of them is asked for */
  /* offset in Model of a number that it keeps, the first of `component` if the key takes an axis */
  size_t kept;
} MeasureNumber;

#define WORD(...) \
  &(const MeasureNumber) { __VA_ARGS__ }

/* What a measure notes of each event that is over: a row of events.csv. They stand in its list
 * behind `header` numbers of its own. */
typedef struct {
  PetscInt header, n; /* n: columns */
  /* of the header, whose first number is 1 while an event is under way: when that began, s */
  PetscInt begun;
  const char *const *names, *const *units;
} MeasureEvents;

typedef struct {
  const char *key;
  MeasureArgument takes;
  PetscBool only_2d;
  PetscBool no_radial; /* a vector whose radial component adds up to zero in axisymmetry */
  /* of the key: its help; its unit for people, if words have several */
  MeasureNumber number;
  /* with MEASURE_WORD, MEASURE_AVALANCHES: ended by NULL; the first is the default of the latter */
  const MeasureNumber *const *words;
  /* Collective, or NULL: after every accepted step of dt, and at the start with dt = 0. */
  PetscErrorCode (*remember)(Model *m, const MeasureSpec *s, PetscReal dt, PetscReal kept[MEASURE_KEPT]);
  const MeasureEvents *events; /* NULL: it counts none */
} Measure;

extern const Measure *const measures[];                      /* ended by NULL */
extern const MeasureNumber *const measure_avalanche_words[]; /* what `tells` may name */
const Measure *measure_find(const char *kind);
/* What the spec asks for. */
const MeasureNumber *measure_number(const MeasureSpec *spec);
/* Is it followed at a place of the material? */
static inline PetscBool measure_has_tracer(const MeasureSpec *s)
{
  const MeasureNumber *number = measure_number(s);
  return number->of == OF_TRACER || (number->may_trace && s->has_tracer);
}

/* Events of measure k that are over, and event i of them: as many numbers as its table has columns. */
PetscInt measure_n_events(const Model *m, PetscInt k);
PetscBool measure_under_way(const Model *m, PetscInt k, PetscReal *since);
/* Can the list of measure k be so long? */
PetscBool measure_list_fits(const Model *m, PetscInt k, PetscInt64 length);
const PetscReal *measure_event(const Model *m, PetscInt k, PetscInt i);

/* -1: all bodies. */
PetscInt measure_body(const Model *model, const MeasureSpec *spec);
static inline PetscBool measure_takes_point(const Model *m, PetscInt body, PetscInt p)
{
  return body < 0 || m->points->body[p] == body;
}

/* Share of a point that counts: that of its domain which lies in the shape of the spec, if there is
 * one; none of other bodies (powder/share.c). */
PetscReal measure_share_in(const Model *m, const Shape *shape, PetscInt p);
static inline PetscReal measure_share(const Model *m, const MeasureSpec *s, PetscInt body, PetscInt p)
{
  if (!measure_takes_point(m, body, p)) return 0;
  return s->has_in ? measure_share_in(m, &s->in, p) : 1;
}
/* Volume of a point's material, m3: a loose point may have opened to many times its volume, but what
 * it holds has not grown. */
static inline PetscReal measure_solid_volume(const Model *m, PetscInt p)
{
  return PetscMin(1, m->points->real[POINT_J][p]) * m->points->real[POINT_VOLUME][p];
}
/* Its section in two dimensions, m2: of a ring without the circle. */
static inline PetscReal measure_solid_area(const Model *m, PetscInt p)
{
  const PetscReal x = point_real(m->points, POINT_X, p)[0];
  return measure_solid_volume(m, p) / PetscMax(kinematics_weight(m->c->kinematics, x), PETSC_SMALL);
}
/* Unit vectors against gravity (without: y) and to the right of it, in two dimensions. */
void measure_up(const Model *m, PetscReal right[2], PetscReal up[2]);

/* Collective. Angle of the centre of mass below the centre that the spec is `about`, rad. */
PetscErrorCode MassAngle(const Model *m, const MeasureSpec *s, PetscReal *angle);

/* Collective. Inclination of the free surface, deg, and how far it is from a line, m (powder/free_surface.c). */
PetscErrorCode SurfaceFit(const Model *m, const MeasureSpec *s, PetscReal *inclination, PetscReal *deviation);

/* A measure that is asked for its rate or its mean in a window (powder/rate.c): its value at the end
 * of an accepted step of dt (0: at the start), and what comes of the values kept. */
static inline PetscBool measure_has_window(const MeasureSpec *s) { return s->has_rate || s->has_mean; }
PetscErrorCode WindowRemember(Model *m, const MeasureSpec *s, MeasureMemory *memory, PetscReal dt, PetscReal value);
PetscReal window_value(const MeasureSpec *s, const MeasureMemory *memory);
PetscBool window_list_fits(PetscInt64 length);
/* Is the value of measure k of a case, before any window, the mean over the last step? Of a formula: is any that it
 * takes (formula.c)? Not collective. */
PetscErrorCode MeasureOverStep(const Case *c, PetscInt k, PetscBool *is);
/* Has a row of the history the mean of it since the row before (rows.c)? k < 0: of no measure. Not collective. */
PetscErrorCode MeasureRowIsMean(const Case *c, PetscInt k, PetscBool *is);
/* Collective. After a step of dt: what the next row of the history is to have of measure k (rows.c). */
PetscErrorCode RowRemember(Model *m, PetscInt k, PetscReal dt);
/* Collective. A formula of what a row of the history has of its measures (formula.c). */
PetscErrorCode FormulaOfRow(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value);
/* "kg/s" of "kg". */
const char *rate_unit(const char *unit);

/* Collective: the farthest coordinate of a body, and its free surface: the front, unless the spec
 * asks for something else of it. */
PetscErrorCode MeasureExtent(Model *model, const MeasureSpec *spec, PetscInt index, PetscReal *value);
PetscErrorCode MeasureSurface(Model *model, const MeasureSpec *spec, PetscInt index, PetscReal *value);
