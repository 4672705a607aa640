/* Keys of the measures: those of the registry, and what stands behind and beside them. */
#include "base/formula.h"
#include "input/schema/keys/schema_keys.h"
#include "model/measure/measure.h"

static const SchemaWord front_words[] = {{"points", FRONT_POINTS, "the farthest material point"},
                                         {"surface", FRONT_SURFACE, "the front of the free surface, with max: x in 2D"},
                                         {NULL, 0, NULL}};

/* --- of --- */
static const SchemaEntry of_entries[] = {
  KEY(
    "tracer", VECTOR, "m",
    "a massless point carried by the material, out of the grid too, by its position at the start (of a later stage, or "
    "a run with initial: {run: ..}: mpm by where the material is then, fem by where it was undeformed); nan from when "
    "no node of the grid carries it any more",
    AT(MeasureSpec, tracer), GIVEN(MeasureSpec, has_tracer)),
  KEY("body", REFERENCE, NULL, "a name from `bodies`", .target = "bodies", AT(MeasureSpec, body)),
  KEY("boundary", BOUNDARY, NULL, "an entry of `boundary`: its name, or its index counted from 0",
      AT(MeasureSpec, boundary)),
  KEY("wall", REFERENCE, NULL, "a name from `walls`", .target = "walls", AT(MeasureSpec, wall)),
  KEY("interface", REFERENCE, NULL, "a name from `interfaces`", .target = "interfaces", AT(MeasureSpec, interface)),
  {.key = NULL},
};
static const struct {
  const char *key, *hint;
} subjects[] = {[OF_BODY] = {"body", "write of: {body: name}"},
                [OF_TRACER] = {"tracer", "write of: {tracer: [x, y]}"},
                [OF_BOUNDARY] = {"boundary", "write of: {boundary: name or index}"},
                [OF_WALL] = {"wall", "write of: {wall: name}"},
                [OF_INTERFACE] = {"interface", "write of: {interface: name}"}};
static const SchemaGroup of_groups[] = {{GROUP_ONE, {"tracer", "body", "boundary", "wall", "interface", NULL}},
                                        {GROUP_NONE, {NULL}}};
static PetscBool hide_in_of(const SchemaEntry *e, const void *source)
{
  const MeasureSubject of = measure_has_tracer(source) ? OF_TRACER : measure_number(source)->of;
  return strcmp(e->key, subjects[of].key) != 0;
}
static const SchemaTable of = {
  .name = "of", .help = "What is measured.", .entries = of_entries, .groups = of_groups, .hide = hide_in_of};

/* --- sides of a body --- */
#define SIDES(what)                                                                                      \
  KEY("max", AXIS, NULL, what "largest coordinate along this axis", TAG(1), AT(MeasureSpec, component)), \
    KEY("min", AXIS, NULL, what "smallest coordinate along this axis", TAG(0), AT(MeasureSpec, component))

#define BEYOND(what) KEY("beyond", NUMBER, NULL, what, .fallback = "0", BETWEEN(0, 1), AT(MeasureSpec, beyond))

static const SchemaEntry extent_entries[] = {
  SIDES(""),
  BEYOND("share of the mass that may lie beyond: 0 is the farthest point, 0.01 the place within which 99 % are"),
  KEY("advance", BOOLEAN, NULL,
      "how far that is beyond where it was at the start, outwards: the run-out of a front, whatever the size of the "
      "cells in which the outermost points begin",
      .fallback = "false", AT(MeasureSpec, advance)),
  {.key = NULL},
};
static const SchemaTable extent = {.name = "extent",
                                   .help = "How far a body reaches.",
                                   .entries = extent_entries,
                                   .groups = schema_one_tag,
                                   .tag_offset = offsetof(MeasureSpec, maximum)};

static const SchemaEntry run_out_entries[] = {
  SIDES("the front is the "),
  KEY("speed", NUMBER, "m/s", "a front that advances more slowly has come to rest", REQUIRED, ABOVE(0),
      AT(MeasureSpec, speed)),
  KEY("front", WORD, NULL, "what is farthest", .words = front_words, .fallback = "points", AT(MeasureSpec, front)),
  BEYOND("share of the mass that the front of points leaves beyond: 0.01 follows the place within which 99 % are"),
  {.key = NULL},
};
static const SchemaTable run_out = {
  .name = "run_out_time",
  .help = "The last time at which the front of a body advanced faster than a given speed; every step counts.",
  .entries = run_out_entries,
  .groups = schema_one_tag,
  .tag_offset = offsetof(MeasureSpec, maximum)};

