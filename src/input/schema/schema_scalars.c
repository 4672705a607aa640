/* Readers of single values: numbers, words, texts, names. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/text.h"
#include "input/schema/schema.h"
#include "material/law.h"

/* [+-] digits [. digits] [e [+-] digits], at least one digit before the exponent: no hexadecimal,
 * no inf, no nan. */
static PetscBool looks_like_number(const char *p)
{
  int digits = 0;
  if (*p == '+' || *p == '-') ++p;
  for (; isdigit((unsigned char)*p); ++p) ++digits;
  if (*p == '.')
    for (++p; isdigit((unsigned char)*p); ++p) ++digits;
  if (digits == 0) return PETSC_FALSE;
  if (*p == 'e' || *p == 'E') {
    ++p;
    if (*p == '+' || *p == '-') ++p;
    if (!isdigit((unsigned char)*p)) return PETSC_FALSE;
    while (isdigit((unsigned char)*p)) ++p;
  }
  return !*p;
}

PetscBool schema_parse_number(const YamlNode *node, PetscReal *value)
{
  if (!node || node->kind != YAML_SCALAR || !node->plain || !looks_like_number(node->text)) return PETSC_FALSE;
  *value = strtod(node->text, NULL);
  return !PetscIsInfOrNanReal(*value);
}

PetscBool schema_parse_integer(const YamlNode *node, PetscInt *value)
{
  PetscReal real;
  if (!schema_parse_number(node, &real) || real != PetscFloorReal(real) || PetscAbsReal(real) > 2147483647.)
    return PETSC_FALSE;
  *value = (PetscInt)real;
  return PETSC_TRUE;
}

static PetscBool in_range(const SchemaEntry *e, PetscReal v)
{
  if (!e->bounded) return PETSC_TRUE;
  if (v < e->min || (e->min_open && v <= e->min)) return PETSC_FALSE;
  return !(v > e->max || (e->max_open && v >= e->max));
}

static const char *describe(const YamlNode *node, char *buffer, size_t size)
{
  const char *article = node->kind != YAML_SCALAR && !node->n ? "an empty" : "a";
  if (node->kind == YAML_SEQUENCE) snprintf(buffer, size, "%s list", article);
  else if (node->kind == YAML_MAPPING) snprintf(buffer, size, "%s mapping", article);
  else if (yaml_is_null(node)) snprintf(buffer, size, "empty");
  else
    snprintf(buffer, size, node->plain ? "%s'%.60s'" : "%s'%.60s' in quotes", node->plain ? "" : "the text ",
             node->text);
  return buffer;
}

/* What people write where a number belongs. */
static void hint_number(SchemaReader *r, const SchemaEntry *e, const YamlNode *node)
{
  char *end;
  if (node->kind != YAML_SCALAR) return;
  if (!node->plain && looks_like_number(node->text)) diag_hint(r->diag, "leave the quotes out");
  else if (strcspn(node->text, "0123456789") && strchr("nNiI.+-", node->text[0]) && node->text[0] &&
           !isdigit((unsigned char)node->text[0]) && strtod(node->text, &end) != 0 && !*end)
    diag_hint(r->diag, "a finite number is needed");
  else if (looks_like_number(node->text)) diag_hint(r->diag, "the number is too large for this machine");
  else if (isdigit((unsigned char)node->text[0]) && strchr(node->text, ','))
    diag_hint(r->diag, "decimals follow a point: 1.5");
  else if (isdigit((unsigned char)node->text[0]) && e->unit && e->unit[0])
    diag_hint(r->diag, "write the number alone; its unit is %s", e->unit);
}

void schema_mismatch(SchemaReader *r, const SchemaEntry *e, const YamlNode *node)
{
  char path[512], expected[300], found[120];
  SchemaError(r, node, "%s must be %s, not %s", yaml_path(node, path, sizeof(path)),
              schema_expected(e, r->dim, expected, sizeof(expected)), describe(node, found, sizeof(found)));
}

