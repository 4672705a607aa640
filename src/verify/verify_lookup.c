/* Questions to a Reference, and its end. */
#include <math.h>
#include <string.h>
#include "verify/verify_settings.h"

PetscReal named_value(PetscInt n, const NamedValue *values, const char *name)
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

static PetscErrorCode NumbersClear(PetscInt n, NamedValue **values)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) PetscCall(PetscFree((*values)[i].name));
  PetscCall(PetscFree(*values));
  PetscFunctionReturn(0);
}

static PetscErrorCode SeriesClear(StudySpec *study)
{
  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < study->n_series; ++s) {
    PetscCall(PetscFree(study->series[s].name));
    PetscCall(PetscFree(study->series[s].title));
    PetscCall(PetscFree(study->series[s].source.text));
    PetscCall(SettingsClear(&study->series[s].set));
  }
  PetscCall(PetscFree(study->series));
  for (PetscInt k = 0; k < study->n_agree; ++k) {
    PetscCall(PetscFree(study->agree[k].series));
    PetscCall(PetscFree(study->agree[k].with));
  }
  PetscCall(PetscFree(study->agree));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetsClear(RowSpec *row)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < row->n_sets; ++k) {
    PetscCall(PetscFree(row->sets[k].series));
    PetscCall(SettingsClear(&row->sets[k].set));
  }
  PetscCall(PetscFree(row->sets));
  PetscFunctionReturn(0);
}

static PetscErrorCode RowsClear(StudySpec *study)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < study->n_rows; ++i) {
    PetscCall(PetscFree(study->rows[i].at));
    PetscCall(PetscFree(study->rows[i].source.text));
    PetscCall(SettingsClear(&study->rows[i].set));
    PetscCall(SetsClear(&study->rows[i]));
    PetscCall(NumbersClear(study->rows[i].n_references, &study->rows[i].references));
  }
  PetscCall(PetscFree(study->rows));
  PetscFunctionReturn(0);
}

static PetscErrorCode StudyClear(StudySpec *study)
{
  PetscFunctionBeginUser;
  PetscCall(SeriesClear(study));
  PetscCall(RowsClear(study));
  PetscCall(NumbersClear(study->exact.n_values, &study->exact.values));
  PetscCall(NumbersClear(study->n_limits, &study->limits));
  PetscCall(SettingsClear(&study->sweep.set));
  PetscCall(PetscFree(study->sweep.name));
  PetscCall(PetscFree(study->sweep.symbol));
  PetscCall(PetscFree(study->sweep.unit));
  PetscCall(PetscFree(study->exact.source.text));
  PetscCall(PetscFree(study->source.text));
  PetscCall(PetscFree(study->measure));
  PetscCall(PetscFree(study->title));
  PetscCall(PetscFree(study->name));
  PetscFunctionReturn(0);
}

PetscErrorCode ReferenceDestroy(Reference **reference)
{
  PetscFunctionBeginUser;
  if (!*reference) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < (*reference)->n_studies; ++k) PetscCall(StudyClear(&(*reference)->studies[k]));
  PetscCall(PetscFree((*reference)->studies));
  PetscCall(PetscFree((*reference)->title));
  PetscCall(YamlDestroy(&(*reference)->document));
  PetscCall(PetscFree(*reference));
  PetscFunctionReturn(0);
}
