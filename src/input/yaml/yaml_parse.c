/* libfyaml's events into our tree. Its messages become ours; what YAML allows and a case file does
 * not is refused here. */
#include <libfyaml.h>
#include <stdlib.h>
#include <string.h>
#include "input/yaml/yaml.h"

typedef struct {
  const char *text; /* all that is parsed */
  size_t size;
  YamlDocument *document;
  Diag *diag;
  PetscInt argument;     /* of --set, 0: the file */
  PetscBool fragment;    /* a value alone, not a whole file */
  YamlNode *root, *open; /* open: the collection that takes the next node */
  YamlNode *pending_key; /* a key that waits for its value: text and place */
  int depth, documents;
  PetscBool failed; /* stop: the tree cannot be trusted */
  PetscInt n_anchors, max_anchors;
  struct Anchor {
    char *name;
    YamlNode *node;
  } * anchors;
  Names anchor_names; /* the newest of a name counts */
} Builder;

/* About a place in the file, or about the argument of --set. */
static void complain(Builder *b, YamlPlace place, const char *message)
{
  const YamlNode node = {.place = b->argument ? (YamlPlace){0} : place, .argument = b->argument};
  yaml_error(b->document, b->diag, &node, PETSC_FALSE, "%s", message);
}

static void fail(Builder *b, const YamlNode *where, const char *message)
{
  complain(b, where ? where->place : (YamlPlace){.width = 1}, message);
  b->failed = PETSC_TRUE;
}

static void mark(struct fy_token *token, YamlNode *node)
{
  const struct fy_mark *start = token ? fy_token_start_mark(token) : NULL,
                       *end = token ? fy_token_end_mark(token) : NULL;
  const PetscBool one_line = start && end && end->line == start->line && end->column > start->column;
  if (start) node->place = (YamlPlace){start->line + 1, start->column + 1, one_line ? end->column - start->column : 1};
  else node->place = (YamlPlace){.width = 1};
}

/* libfyaml 0.7.12 loses the memory in which it unfolds a text in single quotes that has doubled
 * ones side by side, if there are more than three. */
#define MAX_DOUBLED 3

static PetscBool has_too_many_quotes(const Builder *b, struct fy_token *token)
{
  const struct fy_mark *start = fy_token_start_mark(token), *end = fy_token_end_mark(token);
  size_t run = 0, quotes = 0;
  PetscBool adjacent = PETSC_FALSE;
  if (fy_token_scalar_style(token) != FYSS_SINGLE_QUOTED || !start || !end) return PETSC_FALSE;
  for (size_t i = start->input_pos; i < end->input_pos && i < b->size; ++i) {
    run = b->text[i] == '\'' ? run + 1 : 0;
    quotes += run > 0;
    if (run >= 4) adjacent = PETSC_TRUE;
  }
  return adjacent && quotes > 2 * MAX_DOUBLED;
}

static PetscErrorCode CopyText(struct fy_token *token, char **text)
{
  size_t length = 0;
  const char *source = token ? fy_token_get_text(token, &length) : NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(length + 1, text));
  if (length) PetscCall(PetscMemcpy(*text, source, length));
  (*text)[length] = '\0';
  PetscFunctionReturn(0);
}

static PetscErrorCode RememberAnchor(Builder *b, struct fy_token *anchor, YamlNode *node)
{
  PetscFunctionBeginUser;
  if (!anchor) PetscFunctionReturn(0);
  if (b->n_anchors == b->max_anchors) {
    b->max_anchors = 2 * b->max_anchors + 8;
    PetscCall(PetscRealloc((size_t)b->max_anchors * sizeof(*b->anchors), &b->anchors));
  }
  struct Anchor *a = &b->anchors[b->n_anchors];
  PetscCall(CopyText(anchor, &a->name));
  a->node = node;
  PetscCall(NamesSet(&b->anchor_names, a->name, b->n_anchors++));
  PetscFunctionReturn(0);
}

/* A key that stands twice: both places are worth knowing. */
static void check_twice(Builder *b, const YamlNode *key)
{
  const YamlNode *first = yaml_find(b->open, key->text);
  char message[400], path[200];
  if (!first) return;
  snprintf(message, sizeof(message), "key '%.100s' stands twice in %s (first in line %d)", key->text,
           yaml_path(b->open, path, sizeof(path)), first->key_place.line);
  complain(b, key->place, message);
}

/* Hang a finished or opening node into the tree. */
static PetscErrorCode Attach(Builder *b, YamlNode *node)
{
  PetscFunctionBeginUser;
  node->argument = b->argument;
  if (b->document->n_nodes > YAML_MAX_NODES && !b->failed) fail(b, node, "the file has too many values");
  if (!b->open) {
    b->root = node;
    PetscFunctionReturn(0);
  }
  if (b->open->kind == YAML_MAPPING) {
    YamlNode *key = b->pending_key;
    node->key = key->text;
    key->text = NULL;
    node->key_place = key->place;
    /* an empty value has no place of its own */
    if (node->place.line == 0) node->place = key->place;
    PetscCall(YamlNodeDestroy(&b->pending_key));
  }
  PetscCall(YamlNodeAppend(b->open, node));
  PetscFunctionReturn(0);
}

