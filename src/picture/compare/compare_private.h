/* What the files of this folder share. */
#pragma once
#include "picture/compare/compare.h"
#include "picture/compare/difference.h"
#include "picture/curves/keys.h"
#include "picture/curves/runs.h"

/* A measure of the first run and of another one. */
typedef struct {
  const char *measure, *unit;
  PetscInt run;
  PetscBool met; /* have they a time in common at which both have values? */
  Difference difference;
} CompareRow;

typedef struct {
  const CompareOptions *options;
  CurveRun *runs;
  DifferingKeys keys;
  PetscInt n_rows;
  CompareRow *rows;
  char folder[PETSC_MAX_PATH_LEN];
} Comparison;

/* compare_table.c */
void compare_print(FILE *out, const Comparison *c);
/* differences.csv and keys.csv, whole or not at all. */
PetscErrorCode CompareTables(const Comparison *c, Diag *diag, void (*said)(const char *path));