/* Generous: a neutron star has 1e18 kg/m3, light 3e8 m/s. Beyond them sums and products run out of
 * digits or of the machine's range, and a body does not even fall (docs/trust.md). */
const SchemaMagnitude schema_magnitudes[] = {
  {"kg/m3", 1e-15, 1e19}, {"Pa", 1e-30, 1e20}, {"N/m2", 0, 1e20},  {"N", 0, 1e30},   {"m", 0, 1e30}, {"m/s", 0, 3e8},
  {"m/s2", 0, 1e15},      {"s", 1e-20, 1e20},  {"rad/s", 0, 1e15}, {"1/s", 0, 1e15}, {NULL, 0, 0},
};

static PetscBool can_be_meant(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, PetscReal value)
{
  const PetscReal size = PetscAbsReal(value);
  const SchemaMagnitude *m = schema_magnitudes;
  char path[512];
  while (m->unit && (!e->unit || strcmp(m->unit, e->unit))) ++m;
  if (e->endless || !m->unit || size == 0 || (size >= m->least && size <= m->most)) return PETSC_TRUE;
  SchemaError(r, node, "%s: %g %s cannot be meant, nothing is %s than %g", yaml_path(node, path, sizeof(path)),
              (double)value, e->unit, size > m->most ? "larger" : "smaller",
              (double)(size > m->most ? m->most : m->least));
  diag_hint(r->diag, "is it written in %s? Everything in a case file is in SI units", e->unit);
  return PETSC_FALSE;
}

PetscBool schema_number(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, PetscReal *value)
{
  if (!schema_parse_number(node, value)) {
    schema_mismatch(r, e, node);
    hint_number(r, e, node);
    return PETSC_FALSE;
  }
  if (in_range(e, *value)) return can_be_meant(r, e, node, *value);
  schema_mismatch(r, e, node);
  return PETSC_FALSE;
}

