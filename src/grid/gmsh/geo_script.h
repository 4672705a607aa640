/* A script of Gmsh (.geo) as text whose characters are known to be code, texts in quotes or
 * comments.
 *
 * Gmsh itself does not always agree with what a script says on paper: the part that skips over an
 * If or a Macro swallows quotes, For and Call go on at the start of a line or of a piece of it, and
 * a last line without its end is read in another way. A script from somebody else may make use of
 * that. So texts and comments count as harmless only where Gmsh cannot lose its place. */
#pragma once
#include <petscsys.h>

typedef enum { GEO_CODE, GEO_TEXT, GEO_COMMENT } GeoKind;

typedef struct {
  const char *path;
  char *text; /* n bytes and a NUL */
  size_t n;
  unsigned char *kind;  /* GeoKind of each byte */
  size_t doubtful_from; /* from here on Gmsh may read texts and comments as commands */
  PetscBool prints;     /* the word Printf is there */
} GeoScript;

/* What is wrong with a script, and where. reason NULL: nothing. */
typedef struct {
  size_t at, width;
  const char *reason;
} GeoFinding;

/* Read a file. *why: why it cannot be read, NULL if it could. finding: a byte or a text that Gmsh
 * would trip over. */
PetscErrorCode GeoScriptRead(const char *path, GeoScript *script, GeoFinding *finding, const char **why);
PetscErrorCode GeoScriptFree(GeoScript *script);

static inline PetscBool geo_is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
static inline PetscBool geo_is_digit(char c) { return c >= '0' && c <= '9'; }
static inline PetscBool geo_is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/* The first place from `at` on that is no space, and no comment if `at` is in code. */
size_t geo_next(const GeoScript *script, size_t at);
/* The end of the letters, digits and '_' at `at`. */
size_t geo_word_end(const GeoScript *script, size_t at);
/* The closing quote of the text that opens at `at`, or n. */
size_t geo_quote_end(const GeoScript *script, size_t at);

/* The first thing in the script that acts on the system, but for files that it reads in. */
void geo_find_action(const GeoScript *script, GeoFinding *finding);

/* A file that the script reads in with Include or Merge. */
typedef struct {
  size_t at, width;    /* the word */
  char name[512];      /* as it stands there */
  PetscBool merged;    /* Merge: what it holds depends on its ending */
  PetscBool certain;   /* in code, not in a text or a comment */
  const char *problem; /* the name cannot be told: why */
} GeoInclusion;

/* The next one at or behind *at, which moves on. PETSC_FALSE: there is none. */
PetscBool geo_next_inclusion(const GeoScript *script, size_t *at, GeoInclusion *inclusion);
