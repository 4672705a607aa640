#include <string.h>
#include "cli/begin/installed.h"
#include "cli/describe/values.h"
#include "input/schema/schema.h"

/* Names of values, and what they stand for; `list`: words of `talus list`. */
static const struct {
  const char *name;
  ValueKind kind;
  const char *list;
} known[] = {
  {"CASE", VALUE_CASE, NULL},
  {"CASE_DIR", VALUE_FOLDER, NULL},
  {"RUN_DIR", VALUE_RUN, NULL},
  {"RUN", VALUE_RUN, NULL},
  {"DIR", VALUE_FOLDER, NULL},
  {"FILE", VALUE_FILE, NULL},
  {"PATH=VALUE", VALUE_KEYS, NULL},
  {"KEY=VALUES", VALUE_KEYS, NULL},
  {"FIELD", VALUE_WORDS, "fields"},
  {"COMMAND", VALUE_WORDS, "commands"},
  {"INSTALLED", VALUE_WORDS, "cases"},
  {"COMPONENT", VALUE_WORDS, "x|y|z|xx|yy|zz|xy|yz|xz|magnitude|mises|mean"},
  {NULL, VALUE_NONE, NULL},
};

static int find_known(const char *name)
{
  int i = 0;
  while (known[i].name && strcmp(known[i].name, name)) ++i;
  return i;
}

/* "mpm|fem|gmm" names its words itself, and so does a single word in small letters. */
static PetscBool names_its_words(const char *name) { return strchr(name, '|') || (name[0] >= 'a' && name[0] <= 'z'); }

ValueKind value_kind(const char *name) { return names_its_words(name) ? VALUE_WORDS : known[find_known(name)].kind; }

static PetscBool copy_word(const char *text, size_t length, char word[128])
{
  snprintf(word, 128, "%.*s", (int)length, text);
  return PETSC_TRUE;
}

/* Key i of a table and of those below it that have one name, with its words ("method=mpm"); *i
 * counts down. */
static PetscBool find_key(const SchemaTable *table, const char *path, int *i, char word[128])
{
  SchemaEntry e;
  char below[128];
  for (PetscInt k = 0; (e = schema_entry(table, k)).key; ++k) {
    snprintf(below, sizeof below, "%s%s%s", path, *path ? "." : "", e.key);
    const PetscBool nested = e.type == TYPE_LIST || e.type == TYPE_NAMED;
    if (e.type == TYPE_TABLE && find_key(e.table, below, i, word)) return PETSC_TRUE;
    if (nested || e.type == TYPE_TABLE) continue;
    for (int w = 0; w == 0 || schema_word(&e, w).word; ++w)
      if ((*i)-- == 0) {
        const char *value = schema_word(&e, w).word;
        snprintf(word, 128, "%.90s=%.36s", below, value ? value : "");
        return PETSC_TRUE;
      }
  }
  return PETSC_FALSE;
}

PetscBool value_word(const char *name, int i, char word[128])
{
  const char *list = known[find_known(name)].list, *found;
  if (list && strchr(list, '|')) name = list;
  if (names_its_words(name)) {
    for (; i > 0 && *name; --i) name += strcspn(name, "|"), name += *name == '|';
    return *name ? copy_word(name, strcspn(name, "|"), word) : PETSC_FALSE;
  }
  if (value_kind(name) == VALUE_KEYS) return find_key(&schema_case, "", &i, word);
  if (!list) return PETSC_FALSE;
  if (!strcmp(list, "cases")) return installed_case(i, word);
  if (strcmp(list, "commands")) found = cli_list_word(list, i);
  else found = cli_commands[i].name;
  return found ? copy_word(found, strlen(found), word) : PETSC_FALSE;
}

PetscBool value_of_word(const CliUsage *usage, int i, char name[128])
{
  const char *text = usage->usage;
  for (i += 2; i > 0 && *text; --i) {
    const size_t length = strcspn(text, " ");
    if (strstr(text, "...") && strstr(text, "...") < text + length) break; /* as often as one likes */
    text += length;
    text += strspn(text, " ");
  }
  if (*text == '[') ++text;
  const size_t length = strcspn(text, " ],.");
  copy_word(text, length, name);
  return length > 0 && name[0] != '-' && strcmp(name, "options");
}

void value_escaped(FILE *out, const char *text, const char *special)
{
  for (; *text; ++text) {
    if (strchr(special, *text)) fputc('\\', out);
    fputc(*text == '\n' ? ' ' : *text, out);
  }
}
