/* CaseToYaml: the same tables, walked the other way. */
#include "base/text.h"
#include "input/case_file.h"
#include "input/schema/schema.h"

static PetscErrorCode WriteTable(FILE *out, int indent, const Case *c, const SchemaTable *table, const void *source,
                                 PetscBool *first);

static const void *at(const void *source, size_t offset) { return (const char *)source + offset; }

static PetscInt count_items(const SchemaEntry *e, const void *source)
{
  const PetscInt n = *(const PetscInt *)at(source, e->count);
  const char *items = *(char *const *)at(source, e->offset);
  PetscInt count = 0;
  for (PetscInt i = 0; i < n; ++i)
    count += !e->items_tagged || *(const int *)(items + (size_t)i * e->table->size + e->table->tag_offset) == e->tag;
  return count;
}

static PetscBool is_text(SchemaType type)
{
  return type == TYPE_TEXT || type == TYPE_NAME || type == TYPE_VALUES || type == TYPE_FILE || type == TYPE_REFERENCE;
}

static PetscBool is_tag(const SchemaTable *table, const SchemaEntry *e, const void *tag)
{
  return table->tag_is_key ? !strcmp(*(char *const *)tag, e->key) : *(const int *)tag == e->tag;
}

static PetscBool written(const Case *c, const SchemaTable *table, const SchemaEntry *e, const void *source)
{
  const PetscInt dim = kinematics_dim(c->kinematics);
  const PetscBool stages = c->n_stages || c->spec;
  if (e->staged && !stages && !*(const PetscBool *)at(source, e->offset)) return PETSC_FALSE;
  if (e->input_only || (e->only_2d && dim == 3) || (e->only_3d && dim == 2)) return PETSC_FALSE;
  if (e->turns && c->kinematics->hoop) return PETSC_FALSE;
  if (e->tagged && !is_tag(table, e, at(source, table->tag_offset))) return PETSC_FALSE;
  if (e->present && !*(const PetscBool *)at(source, e->present - 1)) return PETSC_FALSE;
  if (table->hide && table->hide(e, source)) return PETSC_FALSE;
  if (is_text(e->type)) return *(char *const *)at(source, e->offset) != NULL;
  if (e->type == TYPE_AMPLITUDE) return ((const Amplitude *)at(source, e->offset))->n > 0;
  /* a list that a stage has emptied */
  if (c->spec && e->items_tagged && count_items(e, source) == 0) return PETSC_TRUE;
  if (e->type == TYPE_LIST || e->type == TYPE_NAMED) return count_items(e, source) > 0;
  if (e->type == TYPE_OPTIONS || e->type == TYPE_REFERENCES || e->type == TYPE_AMPLITUDES)
    return *(const PetscInt *)at(source, e->count) > 0;
  return PETSC_TRUE;
}

/* A mapping whose keys all turn out absent must still be one. */
static PetscErrorCode WriteNested(FILE *out, int indent, const Case *c, const SchemaTable *table, const void *source)
{
  TextStream nested;
  PetscBool first = PETSC_FALSE;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&nested));
  PetscCall(WriteTable(nested.out, indent, c, table, source, &first));
  PetscCall(TextClose(&nested, &text));
  fprintf(out, text[0] ? "\n%s" : " {}\n", text);
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteItems(FILE *out, int indent, const Case *c, const SchemaEntry *e, const void *source)
{
  const SchemaTable *table = e->table;
  const PetscInt n = *(const PetscInt *)at(source, e->count);
  const char *item = *(char *const *)at(source, e->offset);

  PetscFunctionBeginUser;
  fputs(count_items(e, source) ? "\n" : " []\n", out);
  for (PetscInt i = 0; i < n; ++i, item += table->size) {
    PetscBool first = PETSC_TRUE;
    if (e->items_tagged && *(const int *)(item + table->tag_offset) != e->tag) continue;
    if (e->type == TYPE_NAMED) {
      fprintf(out, "%*s", indent, "");
      schema_write_text(out, *(char *const *)item);
      fputc(':', out);
      PetscCall(WriteNested(out, indent + 2, c, table, item));
    } else {
      fprintf(out, "%*s- ", indent, "");
      PetscCall(WriteTable(out, indent + 2, c, table, item, &first));
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteEntry(FILE *out, int indent, const Case *c, const SchemaEntry *e, const void *source)
{
  PetscFunctionBeginUser;
  fprintf(out, "%s:", e->key);
  if (e->type == TYPE_TABLE) PetscCall(WriteNested(out, indent + 2, c, e->table, at(source, e->offset)));
  else if (e->type == TYPE_LIST || e->type == TYPE_NAMED) PetscCall(WriteItems(out, indent + 2, c, e, source));
  else {
    fputc(' ', out);
    schema_writers[e->type](&(SchemaWriting){out, c, e, source});
    fprintf(out, e->unit && e->unit[0] ? "  # %s\n" : "\n", e->unit);
  }
  PetscFunctionReturn(0);
}

/* first: the indent of the first key stands there already, behind a dash. */
static PetscErrorCode WriteTable(FILE *out, int indent, const Case *c, const SchemaTable *table, const void *source,
                                 PetscBool *first)
{
  SchemaEntry e;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; (e = schema_entry(table, i)).key; ++i) {
    if (!written(c, table, &e, source)) continue;
    if (!*first) fprintf(out, "%*s", indent, "");
    *first = PETSC_FALSE;
    PetscCall(WriteEntry(out, indent, c, &e, source));
  }
  if (table->write_open) PetscCall((*table->write_open)(out, indent, c, source));
  PetscFunctionReturn(0);
}

PetscErrorCode CaseToYaml(const Case *c, char **text)
{
  TextStream stream;
  PetscBool first = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  PetscCall(WriteTable(stream.out, 0, c, &schema_case, c, &first));
  PetscCall(TextClose(&stream, text));
  PetscFunctionReturn(0);
}
