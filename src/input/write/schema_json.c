/* The reference as JSON Schema, draft 2020-12: one definition for each table, materials split by
 * law. */
#include <string.h>
#include "case/fields.h"
#include "input/write/schema_print.h"
#include "material/law.h"

static void json_string(FILE *out, const char *text)
{
  fputc('"', out);
  for (const char *p = text; *p; ++p) {
    if (*p == '"' || *p == '\\') fprintf(out, "\\%c", *p);
    else if ((unsigned char)*p < 32) fprintf(out, "\\u%04x", *p);
    else fputc(*p, out);
  }
  fputc('"', out);
}

static void bounds(FILE *out, const SchemaEntry *e)
{
  if (e->bounded && e->min > -PETSC_MAX_REAL)
    fprintf(out, ", \"%s\": %.17g", e->min_open ? "exclusiveMinimum" : "minimum", (double)e->min);
  if (e->bounded && e->max < PETSC_MAX_REAL)
    fprintf(out, ", \"%s\": %.17g", e->max_open ? "exclusiveMaximum" : "maximum", (double)e->max);
}

static void enumerate(FILE *out, const SchemaEntry *e)
{
  fputs("\"enum\": [", out);
  for (int k = 0; schema_word(e, k).word; ++k) {
    fputs(k ? ", " : "", out);
    json_string(out, schema_word(e, k).word);
  }
  fputc(']', out);
}

static void json_fields(FILE *out)
{
  fputs("\"type\": \"array\", \"items\": {\"enum\": [", out);
  for (const OutputField *f = output_fields; f->name; ++f) {
    fputs(f == output_fields ? "" : ", ", out);
    json_string(out, f->name);
  }
  fputs("]}", out);
}

/* A table's name as a JSON pointer takes it: no spaces. */
static void json_name(FILE *out, const SchemaTable *table)
{
  for (const char *p = table->name; *p; ++p) fputc(*p == ' ' ? '-' : *p, out);
}

static void json_reference(FILE *out, const SchemaTable *table)
{
  fputs("\"$ref\": \"#/$defs/", out);
  json_name(out, table);
  fputc('"', out);
}

/* The keys of a table: one of them may stand for {it: {}}. */
static void json_keys(FILE *out, const SchemaTable *table)
{
  SchemaEntry e;
  fputs("{\"enum\": [", out);
  for (PetscInt i = 0; (e = schema_entry(table, i)).key; ++i) {
    fputs(i ? ", " : "", out);
    json_string(out, e.key);
  }
  fputs("]}", out);
}

/* What the value may be, without braces around it. */
static void json_value(FILE *out, const SchemaEntry *e)
{
  switch (e->type) {
  case TYPE_NUMBER:
    fputs("\"type\": \"number\"", out);
    bounds(out, e);
    break;
  case TYPE_INTEGER:
    fputs("\"type\": \"integer\"", out);
    bounds(out, e);
    break;
  case TYPE_WORD:
  case TYPE_MEMBER:
  case TYPE_WORD_TEXT: enumerate(out, e); break;
  case TYPE_FIELDS: json_fields(out); break;
  case TYPE_FLAGS:
    fputs("\"type\": \"array\", \"uniqueItems\": true, \"items\": {", out);
    enumerate(out, e);
    fputc('}', out);
    break;
  case TYPE_TABLE:
    if (e->spelled) {
      fputs("\"anyOf\": [", out);
      json_keys(out, e->table);
      fputs(", {", out);
    }
    json_reference(out, e->table);
    if (e->spelled) fputs("}]", out);
    break;
  case TYPE_LIST:
    fputs("\"type\": \"array\", \"items\": {", out);
    json_reference(out, e->table);
    fputc('}', out);
    break;
  case TYPE_NAMED:
    fputs("\"type\": \"object\", \"additionalProperties\": {", out);
    json_reference(out, e->table);
    fputc('}', out);
    break;
  default: /* a piece without its outer braces */
    fprintf(out, "%.*s", (int)strlen(schema_types[e->type].json) - 2, schema_types[e->type].json + 1);
  }
}

static void property(FILE *out, const SchemaEntry *e)
{
  char text[400], fallback[200];
  schema_default(e, fallback, sizeof(fallback));
  snprintf(text, sizeof(text), "%s%s%s%s%s%s", e->help, e->unit && e->unit[0] ? " [" : "",
           e->unit && e->unit[0] ? e->unit : "", e->unit && e->unit[0] ? "]" : "",
           fallback[0] && !e->required ? "; default: " : "", e->required ? "" : fallback);
  json_string(out, e->key);
  fputs(": {", out);
  json_value(out, e);
  fputs(", \"description\": ", out);
  json_string(out, text);
  fputc('}', out);
}

static void json_required(FILE *out, const SchemaTable *table)
{
  SchemaEntry e;
  int n = 0;
  fputs(", \"required\": [", out);
  for (PetscInt i = 0; (e = schema_entry(table, i)).key; ++i) {
    if (!e.required || e.only_2d || e.only_3d) continue;
    fputs(n++ ? ", " : "", out);
    json_string(out, e.key);
  }
  fputc(']', out);
}

