/* Paths like bodies[0].shape.box.min: followed for messages, followed and filled in for --set. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include "input/yaml/yaml.h"

/* One step of a path: a key, or an index in brackets. */
typedef struct {
  char key[256];
  PetscInt index; /* -1: it is a key */
} PathStep;

/* Cut the first step off; NULL if the path is not well formed there. */
static const char *next_step(const char *path, PathStep *step)
{
  if (*path == '[') {
    char *end;
    if (!isdigit((unsigned char)path[1])) return NULL;
    const long index = strtol(path + 1, &end, 10);
    if (*end != ']' || index > 1000000) return NULL;
    step->index = (PetscInt)index;
    path = end + 1;
  } else {
    const size_t length = strcspn(path, ".[");
    if (length == 0 || length >= sizeof(step->key)) return NULL;
    memcpy(step->key, path, length);
    step->key[length] = '\0';
    step->index = -1;
    path += length;
  }
  if (*path == '.') return path[1] && path[1] != '.' && path[1] != '[' ? path + 1 : NULL;
  return *path == '\0' || *path == '[' ? path : NULL;
}

static YamlNode *path_child(const YamlNode *node, const PathStep *step)
{
  if (step->index < 0) return yaml_find(node, step->key);
  return node->kind == YAML_SEQUENCE && step->index < node->n ? node->child[step->index] : NULL;
}

/* The node at the path, or its nearest existing parent. */
static const YamlNode *follow(const YamlNode *root, const char *path)
{
  const YamlNode *node = root;
  while (node && *path) {
    PathStep step;
    const char *rest = next_step(path, &step);
    const YamlNode *child = rest ? path_child(node, &step) : NULL;
    if (!child) break;
    node = child;
    path = rest;
  }
  return node;
}

/* "@2:materials.sand": of the file as stage 2 changes it; the path begins behind that. */
static const YamlNode *root_of(const YamlDocument *document, const char **path)
{
  char *end;
  if (!*path || **path != '@') return document->root;
  const long stage = strtol(*path + 1, &end, 10);
  *path = end + (*end == ':');
  return stage >= 0 && stage < document->n_stages ? document->stage[stage] : document->root;
}

/* The line of the file is not all that holds: what changes it stands behind it. */
static void add_change(const YamlDocument *document, PetscInt argument, char **line, DiagPlace *place)
{
  char *both = NULL;
  if (!*line || asprintf(&both, "%s  # --set %s", *line, document->arguments[argument - 1]) < 0) return;
  free(*line);
  place->text = *line = both;
}

void yaml_resolve(void *context, const char *path, DiagPlace *place)
{
  YamlDocument *document = context;
  const YamlNode *root = root_of(document, &path);
  const YamlNode *node = root && path ? follow(root, path) : NULL;
  char *line = NULL;
  place->file = document->file;
  if (!node || node == root) return;
  const YamlNode brought = {.argument = yaml_argument(node, PETSC_FALSE)};
  const PetscInt changed = yaml_argument(node, PETSC_TRUE);
  yaml_place(document, brought.argument ? &brought : node, node->kind != YAML_SCALAR, &line, place);
  if (changed && !brought.argument) add_change(document, changed, &line, place);
  /* Diag copies a place at once, but after this function has returned:
   * the document keeps the line until the next call. */
  free(document->resolved);
  document->resolved = line;
}

/* A list has numbers where a mapping has keys. Whoever knows the name of an entry learns its number. */
static void hint_entry(const YamlNode *node, const PathStep *step, const char *path, Diag *diag)
{
  const YamlNode *name = NULL;
  for (PetscInt i = 0; i < node->n && node->kind == YAML_SEQUENCE; ++i) {
    name = yaml_find(node->child[i], "name");
    if (!name || !name->text || step->index >= 0 || strcmp(name->text, step->key)) continue;
    diag_hint(diag, "%s is a list, and '%s' is %s[%d]", path, step->key, path, (int)i);
    return;
  }
  if (node->kind == YAML_SEQUENCE) {
    name = node->n ? yaml_find(node->child[0], "name") : NULL;
    if (name && name->text) diag_hint(diag, "name an entry of the list by its number: %s[0] is '%s'", path, name->text);
    else diag_hint(diag, "name an entry of the list: %s[0]", path);
  } else if (node->kind == YAML_MAPPING && node->n)
    diag_hint(diag, "name one of its keys: %s.%s", path, node->child[0]->key);
}

