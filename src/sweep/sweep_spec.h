/* What a sweep is: keys and their values, numbers that are taken, bands of experiments. It stands in
 * sweep.yaml or is typed. */
#pragma once
#include "input/settings.h"
#include "sweep/sweep.h"
#include "sweep/taken.h"

/* A key of the case file with its values. */
typedef struct {
  char *key;             /* path, as in --set */
  char *text, *quick;    /* values as written: "35:47:2", "0, 10, 20"; NULL: none with --quick */
  char *label;           /* in pictures; NULL: the last word of the path */
  const YamlNode *node;  /* where it stands; NULL: typed... */
  const SweepWord *word; /* ...here */
  PetscInt n;
  char **value; /* one by one */
} SweepKey;

/* A direction of the product: a key, and others that vary along with it. */
typedef struct {
  SweepKey key;
  PetscInt n_along;
  SweepKey *along;
} SweepAxis;

typedef struct {
  char *name;
  PetscReal low, high; /* in the unit shown */
} SweepBand;

typedef struct {
  Taken taken;
  PetscInt n_bands;
  SweepBand *bands;
} SweepMeasure;

typedef struct {
  char *name, *title; /* NULL: typed */
  SettingList set, quick;
  PetscInt n_axes;
  SweepAxis *axes;
  PetscInt n_measures;
  SweepMeasure *measures;
} SweepSpecification;

typedef struct {
  char *title;
  PetscInt n;
  SweepSpecification *sweeps;
  YamlDocument *document; /* NULL: typed */
} SweepFile;

#define SWEEP_MOST_MEMBERS 10000

/* sweep_file.c: read sweep.yaml. On a mistake *sweeps stays NULL, and diag says file:line:column. */
PetscErrorCode SweepFileRead(const char *path, Diag *diag, SweepFile **sweeps);
/* One sweep, from the words of a command line. */
PetscErrorCode SweepFileFromWords(PetscInt n, const SweepWord *words, Diag *diag, SweepFile **sweeps);
PetscErrorCode SweepFileDestroy(SweepFile **sweeps);

/* sweep_words.c: an error about an option of the command line. */
void sweep_word_error(Diag *diag, const SweepWord *word, const char *message);

/* sweep_values.c: the values that the text of a key (quick: its shorter one, if it has one) stands
 * for: joined by commas, each a value or a range from:to:step that holds `to` if steps lead
 * there. */
PetscErrorCode SweepKeyExpand(SweepKey *key, PetscBool quick, const YamlDocument *document, Diag *diag);
/* An error if a value stands there twice. */
void sweep_key_check_twice(const SweepKey *key, const YamlDocument *document, Diag *diag);
/* The number that value i is, NaN if it is none. */
PetscReal sweep_number(const SweepKey *key, PetscInt i);
/* An error at the key's place: in the file, or as it was typed. */
void sweep_key_error(const SweepKey *key, const YamlDocument *document, Diag *diag, const char *format, ...)
  PETSC_ATTRIBUTE_FORMAT(4, 5);
/* "friction_angle" of materials.sugar.friction_angle */
const char *sweep_short_key(const SweepKey *key);
/* Does another key end with the same word, so that both need all of theirs? */
PetscBool sweep_is_ambiguous(const SweepSpecification *sweep, const SweepKey *key);
