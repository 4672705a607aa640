/* Measures of a run whose stages add and drop some. */
#include <string.h>
#include "case/case.h"

PetscInt case_columns(const Case *c) { return c->columns ? c->n_columns : c->n_measures; }

const MeasureSpec *case_column(const Case *c, PetscInt k) { return c->columns ? c->columns[k] : &c->measures[k]; }

PetscInt case_column_of(const Case *c, const char *name)
{
  for (PetscInt k = 0; k < case_columns(c); ++k)
    if (!strcmp(case_column(c, k)->name, name)) return k;
  return -1;
}

PetscInt case_measure_of(const Case *c, const char *name)
{
  for (PetscInt k = 0; k < c->n_measures; ++k)
    if (!strcmp(c->measures[k].name, name)) return k;
  return -1;
}

PetscErrorCode CaseCollectColumns(Case *c)
{
  const MeasureSpec **columns;
  PetscInt most = 0;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < c->n_stages; ++s) most += c->stage_case[s]->n_measures;
  PetscCall(PetscCalloc1(most + 1, &columns));
  c->columns = columns;
  c->n_columns = 0;
  for (PetscInt s = 0; s < c->n_stages; ++s)
    for (PetscInt k = 0; k < c->stage_case[s]->n_measures; ++k) {
      const MeasureSpec *measure = &c->stage_case[s]->measures[k];
      if (case_column_of(c, measure->name) < 0) columns[c->n_columns++] = measure;
    }
  PetscFunctionReturn(0);
}