static PetscErrorCode MakeKind(YamlDocument *document, YamlNode *node, const PathStep *step, PetscInt argument,
                               Diag *diag, PetscBool *ok)
{
  const YamlKind kind = step->index < 0 ? YAML_MAPPING : YAML_SEQUENCE;
  char path[512];

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  if (yaml_is_null(node)) {
    PetscCall(PetscFree(node->text));
    node->kind = kind;
    node->argument = argument;
  }
  if (node->kind != kind) {
    YamlNode place = {.argument = argument};
    yaml_error(document, diag, &place, PETSC_FALSE, "%s is %s, it has no %s", yaml_path(node, path, sizeof(path)),
               node->kind == YAML_SCALAR    ? "a single value"
               : node->kind == YAML_MAPPING ? "a mapping of keys"
                                            : "a list",
               kind == YAML_MAPPING ? "keys" : "numbered entries");
    hint_entry(node, step, path, diag);
    *ok = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

/* Child of the step, made (empty) if it is not there. *child stays NULL where that cannot be. */
static PetscErrorCode Descend(YamlDocument *document, YamlNode *node, const PathStep *step, PetscInt argument,
                              Diag *diag, YamlNode **child)
{
  PetscBool ok;
  char path[512];

  PetscFunctionBeginUser;
  *child = NULL;
  PetscCall(MakeKind(document, node, step, argument, diag, &ok));
  if (!ok) PetscFunctionReturn(0);
  *child = path_child(node, step);
  if (*child) PetscFunctionReturn(0);
  if (step->index > node->n) {
    YamlNode place = {.argument = argument};
    yaml_error(document, diag, &place, PETSC_FALSE,
               "%s has %" PetscInt_FMT " entries, so there is no [%" PetscInt_FMT "]",
               yaml_path(node, path, sizeof(path)), node->n, step->index);
    if (node->n) diag_hint(diag, "entries count from 0; [%" PetscInt_FMT "] would append one", node->n);
    PetscFunctionReturn(0);
  }
  PetscCall(YamlNodeCreate(document, YAML_SCALAR, child));
  PetscCall(PetscStrallocpy("", &(*child)->text));
  (*child)->argument = argument;
  if (step->index < 0) PetscCall(PetscStrallocpy(step->key, &(*child)->key));
  PetscCall(YamlNodeAppend(node, *child));
  PetscFunctionReturn(0);
}

/* Put `value` where `node` stands. */
static PetscErrorCode Replace(YamlDocument *document, YamlNode *node, YamlNode *value)
{
  YamlNode *parent = node->parent;
  const PetscInt index = node->index;

  PetscFunctionBeginUser;
  value->key = node->key;
  value->key_place = node->key_place;
  node->key = NULL;
  value->parent = parent;
  value->index = index;
  if (parent) parent->child[index] = value;
  else document->root = value;
  PetscCall(YamlNodeDestroy(&node));
  PetscFunctionReturn(0);
}

static void bad_path(YamlDocument *document, PetscInt argument, Diag *diag, const char *what)
{
  YamlNode place = {.argument = argument};
  yaml_error(document, diag, &place, PETSC_FALSE, "%s", what);
  diag_hint(diag,
            "write --set path.to.key=value, for example --set grid.size=0.25 or --set 'bodies[0].points_per_cell=9'");
}

/* --set key=null: as if the key was not there. Nothing behind '=' is an option of PETSc's without a value. */
static PetscBool leaves_out(const YamlNode *node, const YamlNode *value)
{
  return (PetscBool)(node->parent && node->key && yaml_is_null(value) && value->text[0]);
}

static PetscErrorCode SetAt(YamlDocument *document, const char *path, YamlNode **value, PetscInt argument, Diag *diag)
{
  YamlNode *node = document->root;

  PetscFunctionBeginUser;
  while (*path) {
    PathStep step;
    path = next_step(path, &step);
    if (!path) {
      bad_path(document, argument, diag, "this is no path to a key");
      PetscFunctionReturn(0);
    }
    PetscCall(Descend(document, node, &step, argument, diag, &node));
    if (!node) PetscFunctionReturn(0);
  }
  if (leaves_out(node, *value)) {
    PetscCall(YamlNodeRemove(node->parent, node->index));
    PetscFunctionReturn(0);
  }
  PetscCall(Replace(document, node, *value));
  *value = NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode YamlSet(YamlDocument *document, const char *text, Diag *diag)
{
  const char *equals = strchr(text, '=');
  const PetscInt argument = ++document->n_arguments;
  YamlNode *value = NULL;
  char *path;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)argument * sizeof(char *), &document->arguments));
  PetscCall(PetscStrallocpy(text, &document->arguments[argument - 1]));
  if (!document->root) PetscFunctionReturn(0);
  if (!equals || equals == text) {
    bad_path(document, argument, diag, equals ? "there is no key before '='" : "there is no '='");
    PetscFunctionReturn(0);
  }
  PetscCall(YamlParseInto(document, equals + 1, strlen(equals + 1), argument, diag, &value));
  if (!value) PetscFunctionReturn(0);
  PetscCall(PetscStrallocpy(text, &path));
  path[equals - text] = '\0';
  PetscCall(SetAt(document, path, &value, argument, diag));
  PetscCall(YamlNodeDestroy(&value));
  PetscCall(PetscFree(path));
  PetscFunctionReturn(0);
}