/* Programs that speak YAML 1.1, Python's yaml among them, read the key `on` as true and write it so. Where users give
 * names one may be `true`. */
static PetscErrorCode TakeOn(const YamlNode *mapping, YamlNode *key)
{
  static const char *const named[] = {"materials", "measures", "parameters", "petsc"};

  PetscFunctionBeginUser;
  if (!key->plain || strcmp(key->text, "true")) PetscFunctionReturn(0);
  for (size_t k = 0; mapping->key && k < sizeof named / sizeof *named; ++k)
    if (!strcmp(mapping->key, named[k])) PetscFunctionReturn(0);
  PetscCall(PetscFree(key->text));
  PetscCall(PetscStrallocpy("on", &key->text));
  PetscFunctionReturn(0);
}

static PetscBool wants_key(const Builder *b) { return b->open && b->open->kind == YAML_MAPPING && !b->pending_key; }

static PetscErrorCode TakeScalar(Builder *b, struct fy_event *event)
{
  struct fy_token *token = event->scalar.value;
  YamlNode *node;

  PetscFunctionBeginUser;
  PetscCall(YamlNodeCreate(b->document, YAML_SCALAR, &node));
  mark(token, node);
  if (token && has_too_many_quotes(b, token)) {
    fail(b, node, "too many doubled quotes ('') for a text in single quotes; put it in double quotes");
    PetscCall(YamlNodeDestroy(&node));
    PetscFunctionReturn(0);
  }
  PetscCall(CopyText(token, &node->text));
  node->plain = !token || fy_token_scalar_style(token) == FYSS_PLAIN;
  if (event->scalar.tag) fail(b, node, "a case file has no tags (words that begin with '!')");
  if (strlen(node->text) != (token ? fy_token_get_text_length(token) : 0))
    fail(b, node, "a text may not hold the character NUL");
  if (wants_key(b)) {
    b->pending_key = node;
    if (yaml_is_null(node)) fail(b, node, "here a key is missing before ':'");
    if (node->plain && !strcmp(node->text, "<<")) {
      fail(b, node, "merge keys (<<) are not supported");
      diag_hint(b->diag, "write the keys out: an alias stands for a whole value");
    }
    PetscCall(TakeOn(b->open, node));
    check_twice(b, node);
    PetscFunctionReturn(0);
  }
  PetscCall(Attach(b, node));
  PetscCall(RememberAnchor(b, event->scalar.anchor, node));
  PetscFunctionReturn(0);
}

static PetscErrorCode Open(Builder *b, YamlKind kind, struct fy_token *token, struct fy_token *tag,
                           struct fy_token *anchor)
{
  YamlNode *node;

  PetscFunctionBeginUser;
  PetscCall(YamlNodeCreate(b->document, kind, &node));
  mark(token, node);
  if (kind == YAML_MAPPING || kind == YAML_SEQUENCE) node->place.width = 1;
  if (tag) fail(b, node, "a case file has no tags (words that begin with '!')");
  if (++b->depth > YAML_MAX_DEPTH) fail(b, node, "the values are nested too deeply (more than 64 levels)");
  if (wants_key(b)) {
    fail(b, node, "a key must be a single word, not a list or a mapping");
    PetscCall(YamlNodeDestroy(&node));
    PetscFunctionReturn(0);
  }
  PetscCall(Attach(b, node));
  PetscCall(RememberAnchor(b, anchor, node));
  b->open = node;
  PetscFunctionReturn(0);
}

static void parse_close(Builder *b)
{
  b->depth -= 1;
  if (b->open) b->open = b->open->parent;
}

static PetscErrorCode CopyTree(Builder *b, const YamlNode *source, int depth, YamlNode **copy)
{
  PetscFunctionBeginUser;
  PetscCall(YamlNodeCreate(b->document, source->kind, copy));
  (*copy)->plain = source->plain;
  (*copy)->place = source->place;
  (*copy)->key_place = source->key_place;
  (*copy)->argument = source->argument;
  if (source->text) PetscCall(PetscStrallocpy(source->text, &(*copy)->text));
  b->document->n_copied += (source->text ? strlen(source->text) : 0) + (source->key ? strlen(source->key) : 0);
  if (b->document->n_nodes > YAML_MAX_NODES || b->document->n_copied > YAML_MAX_COPIED || depth > YAML_MAX_DEPTH) {
    if (!b->failed) fail(b, source, "aliases of aliases make the file too large");
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < source->n && !b->failed; ++i) {
    YamlNode *child;
    PetscCall(CopyTree(b, source->child[i], depth + 1, &child));
    if (source->child[i]->key) PetscCall(PetscStrallocpy(source->child[i]->key, &child->key));
    PetscCall(YamlNodeAppend(*copy, child));
  }
  PetscFunctionReturn(0);
}