static void require_each(FILE *out, const SchemaTable *table, const SchemaGroup *group)
{
  const char *key;
  for (PetscInt k = 0; (key = schema_group_key(table, group, k)); ++k) {
    fprintf(out, "%s{\"required\": [", k ? ", " : "");
    json_string(out, key);
    fputs("]}", out);
  }
}

/* "exactly one of" and so on; a single `oneOf` or `anyOf` for each group, joined by allOf. */
static void json_group(FILE *out, const SchemaTable *table, const SchemaGroup *group)
{
  fprintf(out, "{\"%s\": [", group->kind == GROUP_AT_LEAST_ONE ? "anyOf" : "oneOf");
  require_each(out, table, group);
  if (group->kind == GROUP_AT_MOST_ONE) { /* or none at all */
    fputs(", {\"not\": {\"anyOf\": [", out);
    require_each(out, table, group);
    fputs("]}}", out);
  }
  fputs("]}", out);
}

static void json_groups(FILE *out, const SchemaTable *table)
{
  if (!table->groups) return;
  fputs(", \"allOf\": [", out);
  for (const SchemaGroup *group = table->groups; group->kind != GROUP_NONE; ++group) {
    fputs(group == table->groups ? "" : ", ", out);
    json_group(out, table, group);
  }
  fputc(']', out);
}

/* A material with this law: which keys it may have, and which it must. */
static void one_law(FILE *out, const Law *law)
{
  SchemaEntry entry;
  int n = 0;
  fputs("{\"if\": {\"properties\": {\"law\": {\"const\": ", out);
  json_string(out, law->name);
  fputs("}}, \"required\": [\"law\"]}, \"then\": {\"propertyNames\": {\"enum\": [\"law\", \"density\"", out);
  for (PetscInt i = 0; !law->elastic && (entry = schema_elastic(i)).key; ++i) fprintf(out, ", \"%s\"", entry.key);
  for (const LawParameter *p = law->parameters; p && p->name; ++p) fprintf(out, ", \"%s\"", p->name);
  fputs("]}, \"required\": [", out);
  for (const LawParameter *p = law->parameters; p && p->name; ++p)
    if (schema_law_entry(p).required) fprintf(out, "%s\"%s\"", n++ ? ", " : "", p->name);
  fputs("], \"properties\": {", out);
  for (const LawParameter *p = law->parameters; p && p->name; ++p) {
    entry = schema_law_entry(p);
    fputs(p == law->parameters ? "" : ", ", out);
    property(out, &entry);
  }
  fputs("}}}", out);
}

static void material_properties(FILE *out)
{
  SchemaEntry entry;
  for (PetscInt i = 0; (entry = schema_elastic(i)).key; ++i) {
    fputs(",\n    ", out);
    property(out, &entry);
  }
  for (const Law *const *law = laws; *law; ++law)
    for (const LawParameter *p = (*law)->parameters; p && p->name; ++p) {
      PetscBool twice = PETSC_FALSE;
      for (const Law *const *other = laws; other != law; ++other)
        for (const LawParameter *q = (*other)->parameters; q && q->name; ++q)
          if (!strcmp(p->name, q->name)) twice = PETSC_TRUE;
      /* `properties` may not name it again; the law's own entry below tells the rest */
      if (twice) continue;
      fputs(",\n    ", out);
      json_string(out, p->name);
      fputs(p->words ? ": {\"type\": \"string\"}" : ": {\"type\": \"number\"}", out);
    }
}

static void json_table(FILE *out, const SchemaTable *table)
{
  SchemaEntry e;
  fputs("{\"type\": \"object\", \"description\": ", out);
  json_string(out, table->help);
  fputs(", \"properties\": {\n    ", out);
  for (PetscInt i = 0; (e = schema_entry(table, i)).key; ++i) {
    fputs(i ? ",\n    " : "", out);
    property(out, &e);
  }
  if (table->open) material_properties(out);
  fputs("}, \"additionalProperties\": false", out);
  json_required(out, table);
  json_groups(out, table);
  if (table->open) {
    fputs(", \"allOf\": [", out);
    for (const Law *const *law = laws; *law; ++law) {
      fputs(law == laws ? "\n    " : ",\n    ", out);
      one_law(out, *law);
    }
    fputc(']', out);
  }
  fputc('}', out);
}

PetscErrorCode SchemaPrintJson(FILE *out)
{
  SchemaTables all;

  PetscFunctionBeginUser;
  schema_collect(&all);
  fputs(
    "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"talus case file\",\n  "
    "\"$ref\": \"#/$defs/case\",\n  \"$defs\": {\n",
    out);
  for (PetscInt i = 0; i < all.n; ++i) {
    fputs("  \"", out);
    json_name(out, all.table[i]);
    fputs("\": ", out);
    json_table(out, all.table[i]);
    fputs(i + 1 < all.n ? ",\n" : "\n", out);
  }
  fputs("  }\n}\n", out);
  PetscFunctionReturn(0);
}
