/* The language of the case file as data: one table drives reading, writing, the reference and the
 * JSON Schema.
 *
 * A table describes the keys of one mapping and where their values live in a struct of case.h. To
 * add a key: one line in a table (schema_tables.c and its neighbours). To add a kind of value: its
 * reader and JSON in schema_types.c, its writer in schema_write_types.c. */
#pragma once
#include <stddef.h>
#include <stdio.h>
#include "case/case.h"
#include "input/yaml/yaml.h"

typedef enum {
  TYPE_NUMBER,     /* PetscReal */
  TYPE_INTEGER,    /* PetscInt */
  TYPE_BOOLEAN,    /* PetscBool */
  TYPE_WORD,       /* an enum, from `words` */
  TYPE_WORD_TEXT,  /* char *, from `words` */
  TYPE_MEMBER,     /* const struct *, from `registry` */
  TYPE_TEXT,       /* char * */
  TYPE_NAME,       /* char *, fit for a path */
  TYPE_VALUES,     /* char *: any value or list on one line */
  TYPE_FILE,       /* char *, resolved against the folder of the case */
  TYPE_REFERENCE,  /* char *, a name from the list or mapping `target` at the top of the file */
  TYPE_REFERENCES, /* char ** and their number */
  TYPE_BOUNDARY,   /* PetscInt, index or name of an entry of `boundary` */
  TYPE_VECTOR,     /* PetscReal[3], as many as dimensions */
  TYPE_SPIN,       /* PetscReal[3]: a number about z in 2D, a vector in 3D */
  TYPE_AXIS,       /* PetscInt 0 1 2 */
  TYPE_SPIN_AXIS,  /* the same for rotations: only z in 2D */
  TYPE_DIRECTION,  /* 0 1 2, NORMAL */
  TYPE_AXES,       /* PetscBool[4], of directions */
  TYPE_INTERVAL,   /* number or [min, max]: PetscReal at offset and at second */
  TYPE_SIZE,       /* cell size: resolved to counts by the check of the grid */
  TYPE_COUNTS,     /* PetscInt[3] */
  TYPE_AMPLITUDE,  /* Amplitude */
  TYPE_POLYGON,    /* vertices at offset, their number at count */
  TYPE_LINE,       /* the same, of two or more */
  TYPE_EVERY,      /* PetscReal: end = 0, s > 0, {steps: n} = -n */
  TYPE_FIELDS,     /* char ** and their number: words of output_fields */
  TYPE_NUMBERS,    /* NamedValue * and their number: any key: a number */
  TYPE_AMPLITUDES, /* NamedAmplitude * and their number: any key: [[time, factor], ...] */
  TYPE_OPTIONS,    /* char ** and their number: options of PETSc */
  TYPE_FLAGS,      /* a list of `words`: PetscBool at offset + sizeof(PetscBool) times the word's value */
  TYPE_PART,       /* part of a case, as it stands under the same key at the top: read with it, see stages.h */
  TYPE_TABLE,      /* a nested mapping */
  TYPE_LIST,       /* a list of mappings: array of structs and its number */
  TYPE_NAMED,      /* a mapping of name: mapping; the struct begins with its name */
  TYPE_COUNT
} SchemaType;

typedef struct {
  const char *word;
  int value;
  const char *help;
} SchemaWord;

typedef struct SchemaTable SchemaTable;
typedef struct SchemaEntry SchemaEntry;

struct SchemaEntry {
  const char *key;
  SchemaType type;
  const char *help;
  const char *unit;
  const char *fallback; /* the default as it would stand in the file */
  const char *note;     /* for the reader of the reference: a default that depends on others */
  PetscReal min, max;   /* if bounded */
  PetscBool bounded, min_open, max_open;
  PetscBool required, only_2d, only_3d;
  PetscBool turns;      /* a rotation: means nothing where the plane itself turns about its axis */
  PetscBool endless;    /* a number beyond what its unit can mean has a meaning: none */
  PetscBool always;     /* a mapping that is read even if absent: its keys have defaults */
  PetscBool input_only; /* resolved to another key, never written */
  PetscBool spelled;    /* a mapping of one key may be that key alone: basis: gimp for basis: {gimp: {}} */
  PetscBool staged;     /* a PetscBool that is written only where it is true or the case has stages */
  const SchemaWord *words;
  /* instead of words: structs that begin with their word and its help, ended by NULL */
  const void *const *registry;
  const SchemaTable *table;
  const char *target;
  const char *with; /* makes sense only beside this key */
  size_t offset, second, count;
  size_t present;         /* 1 + offset of a PetscBool that says whether it was given; 0: none */
  PetscBool tagged;       /* giving this key sets the table's tag to `tag`... */
  PetscBool items_tagged; /* ...or that of each item of the list */
  int tag;
};

typedef enum { GROUP_NONE, GROUP_ONE, GROUP_AT_MOST_ONE, GROUP_AT_LEAST_ONE } SchemaGroupKind;

typedef struct {
  SchemaGroupKind kind;
  const char *keys[8]; /* ended by NULL; none: those that set the table's tag */
} SchemaGroup;