PetscErrorCode SchemaReadNumber(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscFunctionBeginUser;
  schema_number(r, e, node, (PetscReal *)((char *)target + e->offset));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadInteger(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscInt value;

  PetscFunctionBeginUser;
  if (!schema_parse_integer(node, &value) || !in_range(e, (PetscReal)value)) schema_mismatch(r, e, node);
  else *(PetscInt *)((char *)target + e->offset) = value;
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadBoolean(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  const char *text = node->kind == YAML_SCALAR && node->plain ? node->text : "";
  PetscBool *value = (PetscBool *)((char *)target + e->offset);

  PetscFunctionBeginUser;
  if (!strcmp(text, "true")) *value = PETSC_TRUE;
  else if (!strcmp(text, "false")) *value = PETSC_FALSE;
  else schema_mismatch(r, e, node);
  PetscFunctionReturn(0);
}

/* Its word is NULL, and a mistake is told, if there is none. */
static SchemaWord find_word(SchemaReader *r, const SchemaEntry *e, const YamlNode *node)
{
  const char *words[32] = {NULL}, *text = node->kind == YAML_SCALAR ? node->text : NULL;
  int n = 0;
  for (; schema_word(e, n).word && n < 31; ++n) {
    words[n] = schema_word(e, n).word;
    if (text && !strcmp(text, words[n])) return schema_word(e, n);
  }
  schema_mismatch(r, e, node);
  if (text && schema_hint_synonym(r, text, n, words)) return schema_word(e, n);
  const char *nearest = text ? diag_nearest(text, words) : NULL;
  if (text && e->registry == (const void *const *)laws)
    diag_hint(r->diag, "%s%s%sa law of your own is loaded by --law %.48s=FILE.so: docs/plugin.md",
              nearest ? "did you mean '" : "", nearest ? nearest : "", nearest ? "'? Or " : "", text);
  else if (nearest) schema_hint_words(r, text, n, words);
  return schema_word(e, n);
}

PetscErrorCode SchemaReadWord(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  const SchemaWord word = find_word(r, e, node);

  PetscFunctionBeginUser;
  if (word.word) *(int *)((char *)target + e->offset) = word.value;
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadMember(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  const SchemaWord word = find_word(r, e, node);

  PetscFunctionBeginUser;
  if (word.word) *(const void **)((char *)target + e->offset) = e->registry[word.value];
  PetscFunctionReturn(0);
}

static PetscErrorCode Store(const char *text, const SchemaEntry *e, void *target)
{
  char **place = (char **)((char *)target + e->offset);

  PetscFunctionBeginUser;
  PetscCall(PetscFree(*place));
  PetscCall(PetscStrallocpy(text, place));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadWordText(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  const SchemaWord word = find_word(r, e, node);

  PetscFunctionBeginUser;
  if (word.word) PetscCall(Store(word.word, e, target));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadText(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscFunctionBeginUser;
  if (node->kind != YAML_SCALAR || (yaml_is_null(node) && !e->fallback)) schema_mismatch(r, e, node);
  else PetscCall(Store(node->text, e, target));
  PetscFunctionReturn(0);
}

PetscBool schema_check_name(SchemaReader *r, const YamlNode *node, const char *name, PetscBool key)
{
  const size_t good = strcspn(name, ".[]=,\"'\n\t{}:");
  if (name[0] && !name[good] && strlen(name) < 128 && name[0] != ' ') return PETSC_TRUE;
  if (!name[0]) yaml_error(r->document, r->diag, node, key, "a name may not be empty");
  else if (!name[good]) yaml_error(r->document, r->diag, node, key, "this name is too long or begins with a space");
  else
    yaml_error(r->document, r->diag, node, key, "the name '%.60s' may not hold the character '%c'", name, name[good]);
  diag_hint(r->diag, "letters, digits, '_' and '-' make good names");
  return PETSC_FALSE;
}

PetscErrorCode SchemaReadName(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscFunctionBeginUser;
  if (node->kind != YAML_SCALAR || yaml_is_null(node)) schema_mismatch(r, e, node);
  else if (schema_check_name(r, node, node->text, PETSC_FALSE)) PetscCall(Store(node->text, e, target));
  PetscFunctionReturn(0);
}

/* The entries of a list are joined by commas. */
PetscErrorCode SchemaReadValues(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  TextStream stream;
  char *text;

  PetscFunctionBeginUser;
  if (yaml_is_null(node) || (node->kind != YAML_SCALAR && !node->n)) {
    schema_mismatch(r, e, node);
    PetscFunctionReturn(0);
  }
  PetscCall(TextOpen(&stream));
  for (PetscInt i = 0; node->kind == YAML_SEQUENCE && i < node->n; ++i) {
    if (i) fputs(", ", stream.out);
    schema_write_flow(stream.out, node->child[i]);
  }
  if (node->kind == YAML_SCALAR) fputs(node->text, stream.out);
  else if (node->kind == YAML_MAPPING) schema_write_flow(stream.out, node);
  PetscCall(TextClose(&stream, &text));
  PetscCall(Store(text, e, target));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

/* Made absolute, so that the resolved case means the same wherever it is read. */
PetscErrorCode SchemaReadFile(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  const char *folder = r->c->folder;
  char here[PETSC_MAX_PATH_LEN], path[3 * PETSC_MAX_PATH_LEN], key[512];

  PetscFunctionBeginUser;
  if (node->kind != YAML_SCALAR || yaml_is_null(node)) {
    schema_mismatch(r, e, node);
    PetscFunctionReturn(0);
  }
  if (!getcwd(here, sizeof(here))) PetscCall(PetscStrcpy(here, "."));
  if (node->text[0] == '/') snprintf(path, sizeof(path), "%s", node->text);
  else if (folder[0] == '/') snprintf(path, sizeof(path), "%s/%s", folder, node->text);
  else if (!strcmp(folder, ".")) snprintf(path, sizeof(path), "%s/%s", here, node->text);
  else snprintf(path, sizeof(path), "%s/%s/%s", here, folder, node->text);
  PetscCall(Store(path, e, target));
  PetscCall(CaseAddFile(r->c, yaml_path(node, key, sizeof key), path));
  PetscFunctionReturn(0);
}

/* Names at the top of the file under `target`: keys of a mapping, or `name` of the entries of a
 * list. */
static PetscInt collect_names(const SchemaReader *r, const char *target, PetscInt max, const char **names)
{
  const YamlNode *group = yaml_find(r->document->root, target);
  PetscInt n = 0;
  for (PetscInt i = 0; group && i < group->n && n < max; ++i) {
    const YamlNode *name = group->kind == YAML_SEQUENCE ? yaml_find(group->child[i], "name") : NULL;
    if (group->kind == YAML_MAPPING) names[n++] = group->child[i]->key;
    else if (name && name->text) names[n++] = name->text;
  }
  return n;
}

static PetscErrorCode CheckReference(SchemaReader *r, const YamlNode *node, const char *target, PetscBool *found)
{
  const YamlNode *group = yaml_find(r->document->root, target);
  const PetscInt max = group ? group->n : 0;
  const char **names;
  char path[512];

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(PetscCalloc1(max + 1, &names));
  const PetscInt n = collect_names(r, target, max, names);
  for (PetscInt i = 0; i < n; ++i)
    if (!strcmp(names[i], node->text)) *found = PETSC_TRUE;
  if (!*found) {
    SchemaError(r, node, "%s: there is no '%s' in %s", yaml_path(node, path, sizeof(path)), node->text, target);
    schema_hint_words(r, node->text, n, names);
  }
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadReference(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  PetscBool found;

  PetscFunctionBeginUser;
  if (node->kind != YAML_SCALAR || yaml_is_null(node)) {
    schema_mismatch(r, e, node);
    PetscFunctionReturn(0);
  }
  PetscCall(CheckReference(r, node, e->target, &found));
  if (found) PetscCall(Store(node->text, e, target));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadReferences(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  char ***names = (char ***)((char *)target + e->offset);
  PetscInt *n = (PetscInt *)((char *)target + e->count);
  SchemaEntry one = *e;
  PetscBool found;

  PetscFunctionBeginUser;
  one.type = TYPE_REFERENCE;
  if (!schema_is(r, e, node, YAML_SEQUENCE, 1)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(node->n, names));
  for (PetscInt i = 0; i < node->n; ++i) {
    const YamlNode *child = node->child[i];
    found = PETSC_FALSE;
    if (child->kind != YAML_SCALAR || yaml_is_null(child)) schema_mismatch(r, &one, child);
    else PetscCall(CheckReference(r, child, e->target, &found));
    if (found) PetscCall(PetscStrallocpy(child->text, &(*names)[(*n)++]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadBoundary(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  const YamlNode *list = yaml_find(r->document->root, "boundary");
  PetscInt *value = (PetscInt *)((char *)target + e->offset);
  PetscBool found = PETSC_FALSE;
  char path[512];

  PetscFunctionBeginUser;
  if (node->kind != YAML_SCALAR || yaml_is_null(node)) schema_mismatch(r, e, node);
  else if (schema_parse_integer(node, value)) {
    if (*value >= 0 && list && *value < list->n) PetscFunctionReturn(0);
    SchemaError(r, node, "%s: boundary has %" PetscInt_FMT " entries, counted from 0",
                yaml_path(node, path, sizeof(path)), list ? list->n : 0);
  } else {
    PetscCall(CheckReference(r, node, "boundary", &found));
    for (PetscInt i = 0; found && i < list->n; ++i) {
      const YamlNode *name = yaml_find(list->child[i], "name");
      if (name && name->text && !strcmp(name->text, node->text)) *value = i;
    }
    PetscBool named = PETSC_FALSE;
    for (PetscInt i = 0; list && i < list->n; ++i) named |= yaml_find(list->child[i], "name") != NULL;
    if (!found && !named) diag_hint(r->diag, "name an entry of boundary (name: ...) or give its index, counted from 0");
  }
  PetscFunctionReturn(0);
}