/* --- avalanches --- */
#define CONTAINER(...)                                                                                             \
  KEY("container", BOUNDARY, NULL,                                                                                 \
      "the entry of `boundary` whose motion carries the powder, its name or index: what moves with it is at rest", \
      AT(MeasureSpec, avalanche.container), GIVEN(MeasureSpec, avalanche.has_container), __VA_ARGS__)

static const SchemaEntry agitation_entries[] = {CONTAINER(REQUIRED), {.key = NULL}};
static const SchemaTable agitation = {
  .name = "agitation", .help = "How much a powder moves in a container that moves.", .entries = agitation_entries};

static const SchemaEntry avalanche_entries[] = {
  KEY("tells", WORD_TEXT, NULL, "what the measure is", .registry = (const void *const *)measure_avalanche_words,
      .fallback = "number", AT(MeasureSpec, word)),
  CONTAINER(.note = "one at rest"),
  KEY("times", NUMBER, NULL,
      "an avalanche has a kinetic energy, relative to the container, so many times that while the powder creeps, or "
      "that of moving with the container if this is more",
      ABOVE(0), AT(MeasureSpec, avalanche.times)),
  KEY("kinetic", NUMBER, "J", "or of more than this", ABOVE(0), AT(MeasureSpec, avalanche.kinetic)),
  KEY("ends", NUMBER, NULL, "it begins when this share of that is exceeded, and ends when no more is left...",
      .fallback = "0.3", BETWEEN(0, 1), AT(MeasureSpec, avalanche.ends)),
  KEY("fades", NUMBER, NULL, "...or no more than this share of its own peak...", .fallback = "0.05", BETWEEN(0, 1),
      AT(MeasureSpec, avalanche.fades)),
  KEY("calm", NUMBER, "s", "...for so long", .fallback = "0.1", AT_LEAST(0), AT(MeasureSpec, avalanche.calm)),
  KEY("creep", NUMBER, "s", "the energy while the powder creeps is its mean over about so long", .fallback = "0.5",
      ABOVE(0), AT(MeasureSpec, avalanche.creep)),
  KEY("from", NUMBER, "s", "what moves before is no event", .fallback = "0", AT_LEAST(0),
      AT(MeasureSpec, avalanche.from)),
  KEY("carried", NUMBER, "m", "mass that is carried farther than this, relative to the container, has taken part",
      .note = "the smallest cell", ABOVE(0), AT(MeasureSpec, avalanche.carried)),
  KEY("least", NUMBER, "kg", "where less mass has taken part, single points leapt: no avalanche", .fallback = "0",
      AT_LEAST(0), AT(MeasureSpec, avalanche.least)),
  {.key = NULL},
};
static const SchemaGroup avalanche_groups[] = {{GROUP_ONE, {"times", "kinetic", NULL}}, {GROUP_NONE, {NULL}}};
static PetscBool hide_in_avalanches(const SchemaEntry *e, const void *source)
{
  const AvalancheSpec *a = &((const MeasureSpec *)source)->avalanche;
  if (!strcmp(e->key, "times")) return a->times == 0;
  if (!strcmp(e->key, "kinetic")) return a->kinetic == 0;
  return !strcmp(e->key, "carried") && a->carried == 0;
}
static const SchemaTable avalanches = {.name = "avalanches",
                                       .help = "When a powder slides.",
                                       .entries = avalanche_entries,
                                       .groups = avalanche_groups,
                                       .hide = hide_in_avalanches};

/* --- its rate, its mean --- */
#define SPAN " all steps: of the last so many seconds, or [from, to]: between two times, from when its stage began"
#define WINDOW(help)                                                                         \
  KEY("window", INTERVAL, "s", help SPAN, REQUIRED, AT_LEAST(0), AT(MeasureSpec, window[0]), \
      .second = offsetof(MeasureSpec, window[1]))
static const SchemaEntry rate_entries[] = {WINDOW("a line of least squares through the values of"), {.key = NULL}};
static const SchemaTable rate = {
  .name = "rate", .help = "How fast a measure changes: its unit per second.", .entries = rate_entries};
static const SchemaEntry mean_entries[] = {WINDOW("the mean over time of"), {.key = NULL}};
static const SchemaTable mean = {.name = "mean", .help = "What a measure is on the average.", .entries = mean_entries};

/* --- a measure --- */
#define MOST_KEYS 96

