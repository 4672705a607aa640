#include "input/yaml/yaml.h"
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

PetscErrorCode YamlNodeCreate(YamlDocument *document, YamlKind kind, YamlNode **node)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(node));
  (*node)->kind = kind;
  (*node)->plain = PETSC_TRUE;
  document->n_nodes += 1;
  PetscFunctionReturn(0);
}

PetscErrorCode YamlNodeDestroy(YamlNode **node)
{
  PetscFunctionBeginUser;
  if (!*node) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < (*node)->n; ++i) PetscCall(YamlNodeDestroy(&(*node)->child[i]));
  PetscCall(PetscFree((*node)->child));
  if ((*node)->keys) PetscCall(NamesFree((*node)->keys));
  PetscCall(PetscFree((*node)->keys));
  PetscCall(PetscFree((*node)->text));
  PetscCall(PetscFree((*node)->key));
  PetscCall(PetscFree(*node));
  PetscFunctionReturn(0);
}

/* The first of a name counts. */
static PetscErrorCode Remember(YamlNode *mapping, PetscInt i)
{
  const char *key = mapping->child[i]->key;

  PetscFunctionBeginUser;
  if (key && names_find(mapping->keys, key) < 0) PetscCall(NamesSet(mapping->keys, key, i));
  PetscFunctionReturn(0);
}

/* Few keys are found as fast without. */
#define MANY_KEYS 32

