/* Rows of a folder whose path is that of one material point: element.yaml in place of a case. */
#include <petsctime.h>
#include <string.h>
#include "element/element.h"
#include "verify/verify_private.h"

static ElementOptions options_of(const Verification *v, const VerifyRow *r)
{
  return (ElementOptions){
    .file = v->file, .out = r->folder, .n_set = r->set.n, .set = (const char *const *)r->set.text};
}

PetscErrorCode VerifyElementPlan(Verification *v, VerifyRow *r, Diag *diag)
{
  const ElementOptions options = options_of(v, r);
  const char *words[ELEMENT_N_MEASURES + 1] = {NULL};
  PetscBool good;

  PetscFunctionBeginUser;
  PetscCall(ElementCheck(&options, diag, &good));
  if (!good) yaml_error(v->reference->document, diag, r->row->node, PETSC_FALSE, "the path of this row cannot be read");
  r->n_measures = ELEMENT_N_MEASURES;
  for (r->measure = 0; r->measure < ELEMENT_N_MEASURES; ++r->measure) {
    words[r->measure] = element_measures[r->measure].name;
    if (!strcmp(words[r->measure], r->study->measure)) break;
  }
  if (r->study->has_course || r->study->moments)
    yaml_error(v->reference->document, diag, r->study->node, PETSC_FALSE, "a material point has no time");
  if (r->measure == ELEMENT_N_MEASURES) {
    yaml_error(v->reference->document, diag, yaml_find(r->study->node, "measure"), PETSC_FALSE,
               "%s has no measure '%s'", v->file, r->study->measure);
    diag_hint_names(diag, r->study->measure, words);
  } else {
    PetscCall(PetscStrncpy(r->unit, element_measures[r->measure].unit, sizeof r->unit));
    PetscCall(PetscCalloc1(r->n_measures, &r->measures));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyElementRun(Verification *v, VerifyRow *r, Diag *diag)
{
  const ElementOptions options = options_of(v, r);
  ElementOutcome outcome = ELEMENT_DONE;
  ElementSummary summary = {0};
  int ended;
  PetscLogDouble begin, end;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&begin));
  if (v->rank == 0) PetscCall(ElementRun(&options, NULL, diag, &summary, &outcome));
  PetscCall(PetscTime(&end));
  for (PetscInt k = 0; k < r->n_measures; ++k) r->measures[k] = summary.measures[k];
  r->summary.steps = summary.increments;
  r->summary.iterations = summary.iterations;
  r->summary.iterations_per_step = summary.most_iterations;
  r->summary.seconds = end - begin;
  ended = (int)outcome;
  PetscCallMPI(MPI_Bcast(&ended, 1, MPI_INT, 0, v->comm));
  r->result = ended == ELEMENT_DONE ? RUN_DONE : ended == ELEMENT_STUCK ? RUN_GAVE_UP : RUN_BAD_INPUT;
  r->ran = PETSC_TRUE;
  PetscCall(VerifyShareRow(v, r));
  PetscFunctionReturn(0);
}
