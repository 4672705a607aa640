/* Mappings, lists and named lists: walk the table, read each key, complain about the rest. */
#include <string.h>
#include "input/schema/schema.h"

SchemaEntry schema_entry(const SchemaTable *table, PetscInt i)
{
  return table->entry ? table->entry(i) : table->entries[i];
}

const SchemaGroup schema_one_tag[] = {{GROUP_ONE, {NULL}}, {GROUP_NONE, {NULL}}};

const char *schema_group_key(const SchemaTable *table, const SchemaGroup *group, PetscInt k)
{
  SchemaEntry entry;
  if (group->keys[0]) return group->keys[k];
  for (PetscInt i = 0; (entry = schema_entry(table, i)).key; ++i)
    if (entry.tagged && k-- == 0) return entry.key;
  return NULL;
}

/* Its key is NULL if there is none. */
static SchemaEntry find_entry(const SchemaTable *table, const char *key)
{
  PetscInt i = 0;
  SchemaEntry entry;
  while ((entry = schema_entry(table, i)).key && strcmp(entry.key, key)) ++i;
  return entry;
}

PetscBool schema_fits(const SchemaReader *r, const SchemaEntry *entry)
{
  return (PetscBool) !((entry->only_2d && r->dim == 3) || (entry->only_3d && r->dim == 2) || (entry->turns && r->hoop));
}

/* A key with nothing behind it would count as given for the groups and as absent for the rest, so
 * it is a mistake. Whoever has commented out what stood there wants the key out, too. */
static void hint_empty(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node)
{
  const PetscBool nested = entry->type == TYPE_TABLE || entry->type == TYPE_LIST || entry->type == TYPE_NAMED;
  if (nested && !entry->required && !entry->tagged && yaml_is_null(node))
    diag_hint(r->diag, "leave '%s' out if nothing is meant", entry->key);
}

#define MOST_WORDS 64

void schema_hint_words(SchemaReader *r, const char *word, PetscInt n, const char *const *words)
{
  if (diag_full(r->diag, DIAG_ERROR)) return; /* its error is not shown */
  const char *nearest = word ? diag_nearest(word, words) : NULL;
  char list[600] = "";
  if (nearest) {
    diag_hint(r->diag, "did you mean '%s'?", nearest);
    return;
  }
  for (PetscInt i = 0; i < n; ++i) {
    const size_t used = strlen(list);
    snprintf(list + used, sizeof(list) - used, "%s%s", i ? ", " : "", words[i]);
  }
  if (n) diag_hint(r->diag, "known here: %s%s", list, strlen(list) + 1 == sizeof(list) ? "..." : "");
}

/* The table's keys that there are in this kinematics. */
static PetscInt words_of(SchemaReader *r, const SchemaTable *table, const char *words[MOST_WORDS + 1])
{
  SchemaEntry entry;
  PetscInt n = 0;
  for (PetscInt i = 0; (entry = schema_entry(table, i)).key && n < MOST_WORDS; ++i)
    if (schema_fits(r, &entry)) words[n++] = entry.key;
  words[n] = NULL;
  return n;
}

static PetscErrorCode UnknownKeys(SchemaReader *r, const SchemaTable *table, const YamlNode *mapping)
{
  const char *words[MOST_WORDS + 1];
  SchemaEntry entry;
  char path[512];

  PetscFunctionBeginUser;
  const PetscInt n = words_of(r, table, words);
  for (PetscInt i = 0; i < mapping->n; ++i) {
    YamlNode *child = mapping->child[i];
    entry = find_entry(table, child->key);
    if (entry.key && schema_fits(r, &entry)) continue;
    if (entry.key) {
      SchemaKeyError(r, child, "key '%s' of %s %s", child->key, yaml_path(mapping, path, sizeof(path)),
                     entry.turns     ? "has no meaning in axisymmetry: nothing turns, about the axis nor across it"
                     : entry.only_2d ? "belongs to two dimensions, this case is 3d"
                                     : "belongs to kinematics: 3d, this case is two-dimensional");
      if (!strcmp(child->key, "circle")) diag_hint(r->diag, "in 3d there is 'sphere'");
      if (!strcmp(child->key, "sphere")) diag_hint(r->diag, "in two dimensions there is 'circle'");
    } else {
      SchemaKeyError(r, child, "key '%s' of %s is not known", child->key, yaml_path(mapping, path, sizeof(path)));
      child->meant = schema_meant(child->key, n, words);
      if (schema_hint_key(r, child, n, words)) continue;
      if (diag_nearest(child->key, words) || !schema_hint_elsewhere(r, table, child->key))
        schema_hint_words(r, child->key, n, words);
    }
  }
  PetscFunctionReturn(0);
}