typedef struct SchemaReader {
  YamlDocument *document;
  Diag *diag;
  Case *c;
  PetscInt dim;       /* 0: kinematics could not be read, lengths are not checked */
  PetscBool hoop;     /* do the kinematics have one? */
  PetscBool has_grid; /* has the grid been read without a mistake? */
} SchemaReader;

struct SchemaTable {
  const char *name; /* unique: a heading of the reference, a definition of the JSON Schema */
  const char *help;
  const SchemaEntry *entries;       /* ended by key = NULL */
  SchemaEntry (*entry)(PetscInt i); /* or made from a registry, ended likewise */
  const SchemaGroup *groups;        /* ended by GROUP_NONE; NULL if there are none */
  size_t size;                      /* of the struct, for lists */
  size_t tag_offset;
  PetscBool tag_is_key; /* is the tag no number but the key, a char *? */
  /* Keys that the entries do not list; NULL: they are mistakes. */
  PetscErrorCode (*open)(SchemaReader *r, const YamlNode *mapping, void *target);
  PetscErrorCode (*clear)(void *target); /* free what `open` has read; NULL: nothing */
  /* After reading without a mistake: resolve defaults, look at keys together. */
  PetscErrorCode (*check)(SchemaReader *r, const YamlNode *mapping, void *target);
  /* Is this entry to be left out when `source` is written? NULL: never. */
  PetscBool (*hide)(const SchemaEntry *entry, const void *source);
  PetscErrorCode (*write_open)(FILE *out, int indent, const Case *c, const void *source);
};

/* Word i, from wherever the entry takes them; with word = NULL if there are no more. */
static inline SchemaWord schema_word(const SchemaEntry *e, int i)
{
  if (!e->registry) return e->words ? e->words[i] : (SchemaWord){NULL, 0, NULL};
  const char *const *member = (const char *const *)e->registry[i];
  return member ? (SchemaWord){member[0], i, member[1]} : (SchemaWord){NULL, 0, NULL};
}

/* The whole language. */
extern const SchemaTable schema_case;

SchemaEntry schema_entry(const SchemaTable *table, PetscInt i);
/* The groups of a table of which one tagged key must be given. */
extern const SchemaGroup schema_one_tag[];
/* Key k of a group, NULL behind the last. */
const char *schema_group_key(const SchemaTable *table, const SchemaGroup *group, PetscInt k);

/* --- reading (schema_read.c) --- */
PetscErrorCode SchemaReadTable(SchemaReader *r, const SchemaTable *table, const YamlNode *mapping, void *target);
/* Free what SchemaReadTable has read of texts, numbers, tables and lists. */
PetscErrorCode SchemaClear(const SchemaTable *table, void *target);
/* One value; dispatches on the type. */
PetscErrorCode SchemaReadEntry(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, void *target);
/* Record a mistake at the value, or at the key. `%s` of the path comes first in the message by
 * habit. */
#define SchemaError(r, node, ...) yaml_error((r)->document, (r)->diag, node, PETSC_FALSE, __VA_ARGS__)
#define SchemaKeyError(r, node, ...) yaml_error((r)->document, (r)->diag, node, PETSC_TRUE, __VA_ARGS__)
/* "<path> must be <what>, not <what stands there>". */
void schema_mismatch(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node);
/* Is the node a list or a mapping with at least so many entries? A mismatch if not. */
PetscBool schema_is(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, YamlKind kind, PetscInt least);
/* "a number > 0, in Pa". Returns buffer. */
/* Its words joined by commas, the last one by `last`, behind what is in the buffer. */
void schema_append_words(const SchemaEntry *entry, const char *last, char *buffer, size_t size);
const char *schema_expected(const SchemaEntry *entry, PetscInt dim, char *buffer, size_t size);
/* The bounds alone: "> 0"; empty if there are none. */
const char *schema_range(const SchemaEntry *entry, char *buffer, size_t size);
/* A number, with a message and PETSC_FALSE if it is none or out of its bounds. */
PetscBool schema_number(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, PetscReal *value);
/* What numbers of a unit can mean: at most, and (other than 0) at least; ended by unit = NULL. */
typedef struct {
  const char *unit;
  PetscReal least, most;
} SchemaMagnitude;
extern const SchemaMagnitude schema_magnitudes[];
#define SCHEMA_LARGEST_FACTOR 1e30 /* of an amplitude */
/* The same without messages and bounds. */
PetscBool schema_parse_number(const YamlNode *node, PetscReal *value);
PetscBool schema_parse_integer(const YamlNode *node, PetscInt *value);
/* Does the entry belong to the case's dimension? */
PetscBool schema_fits(const SchemaReader *r, const SchemaEntry *entry);
/* "write `motion: [{velocity: ..}]`", for a key that the table does not know and few mappings below it do, or the rest
 * of the file, or that is a part of a known one; PETSC_FALSE and nothing: there are none, or many
 * (schema_elsewhere.c). */
