#include "verify/verify_settings.h"
#include <ctype.h>
#include <string.h>
#include "base/text.h"
#include "input/schema/schema.h"

/* A node on one line: what stood in the file, or its equal in flow style. */
static void write_flow(FILE *out, const YamlNode *node)
{
  if (node->kind == YAML_SCALAR) {
    if (node->plain) fputs(node->text, out);
    else schema_write_text(out, node->text);
    return;
  }
  fputc(node->kind == YAML_MAPPING ? '{' : '[', out);
  for (PetscInt i = 0; i < node->n; ++i) {
    if (i) fputs(", ", out);
    if (node->kind == YAML_MAPPING) schema_write_text(out, node->child[i]->key), fputs(": ", out);
    write_flow(out, node->child[i]);
  }
  fputc(node->kind == YAML_MAPPING ? '}' : ']', out);
}

PetscErrorCode SettingListRead(const YamlNode *mapping, SettingList *list)
{
  TextStream stream;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mapping->n, &list->text));
  for (; list->n < mapping->n; ++list->n) {
    const YamlNode *child = mapping->child[list->n];
    PetscCall(TextOpen(&stream));
    fprintf(stream.out, "%s=", child->key);
    write_flow(stream.out, child);
    PetscCall(TextClose(&stream, &list->text[list->n]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SettingListClear(SettingList *list)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < list->n; ++i) PetscCall(PetscFree(list->text[i]));
  PetscCall(PetscFree(list->text));
  list->n = 0;
  PetscFunctionReturn(0);
}

/* Does `text` name the variable: $symbol, and not the beginning of a longer name? */
static PetscBool is_variable(const char *text, const char *symbol, size_t length)
{
  if (text[0] != '$' || strncmp(text + 1, symbol, length)) return PETSC_FALSE;
  const unsigned char next = (unsigned char)text[1 + length];
  return !(isalnum(next) || next == '_');
}

static void write_replaced(FILE *out, const char *text, const char *symbol, const char *value)
{
  const size_t length = strlen(symbol);
  while (*text)
    if (is_variable(text, symbol, length)) {
      fputs(value, out);
      text += length + 1;
    } else fputc(*text++, out);
}

static PetscErrorCode Append(const SettingList *settings, const SweepSpec *sweep, const char *value, SettingList *list)
{
  TextStream stream;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(list->n + settings->n) * sizeof(char *), &list->text));
  for (PetscInt i = 0; i < settings->n; ++i) {
    PetscCall(TextOpen(&stream));
    write_replaced(stream.out, settings->text[i], sweep->symbol, value);
    PetscCall(TextClose(&stream, &list->text[list->n++]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SettingListCreate(const StudySpec *study, const SeriesSpec *series, const RowSpec *row,
                                 SettingList *list)
{
  PetscFunctionBeginUser;
  *list = (SettingList){0};
  PetscCall(Append(&series->set, &study->sweep, row->at, list));
  PetscCall(Append(&study->sweep.set, &study->sweep, row->at, list));
  PetscCall(Append(&row->set, &study->sweep, row->at, list));
  for (PetscInt k = 0; k < row->n_sets; ++k)
    if (!strcmp(row->sets[k].series, series->name)) PetscCall(Append(&row->sets[k], &study->sweep, row->at, list));
  PetscFunctionReturn(0);
}

PetscBool setting_lists_equal(const SettingList *a, const SettingList *b)
{
  if (a->n != b->n) return PETSC_FALSE;
  for (PetscInt i = 0; i < a->n; ++i)
    if (strcmp(a->text[i], b->text[i])) return PETSC_FALSE;
  return PETSC_TRUE;
}
