/* Readers of composed values: vectors, axes, intervals, amplitudes, polygons, output times. */
#include <string.h>
#include "case/fields.h"
#include "input/schema/schema.h"

static const char *const axis_words[] = {"x", "y", "z", [NORMAL] = "normal", NULL};

PetscInt schema_parse_vector(const YamlNode *node, PetscReal value[3])
{
  PetscInt n = 0;
  if (!node || node->kind != YAML_SEQUENCE || node->n > 3) return 0;
  for (; n < node->n; ++n)
    if (!schema_parse_number(node->child[n], &value[n])) return 0;
  return n;
}

static PetscBool check_length(SchemaReader *r, const SchemaEntry *e, const YamlNode *node)
{
  char path[512];
  if (!schema_is(r, e, node, YAML_SEQUENCE, 0)) return PETSC_FALSE;
  if (r->dim ? node->n == r->dim : node->n == 2 || node->n == 3) return PETSC_TRUE;
  SchemaError(r, node, "%s must have %s, not %" PetscInt_FMT, yaml_path(node, path, sizeof(path)),
              r->dim == 3   ? "3 entries (kinematics: 3d)"
              : r->dim == 2 ? "2 entries (this case is two-dimensional)"
                            : "2 or 3 entries",
              node->n);
  return PETSC_FALSE;
}