static void check_required(SchemaReader *r, const SchemaEntry *entry, const YamlNode *mapping)
{
  char path[512], expected[300];
  if (!entry->required || !schema_fits(r, entry)) return;
  if (yaml_find(mapping, entry->key) || schema_is_meant(mapping, entry->key)) return;
  SchemaKeyError(r, mapping, "key '%s' of %s is missing", entry->key, yaml_path(mapping, path, sizeof(path)));
  diag_hint(r->diag, "%s: %s (%s)", entry->key, entry->help,
            schema_expected(entry, r->dim, expected, sizeof(expected)));
}

static PetscErrorCode ReadDefault(SchemaReader *r, const SchemaEntry *entry, void *target)
{
  YamlNode *node = NULL, scalar = {.kind = YAML_SCALAR, .plain = PETSC_TRUE};

  PetscFunctionBeginUser;
  if (entry->type == TYPE_TABLE) {
    YamlNode empty = {.kind = YAML_MAPPING};
    PetscCall(SchemaReadEntry(r, entry, &empty, target));
  } else if (strchr("[{", entry->fallback[0])) {
    PetscCall(YamlParseInto(r->document, entry->fallback, strlen(entry->fallback), 0, r->diag, &node));
    PetscCall(SchemaReadEntry(r, entry, node, target));
    PetscCall(YamlNodeDestroy(&node));
  } else {
    PetscCall(PetscStrallocpy(entry->fallback, &scalar.text));
    PetscCall(SchemaReadEntry(r, entry, &scalar, target));
    PetscCall(PetscFree(scalar.text));
  }
  PetscFunctionReturn(0);
}

