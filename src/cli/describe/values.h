/* What may stand where a usage says "CASE", "DIR", "x|y|z": told by that name alone, so that an
 * option needs one line in its table. A name that is not known completes to nothing. */
#pragma once
#include <stdio.h>
#include "cli/cli.h"

typedef enum {
  VALUE_NONE,   /* a number, a name of one's own */
  VALUE_WORDS,  /* a few words: value_word */
  VALUE_KEYS,   /* KEY=VALUE of a case file: value_word, those that end in '=' want something behind it */
  VALUE_CASE,   /* a case file, or a folder that has one */
  VALUE_RUN,    /* a run folder */
  VALUE_FOLDER, /* any folder */
  VALUE_FILE    /* any file */
} ValueKind;

ValueKind value_kind(const char *name);
/* Word i of VALUE_WORDS and VALUE_KEYS; PETSC_FALSE behind the last. */
PetscBool value_word(const char *name, int i, char word[128]);

/* What the usage of a command calls its word i ("CASE"), without brackets; "[RUN...]" is all from
 * there on. PETSC_FALSE if there is none. */
PetscBool value_of_word(const CliUsage *usage, int i, char name[128]);

/* The text with a backslash before each character of `special`, on one line. */
void value_escaped(FILE *out, const char *text, const char *special);
