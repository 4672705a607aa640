/* What the files of this folder share. */
#pragma once
#include "picture/compare/compare.h"
#include "picture/compare/difference.h"
#include "picture/compare/lack.h"
#include "picture/curves/keys.h"
#include "picture/curves/runs.h"

/* A measure of the first run and of another one. */
typedef struct {
  const char *measure, *unit;
  PetscInt run;
  PetscBool met;   /* have they a time in common at which both have values? */
  PetscBool found; /* values that each run finds once, at times of its own: these are compared */
  PetscBool empty; /* neither of them has a value */
  /* Its differences are relative to this, of energies the largest of all, of their balance 1: what some of them are is
   * round-off of others. 0: to its own largest value. */
  PetscReal scale;
  Difference difference;
  Lack lacks[2]; /* where the first run has no value and the other one has, and the other way round */
} CompareRow;

typedef struct {
  const CompareOptions *options;
  CurveRun *runs;
  Case **cases; /* of the runs; NULL: one cannot be read */
  DifferingKeys keys;
  PetscInt n_rows;
  CompareRow *rows;
  char folder[PETSC_MAX_PATH_LEN];
} Comparison;

/* The earlier one of the two, NULL if values are there in both runs alike. */
const Lack *compare_lack(const CompareRow *row);

/* compare_table.c */
void compare_print(FILE *out, const Comparison *c);
/* differences.csv and keys.csv, whole or not at all. */
PetscErrorCode CompareTables(const Comparison *c, Diag *diag, void (*said)(const char *path));
