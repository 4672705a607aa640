/* The reference as JSON Schema, draft 2020-12: one definition for each table, materials split by law. */
#include <string.h>
#include "base/text.h"
#include "case/fields.h"
#include "input/schema_print.h"
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

/* Names of structs that begin with theirs, up to one without. */
static void enumerate(FILE *out, const void *structs, size_t size)
{
  const char *at = structs;
  fputs("\"enum\": [", out);
  for (const char *name; (name = *(const char *const *)at); at += size) {
    fputs(at == structs ? "" : ", ", out);
    json_string(out, name);
  }
  fputc(']', out);
}

static void json_laws(FILE *out)
{
  fputs("\"enum\": [", out);
  for (const Law *const *law = laws; *law; ++law) {
    fputs(law == laws ? "" : ", ", out);
    json_string(out, (*law)->name);
  }
  fputc(']', out);
}

static void json_fields(FILE *out)
{
  fputs("\"type\": \"array\", \"items\": {", out);
  enumerate(out, output_fields, sizeof *output_fields);
  fputc('}', out);
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

/* What the value may be, without braces around it. */
static void json_value(FILE *out, const SchemaEntry *e)
{
  switch (e->type) {
  case TYPE_NUMBER:
  case TYPE_INTEGER:
    fprintf(out, "\"type\": \"%s\"", e->type == TYPE_NUMBER ? "number" : "integer");
    bounds(out, e);
    break;
  case TYPE_WORD:
  case TYPE_WORD_TEXT: enumerate(out, e->words, sizeof *e->words); break;
  case TYPE_LAW: json_laws(out); break;
  case TYPE_FIELDS: json_fields(out); break;
  case TYPE_TABLE: json_reference(out, e->table); break;
  case TYPE_LIST:
  case TYPE_NAMED:
    fputs(
      e->type == TYPE_LIST ? "\"type\": \"array\", \"items\": {" : "\"type\": \"object\", \"additionalProperties\": {",
      out);
    json_reference(out, e->table);
    fputc('}', out);
    break;
  default: /* a piece without its outer braces */
    fprintf(out, "%.*s", (int)strlen(schema_types[e->type].json) - 2, schema_types[e->type].json + 1);
  }
}

static void property(FILE *out, const SchemaEntry *e)
{
  char text[TEXT_LABEL + 256], label[TEXT_LABEL], fallback[200];
  schema_default(e, fallback, sizeof(fallback));
  snprintf(text, sizeof(text), "%s%s%s", text_with_unit(e->help, e->unit, label),
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
  int n = 0;
  fputs(", \"required\": [", out);
  for (const SchemaEntry *e = table->entries; e->key; ++e) {
    if (!e->required || e->only_2d || e->only_3d) continue;
    fputs(n++ ? ", " : "", out);
    json_string(out, e->key);
  }
  fputc(']', out);
}

static void require_one(FILE *out, const SchemaGroup *group)
{
  for (int k = 0; group->keys[k]; ++k) fprintf(out, "%s{\"required\": [\"%s\"]}", k ? ", " : "", group->keys[k]);
}

/* "exactly one of" and so on; a single `oneOf` or `anyOf` for each group, joined by allOf. */
static void json_group(FILE *out, const SchemaGroup *group)
{
  fprintf(out, "{\"%s\": [", group->kind == GROUP_AT_LEAST_ONE ? "anyOf" : "oneOf");
  require_one(out, group);
  if (group->kind == GROUP_AT_MOST_ONE) { /* or none at all */
    fputs(", {\"not\": {\"anyOf\": [", out);
    require_one(out, group);
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
    json_group(out, group);
  }
  fputc(']', out);
}

/* A material with this law: which keys it may have, and which it must. */
static void one_law(FILE *out, const Law *law)
{
  int n = 0;
  fputs("{\"if\": {\"properties\": {\"law\": {\"const\": ", out);
  json_string(out, law->name);
  fputs("}}, \"required\": [\"law\"]}, \"then\": {\"propertyNames\": {\"enum\": [\"law\", \"density\"", out);
  for (const SchemaEntry *e = schema_elastic; e->key; ++e) fprintf(out, ", \"%s\"", e->key);
  for (const LawParameter *p = law->parameters; p && p->name; ++p) fprintf(out, ", \"%s\"", p->name);
  fputs("]}, \"required\": [", out);
  for (const LawParameter *p = law->parameters; p && p->name; ++p)
    if (PetscIsNanReal(p->fallback)) fprintf(out, "%s\"%s\"", n++ ? ", " : "", p->name);
  fputs("], \"properties\": {", out);
  for (const LawParameter *p = law->parameters; p && p->name; ++p) {
    const SchemaEntry entry = schema_law_entry(p);
    fputs(p == law->parameters ? "" : ", ", out);
    property(out, &entry);
  }
  fputs("}}}", out);
}

static void material_properties(FILE *out)
{
  for (const SchemaEntry *e = schema_elastic; e->key; ++e) {
    fputs(",\n    ", out);
    property(out, e);
  }
  for (const Law *const *law = laws; *law; ++law)
    for (const LawParameter *p = (*law)->parameters; p && p->name; ++p) {
      const SchemaEntry entry = schema_law_entry(p);
      PetscBool twice = PETSC_FALSE;
      for (const Law *const *other = laws; other != law; ++other)
        for (const LawParameter *q = (*other)->parameters; q && q->name; ++q)
          if (!strcmp(p->name, q->name)) twice = PETSC_TRUE;
      if (twice) continue; /* `properties` may not name it again; the law's own entry below tells the rest */
      fputs(",\n    ", out);
      json_string(out, entry.key);
      fputs(": {\"type\": \"number\"}", out);
    }
}

static void json_table(FILE *out, const SchemaTable *table)
{
  fputs("{\"type\": \"object\", \"description\": ", out);
  json_string(out, table->help);
  fputs(", \"properties\": {\n    ", out);
  for (const SchemaEntry *e = table->entries; e->key; ++e) {
    fputs(e == table->entries ? "" : ",\n    ", out);
    property(out, e);
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
