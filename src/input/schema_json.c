/* The reference as JSON Schema, draft 2020-12: one definition for each table, materials split by law. */
#include <string.h>
#include "case/fields.h"
#include "input/schema_print.h"
#include "material/law.h"

static void String(FILE *out, const char *text)
{
  fputc('"', out);
  for (const char *p = text; *p; ++p) {
    if (*p == '"' || *p == '\\') fprintf(out, "\\%c", *p);
    else if ((unsigned char)*p < 32) fprintf(out, "\\u%04x", *p);
    else fputc(*p, out);
  }
  fputc('"', out);
}

static void Bounds(FILE *out, const SchemaEntry *e)
{
  if (e->bounded && e->min > -PETSC_MAX_REAL)
    fprintf(out, ", \"%s\": %.17g", e->min_open ? "exclusiveMinimum" : "minimum", (double)e->min);
  if (e->bounded && e->max < PETSC_MAX_REAL)
    fprintf(out, ", \"%s\": %.17g", e->max_open ? "exclusiveMaximum" : "maximum", (double)e->max);
}

static void Enumerate(FILE *out, const SchemaWord *words)
{
  fputs("\"enum\": [", out);
  for (const SchemaWord *w = words; w->word; ++w) {
    fputs(w == words ? "" : ", ", out);
    String(out, w->word);
  }
  fputc(']', out);
}

static void Laws(FILE *out)
{
  fputs("\"enum\": [", out);
  for (const Law *const *law = laws; *law; ++law) {
    fputs(law == laws ? "" : ", ", out);
    String(out, (*law)->name);
  }
  fputc(']', out);
}

static void Fields(FILE *out)
{
  fputs("\"type\": \"array\", \"items\": {\"enum\": [", out);
  for (const OutputField *f = output_fields; f->name; ++f) {
    fputs(f == output_fields ? "" : ", ", out);
    String(out, f->name);
  }
  fputs("]}", out);
}

/* A table's name as a JSON pointer takes it: no spaces. */
static void Name(FILE *out, const SchemaTable *table)
{
  for (const char *p = table->name; *p; ++p) fputc(*p == ' ' ? '-' : *p, out);
}

static void Reference(FILE *out, const SchemaTable *table)
{
  fputs("\"$ref\": \"#/$defs/", out);
  Name(out, table);
  fputc('"', out);
}

/* What the value may be, without braces around it. */
static void Value(FILE *out, const SchemaEntry *e)
{
  switch (e->type) {
  case TYPE_NUMBER:
    fputs("\"type\": \"number\"", out);
    Bounds(out, e);
    break;
  case TYPE_INTEGER:
    fputs("\"type\": \"integer\"", out);
    Bounds(out, e);
    break;
  case TYPE_WORD:
  case TYPE_WORD_TEXT: Enumerate(out, e->words); break;
  case TYPE_LAW: Laws(out); break;
  case TYPE_FIELDS: Fields(out); break;
  case TYPE_TABLE: Reference(out, e->table); break;
  case TYPE_LIST:
    fputs("\"type\": \"array\", \"items\": {", out);
    Reference(out, e->table);
    fputc('}', out);
    break;
  case TYPE_NAMED:
    fputs("\"type\": \"object\", \"additionalProperties\": {", out);
    Reference(out, e->table);
    fputc('}', out);
    break;
  default: /* a piece without its outer braces */
    fprintf(out, "%.*s", (int)strlen(schema_types[e->type].json) - 2, schema_types[e->type].json + 1);
  }
}

static void Property(FILE *out, const SchemaEntry *e)
{
  char text[400], fallback[200];
  SchemaDefault(e, fallback, sizeof(fallback));
  snprintf(text, sizeof(text), "%s%s%s%s%s%s", e->help, e->unit && e->unit[0] ? " [" : "",
           e->unit && e->unit[0] ? e->unit : "", e->unit && e->unit[0] ? "]" : "",
           fallback[0] && !e->required ? "; default: " : "", e->required ? "" : fallback);
  String(out, e->key);
  fputs(": {", out);
  Value(out, e);
  fputs(", \"description\": ", out);
  String(out, text);
  fputc('}', out);
}

static void Required(FILE *out, const SchemaTable *table)
{
  int n = 0;
  fputs(", \"required\": [", out);
  for (const SchemaEntry *e = table->entries; e->key; ++e) {
    if (!e->required || e->only_2d || e->only_3d) continue;
    fputs(n++ ? ", " : "", out);
    String(out, e->key);
  }
  fputc(']', out);
}