static SchemaEntry entry_of(const Measure *measure)
{
  static const SchemaEntry takes[] = {
    [MEASURE_AXIS] = {.type = TYPE_AXIS, AT(MeasureSpec, component)},
    [MEASURE_SPIN_AXIS] = {.type = TYPE_SPIN_AXIS, AT(MeasureSpec, component)},
    [MEASURE_WORD] = {.type = TYPE_WORD_TEXT, AT(MeasureSpec, word)},
    [MEASURE_EXTENT] = {.type = TYPE_TABLE, .table = &extent},
    [MEASURE_FRONT] = {.type = TYPE_TABLE, .table = &run_out},
    [MEASURE_AVALANCHES] = {.type = TYPE_TABLE, .table = &avalanches},
    [MEASURE_CONTAINER] = {.type = TYPE_TABLE, .table = &agitation},
    [MEASURE_TEXT] = {.type = TYPE_TEXT, AT(MeasureSpec, word)},
  };
  SchemaEntry entry = takes[measure->takes];
  entry.key = measure->key;
  entry.unit = measure->number.unit;
  entry.help = measure->number.help;
  entry.registry = entry.type == TYPE_WORD_TEXT ? (const void *const *)measure->words : NULL;
  entry.only_2d = measure->only_2d;
  entry.turns = measure->takes == MEASURE_SPIN_AXIS;
  entry.tagged = PETSC_TRUE;
  return entry;
}

static PetscInt n_measures(void)
{
  PetscInt n = 0;
  while (measures[n]) ++n;
  return n;
}

static SchemaEntry measure_entry(PetscInt i)
{
  static const SchemaEntry beside[] = {
    KEY("at", NUMBER, "m", "x of a number that is taken at a place", AT(MeasureSpec, at), GIVEN(MeasureSpec, has_at)),
    KEY("about", VECTOR, "m", "the centre of a container, for a number that is taken about one", AT(MeasureSpec, about),
        GIVEN(MeasureSpec, has_about)),
    KEY("middle", NUMBER, NULL, "share of a surface, from wall to wall, that a line is fitted to", .note = "0.85",
        .bounded = PETSC_TRUE, .min = 0, .max = 1, .min_open = PETSC_TRUE, AT(MeasureSpec, middle)),
    KEY(
      "in", TABLE, NULL,
      "only what lies in this shape; a point that its surface cuts counts in part: its domain, a square or cube of its "
      "volume, is sampled. With basis cell, and in fem, points are no middles of such domains: a sphere with a radius "
      "of two of their spacings is up to 8 % off, of four 2 % (hexahedra; gimp 1 %, 0.3 %); in tetrahedra of four "
      "points one with a radius of an edge and less up to 30 %, of one and a half 3 %, of three 0.6 %",
      .table = &schema_shape, AT(MeasureSpec, in), GIVEN(MeasureSpec, has_in)),
    KEY("of", TABLE, NULL, "which tracer, body, boundary or wall", .table = &of),
    KEY("rate", TABLE, NULL, "how fast that changes, instead of it", .table = &rate, GIVEN(MeasureSpec, has_rate)),
    KEY("mean", TABLE, NULL, "what it is on the average, instead of it", .table = &mean, GIVEN(MeasureSpec, has_mean)),
    {.key = NULL},
  };
  static SchemaEntry made[MOST_KEYS]; /* once: whoever reads a table asks for each many times */
  static PetscInt n;
  for (const PetscInt first = n_measures(); !n || made[n - 1].key; ++n) {
    PetscCheckAbort(n < MOST_KEYS, PETSC_COMM_SELF, PETSC_ERR_PLIB, "more keys of a measure than MOST_KEYS");
    made[n] = n < first ? entry_of(measures[n]) : beside[n - first];
  }
  return made[i];
}

/* Keys that belong to some numbers only: must or may they stand beside this one? */
static void check_beside(SchemaReader *r, const YamlNode *mapping, const MeasureSpec *m, const char *path)
{
  const MeasureNumber *number = measure_number(m);
  const struct {
    const char *key, *example;
    PetscBool needed, allowed;
  } keys[] = {
    {"at", "at: x", number->at, number->at},
    {"about", "about: [x, y]", number->about, number->about || number->may_about},
    {"middle", NULL, PETSC_FALSE, number->middle},
    {"in", NULL, PETSC_FALSE, (number->in || number->sum) && !measure_has_tracer(m)},
  };
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(keys); ++k) {
    const YamlNode *node = yaml_find(mapping, keys[k].key);
    if (keys[k].needed && !node) {
      SchemaKeyError(r, mapping, "key '%s' of %s is missing", keys[k].key, path);
      diag_hint(r->diag, "write %s: %s, %s", m->kind, m->word, keys[k].example);
    }
    if (!keys[k].allowed && node)
      SchemaKeyError(r, node, "%s.%s means nothing to %s%s%s", path, keys[k].key, m->kind, m->word ? ": " : "",
                     m->word ? m->word : "");
  }
}

