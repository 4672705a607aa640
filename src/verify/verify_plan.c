/* Which runs a verification takes. Each case is read once before anything is run, so that a mistake
 * in the last row does not show after an hour. */
#include <ctype.h>
#include <string.h>
#include "input/case_file.h"
#include "verify/verify_private.h"

/* What stands in a path: spaces and slashes do not. */
static void append_word(char *path, size_t size, const char *word)
{
  size_t n = strlen(path);
  for (; *word && n + 1 < size; ++word)
    path[n++] = isalnum((unsigned char)*word) || strchr("._-+", *word) ? *word : '_';
  path[n] = '\0';
}

static void name_folder(const Verification *v, VerifyRow *r)
{
  const size_t size = sizeof r->folder;
  const char *const words[] = {r->study->name, r->series->name, r->study->sweep.symbol};
  PetscSNPrintf(r->folder, size, "%s", v->out);
  for (int k = 0; k < 3; ++k) {
    PetscStrlcat(r->folder, "/", size);
    append_word(r->folder, size, words[k]);
  }
  PetscStrlcat(r->folder, "_", size);
  append_word(r->folder, size, r->row->at);
}

static PetscErrorCode AddRow(Verification *v, const StudySpec *study, const SeriesSpec *series, const RowSpec *row)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(v->n + 1) * sizeof(VerifyRow), &v->rows));
  VerifyRow *r = &v->rows[v->n++];
  PetscCall(PetscMemzero(r, sizeof *r));
  r->study = study;
  r->series = series;
  r->row = row;
  name_folder(v, r);
  PetscCall(SettingListCreate(study, series, row, &r->set));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddStudy(Verification *v, const StudySpec *study)
{
  const PetscBool full = v->options->full || v->options->run;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < study->n_series; ++s)
    for (PetscInt i = 0; i < study->n_rows; ++i)
      if (full || !(study->series[s].full || study->rows[i].full))
        PetscCall(AddRow(v, study, &study->series[s], &study->rows[i]));
  PetscFunctionReturn(0);
}

static void unknown_measure(const Verification *v, const VerifyRow *r, const Case *c, Diag *diag)
{
  const YamlNode *node = yaml_find(r->study->node, "measure");
  const char *words[64] = {NULL}, *nearest;
  for (PetscInt k = 0; k < PetscMin(case_columns(c), 63); ++k) words[k] = case_column(c, k)->name;
  yaml_error(v->reference->document, diag, node, PETSC_FALSE, "%s has no measure '%s'", v->file, r->study->measure);
  nearest = diag_nearest(r->study->measure, words);
  if (nearest) diag_hint(diag, "did you mean '%s'?", nearest);
}

PetscErrorCode VerifyPlanRow(Verification *v, VerifyRow *r, Diag *diag, Case **read)
{
  PetscFunctionBeginUser;
  PetscCall(CaseRead(v->comm, v->file, r->set.n, (const char *const *)r->set.text, diag, read));
  const Case *c = *read;
  if (!c) {
    yaml_error(v->reference->document, diag, r->row->node, PETSC_FALSE,
               "the case of this row cannot be read (study %s, series %s, %s = %s)", r->study->name, r->series->name,
               r->study->sweep.symbol, r->row->at);
    PetscFunctionReturn(0);
  }
  r->n_measures = case_columns(c);
  for (r->measure = 0; r->measure < case_columns(c) && strcmp(case_column(c, r->measure)->name, r->study->measure);)
    ++r->measure;
  if (r->measure == case_columns(c)) unknown_measure(v, r, c, diag);
  else {
    PetscCall(PetscStrncpy(r->unit, measure_unit(case_column(c, r->measure)), sizeof r->unit));
    PetscCall(PetscCalloc1(r->n_measures, &r->measures));
  }
  PetscFunctionReturn(0);
}

static void unknown_study(const Verification *v, Diag *diag)
{
  const char *words[64] = {NULL}, *nearest;
  for (PetscInt k = 0; k < PetscMin(v->reference->n_studies, 63); ++k) words[k] = v->reference->studies[k].name;
  diag_error(diag, NULL, "there is no study '%s'", v->options->only);
  nearest = diag_nearest(v->options->only, words);
  if (nearest) diag_hint(diag, "did you mean '%s'?", nearest);
  else if (words[0]) diag_hint(diag, "for example --only %s", words[0]);
}

PetscErrorCode VerifyPlanAll(Verification *v, Diag *diag)
{
  const char *only = v->options->only;
  PetscBool found = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < v->reference->n_studies; ++k) {
    if (only && strcmp(only, v->reference->studies[k].name)) continue;
    found = PETSC_TRUE;
    PetscCall(AddStudy(v, &v->reference->studies[k]));
  }
  if (!found) unknown_study(v, diag);
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyPlan(Verification *v, Diag *diag)
{
  Case *c;

  PetscFunctionBeginUser;
  PetscCall(VerifyPlanAll(v, diag));
  if (v->n == 0 && !diag_errors(diag)) diag_error(diag, NULL, "there is nothing to run without --full");
  for (PetscInt k = 0; k < v->n && !diag_errors(diag); ++k) {
    if (v->element) PetscCall(VerifyElementPlan(v, &v->rows[k], diag));
    else {
      PetscCall(VerifyPlanRow(v, &v->rows[k], diag, &c));
      PetscCall(CaseDestroy(&c));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyRowClear(VerifyRow *r)
{
  PetscFunctionBeginUser;
  PetscCall(SettingListClear(&r->set));
  PetscCall(PetscFree(r->measures));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyPlanClear(Verification *v)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < v->n; ++k) PetscCall(VerifyRowClear(&v->rows[k]));
  PetscCall(PetscFree(v->rows));
  v->n = 0;
  PetscFunctionReturn(0);
}
