#include "input/settings.h"
#include <ctype.h>
#include <string.h>
#include "base/text.h"
#include "input/case_file.h"

#define MOST_SETTINGS 32

PetscErrorCode SchemaReadDocument(MPI_Comm comm, const char *file, const SchemaTable *table, Diag *diag,
                                  YamlDocument **document, void *target)
{
  const DiagPlace whole = {.file = file, .width = 1};
  char *bytes, reason[256];
  size_t size = 0;

  PetscFunctionBeginUser;
  *document = NULL;
  PetscCall(FileReadEverywhere(comm, file, &size, &bytes, reason));
  if (reason[0]) diag_at(diag, DIAG_ERROR, &whole, "%s", reason);
  else PetscCall(YamlCreate(file, bytes, size, diag, document));
  PetscCall(PetscFree(bytes));
  YamlNode *root = *document ? (*document)->root : NULL;
  if (root && root->kind != YAML_MAPPING)
    yaml_error(*document, diag, root, PETSC_FALSE, "the file must be a mapping of keys");
  else if (root) {
    SchemaReader reader = {.document = *document, .diag = diag};
    PetscCall(SchemaReadTable(&reader, table, root, target));
  }
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

PetscErrorCode SettingListAdd(SettingList *list, const char *text)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(list->n + 1) * sizeof(char *), &list->text));
  PetscCall(PetscStrallocpy(text, &list->text[list->n++]));
  PetscFunctionReturn(0);
}

PetscErrorCode SettingListAppend(SettingList *list, const SettingList *settings, const char *symbol, const char *value)
{
  TextStream stream;
  char *text;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < settings->n; ++i) {
    PetscCall(TextOpen(&stream));
    if (symbol) write_replaced(stream.out, settings->text[i], symbol, value);
    else fputs(settings->text[i], stream.out);
    PetscCall(TextClose(&stream, &text));
    PetscCall(SettingListAdd(list, text));
    PetscCall(PetscFree(text));
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

PetscBool setting_lists_equal(const SettingList *a, const SettingList *b)
{
  if (a->n != b->n) return PETSC_FALSE;
  for (PetscInt i = 0; i < a->n; ++i)
    if (strcmp(a->text[i], b->text[i])) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscErrorCode OpenSettings(SchemaReader *r, const YamlNode *mapping, void *target)
{
  TextStream stream;
  char *text;

  PetscFunctionBeginUser;
  if (mapping->n > MOST_SETTINGS) SchemaError(r, mapping, "more than %d values are changed here", MOST_SETTINGS);
  for (PetscInt i = 0; i < mapping->n; ++i) {
    PetscCall(TextOpen(&stream));
    fprintf(stream.out, "%s=", mapping->child[i]->key);
    schema_write_flow(stream.out, mapping->child[i]);
    PetscCall(TextClose(&stream, &text));
    PetscCall(SettingListAdd(target, text));
    PetscCall(PetscFree(text));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ClearSettings(void *target)
{
  PetscFunctionBeginUser;
  PetscCall(SettingListClear(target));
  PetscFunctionReturn(0);
}

static const SchemaEntry no_entries[] = {{.key = NULL}};
const SchemaTable schema_settings = {.name = "set",
                                     .help = "Values of the case file to change.",
                                     .entries = no_entries,
                                     .open = OpenSettings,
                                     .clear = ClearSettings,
                                     .size = sizeof(SettingList)};