/* Do more stages come, or has one begun? The case knows how long they take (case_file.c). */
static PetscBool has_stages(const SchemaReader *r)
{
  return (PetscBool)(r->document->n_stages > 0 || yaml_find(r->document->root, "stages"));
}

static void check_window(SchemaReader *r, const YamlNode *mapping, const MeasureSpec *m, const char *path)
{
  const char *over = m->has_rate ? "rate" : "mean";
  const YamlNode *window = yaml_find(yaml_find(mapping, over), "window");
  if (m->has_rate && m->has_mean)
    SchemaKeyError(r, yaml_find(mapping, "mean"), "%s takes a rate or a mean, not both", path);
  if (!window) return;
  if (m->window[0] == m->window[1] && !(m->window[0] > 0))
    SchemaError(r, window, "%s.%s.window must be longer than 0 s", path, over);
  else if (m->window[0] < m->window[1] && m->window[0] >= r->c->analysis.end && !has_stages(r))
    SchemaError(r, window, "%s.%s.window begins when the run is over, at %g s (analysis.end)", path, over,
                (double)r->c->analysis.end);
}

/* Of what moves with a container that stands still nothing is a multiple. */
static void check_container(SchemaReader *r, const YamlNode *mapping, const MeasureSpec *m, const char *path)
{
  const YamlNode *of_key = yaml_find(mapping, m->kind);
  const PetscBool needed = !strcmp(m->kind, "agitation") || m->avalanche.times > 0;
  const AvalancheSpec *a = &m->avalanche;
  if (!needed) return;
  if (!a->has_container) {
    SchemaError(r, yaml_find(of_key, "times"), "%s.%s.times: of which motion? Name the `container`", path, m->kind);
    diag_hint(r->diag, "for a container at rest give `kinetic`, in J");
  } else if (a->container < r->c->n_boundary && r->c->boundary[a->container].kind == MOTION_FIXED)
    SchemaError(r, yaml_find(of_key, "container"), "%s.%s.container does not move", path, m->kind);
}

static void check_front(SchemaReader *r, const YamlNode *mapping, const MeasureSpec *m, const char *path)
{
  const YamlNode *front = yaml_find(yaml_find(mapping, m->kind), "front");
  if (m->front != FRONT_SURFACE) return;
  if (r->dim == 3) SchemaError(r, front, "%s.%s.front: a free surface is known in 2D only", path, m->kind);
  else if (!m->maximum || m->component)
    SchemaError(r, front, "%s.%s.front: the surface's front is max: x", path, m->kind);
  if (m->beyond > 0)
    SchemaError(r, yaml_find(yaml_find(mapping, m->kind), "beyond"),
                "%s.%s.beyond means nothing to the front of the surface", path, m->kind);
}

/* Round the circle radial momenta add up to nothing. */
static void check_component(SchemaReader *r, const YamlNode *mapping, const MeasureSpec *m, const char *path)
{
  if (!r->hoop || m->component || !measure_find(m->kind)->no_radial) return;
  SchemaError(r, yaml_find(mapping, m->kind), "%s.%s: x: round the full circle it is zero", path, m->kind);
  diag_hint(r->diag, "along the axis it means something: %s: y", m->kind);
}

static void check_subject(SchemaReader *r, const YamlNode *mapping, const MeasureSpec *m, const char *path)
{
  const YamlNode *of_node = yaml_find(mapping, "of");
  const MeasureSubject wanted = measure_number(m)->of;
  if (wanted == OF_MODEL) {
    if (of_node)
      SchemaKeyError(r, of_node, "%s.of: %s%s%s is known for the whole model only", path, m->kind, m->word ? ": " : "",
                     m->word ? m->word : "");
    return;
  }
  if (of_node ? yaml_find(of_node, subjects[wanted].key) != NULL : wanted == OF_BODY) return;
  if (measure_number(m)->may_trace && m->has_tracer) return;
  if (!of_node) SchemaKeyError(r, mapping, "key 'of' of %s is missing", path);
  else SchemaKeyError(r, of_node, "%s.of must name a %s", path, subjects[wanted].key);
  if (of_node && !strcmp(m->kind, "reaction") && yaml_find(of_node, "wall"))
    diag_hint(r->diag, "the force of a wall is the measure `wall_force`");
  else diag_hint(r->diag, "%s", subjects[wanted].hint);
}

