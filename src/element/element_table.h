/* What a point went through: a row at its start and after every increment. */
#pragma once
#include "element/element_spec.h"

enum {
  ELEMENT_STAGE,  /* 0 at the start, then from 1 */
  ELEMENT_STRAIN, /* ln V, six */
  ELEMENT_SHEAR = ELEMENT_STRAIN + 6,
  ELEMENT_VOLUME,
  ELEMENT_DEVIATORIC,
  ELEMENT_STRESS, /* effective Cauchy stress, six */
  ELEMENT_PORE = ELEMENT_STRESS + 6,
  ELEMENT_P,
  ELEMENT_Q,
  ELEMENT_FRICTION,
  ELEMENT_LAW, /* the law's fields from here on */
  ELEMENT_COLUMNS = ELEMENT_LAW + LAW_MAX_STATE
};

typedef struct {
  const Law *law;
  PetscInt n_columns, n, capacity;
  PetscReal *values; /* n rows */
} ElementTable;

PetscErrorCode ElementTableAdd(ElementTable *table, PetscInt stage, const DrivePoint *point);
static inline PetscReal element_value(const ElementTable *table, PetscInt row, PetscInt column)
{
  return table->values[row * table->n_columns + column];
}
/* CSV; what goes wrong is told to diag. */
PetscErrorCode ElementTableWrite(const ElementTable *table, const char *path, Diag *diag);

/* element_figure.c: the picture of it, in one PNG. */
PetscErrorCode ElementFigure(const ElementSpec *spec, const ElementTable *table, const char *png, Diag *diag,
                             PetscBool *done);
/* element_measures.c: what stands in the last row, and the peak of q. */
void element_measure(const ElementTable *table, PetscReal values[ELEMENT_N_MEASURES]);
/* element_report.c: a line for each stage, on the terminal. */
void element_report(FILE *out, const ElementSpec *spec, const ElementTable *table);
