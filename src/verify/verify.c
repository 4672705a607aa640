#include "verify/verify.h"
#include <errno.h>
#include <limits.h>
#include <petsctime.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "input/case_file.h"
#include "output/directory/run_dir_files.h"
#include "output/directory/run_dir_mark.h"
#include "verify/verify_private.h"

/* The name of the case is that of its folder, also where that is given as "." */
static void name_case(Verification *v)
{
  const VerifyOptions *o = v->options;
  char *real = realpath(o->folder, NULL);
  const char *slash = real ? strrchr(real, '/') : NULL;
  PetscStrncpy(v->name, slash && slash[1] ? slash + 1 : "case", sizeof v->name);
  free(real);
  v->element = file_exists(o->folder, "element.yaml") && !file_exists(o->folder, "case.yaml");
  PetscSNPrintf(v->file, sizeof v->file, "%s/%s.yaml", o->folder, v->element ? "element" : "case");
  if (o->out) PetscStrncpy(v->out, o->out, sizeof v->out);
  else PetscSNPrintf(v->out, sizeof v->out, "runs/verify/%s", v->name);
}

static PetscErrorCode Run(Verification *v, VerifyRow *r, Diag *diag)
{
  const RunOptions run = {.out = r->folder, .force = PETSC_TRUE, .quiet = PETSC_TRUE, .summary = &r->summary};
  PetscBool found = PETSC_FALSE;
  double start, end;
  Case *c;

  PetscFunctionBeginUser;
  PetscCall(CaseRead(v->comm, v->file, r->set.n, (const char *const *)r->set.text, diag, &c));
  r->result = RUN_BAD_INPUT;
  if (c) c->grid.trusted = v->options->trust;
  if (c && v->options->resume) PetscCall(VerifyTakeOver(v, r, c, &found));
  if (!c || found) {
    PetscCall(CaseDestroy(&c));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscTime(&start));
  PetscCall(RunCase(v->comm, c, &run, diag, r->measures, &r->result));
  PetscCall(PetscTime(&end));
  r->seconds = end - start;
  PetscCallMPI(MPI_Bcast(&r->seconds, 1, MPIU_REAL, 0, v->comm));
  PetscCallMPI(MPI_Bcast(r->measures, (PetscMPIInt)r->n_measures, MPIU_REAL, 0, v->comm));
  r->ran = PETSC_TRUE;
  /* States are large, and a verification compares numbers: they go unless they are wanted. */
  if (v->rank == 0 && !v->options->keep && r->result != RUN_BAD_INPUT) run_dir_remove_states(r->folder);
  PetscCall(CaseDestroy(&c));
  PetscFunctionReturn(0);
}

/* The same run in an earlier study: its results are taken over. */
static PetscErrorCode Reuse(const Verification *v, VerifyRow *r, PetscBool *found)
{
  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  for (const VerifyRow *other = v->rows; other < r; ++other) {
    if (!other->ran || !setting_lists_equal(&other->set, &r->set)) continue;
    PetscCall(PetscStrncpy(r->folder, other->folder, sizeof r->folder));
    PetscCall(PetscArraycpy(r->measures, other->measures, r->n_measures));
    r->result = other->result;
    r->summary = other->summary;
    r->seconds = 0;
    r->taken = other->taken;
    PetscCall(PetscStrncpy(r->sources, other->sources, sizeof r->sources));
    r->ran = r->shared = *found = PETSC_TRUE;
    break;
  }
  PetscFunctionReturn(0);
}

/* A file of the user's that a table or a figure would overwrite; NULL if there is none. */
static const char *in_the_way(const Verification *v, char name[300])
{
  if (run_dir_is_signed(v->out) || verify_is_table(v->out)) return NULL;
  PetscStrncpy(name, "verification.md", 300);
  for (PetscInt k = 0; k <= v->n; ++k) {
    if (file_exists(v->out, name)) return name;
    if (k < v->n) PetscSNPrintf(name, 300, "%s.png", v->rows[k].study->name);
  }
  return NULL;
}

/* By rank 0. */
static void prepare_folder(const Verification *v, Diag *diag)
{
  char name[300];
  int error = file_make_folders(v->out);
  const char *taken = error ? NULL : in_the_way(v, name);
  if (taken) {
    diag_error(diag, NULL, "'%s' holds a %s that talus has not written: it would be overwritten", v->out, taken);
    diag_hint(diag, "name another directory with --out");
    return;
  }
  if (!error && access(v->out, W_OK | X_OK)) error = errno;
  if (!error) error = run_dir_sign(v->out);
  if (error) diag_error(diag, NULL, "cannot write into '%s': %s", v->out, strerror(error));
}

