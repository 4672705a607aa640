/* Each kind of value: what it is called, its JSON Schema, its reader and writer. */
#include <math.h>
#include <string.h>
#include "input/schema/schema.h"

/* JSON pieces shared by several kinds. */
#define JSON_VECTOR "{\"type\": \"array\", \"items\": {\"type\": \"number\"}, \"minItems\": 2, \"maxItems\": 3}"
#define JSON_AXIS "{\"enum\": [\"x\", \"y\", \"z\"]}"
#define JSON_DIRECTION "{\"enum\": [\"x\", \"y\", \"z\", \"normal\"]}"
#define JSON_PAIRS                                                                                              \
  "{\"type\": \"array\", \"items\": {\"type\": \"array\", \"items\": {\"type\": \"number\"}, \"minItems\": 2, " \
  "\"maxItems\": 2}, \"minItems\": "

const SchemaTypeInfo schema_types[TYPE_COUNT] = {
  [TYPE_NUMBER] = {"a number", "number", NULL, SchemaReadNumber},
  [TYPE_INTEGER] = {"a whole number", "whole number", NULL, SchemaReadInteger},
  [TYPE_BOOLEAN] = {"true or false", "true or false", "{\"type\": \"boolean\"}", SchemaReadBoolean},
  [TYPE_WORD] = {"one of", "word", NULL, SchemaReadWord},
  [TYPE_WORD_TEXT] = {"one of", "word", NULL, SchemaReadWordText},
  [TYPE_MEMBER] = {"one of", "word", NULL, SchemaReadMember},
  [TYPE_TEXT] = {"a text", "text", "{\"type\": [\"string\", \"number\"]}", SchemaReadText},
  [TYPE_NAME] = {"a name", "name", "{\"type\": [\"string\", \"number\"]}", SchemaReadName},
  [TYPE_VALUES] = {"a value or a list of values", "values", "{}", SchemaReadValues},
  [TYPE_FILE] = {"the name of a file", "file", "{\"type\": \"string\"}", SchemaReadFile},
  [TYPE_REFERENCE] = {"a name", "name", "{\"type\": [\"string\", \"number\"]}", SchemaReadReference},
  [TYPE_REFERENCES] = {"a list of names", "names",
                       "{\"type\": \"array\", \"items\": {\"type\": [\"string\", \"number\"]}, \"minItems\": 1}",
                       SchemaReadReferences},
  [TYPE_BOUNDARY] = {"the name or index of a boundary entry", "name or index", "{\"type\": [\"string\", \"integer\"]}",
                     SchemaReadBoundary},
  [TYPE_VECTOR] = {"a vector", "vector", JSON_VECTOR, SchemaReadVector},
  [TYPE_SPIN] = {"a number in 2D, a vector in 3D", "number or vector",
                 "{\"anyOf\": [{\"type\": \"number\"}, " JSON_VECTOR "]}", SchemaReadSpin},
  [TYPE_AXIS] = {"an axis", "axis", JSON_AXIS, SchemaReadAxis},
  [TYPE_SPIN_AXIS] = {"an axis", "axis", JSON_AXIS, SchemaReadAxis},
  [TYPE_DIRECTION] = {"a direction", "direction", JSON_DIRECTION, NULL},
  [TYPE_AXES] = {"a list of axes like [x, y]", "list of axes",
                 "{\"type\": \"array\", \"items\": " JSON_DIRECTION ", \"minItems\": 1, \"uniqueItems\": true}",
                 SchemaReadAxes},
  [TYPE_INTERVAL] = {"a number, or two [min, max]", "number or [min, max]",
                     "{\"anyOf\": [{\"type\": \"number\"}, {\"type\": \"array\", \"items\": {\"type\": \"number\"}, "
                     "\"minItems\": 2, \"maxItems\": 2}]}",
                     SchemaReadInterval},
  [TYPE_SIZE] = {"a number, or one for each axis", "number or vector",
                 "{\"anyOf\": [{\"type\": \"number\", \"exclusiveMinimum\": 0}, {\"type\": \"array\", \"items\": "
                 "{\"type\": \"number\", \"exclusiveMinimum\": 0}, "
                 "\"minItems\": 2, \"maxItems\": 3}]}",
                 SchemaReadSize},
  [TYPE_COUNTS] =
    {"a list of whole numbers, one for each axis", "whole numbers",
     "{\"type\": \"array\", \"items\": {\"type\": \"integer\", \"minimum\": 1}, \"minItems\": 2, \"maxItems\": 3}",
     SchemaReadCounts},
  [TYPE_AMPLITUDE] = {"a list of pairs [[time, factor], ...]", "[[time, factor], ...]", JSON_PAIRS "1}",
                      SchemaReadAmplitude},
  [TYPE_POLYGON] = {"a list of three corners or more [[x, y], ...]", "[[x, y], ...]", JSON_PAIRS "3}",
                    SchemaReadPolygon},
  [TYPE_LINE] = {"a list of two corners or more [[x, y], ...]", "[[x, y], ...]", JSON_PAIRS "2}", SchemaReadPolygon},
  [TYPE_EVERY] =
    {"`end`, a time in s above 0, or {steps: n}", "end, s, {steps: n}",
     "{\"anyOf\": [{\"const\": \"end\"}, {\"type\": \"number\", \"exclusiveMinimum\": 0}, {\"type\": \"object\", "
     "\"properties\": {\"steps\": "
     "{\"type\": \"integer\", \"minimum\": 1}}, \"required\": [\"steps\"], \"additionalProperties\": false}]}",
     SchemaReadEvery},
  [TYPE_FIELDS] = {"a list of fields", "list of fields", NULL, SchemaReadFields},
  [TYPE_NUMBERS] = {"a mapping {name: number, ...}", "{name: number, ...}",
                    "{\"type\": \"object\", \"additionalProperties\": {\"type\": \"number\"}}", SchemaReadNumbers},
  [TYPE_AMPLITUDES] = {"a mapping {parameter: [[time, factor], ...], ...}", "{name: [[time, factor], ...], ...}",
                       "{\"type\": \"object\", \"additionalProperties\": " JSON_PAIRS "1}}", SchemaReadAmplitudes},
  [TYPE_OPTIONS] =
    {"a mapping {option: value, ...}", "{option: value, ...}",
     "{\"type\": \"object\", \"additionalProperties\": {\"type\": [\"string\", \"number\", \"boolean\", \"null\"]}}",
     SchemaReadOptions},
  [TYPE_FLAGS] = {"a list of", "list of words", NULL, SchemaReadFlags},
  [TYPE_PART] = {"a part of a case", "as at the top", "{\"type\": [\"object\", \"array\", \"string\"]}",
                 SchemaReadPart},
  [TYPE_TABLE] = {"a mapping {key: value, ...}", "mapping"},
  [TYPE_LIST] = {"a list of mappings", "list"},
  [TYPE_NAMED] = {"a mapping {name: {...}, ...}", "name: mapping"},
};

