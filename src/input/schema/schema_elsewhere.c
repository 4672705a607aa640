/* Where a key belongs that is not known where it stands: what people leave out is the mapping around it. */
#include <string.h>
#include "input/schema/schema.h"

#define DEEPEST 3 /* mappings around a key that are thought of */
#define MOST 3    /* ways that are told; more are no help */
#define ROOM 160  /* characters of a way */

typedef struct {
  PetscInt n;
  char text[MOST][ROOM];
} Ways;

/* "half-space" is half_space to people. */
static PetscBool is_same(const char *key, const char *other)
{
  for (; *key && *other; ++key, ++other)
    if ((*key == '-' ? '_' : *key) != (*other == '-' ? '_' : *other)) return PETSC_FALSE;
  return *key == *other;
}

/* What stands between an entry and the keys of its table, and behind these. */
static PetscBool has_keys(const SchemaEntry *entry)
{
  const PetscBool nested = entry->type == TYPE_TABLE || entry->type == TYPE_LIST || entry->type == TYPE_NAMED;
  return (PetscBool)(nested && entry->table);
}

static const char *before(const SchemaEntry *entry)
{
  return entry->type == TYPE_TABLE ? "{" : entry->type == TYPE_LIST ? "[{" : "{NAME: {";
}

static const char *behind(const SchemaEntry *entry)
{
  return entry->type == TYPE_TABLE ? "}" : entry->type == TYPE_LIST ? "}]" : "}}";
}

/* The mappings on the way from a table to a key below it, from outside in. */
typedef struct {
  SchemaEntry around[DEEPEST];
  int n;
} Around;

/* "motion: [{velocity: ..}]" */
static void write_way(const Around *a, const char *key, char text[ROOM])
{
  int used = 0;
  for (int k = 0; k < a->n; ++k)
    used += snprintf(text + used, ROOM - used, "%.24s: %s", a->around[k].key, before(&a->around[k]));
  used += snprintf(text + used, ROOM - used, "%.24s: ..", key);
  for (int k = a->n - 1; k >= 0; --k) used += snprintf(text + used, ROOM - used, "%s", behind(&a->around[k]));
}

/* Add the ways to `key` at `depth` mappings below the table. */
static void add_ways(const SchemaReader *r, const SchemaTable *table, const char *key, int depth, Around *a, Ways *ways)
{
  SchemaEntry entry;

  for (PetscInt i = 0; (entry = schema_entry(table, i)).key; ++i) {
    if (!schema_fits(r, &entry)) continue;
    if (!depth && is_same(key, entry.key)) {
      if (ways->n < MOST) write_way(a, entry.key, ways->text[ways->n]);
      ++ways->n;
    }
    if (!depth || !has_keys(&entry)) continue;
    a->around[a->n++] = entry;
    add_ways(r, entry.table, key, depth - 1, a, ways);
    --a->n;
  }
}

/* Is one a part of the other between underscores, as force is of wall_force? */
static PetscBool is_part(const char *whole, const char *part)
{
  const size_t length = strlen(part);
  for (const char *at = whole; (at = strstr(at, part)); ++at)
    if ((at == whole || at[-1] == '_') && (!at[length] || at[length] == '_')) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void add_longer(const SchemaReader *r, const SchemaTable *table, const char *key, Ways *ways)
{
  SchemaEntry entry;
  for (PetscInt i = 0; (entry = schema_entry(table, i)).key; ++i) {
    if (!schema_fits(r, &entry) || (!is_part(entry.key, key) && !is_part(key, entry.key))) continue;
    if (ways->n < MOST) snprintf(ways->text[ways->n], ROOM, "%.100s: ..", entry.key);
    ++ways->n;
  }
}

/* If they are few. */
static PetscBool tell(SchemaReader *r, const char *where, const Ways *ways)
{
  char text[MOST * (ROOM + 8)] = "";
  if (!ways->n || ways->n > MOST) return PETSC_FALSE;
  for (PetscInt k = 0; k < ways->n; ++k) {
    const size_t used = strlen(text);
    snprintf(text + used, sizeof text - used, "%s`%s`", k ? " or " : "", ways->text[k]);
  }
  diag_hint(r->diag, "%s%s", where, text);
  return PETSC_TRUE;
}

PetscBool schema_hint_elsewhere(SchemaReader *r, const SchemaTable *table, const char *key)
{
  Ways below = {0}, longer = {0}, elsewhere = {0};
  Around none = {.n = 0};
  for (int depth = 1; depth <= DEEPEST && !below.n; ++depth) add_ways(r, table, key, depth, &none, &below);
  if (tell(r, "write ", &below)) return PETSC_TRUE;
  add_longer(r, table, key, &longer);
  if (tell(r, "write ", &longer)) return PETSC_TRUE;
  for (int depth = 0; depth <= DEEPEST && !elsewhere.n; ++depth)
    add_ways(r, &schema_case, key, depth, &none, &elsewhere);
  return tell(r, "it belongs elsewhere in the file: ", &elsewhere);
}

static PetscBool has_name(const YamlNode *list, const char *name)
{
  for (PetscInt i = 0; list && i < list->n; ++i) {
    const YamlNode *its = yaml_find(list->child[i], "name");
    if (its && its->kind == YAML_SCALAR && !strcmp(its->text, name)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool schema_hint_name(SchemaReader *r, const SchemaTable *table, const YamlNode *node)
{
  Ways ways = {0};
  SchemaEntry entry;
  for (PetscInt i = 0; node->key && (entry = schema_entry(table, i)).key; ++i) {
    const char *list = entry.type == TYPE_BOUNDARY ? "boundary" : entry.type == TYPE_REFERENCE ? entry.target : NULL;
    if (!list || !has_name(yaml_find(r->document->root, list), node->text)) continue;
    if (ways.n < MOST) snprintf(ways.text[ways.n], ROOM, "%.24s: {%.24s: %.60s}", node->key, entry.key, node->text);
    ++ways.n;
  }
  return tell(r, "write ", &ways);
}
