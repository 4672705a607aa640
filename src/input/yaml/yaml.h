/* A YAML file as a tree of nodes that know where they stand. libfyaml reads the syntax
 * (yaml_parse.c); the rest is ours, so that --set can change the tree and every message finds its
 * place. */
#pragma once
#include "base/diag/diag.h"
#include "base/names.h"

#define YAML_MAX_DEPTH 64
#define YAML_MAX_NODES 1000000 /* aliases of aliases may not blow a small file up */
#define YAML_MAX_BYTES (256 << 20)
#define YAML_MAX_COPIED (16 << 20) /* bytes of text in all that aliases stand for */

typedef enum { YAML_SCALAR, YAML_SEQUENCE, YAML_MAPPING } YamlKind;

typedef struct {
  int line, column, width;
} YamlPlace;

typedef struct YamlNode {
  YamlKind kind;
  PetscBool plain; /* a scalar without quotes */
  char *text;      /* of a scalar */
  char *key;       /* if it stands in a mapping */
  YamlPlace place; /* of the value; line 0: not from the file */
  YamlPlace key_place;
  const char *meant;  /* of a key that is told not to be known: the one that it stands for; else NULL */
  PetscInt argument;  /* 1 + index of the --set that brought it, 0: from the file */
  PetscInt stage;     /* of a case with stages: the one whose words it is among */
  PetscBool repeated; /* of the tree of a stage: that says it again, in the same words */
  PetscInt n, capacity;
  struct YamlNode **child;
  Names *keys; /* of a mapping with many: which child has which; else NULL */
  struct YamlNode *parent;
  PetscInt index; /* among its parent's children */
} YamlNode;

typedef struct {
  char *file;
  char *text; /* the whole file, NUL-terminated */
  PetscInt n_arguments;
  char **arguments; /* copies of the --set arguments */
  PetscInt n_nodes;
  PetscInt64 n_copied; /* bytes of text that aliases have copied */
  YamlNode *root;      /* NULL after a syntax error */
  PetscInt n_stages;   /* the file as each stage changes it, see stages.h */
  YamlNode **stage;
  char *resolved; /* the line that the last resolved place shows (malloc) */
} YamlDocument;

/* Parse a text; mistakes go to diag. `text` is copied. */
PetscErrorCode YamlCreate(const char *file, const char *text, size_t size, Diag *diag, YamlDocument **document);
PetscErrorCode YamlDestroy(YamlDocument **document);
/* Apply "path.to.key=value"; nodes on the way are created. */
PetscErrorCode YamlSet(YamlDocument *document, const char *argument, Diag *diag);

/* Parse events of `text` into document->root, or into *fragment if that is not NULL (a value of
 * --set, marked so). */
PetscErrorCode YamlParseInto(YamlDocument *document, const char *text, size_t size, PetscInt argument, Diag *diag,
                             YamlNode **fragment);

PetscErrorCode YamlNodeCreate(YamlDocument *document, YamlKind kind, YamlNode **node);
PetscErrorCode YamlNodeDestroy(YamlNode **node);
PetscErrorCode YamlNodeAppend(YamlNode *parent, YamlNode *child);
/* A scalar becomes the mapping {its text: {}}; an empty one, or another node, stays what it is. */
PetscErrorCode YamlSpellOut(YamlDocument *document, YamlNode *node);
/* Destroy a child; those behind it move up. */
PetscErrorCode YamlNodeRemove(YamlNode *parent, PetscInt index);

/* The same value: numbers by what they are, keys in any order. */
PetscBool yaml_equal(const YamlNode *a, const YamlNode *b);
/* Value of `key` in a mapping; NULL if there is none (or the node is no mapping). */
YamlNode *yaml_find(const YamlNode *mapping, const char *key);
/* Is it empty: `key:` with nothing behind it, `~` or `null`? */
PetscBool yaml_is_null(const YamlNode *node);
/* 1 + index of the last --set that brought the node, or all (any of) that it holds; 0: there is none. */
PetscInt yaml_argument(const YamlNode *node, PetscBool any);
/* "bodies[0].shape" for messages; "the file" for the root. Returns buffer. */
const char *yaml_path(const YamlNode *node, char *buffer, size_t size);

/* Place of the value, or of its key. `line` is a buffer that must live as long as the place. */
void yaml_place(const YamlDocument *document, const YamlNode *node, PetscBool key, char **line, DiagPlace *place);
/* A place given by numbers, with its source line. */
void yaml_place_at(const YamlDocument *document, YamlPlace at, char **buffer, DiagPlace *place);
/* A DiagResolver; context: the YamlDocument. */
void yaml_resolve(void *document, const char *path, DiagPlace *place);
/* Record an error at a node (at its key if `key`). */
void yaml_error(const YamlDocument *document, Diag *diag, const YamlNode *node, PetscBool key, const char *format, ...)
  PETSC_ATTRIBUTE_FORMAT(5, 6);