static PetscBool in_group(const SchemaTable *table, const char *key)
{
  const char *other;
  for (const SchemaGroup *group = table->groups; group && group->kind != GROUP_NONE; ++group)
    for (PetscInt k = 0; (other = schema_group_key(table, group, k)); ++k)
      if (!strcmp(other, key)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode SetTag(const SchemaTable *table, const SchemaEntry *entry, void *target)
{
  void *tag = (char *)target + table->tag_offset;

  PetscFunctionBeginUser;
  if (!table->tag_is_key) *(int *)tag = entry->tag;
  else if (!*(char **)tag) /* of two keys that exclude each other the first */
    PetscCall(PetscStrallocpy(entry->key, (char **)tag));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadKey(SchemaReader *r, const SchemaTable *table, const SchemaEntry *entry,
                              const YamlNode *mapping, void *target)
{
  const YamlNode *node = yaml_find(mapping, entry->key);
  char path[512];

  PetscFunctionBeginUser;
  if (!schema_fits(r, entry)) PetscFunctionReturn(0);
  if (node) {
    if (entry->with && !yaml_find(mapping, entry->with))
      SchemaKeyError(r, node, "key '%s' of %s means something only beside '%s'", entry->key,
                     yaml_path(mapping, path, sizeof(path)), entry->with);
    if (entry->tagged) PetscCall(SetTag(table, entry, target));
    if (entry->present) *(PetscBool *)((char *)target + entry->present - 1) = PETSC_TRUE;
    PetscCall(SchemaReadEntry(r, entry, node, target));
    hint_empty(r, entry, node);
  } else if (!entry->required && (entry->always || (entry->fallback && !in_group(table, entry->key))))
    PetscCall(ReadDefault(r, entry, target));
  PetscFunctionReturn(0);
}

static void check_group(SchemaReader *r, const SchemaTable *table, const SchemaGroup *group, const YamlNode *mapping)
{
  const YamlNode *first = NULL, *second = NULL;
  const char *key;
  PetscBool meant = PETSC_FALSE;
  char path[512], words[400] = "";
  for (PetscInt k = 0; (key = schema_group_key(table, group, k)); ++k) {
    const YamlNode *node = yaml_find(mapping, key);
    const size_t used = strlen(words);
    const char *join = !k ? "" : schema_group_key(table, group, k + 1) ? ", " : " or ";
    snprintf(words + used, sizeof(words) - used, "%s'%s'", join, key);
    if (node && !first) first = node;
    else if (node && !second) second = node;
    meant |= schema_is_meant(mapping, key);
  }
  yaml_path(mapping, path, sizeof(path));
  if (!first && !meant && group->kind != GROUP_AT_MOST_ONE)
    SchemaKeyError(r, mapping, "%s needs %s %s", path, group->kind == GROUP_ONE ? "one of" : "at least one of", words);
  if (second && group->kind != GROUP_AT_LEAST_ONE) {
    const YamlNode *later = second->index > first->index ? second : first;
    SchemaKeyError(r, later, "%s has both '%s' and '%s'; give one of them", path, first->key, second->key);
  }
}

PetscErrorCode SchemaReadTable(SchemaReader *r, const SchemaTable *table, const YamlNode *mapping, void *target)
{
  const PetscInt before = diag_errors(r->diag);
  SchemaEntry entry;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; (entry = schema_entry(table, i)).key; ++i) PetscCall(ReadKey(r, table, &entry, mapping, target));
  if (table->open) PetscCall((*table->open)(r, mapping, target));
  else PetscCall(UnknownKeys(r, table, mapping));
  for (const SchemaGroup *group = table->groups; group && group->kind != GROUP_NONE; ++group)
    check_group(r, table, group, mapping);
  for (PetscInt i = 0; (entry = schema_entry(table, i)).key; ++i) check_required(r, &entry, mapping);
  if (table->check && diag_errors(r->diag) == before) PetscCall((*table->check)(r, mapping, target));
  PetscFunctionReturn(0);
}

PetscBool schema_is(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, YamlKind kind, PetscInt least)
{
  char path[512], expected[300];
  if (node->kind == kind && node->n >= least) return PETSC_TRUE;
  if (node->kind == kind && node->n) /* too short, but of the right kind */
    SchemaError(r, node, "%s must be %s, not a %s of %d", yaml_path(node, path, sizeof(path)),
                schema_expected(entry, r->dim, expected, sizeof(expected)), kind == YAML_SEQUENCE ? "list" : "mapping",
                (int)node->n);
  else schema_mismatch(r, entry, node);
  return PETSC_FALSE;
}

static PetscErrorCode ReadNested(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, void *target)
{
  const char *words[MOST_WORDS + 1] = {NULL};

  PetscFunctionBeginUser;
  if (schema_is(r, entry, node, YAML_MAPPING, 0))
    PetscCall(SchemaReadTable(r, entry->table, node, (char *)target + entry->offset));
  else if (node->kind == YAML_SCALAR && !schema_hint_name(r, entry->table, node))
    schema_hint_words(r, NULL, words_of(r, entry->table, words), words);
  PetscFunctionReturn(0);
}

/* Room for n more structs at the end of the array; *first is the new one. */
static PetscErrorCode Grow(const SchemaEntry *entry, PetscInt n, void *target, PetscInt **count, char **first)
{
  void **array = (void **)((char *)target + entry->offset);
  const size_t size = entry->table->size;

  PetscFunctionBeginUser;
  *count = (PetscInt *)((char *)target + entry->count);
  PetscCall(PetscRealloc((size_t)(**count + n) * size, array));
  *first = (char *)*array + (size_t) * *count * size;
  PetscCall(PetscMemzero(*first, (size_t)n * size));
  PetscFunctionReturn(0);
}

/* Entry i of a list may not have the name of one before it. */
static PetscErrorCode CheckNameTwice(SchemaReader *r, const YamlNode *list, PetscInt i, Names *names)
{
  const YamlNode *name = yaml_find(list->child[i], "name");
  char path[512];

  PetscFunctionBeginUser;
  if (!name || !name->text) PetscFunctionReturn(0);
  const PetscInt first = names_find(names, name->text);
  if (first < 0) PetscCall(NamesSet(names, name->text, i));
  else
    SchemaError(r, name, "the name '%s' is taken by %s", name->text, yaml_path(list->child[first], path, sizeof(path)));
  PetscFunctionReturn(0);
}

/* What stands in lists and under names. */
static const SchemaEntry item_entry = {.type = TYPE_TABLE};

static PetscErrorCode ReadList(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, void *target)
{
  const SchemaTable *table = entry->table;
  PetscInt *count;
  Names names = {0};
  char *item, path[512];

  PetscFunctionBeginUser;
  if (!schema_is(r, entry, node, YAML_SEQUENCE, 0)) PetscFunctionReturn(0);
  if (node->n == 0 && entry->required) SchemaError(r, node, "%s is an empty list", yaml_path(node, path, sizeof(path)));
  if (node->n == 0) PetscFunctionReturn(0);
  PetscCall(Grow(entry, node->n, target, &count, &item));
  for (PetscInt i = 0; i < node->n; ++i, item += table->size) {
    *count += 1;
    if (entry->items_tagged) *(int *)(item + table->tag_offset) = entry->tag;
    PetscCall(CheckNameTwice(r, node, i, &names));
    if (schema_is(r, &item_entry, node->child[i], YAML_MAPPING, 0))
      PetscCall(SchemaReadTable(r, table, node->child[i], item));
  }
  PetscCall(NamesFree(&names));
  PetscFunctionReturn(0);
}

/* Has a mapping what its table cannot do without? */
static PetscBool is_whole(const SchemaTable *table, const YamlNode *mapping)
{
  SchemaEntry entry;
  const char *key;
  for (PetscInt i = 0; (entry = schema_entry(table, i)).key; ++i)
    if (entry.required && !yaml_find(mapping, entry.key)) return PETSC_FALSE;
  for (const SchemaGroup *group = table->groups; group && group->kind != GROUP_NONE; ++group) {
    PetscBool any = group->kind == GROUP_AT_MOST_ONE;
    for (PetscInt k = 0; (key = schema_group_key(table, group, k)); ++k) any |= yaml_find(mapping, key) != NULL;
    if (!any) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* `--set materials.ruber.young=1` where there is a rubber: a part of something that is not there. What is given whole
 * (`--set 'materials.steel={...}'`) has a place in that text, and is read with its own mistakes. */
static PetscErrorCode NotThere(SchemaReader *r, const SchemaTable *table, const YamlNode *child, PetscBool *tell)
{
  const YamlNode *list = child->parent;
  const char **names;
  char path[512];
  PetscInt n = 0;

  PetscFunctionBeginUser;
  *tell = child->argument && !child->key_place.line && !child->place.line && child->kind == YAML_MAPPING &&
          !is_whole(table, child);
  if (!*tell) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(list->n + 1, &names));
  for (PetscInt i = 0; i < list->n; ++i)
    if (list->child[i]->key_place.line) names[n++] = list->child[i]->key;
  SchemaError(r, child, "there is no '%s' in %s", child->key, yaml_path(list, path, sizeof(path)));
  diag_hint_names(r->diag, child->key, names);
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadNamed(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, void *target)
{
  PetscInt *count;
  PetscBool not_there;
  char *item, path[512];

  PetscFunctionBeginUser;
  if (!schema_is(r, entry, node, YAML_MAPPING, 0)) PetscFunctionReturn(0);
  if (node->n == 0 && entry->required) SchemaError(r, node, "%s is empty", yaml_path(node, path, sizeof(path)));
  if (node->n == 0) PetscFunctionReturn(0);
  PetscCall(Grow(entry, node->n, target, &count, &item));
  for (PetscInt i = 0; i < node->n; ++i, item += entry->table->size) {
    const YamlNode *child = node->child[i];
    *count += 1;
    PetscCall(PetscStrallocpy(child->key, (char **)item));
    schema_check_name(r, child, child->key, PETSC_TRUE);
    PetscCall(NotThere(r, entry->table, child, &not_there));
    if (not_there) continue;
    if (schema_is(r, &item_entry, child, YAML_MAPPING, 0)) PetscCall(SchemaReadTable(r, entry->table, child, item));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadEntry(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, void *target)
{
  PetscFunctionBeginUser;
  switch (entry->type) {
  case TYPE_TABLE: PetscCall(ReadNested(r, entry, node, target)); break;
  case TYPE_LIST: PetscCall(ReadList(r, entry, node, target)); break;
  case TYPE_NAMED: PetscCall(ReadNamed(r, entry, node, target)); break;
  default: PetscCall((*schema_types[entry->type].read)(r, entry, node, target));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ClearItems(const SchemaEntry *entry, PetscInt n, char **items)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    char *item = *items + (size_t)i * entry->table->size;
    if (entry->type == TYPE_NAMED) PetscCall(PetscFree(*(char **)item));
    PetscCall(SchemaClear(entry->table, item));
  }
  PetscCall(PetscFree(*items));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaClear(const SchemaTable *table, void *target)
{
  PetscFunctionBeginUser;
  for (const SchemaEntry *entry = table->entries; entry->key; ++entry) {
    void *at = (char *)target + entry->offset;
    const PetscInt n = entry->count ? *(PetscInt *)((char *)target + entry->count) : 0;
    if (entry->type == TYPE_TEXT || entry->type == TYPE_NAME || entry->type == TYPE_VALUES)
      PetscCall(PetscFree(*(char **)at));
    if (entry->type == TYPE_TABLE) PetscCall(SchemaClear(entry->table, at));
    if (entry->type == TYPE_LIST || entry->type == TYPE_NAMED) PetscCall(ClearItems(entry, n, at));
    if (entry->type != TYPE_NUMBERS) continue;
    for (PetscInt i = 0; i < n; ++i) PetscCall(PetscFree((*(NamedValue **)at)[i].name));
    PetscCall(PetscFree(*(NamedValue **)at));
  }
  if (table->clear) PetscCall((*table->clear)(target));
  PetscFunctionReturn(0);
}