static PetscBool encloses(const YamlNode *outer, const YamlNode *inner)
{
  while (inner && inner != outer) inner = inner->parent;
  return inner != NULL;
}

static PetscErrorCode TakeAlias(Builder *b, struct fy_token *token)
{
  const YamlNode *source = NULL;
  YamlNode place = {0}, *copy;
  char *name;

  PetscFunctionBeginUser;
  mark(token, &place);
  PetscCall(CopyText(token, &name));
  const PetscInt found = names_find(&b->anchor_names, name);
  if (found >= 0) source = b->anchors[found].node;
  PetscCall(PetscFree(name));
  if (wants_key(b)) fail(b, &place, "a key must be a single word, not an alias");
  else if (!source) fail(b, &place, "there is no anchor (&name) of this name before it");
  else if (encloses(source, b->open)) fail(b, &place, "an alias may not stand inside its own anchor");
  if (b->failed) PetscFunctionReturn(0);
  PetscCall(CopyTree(b, source, b->depth, &copy));
  PetscCall(Attach(b, copy));
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeEvent(Builder *b, struct fy_event *event)
{
  PetscFunctionBeginUser;
  switch (event->type) {
  case FYET_DOCUMENT_START:
    if (++b->documents > 1) {
      YamlNode place = {0};
      mark(event->document_start.document_start, &place);
      fail(b, &place, "a second document begins here ('---'); a case file holds one");
    }
    break;
  case FYET_SCALAR: PetscCall(TakeScalar(b, event)); break;
  case FYET_SEQUENCE_START:
    PetscCall(Open(b, YAML_SEQUENCE, event->sequence_start.sequence_start, event->sequence_start.tag,
                   event->sequence_start.anchor));
    break;
  case FYET_MAPPING_START:
    PetscCall(
      Open(b, YAML_MAPPING, event->mapping_start.mapping_start, event->mapping_start.tag, event->mapping_start.anchor));
    break;
  case FYET_SEQUENCE_END:
  case FYET_MAPPING_END: parse_close(b); break;
  case FYET_ALIAS: PetscCall(TakeAlias(b, event->alias.anchor)); break;
  default: break;
  }
  PetscFunctionReturn(0);
}

/* A tab that indents in this line, or one of the two behind it, which libfyaml tells of as of a text that goes on; its
 * line, 0: there is none. */
static int tab_near(const Builder *b, int line)
{
  const char *end = b->text + b->size;
  int at = 1;
  for (const char *p = b->text; p < end && at <= line + 2; ++at) {
    while (p < end && *p == ' ') ++p;
    if (p < end && *p == '\t' && at >= line) return at;
    while (p < end && *p != '\n') ++p;
    if (p < end) ++p;
  }
  return 0;
}

/* A bracket that is not closed is noticed lines below it. */
static void hint_open(const Builder *b, int line)
{
  const char *at = b->text;
  const YamlPlace place = b->open ? b->open->place : (YamlPlace){0};
  if (b->argument || place.line == 0 || place.line >= line) return;
  for (int k = 1; k < place.line && at; ++k) at = strchr(at, '\n') + 1;
  at += place.column - 1;
  if (*at != '[' && *at != '{') return;
  diag_hint(b->diag, "the '%c' in line %d, column %d has no '%c' before this", *at, place.line, place.column,
            *at == '[' ? ']' : '}');
}

/* libfyaml's complaints, in our form and without its own follow-up ones. */
static void take_syntax_errors(Builder *b, struct fy_diag *messages)
{
  void *iterator = NULL;
  struct fy_diag_error *error = fy_diag_errors_iterate(messages, &iterator);
  if (!error) fail(b, NULL, "this is not YAML");
  else {
    YamlNode place = {.place = {PetscMax(error->line, 1), PetscMax(error->column, 1), 1}};
    const int tab = tab_near(b, place.place.line);
    char message[400];
    snprintf(message, sizeof(message), "syntax: %.300s", error->msg ? error->msg : "this is not YAML");
    if (tab && !strstr(message, "tab")) {
      snprintf(message, sizeof(message), "syntax: a tab indents this line");
      place.place = (YamlPlace){tab, 1, 1};
    }
    message[strcspn(message, "\n")] = '\0';
    fail(b, &place, message);
    if (strstr(message, "tab")) diag_hint(b->diag, "indent with spaces, YAML does not allow tabs there");
    else hint_open(b, place.place.line);
  }
}

/* Bytes of the UTF-8 character at p; 0 if it is malformed or cut off. */
static int character_size(const unsigned char *p, const unsigned char *end)
{
  const int n = *p < 0x80 ? 1 : *p < 0xC2 ? 0 : *p < 0xE0 ? 2 : *p < 0xF0 ? 3 : *p < 0xF5 ? 4 : 0;
  if (n > end - p) return 0;
  for (int i = 1; i < n; ++i)
    if ((p[i] & 0xC0) != 0x80) return 0;
  /* needlessly long, a surrogate, beyond the last character */
  if (n == 3 && ((*p == 0xE0 && p[1] < 0xA0) || (*p == 0xED && p[1] > 0x9F))) return 0;
  if (n == 4 && ((*p == 0xF0 && p[1] < 0x90) || (*p == 0xF4 && p[1] > 0x8F))) return 0;
  return n;
}

static PetscBool is_control(unsigned char c) { return c == 127 || (c < 32 && c != '\t' && c != '\n' && c != '\r'); }

/* First byte that no text file holds, as line and column; NULL if all is well-formed UTF-8. */
static const char *bad_byte(const char *text, size_t size, int *line, int *column)
{
  const unsigned char *p = (const unsigned char *)text, *end = p + size;
  *line = *column = 1;
  while (p < end) {
    const int n = character_size(p, end);
    if (n == 0 || is_control(*p)) return (const char *)p;
    *column = *p == '\n' ? 1 : *column + 1;
    *line += *p == '\n';
    p += n;
  }
  return NULL;
}

static PetscErrorCode RunParser(Builder *b, const char *text, size_t size)
{
  struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_COLLECT_DIAG};
  struct fy_diag_cfg diag_config;
  struct fy_diag *messages;
  struct fy_parser *parser;
  struct fy_event *event;
  PetscBool ended = PETSC_FALSE;

  PetscFunctionBeginUser;
  fy_diag_cfg_default(&diag_config);
  diag_config.fp = NULL;
  diag_config.output_fn = NULL;
  diag_config.colorize = false;
  messages = fy_diag_create(&diag_config);
  PetscCheck(messages, PETSC_COMM_SELF, PETSC_ERR_MEM, "libfyaml has no memory");
  fy_diag_set_collect_errors(messages, true);
  config.diag = messages;
  parser = fy_parser_create(&config);
  PetscCheck(parser && !fy_parser_set_string(parser, text, size), PETSC_COMM_SELF, PETSC_ERR_LIB,
             "libfyaml did not start");
  while (!b->failed && (event = fy_parser_parse(parser))) {
    if (event->type == FYET_STREAM_END) ended = PETSC_TRUE;
    PetscCall(TakeEvent(b, event));
    fy_parser_event_free(parser, event);
  }
  if (!b->failed && !ended) take_syntax_errors(b, messages);
  fy_parser_destroy(parser);
  fy_diag_destroy(messages);
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckEmpty(Builder *b)
{
  PetscFunctionBeginUser;
  if (b->failed || b->fragment) {
    if (!b->failed && !b->root) { /* --set key= : an empty value */
      PetscCall(YamlNodeCreate(b->document, YAML_SCALAR, &b->root));
      PetscCall(PetscStrallocpy("", &b->root->text));
      b->root->argument = b->argument;
    }
    PetscFunctionReturn(0);
  }
  if (!b->root || yaml_is_null(b->root)) fail(b, NULL, "the file is empty");
  else if (b->root->kind != YAML_MAPPING) fail(b, b->root, "a case file consists of `key: value` lines; this does not");
  PetscFunctionReturn(0);
}

PetscErrorCode YamlParseInto(YamlDocument *document, const char *text, size_t size, PetscInt argument, Diag *diag,
                             YamlNode **fragment)
{
  Builder b = {
    .text = text, .size = size, .document = document, .diag = diag, .argument = argument, .fragment = fragment != NULL};
  int line, column;

  PetscFunctionBeginUser;
  const char *bad = bad_byte(text, size, &line, &column);
  if (bad) {
    char message[100];
    snprintf(message, sizeof(message), "byte 0x%02X is no text in UTF-8; is this a case file?", (unsigned char)*bad);
    complain(&b, (YamlPlace){line, column, 1}, message);
    PetscFunctionReturn(0);
  }
  PetscCall(RunParser(&b, text, size));
  PetscCall(CheckEmpty(&b));
  for (PetscInt i = 0; i < b.n_anchors; ++i) PetscCall(PetscFree(b.anchors[i].name));
  PetscCall(PetscFree(b.anchors));
  PetscCall(NamesFree(&b.anchor_names));
  PetscCall(YamlNodeDestroy(&b.pending_key));
  if (b.failed) PetscCall(YamlNodeDestroy(&b.root));
  if (fragment) *fragment = b.root;
  else document->root = b.root;
  PetscFunctionReturn(0);
}
