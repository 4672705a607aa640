/* Keys of the measures: those of the registry, and what stands behind and beside them. */
#include "input/schema/schema_keys.h"
#include "model/measure/measure.h"

static const SchemaWord front_words[] = {{"points", FRONT_POINTS, "the farthest material point"},
                                         {"surface", FRONT_SURFACE, "the front of the free surface, with max: x in 2D"},
                                         {NULL, 0, NULL}};

/* --- of --- */
static const SchemaEntry of_entries[] = {
  KEY("tracer", VECTOR, "m",
      "a massless point carried by the material, out of the grid too, by its position at the start; nan from when no "
      "node of the grid carries it any more",
      AT(MeasureSpec, tracer)),
  KEY("body", REFERENCE, NULL, "a name from `bodies`", .target = "bodies", AT(MeasureSpec, body)),
  KEY("boundary", BOUNDARY, NULL, "an entry of `boundary`: its name, or its index counted from 0",
      AT(MeasureSpec, boundary)),
  {.key = NULL},
};
static const struct {
  const char *key, *hint;
} subjects[] = {[OF_BODY] = {"body", "write of: {body: name}"},
                [OF_TRACER] = {"tracer", "write of: {tracer: [x, y]}"},
                [OF_BOUNDARY] = {"boundary", "write of: {boundary: name or index}"}};
static const SchemaGroup of_groups[] = {{GROUP_ONE, {"tracer", "body", "boundary", NULL}}, {GROUP_NONE, {NULL}}};
static PetscBool hide_in_of(const SchemaEntry *e, const void *source)
{
  return strcmp(e->key, subjects[measure_number(source)->of].key) != 0;
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

/* --- a measure --- */
static SchemaEntry entry_of(const Measure *measure)
{
  static const SchemaEntry takes[] = {
    [MEASURE_AXIS] = {.type = TYPE_AXIS, AT(MeasureSpec, component)},
    [MEASURE_SPIN_AXIS] = {.type = TYPE_SPIN_AXIS, AT(MeasureSpec, component)},
    [MEASURE_WORD] = {.type = TYPE_WORD_TEXT, AT(MeasureSpec, word)},
    [MEASURE_EXTENT] = {.type = TYPE_TABLE, .table = &extent},
    [MEASURE_FRONT] = {.type = TYPE_TABLE, .table = &run_out},
  };
  SchemaEntry entry = takes[measure->takes];
  entry.key = measure->key;
  entry.unit = measure->number.unit;
  entry.help = measure->number.help;
  entry.registry = (const void *const *)measure->words;
  entry.only_2d = measure->only_2d;
  entry.turns = measure->takes == MEASURE_SPIN_AXIS;
  entry.tagged = PETSC_TRUE;
  return entry;
}

static SchemaEntry measure_entry(PetscInt i)
{
  static const SchemaEntry beside[] = {
    KEY("at", NUMBER, "m", "x of a number that is taken at a place", AT(MeasureSpec, at), GIVEN(MeasureSpec, has_at)),
    KEY("of", TABLE, NULL, "which tracer, body or boundary", .table = &of),
    {.key = NULL},
  };
  PetscInt n = 0;
  while (n < i && measures[n]) ++n;
  return measures[n] ? entry_of(measures[n]) : beside[i - n];
}

static void check_place(SchemaReader *r, const YamlNode *mapping, const MeasureSpec *m, const char *path)
{
  const PetscBool needed = measure_number(m)->at;
  if (needed && !m->has_at) {
    SchemaKeyError(r, mapping, "key 'at' of %s is missing", path);
    diag_hint(r->diag, "write %s: %s, at: x", m->kind, m->word);
  }
  if (!needed && m->has_at)
    SchemaKeyError(r, yaml_find(mapping, "at"), "%s.at means nothing to %s: %s", path, m->kind, m->word ? m->word : "");
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
  if (!of_node) SchemaKeyError(r, mapping, "key 'of' of %s is missing", path);
  else SchemaKeyError(r, of_node, "%s.of must name a %s", path, subjects[wanted].key);
  diag_hint(r->diag, "%s", subjects[wanted].hint);
}

static PetscErrorCode CheckMeasure(SchemaReader *r, const YamlNode *mapping, void *target)
{
  char path[512];

  PetscFunctionBeginUser;
  yaml_path(mapping, path, sizeof(path));
  check_place(r, mapping, target, path);
  check_front(r, mapping, target, path);
  check_component(r, mapping, target, path);
  check_subject(r, mapping, target, path);
  PetscFunctionReturn(0);
}

static PetscBool hide_in_measure(const SchemaEntry *e, const void *source)
{
  const MeasureSpec *m = source;
  const MeasureSubject subject = measure_number(m)->of;
  return e->table == &of && (subject == OF_MODEL || (subject == OF_BODY && !m->body));
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