const char *schema_range(const SchemaEntry *e, char *buffer, size_t size)
{
  const PetscBool low = e->bounded && e->min > -PETSC_MAX_REAL;
  const PetscBool high = e->bounded && e->max < PETSC_MAX_REAL;
  const char *above = e->min_open ? ">" : ">=", *below = e->max_open ? "<" : "<=";
  if (low && high) snprintf(buffer, size, "%s %g and %s %g", above, (double)e->min, below, (double)e->max);
  else if (low) snprintf(buffer, size, "%s %g", above, (double)e->min);
  else if (high) snprintf(buffer, size, "%s %g", below, (double)e->max);
  else buffer[0] = '\0';
  return buffer;
}

static const char *types_axes(const SchemaEntry *e, PetscInt dim)
{
  if (e->type == TYPE_DIRECTION) return dim == 2 ? "x, y or normal" : "x, y, z or normal";
  if (e->type == TYPE_AXIS) return dim == 2 ? "x or y" : "x, y or z";
  return dim == 2 ? "z" : "x, y or z";
}

void schema_append_words(const SchemaEntry *e, const char *last, char *buffer, size_t size)
{
  for (int k = 0; schema_word(e, k).word; ++k) {
    const size_t used = strlen(buffer);
    snprintf(buffer + used, size - used, "%s%s",
             k == 0                       ? ""
             : schema_word(e, k + 1).word ? ", "
                                          : last,
             schema_word(e, k).word);
  }
}

const char *schema_expected(const SchemaEntry *e, PetscInt dim, char *buffer, size_t size)
{
  char range[80];
  schema_range(e, range, sizeof(range));
  if (schema_word(e, 0).word && !schema_word(e, 1).word) snprintf(buffer, size, "the word %s", schema_word(e, 0).word);
  else if (schema_word(e, 0).word) {
    snprintf(buffer, size, "%s ", schema_types[e->type].what);
    schema_append_words(e, " or ", buffer, size);
  } else if (e->type == TYPE_AXIS || e->type == TYPE_SPIN_AXIS || e->type == TYPE_DIRECTION)
    snprintf(buffer, size, "%s", types_axes(e, dim));
  else if (e->type == TYPE_VECTOR)
    snprintf(buffer, size, "a vector %s", dim == 3 ? "[x, y, z]" : dim == 2 ? "[x, y]" : "[x, y] or [x, y, z]");
  else snprintf(buffer, size, "%s%s%s", schema_types[e->type].what, range[0] ? " " : "", range);
  const size_t used = strlen(buffer);
  if (e->unit && e->unit[0]) snprintf(buffer + used, size - used, " in %s", e->unit);
  return buffer;
}