PetscBool schema_hint_elsewhere(SchemaReader *r, const SchemaTable *table, const char *key);
/* "write `of: {boundary: base}`", where a name stands in place of the mapping in which it belongs; PETSC_FALSE and
 * nothing: nothing at the top of the file that the table's keys refer to has that name. */
PetscBool schema_hint_name(SchemaReader *r, const SchemaTable *table, const YamlNode *node);
/* What others call one of these n words, or what is not there at all; PETSC_FALSE and nothing: it is neither
 * (schema_synonyms.c). */
PetscBool schema_hint_synonym(SchemaReader *r, const char *word, PetscInt n, const char *const *words);
/* The same of a key that is not known, and where it is what stands behind a comma in place of a point. */
PetscBool schema_hint_key(SchemaReader *r, const YamlNode *node, PetscInt n, const char *const *words);
/* The one of these n words, ended by NULL, that another one stands for; NULL: none. */
const char *schema_meant(const char *word, PetscInt n, const char *const *words);
/* Has a key of the mapping been told to stand for this one? That this one is missing is no other mistake. */
PetscBool schema_is_meant(const YamlNode *mapping, const char *key);
/* "did you mean 'x'?", or the list of all. */
void schema_hint_words(SchemaReader *r, const char *word, PetscInt n, const char *const *words);
/* Read a vector of dim numbers without messages; returns how many there were. */
PetscInt schema_parse_vector(const YamlNode *node, PetscReal value[3]);

/* --- kinds of values (schema_types.c) --- */
typedef PetscErrorCode SchemaReadType(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, void *target);
typedef struct {
  const char *what;       /* "a number" */
  const char *short_name; /* for the column of a table: "number" */
  const char *json;       /* its JSON Schema; NULL: made from the entry */
  SchemaReadType *read;   /* NULL: nested, see schema_read.c */
} SchemaTypeInfo;
extern const SchemaTypeInfo schema_types[TYPE_COUNT];

extern SchemaReadType SchemaReadInterval, SchemaReadAmplitude, SchemaReadAmplitudes, SchemaReadPolygon,
  SchemaReadReferences, SchemaReadEvery, SchemaReadFields, SchemaReadNumbers, SchemaReadOptions, SchemaReadVector,
  SchemaReadSpin, SchemaReadAxis, SchemaReadAxes, SchemaReadSize, SchemaReadCounts, SchemaReadNumber, SchemaReadInteger,
  SchemaReadBoolean, SchemaReadWord, SchemaReadMember, SchemaReadWordText, SchemaReadText, SchemaReadName,
  SchemaReadValues, SchemaReadFile, SchemaReadReference, SchemaReadBoundary, SchemaReadFlags, SchemaReadPart;
/* Is the name fit for a path and a column of a table? Complains at the node (its key if `key`). */
PetscBool schema_check_name(SchemaReader *r, const YamlNode *node, const char *name, PetscBool key);

/* Writers of single values (schema_write_types.c). */
/* the shortest text that reads back to the same number */
void schema_write_real(FILE *out, PetscReal value);
void schema_write_text(FILE *out, const char *text); /* quoted where YAML wants it */
/* A node on one line: what stood in the file, or its equal in flow style. */
void schema_write_flow(FILE *out, const YamlNode *node);
typedef struct {
  FILE *out;
  const Case *c;
  const SchemaEntry *entry;
  const void *source; /* the struct that holds the value */
} SchemaWriting;
typedef void (*SchemaWriteType)(const SchemaWriting *writing);
extern const SchemaWriteType schema_writers[TYPE_COUNT];

/* --- checks of tables (schema_checks.c) --- */
typedef PetscErrorCode SchemaCheck(SchemaReader *r, const YamlNode *mapping, void *target);
extern SchemaCheck SchemaCheckAnalysis, SchemaCheckReduction, SchemaCheckUntil, SchemaCheckBox, SchemaCheckGrid,
  SchemaCheckShapeBox, SchemaCheckShape, SchemaCheckHalfSpace, SchemaCheckCylinder, SchemaCheckCone, SchemaCheckDisk,
  SchemaCheckTerrain, SchemaCheckArc, SchemaCheckBody, SchemaCheckSelector, SchemaCheckMotion, SchemaCheckLoad,
  SchemaCheckWall, SchemaCheckWallMotion, SchemaCheckWallMass, SchemaCheckInterface, SchemaCheckLoads;
/* schema_polygon.c: a mistake if sides of a closed polygon (n x 2) cross; `polygon` is its list. */
PetscErrorCode SchemaCheckCrossing(SchemaReader *r, const YamlNode *polygon, PetscInt n, const PetscReal *vertices);
/* Materials take the parameters of their law (schema_material.c). */
PetscErrorCode SchemaOpenMaterial(SchemaReader *r, const YamlNode *mapping, void *target);
PetscErrorCode SchemaWriteMaterial(FILE *out, int indent, const Case *c, const void *source);
/* Elastic constant i as an entry, for messages and the reference; ended by key = NULL. */
SchemaEntry schema_elastic(PetscInt i);
/* A parameter of a law likewise. `law_parameter`: a const LawParameter *. */
SchemaEntry schema_law_entry(const void *law_parameter);