PetscErrorCode SchemaReadVector(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscReal *value = (PetscReal *)((char *)target + e->offset);
  SchemaEntry one = *e;

  PetscFunctionBeginUser;
  one.type = TYPE_NUMBER;
  if (check_length(r, e, node))
    for (PetscInt i = 0; i < node->n; ++i) schema_number(r, &one, node->child[i], &value[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadSpin(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscFunctionBeginUser;
  if (r->dim == 2 || (r->dim == 0 && node->kind == YAML_SCALAR))
    schema_number(r, e, node, (PetscReal *)((char *)target + e->offset) + 2);
  else PetscCall(SchemaReadVector(r, e, node, target));
  PetscFunctionReturn(0);
}

/* 0 1 2 for x y z, NORMAL where lists take it, -1 and a message for anything else. */
static PetscInt values_axis(SchemaReader *r, const SchemaEntry *e, const YamlNode *node)
{
  const PetscInt first = e->type == TYPE_SPIN_AXIS && r->dim == 2 ? 2 : 0;
  const PetscInt last = e->type != TYPE_SPIN_AXIS && r->dim == 2 ? 1 : 2;
  SchemaEntry one = *e;
  for (PetscInt d = first; d <= last; ++d)
    if (node->kind == YAML_SCALAR && !strcmp(node->text, axis_words[d])) return d;
  if (e->type == TYPE_AXES) {
    if (node->kind == YAML_SCALAR && !strcmp(node->text, axis_words[NORMAL])) return NORMAL;
    one.type = TYPE_DIRECTION;
  }
  schema_mismatch(r, &one, node);
  return -1;
}

PetscErrorCode SchemaReadAxis(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  const PetscInt axis = values_axis(r, e, node);

  PetscFunctionBeginUser;
  if (axis >= 0) *(PetscInt *)((char *)target + e->offset) = axis;
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadAxes(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscBool *component = (PetscBool *)((char *)target + e->offset);
  char path[512];

  PetscFunctionBeginUser;
  if (!schema_is(r, e, node, YAML_SEQUENCE, 1)) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < node->n; ++i) {
    const PetscInt axis = values_axis(r, e, node->child[i]);
    if (axis < 0) continue;
    if (component[axis])
      SchemaError(r, node->child[i], "%s stands twice", yaml_path(node->child[i], path, sizeof(path)));
    component[axis] = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* Which of the words is it? NULL: none. */
static const SchemaWord *flag_of(const SchemaEntry *e, const YamlNode *node)
{
  const SchemaWord *word = e->words;
  while (word->word && (node->kind != YAML_SCALAR || strcmp(word->word, node->text))) ++word;
  return word->word ? word : NULL;
}

PetscErrorCode SchemaReadFlags(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscBool *flags = (PetscBool *)((char *)target + e->offset);
  char path[512], words[200] = "";

  PetscFunctionBeginUser;
  schema_append_words(e, " or ", words, sizeof(words));
  if (!schema_is(r, e, node, YAML_SEQUENCE, 0)) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < node->n; ++i) {
    const SchemaWord *word = flag_of(e, node->child[i]);
    if (word) flags[word->value] = PETSC_TRUE;
    else
      SchemaError(r, node->child[i], "%s must be %s, not '%s'", yaml_path(node->child[i], path, sizeof(path)), words,
                  node->child[i]->kind == YAML_SCALAR ? node->child[i]->text : "a list or a mapping");
  }
  PetscFunctionReturn(0);
}

/* Its keys are read, and its mistakes found, with the case of which it becomes a part. What is no
 * mapping or list where there is one cannot be laid over it. */
PetscErrorCode SchemaReadPart(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  const SchemaEntry *whole = schema_case.entries;

  (void)target;
  PetscFunctionBeginUser;
  while (strcmp(whole->key, e->key) != 0) ++whole;
  if (whole->type == TYPE_LIST) (void)schema_is(r, whole, node, YAML_SEQUENCE, 0);
  else if (whole->type == TYPE_TABLE || whole->type == TYPE_NAMED) (void)schema_is(r, whole, node, YAML_MAPPING, 0);
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadInterval(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscReal *min = (PetscReal *)((char *)target + e->offset), *max = (PetscReal *)((char *)target + e->second);
  SchemaEntry one = *e;
  char path[512];

  PetscFunctionBeginUser;
  one.type = TYPE_NUMBER;
  one.endless = PETSC_TRUE; /* from here to wherever */
  if (node->kind == YAML_SEQUENCE && node->n == 2) {
    if (schema_number(r, &one, node->child[0], min) && schema_number(r, &one, node->child[1], max) && *min > *max)
      SchemaError(r, node, "%s: the first number must not be larger than the second",
                  yaml_path(node, path, sizeof(path)));
  } else if (schema_parse_number(node, min)) *max = *min;
  else schema_mismatch(r, e, node);
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadSize(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  SchemaEntry one = *e;
  PetscReal unused;

  PetscFunctionBeginUser;
  (void)target; /* the check of the grid makes counts of it, where it knows the box */
  one.type = TYPE_NUMBER;
  if (node->kind != YAML_SEQUENCE) schema_number(r, e, node, &unused);
  else if (check_length(r, e, node))
    for (PetscInt i = 0; i < node->n; ++i) schema_number(r, &one, node->child[i], &unused);
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadCounts(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscInt *counts = (PetscInt *)((char *)target + e->offset);
  SchemaEntry one = *e;

  PetscFunctionBeginUser;
  one.type = TYPE_INTEGER;
  if (!check_length(r, e, node)) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < node->n; ++i) {
    one.offset = 0;
    PetscCall(SchemaReadInteger(r, &one, node->child[i], &counts[i]));
  }
  PetscFunctionReturn(0);
}

/* As numbers beyond what their unit can mean: it makes one of any load. */
static PetscBool read_factor(SchemaReader *r, const YamlNode *node, PetscReal *value)
{
  const SchemaEntry number = {.key = "factor", .type = TYPE_NUMBER, .help = ""};
  char path[512];
  if (!schema_number(r, &number, node, value)) return PETSC_FALSE;
  if (PetscAbsReal(*value) <= SCHEMA_LARGEST_FACTOR) return PETSC_TRUE;
  SchemaError(r, node, "%s: a factor of %g cannot be meant, nothing is larger than %g",
              yaml_path(node, path, sizeof(path)), (double)*value, SCHEMA_LARGEST_FACTOR);
  return PETSC_FALSE;
}

static void tell_order(SchemaReader *r, const YamlNode *pair, PetscBool jumps)
{
  char path[512];
  SchemaError(r, pair, "%s: times must grow from pair to pair", yaml_path(pair, path, sizeof(path)));
  if (jumps) diag_hint(r->diag, "a jump is two times close together, less than a step apart");
}

PetscErrorCode SchemaReadAmplitude(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  Amplitude *a = (Amplitude *)((char *)target + e->offset);
  const SchemaEntry time = {.key = e->key, .type = TYPE_NUMBER, .help = ""};
  char path[512];

  PetscFunctionBeginUser;
  if (!schema_is(r, e, node, YAML_SEQUENCE, 1)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(node->n, &a->time));
  PetscCall(PetscCalloc1(node->n, &a->value));
  a->n = node->n;
  for (PetscInt i = 0; i < node->n; ++i) {
    const YamlNode *pair = node->child[i];
    if (pair->kind != YAML_SEQUENCE || pair->n != 2)
      SchemaError(r, pair, "%s must be a pair [time in s, factor]", yaml_path(pair, path, sizeof(path)));
    else if (schema_number(r, &time, pair->child[0], &a->time[i]) && read_factor(r, pair->child[1], &a->value[i]) &&
             i > 0 && a->time[i] <= a->time[i - 1])
      tell_order(r, pair, a->time[i] == a->time[i - 1]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadAmplitudes(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  NamedAmplitude **amplitudes = (NamedAmplitude **)((char *)target + e->offset);

  PetscFunctionBeginUser;
  if (!schema_is(r, e, node, YAML_MAPPING, 1)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(node->n, amplitudes));
  *(PetscInt *)((char *)target + e->count) = node->n;
  for (PetscInt i = 0; i < node->n; ++i) {
    const YamlNode *child = node->child[i];
    const SchemaEntry one = {.key = child->key, .type = TYPE_AMPLITUDE, .help = ""};
    PetscCall(PetscStrallocpy(child->key, &(*amplitudes)[i].name));
    PetscCall(SchemaReadAmplitude(r, &one, child, &(*amplitudes)[i].amplitude));
    (*amplitudes)[i].amplitude.since = child->stage;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadPolygon(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscReal **vertices = (PetscReal **)((char *)target + e->offset);
  const SchemaEntry number = {.key = e->key, .type = TYPE_NUMBER, .help = "", .unit = "m"};
  char path[512];

  PetscFunctionBeginUser;
  if (!schema_is(r, e, node, YAML_SEQUENCE, e->type == TYPE_LINE ? 2 : 3)) PetscFunctionReturn(0);
  PetscCall(PetscFree(*vertices));
  PetscCall(PetscCalloc1(2 * (size_t)node->n, vertices));
  *(PetscInt *)((char *)target + e->count) = node->n;
  for (PetscInt i = 0; i < node->n; ++i) {
    const YamlNode *pair = node->child[i];
    if (pair->kind != YAML_SEQUENCE || pair->n != 2)
      SchemaError(r, pair, "%s must be a corner [x, y] in m", yaml_path(pair, path, sizeof(path)));
    else
      for (PetscInt d = 0; d < 2; ++d) schema_number(r, &number, pair->child[d], &(*vertices)[2 * i + d]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadEvery(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  const SchemaEntry count = {.type = TYPE_INTEGER, .bounded = PETSC_TRUE, .min = 1, .max = PETSC_MAX_REAL};
  PetscReal *every = (PetscReal *)((char *)target + e->offset), seconds;
  const YamlNode *steps = yaml_find(node, "steps");
  PetscInt n = 0;

  PetscFunctionBeginUser;
  if (node->kind == YAML_SCALAR && !strcmp(node->text, "end")) *every = 0;
  else if (schema_parse_number(node, &seconds) && seconds > 0) *every = seconds;
  else if (steps && node->n == 1) {
    PetscCall(SchemaReadInteger(r, &count, steps, &n));
    *every = -(PetscReal)n;
  } else schema_mismatch(r, e, node);
  PetscFunctionReturn(0);
}

static void unknown_field(SchemaReader *r, const YamlNode *node)
{
  const char *words[OUTPUT_FIELDS_MOST + 1] = {NULL};
  const char *word = node->kind == YAML_SCALAR ? node->text : NULL;
  char path[512];
  PetscInt n = 0;
  for (const OutputField *field = output_fields; field->name; ++field) words[n++] = field->name;
  SchemaError(r, node, "%s: there is no field '%s'", yaml_path(node, path, sizeof(path)), word ? word : "[...]");
  schema_hint_words(r, word, n, words);
  if (!diag_full(r->diag, DIAG_ERROR) && !(word && diag_nearest(word, words)))
    diag_hint(r->diag, "what points of a law of one's own keep is a field, too, where --law loads it");
}

PetscErrorCode SchemaReadFields(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  char ***fields = (char ***)((char *)target + e->offset);
  PetscInt *n = (PetscInt *)((char *)target + e->count);

  PetscFunctionBeginUser;
  if (!schema_is(r, e, node, YAML_SEQUENCE, 0)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(node->n, fields));
  for (PetscInt i = 0; i < node->n; ++i) {
    const YamlNode *child = node->child[i];
    PetscBool twice = PETSC_FALSE;
    if (child->kind != YAML_SCALAR || !output_field_find(child->text)) {
      unknown_field(r, child);
      continue;
    }
    for (PetscInt k = 0; k < *n; ++k)
      if (!strcmp((*fields)[k], child->text)) twice = PETSC_TRUE;
    if (!twice) PetscCall(PetscStrallocpy(child->text, &(*fields)[(*n)++]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadNumbers(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  NamedValue **values = (NamedValue **)((char *)target + e->offset);
  const SchemaEntry number = {.key = e->key, .type = TYPE_NUMBER, .help = ""};

  PetscFunctionBeginUser;
  if (!schema_is(r, e, node, YAML_MAPPING, 0)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(node->n, values));
  *(PetscInt *)((char *)target + e->count) = node->n;
  for (PetscInt i = 0; i < node->n; ++i) {
    PetscCall(PetscStrallocpy(node->child[i]->key, &(*values)[i].name));
    if (node->child[i]->key[0] == '-') /* gmsh would take it for an option of its own */
      SchemaKeyError(r, node->child[i], "the name '%.60s' begins with '-'", node->child[i]->key);
    schema_check_name(r, node->child[i], node->child[i]->key, PETSC_TRUE);
    schema_number(r, &number, node->child[i], &(*values)[i].value);
  }
  PetscFunctionReturn(0);
}
