#include "verify/verify_settings.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Text in double quotes, as YAML reads it back. */
static void write_quoted(FILE *out, const char *text)
{
  fputc('"', out);
  for (; *text; ++text) {
    if (*text == '"' || *text == '\\') fputc('\\', out);
    if (*text == '\n') fputs("\\n", out);
    else fputc(*text, out);
  }
  fputc('"', out);
}

/* A node on one line: what stood in the file, or its equal in flow style. */
static void write_flow(FILE *out, const YamlNode *node)
{
  if (node->kind == YAML_SCALAR) {
    if (node->plain) fputs(node->text, out);
    else write_quoted(out, node->text);
    return;
  }
  fputc(node->kind == YAML_MAPPING ? '{' : '[', out);
  for (PetscInt i = 0; i < node->n; ++i) {
    if (i) fputs(", ", out);
    if (node->kind == YAML_MAPPING) write_quoted(out, node->child[i]->key), fputs(": ", out);
    write_flow(out, node->child[i]);
  }
  fputc(node->kind == YAML_MAPPING ? '}' : ']', out);
}

static PetscErrorCode FlowText(const YamlNode *node, char **text)
{
  char *buffer = NULL;
  size_t size;
  FILE *out = open_memstream(&buffer, &size);

  PetscFunctionBeginUser;
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a text");
  write_flow(out, node);
  PetscCheck(fclose(out) == 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a text");
  PetscCall(PetscStrallocpy(buffer, text));
  free(buffer);
  PetscFunctionReturn(0);
}

PetscErrorCode SettingsRead(const YamlNode *mapping, Settings *settings)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mapping->n, &settings->path));
  PetscCall(PetscCalloc1(mapping->n, &settings->value));
  settings->n = mapping->n;
  for (PetscInt i = 0; i < mapping->n; ++i) {
    PetscCall(PetscStrallocpy(mapping->child[i]->key, &settings->path[i]));
    PetscCall(FlowText(mapping->child[i], &settings->value[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SettingsClear(Settings *settings)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < settings->n; ++i) {
    PetscCall(PetscFree(settings->path[i]));
    PetscCall(PetscFree(settings->value[i]));
  }
  PetscCall(PetscFree(settings->path));
  PetscCall(PetscFree(settings->value));
  settings->n = 0;
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

static PetscErrorCode Append(const Settings *settings, const SweepSpec *sweep, const char *value, SettingList *list)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < settings->n; ++i) {
    char *buffer = NULL;
    size_t size;
    PetscCheck(list->n < VERIFY_MAX_SETTINGS, PETSC_COMM_SELF, PETSC_ERR_SUP, "more than %d values changed in a row",
               VERIFY_MAX_SETTINGS);
    FILE *out = open_memstream(&buffer, &size);
    PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a text");
    fprintf(out, "%s=", settings->path[i]);
    write_replaced(out, settings->value[i], sweep->symbol, value);
    PetscCheck(fclose(out) == 0, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a text");
    PetscCall(PetscStrallocpy(buffer, &list->text[list->n++]));
    free(buffer);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SettingListCreate(const StudySpec *study, const SeriesSpec *series, const RowSpec *row,
                                 SettingList *list)
{
  PetscFunctionBeginUser;
  list->n = 0;
  PetscCall(Append(&series->set, &study->sweep, row->at, list));
  PetscCall(Append(&study->sweep.set, &study->sweep, row->at, list));
  PetscCall(Append(&row->set, &study->sweep, row->at, list));
  for (PetscInt k = 0; k < row->n_sets; ++k)
    if (!strcmp(row->sets[k].series, series->name)) PetscCall(Append(&row->sets[k].set, &study->sweep, row->at, list));
  PetscFunctionReturn(0);
}

PetscErrorCode SettingListClear(SettingList *list)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < list->n; ++i) PetscCall(PetscFree(list->text[i]));
  list->n = 0;
  PetscFunctionReturn(0);
}

PetscBool setting_lists_equal(const SettingList *a, const SettingList *b)
{
  if (a->n != b->n) return PETSC_FALSE;
  for (PetscInt i = 0; i < a->n; ++i)
    if (strcmp(a->text[i], b->text[i])) return PETSC_FALSE;
  return PETSC_TRUE;
}