/* By rank 0. A figure that cannot be drawn says so, and changes nothing about the numbers. */
static PetscErrorCode FinishStudy(const Verification *v, PetscInt first, PetscInt last, FILE *out)
{
  PetscBool done;
  Diag *diag;

  PetscFunctionBeginUser;
  verify_table_foot(out, v, first, last);
  PetscCall(DiagCreate(&diag));
  PetscCall(VerifyFigureDraw(v, first, last, diag, &done));
  if (done) fprintf(out, "  figure: %s/%s.png\n", v->out, v->rows[first].study->name);
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

/* All rows; stops early only for bad input or a signal. Returns how many rows are done. */
static PetscErrorCode RunRows(Verification *v, FILE *out, Diag *diag, PetscInt *n)
{
  PetscBool reused;
  PetscInt first = 0;

  PetscFunctionBeginUser;
  for (*n = 0; *n < v->n;) {
    VerifyRow *r = &v->rows[*n];
    if (v->rank == 0 && r->study != v->rows[first].study) first = *n;
    if (v->rank == 0 && *n == first) verify_table_head(out, v, first);
    PetscCall(Reuse(v, r, &reused));
    if (!reused) PetscCall((v->element ? VerifyElementRun : Run)(v, r, diag));
    if (r->result == RUN_BAD_INPUT) break;
    PetscCall(VerifyValue(v, r, diag));
    verify_judge(v->rows, *n);
    if (v->rank == 0) verify_table_row(out, r);
    ++*n;
    const PetscBool last = *n == v->n || v->rows[*n].study != r->study;
    if (v->rank == 0 && (last || r->summary.interrupted)) PetscCall(FinishStudy(v, first, *n, out));
    if (r->summary.interrupted) break;
  }
  PetscFunctionReturn(0);
}

/* Into docs/verification.md, by rank 0. */
static PetscErrorCode Record(const Verification *v, FILE *out, Diag *diag)
{
  char file[PETSC_MAX_PATH_LEN], *all, *alone;
  int error;

  PetscFunctionBeginUser;
  verify_record_file(v->options->folder, file);
  PetscCall(VerifyMarkdown(v, VERIFY_SECTION, &all));
  PetscCall(VerifyMarkdown(v, VERIFY_STUDY_ALONE, &alone));
  const VerifySection section = {.all = all, .study = v->options->only, .alone = alone};
  PetscCall(VerifyRecord(file, v->name, &section, &error));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(alone));
  if (error) diag_error(diag, NULL, "cannot record in '%s': %s", file, strerror(error));
  else fprintf(out, "recorded: %s\n", file);
  PetscFunctionReturn(0);
}

/* Tables into files, by rank 0. */
static PetscErrorCode Write(const Verification *v, FILE *out, Diag *diag)
{
  char file[PETSC_MAX_PATH_LEN], *text;
  int error;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file, sizeof file, "%s/verification.md", v->out));
  PetscCall(VerifyMarkdown(v, VERIFY_WITH_FIGURES, &text));
  error = file_write_text(file, text);
  PetscCall(PetscFree(text));
  if (error) diag_error(diag, NULL, "cannot write '%s': %s", file, strerror(error));
  else fprintf(out, "table: %s\n", file);
  if (v->options->record) PetscCall(Record(v, out, diag));
  PetscFunctionReturn(0);
}

static void check_options(const Verification *v, Diag *diag)
{
  char file[PETSC_MAX_PATH_LEN];
  if (!v->options->record) return;
  verify_record_file(v->options->folder, file);
  if (v->rank == 0 && access(file, W_OK)) diag_error(diag, NULL, "cannot record in '%s': %s", file, strerror(errno));
}

static VerifyOutcome outcome_of(const Verification *v, PetscInt n)
{
  VerifyOutcome outcome = n < v->n ? VERIFY_GAVE_UP : VERIFY_PASSED;
  for (PetscInt k = 0; k < n; ++k) {
    if (v->rows[k].result != RUN_DONE) return VERIFY_GAVE_UP;
    if (!v->rows[k].pass && outcome == VERIFY_PASSED) outcome = VERIFY_OFF;
  }
  return outcome;
}

/* Options, reference and cases are read; errors: on any rank. */
static PetscErrorCode Prepare(Verification *v, Diag *diag, PetscInt *errors)
{
  char file[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  name_case(v);
  check_options(v, diag);
  PetscCall(PetscSNPrintf(file, sizeof file, "%s/reference.yaml", v->options->folder));
  PetscCall(DiagReduce(v->comm, diag, errors));
  if (*errors) PetscFunctionReturn(0);
  PetscCall(ReferenceRead(v->comm, file, diag, &v->reference));
  if (v->reference) PetscCall(VerifyPlan(v, diag));
  PetscCall(DiagSetResolver(diag, NULL, NULL)); /* what follows is about no line of a case */
  if (v->rank == 0 && !diag_errors(diag)) prepare_folder(v, diag);
  PetscCall(DiagReduce(v->comm, diag, errors));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyCase(MPI_Comm comm, const VerifyOptions *options, FILE *out, Diag *diag, VerifyOutcome *outcome)
{
  Verification v = {.comm = comm, .options = options};
  PetscInt errors, n = 0;

  PetscFunctionBeginUser;
  *outcome = VERIFY_BAD_INPUT;
  PetscCallMPI(MPI_Comm_rank(comm, &v.rank));
  PetscCallMPI(MPI_Comm_size(comm, &v.size));
  PetscCall(Prepare(&v, diag, &errors));
  if (!errors) {
    if (v.rank == 0) fprintf(out, "%s: %s\n", v.name, v.reference->title);
    PetscCall(RunRows(&v, out, diag, &n));
    PetscCall(DiagSetResolver(diag, NULL, NULL));
    if (v.rank == 0 && n == v.n) PetscCall(Write(&v, out, diag));
    PetscCall(DiagReduce(comm, diag, &errors));
    if (!errors) *outcome = outcome_of(&v, n);
  }
  PetscCall(VerifyPlanClear(&v));
  PetscCall(ReferenceDestroy(&v.reference));
  PetscFunctionReturn(0);
}
