/* Questions to a Reference. */
#include <math.h>
#include <string.h>
#include "verify/verify_reference.h"

/* Number of this name; NaN if there is none. */
static PetscReal named_value(PetscInt n, const NamedValue *values, const char *name)
{
  for (PetscInt i = 0; i < n; ++i)
    if (!strcmp(values[i].name, name)) return values[i].value;
  return NAN;
}

PetscReal reference_value(const RowSpec *row, const SeriesSpec *series)
{
  return row->has_reference ? row->reference : named_value(row->n_references, row->references, series->name);
}

PetscReal reference_exact(const StudySpec *study, const SeriesSpec *series)
{
  if (!study->has_exact) return NAN;
  return study->exact.has_value ? study->exact.value
                                : named_value(study->exact.n_values, study->exact.values, series->name);
}

PetscReal reference_tolerance(const StudySpec *study, const RowSpec *row, const SeriesSpec *series)
{
  return row->has_tolerance ? row->tolerance : series->has_tolerance ? series->tolerance : study->tolerance;
}

const Source *reference_source(const StudySpec *study, const RowSpec *row, const SeriesSpec *series)
{
  if (row->source.text) return &row->source;
  if (series->source.text) return &series->source;
  return study->source.text ? &study->source : NULL;
}

PetscInt reference_series(const StudySpec *study, const char *name)
{
  for (PetscInt s = 0; s < study->n_series; ++s)
    if (!strcmp(study->series[s].name, name)) return s;
  return -1;
}