/* "exactly one of" and so on; a single `oneOf` or `anyOf` for each group, joined by allOf. */
static void Group(FILE *out, const SchemaGroup *group)
{
  fprintf(out, "{\"%s\": [", group->kind == GROUP_AT_LEAST_ONE ? "anyOf" : "oneOf");
  for (int k = 0; group->keys[k]; ++k) {
    fprintf(out, "%s{\"required\": [", k ? ", " : "");
    String(out, group->keys[k]);
    fputs("]}", out);
  }
  if (group->kind == GROUP_AT_MOST_ONE) { /* or none at all */
    fputs(", {\"not\": {\"anyOf\": [", out);
    for (int k = 0; group->keys[k]; ++k) {
      fprintf(out, "%s{\"required\": [", k ? ", " : "");
      String(out, group->keys[k]);
      fputs("]}", out);
    }
    fputs("]}}", out);
  }
  fputs("]}", out);
}

static void Groups(FILE *out, const SchemaTable *table)
{
  if (!table->groups) return;
  fputs(", \"allOf\": [", out);
  for (const SchemaGroup *group = table->groups; group->kind != GROUP_NONE; ++group) {
    fputs(group == table->groups ? "" : ", ", out);
    Group(out, group);
  }
  fputc(']', out);
}

/* A material with this law: which keys it may have, and which it must. */
static void OneLaw(FILE *out, const Law *law)
{
  int n = 0;
  fputs("{\"if\": {\"properties\": {\"law\": {\"const\": ", out);
  String(out, law->name);
  fputs("}}, \"required\": [\"law\"]}, \"then\": {\"propertyNames\": {\"enum\": [\"law\", \"density\"", out);
  for (const SchemaEntry *e = schema_elastic; e->key; ++e) fprintf(out, ", \"%s\"", e->key);
  for (const LawParameter *p = law->parameters; p && p->name; ++p) fprintf(out, ", \"%s\"", p->name);
  fputs("]}, \"required\": [", out);
  for (const LawParameter *p = law->parameters; p && p->name; ++p)
    if (PetscIsNanReal(p->fallback)) fprintf(out, "%s\"%s\"", n++ ? ", " : "", p->name);
  fputs("], \"properties\": {", out);
  for (const LawParameter *p = law->parameters; p && p->name; ++p) {
    const SchemaEntry entry = SchemaLawEntry(p);
    fputs(p == law->parameters ? "" : ", ", out);
    Property(out, &entry);
  }
  fputs("}}}", out);
}

static void MaterialProperties(FILE *out)
{
  for (const SchemaEntry *e = schema_elastic; e->key; ++e) {
    fputs(",\n    ", out);
    Property(out, e);
  }
  for (const Law *const *law = laws; *law; ++law)
    for (const LawParameter *p = (*law)->parameters; p && p->name; ++p) {
      const SchemaEntry entry = SchemaLawEntry(p);
      PetscBool twice = PETSC_FALSE;
      for (const Law *const *other = laws; other != law; ++other)
        for (const LawParameter *q = (*other)->parameters; q && q->name; ++q)
          if (!strcmp(p->name, q->name)) twice = PETSC_TRUE;
      if (twice) continue; /* `properties` may not name it again; the law's own entry below tells the rest */
      fputs(",\n    ", out);
      String(out, entry.key);
      fputs(": {\"type\": \"number\"}", out);
    }
}

static void Table(FILE *out, const SchemaTable *table)
{
  fputs("{\"type\": \"object\", \"description\": ", out);
  String(out, table->help);
  fputs(", \"properties\": {\n    ", out);
  for (const SchemaEntry *e = table->entries; e->key; ++e) {
    fputs(e == table->entries ? "" : ",\n    ", out);
    Property(out, e);
  }
  if (table->open) MaterialProperties(out);
  fputs("}, \"additionalProperties\": false", out);
  Required(out, table);
  Groups(out, table);
  if (table->open) {
    fputs(", \"allOf\": [", out);
    for (const Law *const *law = laws; *law; ++law) {
      fputs(law == laws ? "\n    " : ",\n    ", out);
      OneLaw(out, *law);
    }
    fputc(']', out);
  }
  fputc('}', out);
}

PetscErrorCode SchemaPrintJson(FILE *out)
{
  SchemaTables all;

  PetscFunctionBeginUser;
  SchemaCollect(&all);
  fputs(
    "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"talus case file\",\n  "
    "\"$ref\": \"#/$defs/case\",\n  \"$defs\": {\n",
    out);
  for (PetscInt i = 0; i < all.n; ++i) {
    fputs("  \"", out);
    Name(out, all.table[i]);
    fputs("\": ", out);
    Table(out, all.table[i]);
    fputs(i + 1 < all.n ? ",\n" : "\n", out);
  }
  fputs("  }\n}\n", out);
  PetscFunctionReturn(0);
}