static PetscErrorCode IndexLast(YamlNode *mapping)
{
  PetscFunctionBeginUser;
  if (mapping->kind != YAML_MAPPING || mapping->n < MANY_KEYS) PetscFunctionReturn(0);
  if (mapping->keys) PetscCall(Remember(mapping, mapping->n - 1));
  else {
    PetscCall(PetscNew(&mapping->keys));
    for (PetscInt i = 0; i < mapping->n; ++i) PetscCall(Remember(mapping, i));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode YamlNodeAppend(YamlNode *parent, YamlNode *child)
{
  PetscFunctionBeginUser;
  if (parent->n == parent->capacity) {
    parent->capacity = parent->capacity ? 2 * parent->capacity : 4;
    PetscCall(PetscRealloc((size_t)parent->capacity * sizeof(YamlNode *), &parent->child));
  }
  child->parent = parent;
  child->index = parent->n;
  parent->child[parent->n++] = child;
  PetscCall(IndexLast(parent));
  PetscFunctionReturn(0);
}

PetscErrorCode YamlSpellOut(YamlDocument *document, YamlNode *node)
{
  YamlNode *value;

  PetscFunctionBeginUser;
  if (node->kind != YAML_SCALAR || !node->text[0] || yaml_is_null(node)) PetscFunctionReturn(0);
  PetscCall(YamlNodeCreate(document, YAML_MAPPING, &value));
  value->place = value->key_place = node->place;
  value->argument = node->argument;
  value->stage = node->stage;
  value->key = node->text;
  node->text = NULL;
  node->kind = YAML_MAPPING;
  PetscCall(YamlNodeAppend(node, value));
  PetscFunctionReturn(0);
}

PetscErrorCode YamlNodeRemove(YamlNode *parent, PetscInt index)
{
  PetscFunctionBeginUser;
  PetscCall(YamlNodeDestroy(&parent->child[index]));
  for (PetscInt i = index; i + 1 < parent->n; ++i) {
    parent->child[i] = parent->child[i + 1];
    parent->child[i]->index = i;
  }
  --parent->n;
  if (parent->keys) PetscCall(NamesFree(parent->keys));
  PetscCall(PetscFree(parent->keys));
  PetscCall(IndexLast(parent)); /* anew */
  PetscFunctionReturn(0);
}

PetscErrorCode YamlCreate(const char *file, const char *text, size_t size, Diag *diag, YamlDocument **document)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(document));
  PetscCall(PetscStrallocpy(file, &(*document)->file));
  PetscCall(PetscMalloc1(size + 1, &(*document)->text));
  PetscCall(PetscMemcpy((*document)->text, text, size));
  (*document)->text[size] = '\0';
  PetscCall(YamlParseInto(*document, (*document)->text, size, 0, diag, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode YamlDestroy(YamlDocument **document)
{
  PetscFunctionBeginUser;
  if (!*document) PetscFunctionReturn(0);
  PetscCall(YamlNodeDestroy(&(*document)->root));
  for (PetscInt k = 0; k < (*document)->n_stages; ++k) PetscCall(YamlNodeDestroy(&(*document)->stage[k]));
  PetscCall(PetscFree((*document)->stage));
  for (PetscInt i = 0; i < (*document)->n_arguments; ++i) PetscCall(PetscFree((*document)->arguments[i]));
  PetscCall(PetscFree((*document)->arguments));
  PetscCall(PetscFree((*document)->file));
  PetscCall(PetscFree((*document)->text));
  free((*document)->resolved);
  PetscCall(PetscFree(*document));
  PetscFunctionReturn(0);
}

YamlNode *yaml_find(const YamlNode *mapping, const char *key)
{
  if (!mapping || mapping->kind != YAML_MAPPING) return NULL;
  if (mapping->keys) {
    const PetscInt i = names_find(mapping->keys, key);
    return i < 0 ? NULL : mapping->child[i];
  }
  for (PetscInt i = 0; i < mapping->n; ++i)
    if (!strcmp(mapping->child[i]->key, key)) return mapping->child[i];
  return NULL;
}

static PetscBool equal_scalars(const YamlNode *a, const YamlNode *b)
{
  char *end_a, *end_b;
  if (!strcmp(a->text, b->text)) return PETSC_TRUE;
  const double x = strtod(a->text, &end_a), y = strtod(b->text, &end_b);
  return end_a > a->text && end_b > b->text && !*end_a && !*end_b && x == y ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool yaml_equal(const YamlNode *a, const YamlNode *b)
{
  if (a->kind != b->kind || a->n != b->n) return PETSC_FALSE;
  if (a->kind == YAML_SCALAR) return equal_scalars(a, b);
  for (PetscInt i = 0; i < a->n; ++i) {
    const YamlNode *other = a->kind == YAML_MAPPING ? yaml_find(b, a->child[i]->key) : b->child[i];
    if (!other || !yaml_equal(a->child[i], other)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscInt yaml_argument(const YamlNode *node, PetscBool any)
{
  PetscInt last = node->argument;
  for (PetscInt i = 0; i < node->n && !node->argument; ++i) {
    const PetscInt argument = yaml_argument(node->child[i], any);
    if (!argument && !any) return 0;
    last = PetscMax(last, argument);
  }
  return last;
}

PetscBool yaml_is_null(const YamlNode *node)
{
  if (node->kind != YAML_SCALAR || !node->plain) return PETSC_FALSE;
  return !node->text[0] || !strcmp(node->text, "~") || !strcmp(node->text, "null");
}

static size_t append_path(const YamlNode *node, char *buffer, size_t size)
{
  size_t used;
  if (!node->parent) return 0;
  used = append_path(node->parent, buffer, size);
  if (used >= size) return used;
  if (node->key) used += (size_t)snprintf(buffer + used, size - used, "%s%s", used ? "." : "", node->key);
  else used += (size_t)snprintf(buffer + used, size - used, "[%" PetscInt_FMT "]", node->index);
  return used;
}

const char *yaml_path(const YamlNode *node, char *buffer, size_t size)
{
  buffer[0] = '\0';
  if (append_path(node, buffer, size) == 0) snprintf(buffer, size, "the file");
  return buffer;
}

static char *copy_line(const char *text, int line)
{
  for (int k = 1; k < line && text; ++k) {
    text = strchr(text, '\n');
    if (text) ++text;
  }
  if (!text) return NULL;
  size_t length = strcspn(text, "\n");
  if (length > 0 && text[length - 1] == '\r') --length;
  return strndup(text, length);
}

void yaml_place_at(const YamlDocument *document, YamlPlace at, char **buffer, DiagPlace *place)
{
  *buffer = at.line > 0 ? copy_line(document->text, at.line) : NULL;
  *place = (DiagPlace){
    .file = document->file, .text = *buffer, .line = at.line, .column = at.column, .width = PetscMax(at.width, 1)};
}

void yaml_place(const YamlDocument *document, const YamlNode *node, PetscBool key, char **line, DiagPlace *place)
{
  if (node->argument) { /* the argument itself is the place: its columns mean nothing in the file */
    char *file = NULL;
    if (asprintf(&file, "--set %s", document->arguments[node->argument - 1]) < 0) file = NULL;
    *line = file;
    *place = (DiagPlace){.file = file, .width = 1};
  } else yaml_place_at(document, key && node->key_place.line > 0 ? node->key_place : node->place, line, place);
}

void yaml_error(const YamlDocument *document, Diag *diag, const YamlNode *node, PetscBool key, const char *format, ...)
{
  char *line = NULL, *message = NULL;
  DiagPlace place;
  va_list arguments;
  if (diag_full(diag, DIAG_ERROR)) {
    diag_at(diag, DIAG_ERROR, &(DiagPlace){0}, "one more");
    return;
  }
  va_start(arguments, format);
  if (vasprintf(&message, format, arguments) < 0) message = NULL;
  va_end(arguments);
  yaml_place(document, node, key, &line, &place);
  diag_at(diag, DIAG_ERROR, &place, "%s", message ? message : "no memory for the message");
  free(line);
  free(message);
}