/* Names of a formula: those of the measures above it. */
static PetscErrorCode KnownAbove(void *context, const char *name, PetscBool *known, PetscReal *value)
{
  const YamlNode *measure = context, *all = measure->parent;

  PetscFunctionBeginUser;
  *value = 1;
  *known = PETSC_FALSE;
  for (PetscInt k = 0; all->child[k] != measure && !*known; ++k)
    *known = strcmp(all->child[k]->key, name) ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckFormula(SchemaReader *r, const YamlNode *mapping, const MeasureSpec *m, const char *path)
{
  Formula formula = {.value = KnownAbove, .context = (void *)mapping, .at = m->word};
  PetscReal value;

  PetscFunctionBeginUser;
  if (strcmp(m->kind, "formula") != 0) PetscFunctionReturn(0);
  PetscCall(FormulaValue(&formula, &value));
  if (!formula.wrong) PetscFunctionReturn(0);
  const YamlNode *text = yaml_find(mapping, m->kind);
  if (!formula.name[0]) SchemaError(r, text, "%s.formula makes no sense from '%s' on", path, formula.wrong);
  else {
    SchemaError(r, text, "%s.formula: '%s' is no measure above it", path, formula.name);
    diag_hint(r->diag, "names are those of measures that stand before it, of letters, digits and _");
  }
  PetscFunctionReturn(0);
}

/* Columns that the history has before those of measures. */
static void check_column(SchemaReader *r, const YamlNode *mapping)
{
  static const char *const taken[] = {"time", "step", "stage"}; /* the last one of cases with stages */
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(taken); ++k) {
    if (strcmp(mapping->key, taken[k]) != 0 || (k == 2 && !r->c->staged)) continue;
    SchemaKeyError(r, mapping, "history.csv has a column '%s' by itself: the measure needs another name", taken[k]);
  }
}

static PetscErrorCode CheckMeasure(SchemaReader *r, const YamlNode *mapping, void *target)
{
  char path[512];

  PetscFunctionBeginUser;
  yaml_path(mapping, path, sizeof(path));
  check_column(r, mapping);
  check_beside(r, mapping, target, path);
  check_window(r, mapping, target, path);
  check_front(r, mapping, target, path);
  check_component(r, mapping, target, path);
  check_container(r, mapping, target, path);
  check_subject(r, mapping, target, path);
  PetscCall(CheckFormula(r, mapping, target, path));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckUntil(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const UntilSpec *until = target;
  const YamlNode *spec = yaml_find(yaml_find(r->document->root, "measures"), until->measure);
  const Measure *counts = NULL;
  char path[512];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; spec && i < spec->n && !counts; ++i) {
    const Measure *measure = measure_find(spec->child[i]->key);
    if (measure && measure->events) counts = measure;
  }
  if (until->kind != UNTIL_COUNT || counts) PetscFunctionReturn(0);
  SchemaError(r, yaml_find(mapping, "count"), "%s.count: the measure '%s' counts no events",
              yaml_path(mapping, path, sizeof(path)), until->measure);
  diag_hint(r->diag, "avalanches do; of others take `below` or `above`");
  PetscFunctionReturn(0);
}

static PetscBool hide_in_measure(const SchemaEntry *e, const void *source)
{
  const MeasureSpec *m = source;
  const MeasureSubject subject = measure_number(m)->of;
  if (!strcmp(e->key, "middle")) return m->middle == 0;
  return e->table == &of && (subject == OF_MODEL || (subject == OF_BODY && !m->body && !measure_has_tracer(m)));
}

const SchemaTable schema_measure = {.name = "measure",
                                    .help = "A number followed through the run, a column of history.csv.",
                                    .entry = measure_entry,
                                    .groups = schema_one_tag,
                                    .size = sizeof(MeasureSpec),
                                    .tag_offset = offsetof(MeasureSpec, kind),
                                    .tag_is_key = PETSC_TRUE,
                                    .check = CheckMeasure,
                                    .hide = hide_in_measure};
