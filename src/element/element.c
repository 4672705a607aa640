#include "element/element.h"
#include <errno.h>
#include <string.h>
#include <unistd.h>
#include "element/element_table.h"
#include "output/directory/run_dir_files.h"
#include "output/directory/run_dir_mark.h"

typedef struct {
  const ElementOptions *options;
  ElementSpec *spec;
  DrivePoint point;
  ElementTable table;
  ElementSummary summary;
  PetscReal passed; /* most of a piece of the table of strength in one part of an increment */
  Diag *diag;
} Element;

/* runs/element/<name of the file>, of a case with the material and the test. */
static void find_out(const Element *e, char out[PETSC_MAX_PATH_LEN])
{
  const ElementOptions *o = e->options;
  char file[PETSC_MAX_PATH_LEN], *slash, *base = file, *dot;
  PetscStrncpy(file, o->file, sizeof file);
  if ((slash = strrchr(file, '/')) && !strcmp(slash, "/case.yaml")) *slash = '\0';
  if ((slash = strrchr(file, '/'))) base = slash + 1;
  if ((dot = strrchr(base, '.')) && dot > base) *dot = '\0';
  if (o->out) PetscStrncpy(out, o->out, PETSC_MAX_PATH_LEN);
  else
    PetscSNPrintf(out, PETSC_MAX_PATH_LEN, "runs/element/%s%s%s%s%s", base, o->test ? "/" : "",
                  o->test ? e->spec->material.name : "", o->test ? "-" : "", o->test ? o->test : "");
}

static PetscBool prepare_folder(const char *path, PetscBool force, Diag *diag)
{
  int error = file_make_folders(path);
  if (!error && !force && !run_dir_is_signed(path) && file_exists(path, "element.csv")) {
    diag_error(diag, NULL, "'%s' holds an element.csv that talus has not written: it would be overwritten", path);
    diag_hint(diag, "name another directory with --out, or overwrite it with --force");
    return PETSC_FALSE;
  }
  if (!error && access(path, W_OK | X_OK)) error = errno;
  if (!error) error = run_dir_sign(path);
  if (error) diag_error(diag, NULL, "cannot write into '%s': %s", path, strerror(error));
  return error ? PETSC_FALSE : PETSC_TRUE;
}

static PetscBool start(Element *e)
{
  const ElementSpec *spec = e->spec;
  Material *m = &e->spec->material;
  if (drive_start(&e->point, m, spec->start.value, spec->pore)) {
    if (spec->cell > 0) m->law->size(m->parameters, spec->cell, e->point.state);
    return PETSC_TRUE;
  }
  /* of a path it has no name */
  diag_error(e->diag, NULL, "the material %s%s(%s) cannot begin with this stress", spec->document ? "" : m->name,
             spec->document ? "" : " ", m->law->name);
  diag_hint(e->diag, "%s", spec->document ? "`start:` names another one" : "--confining P gives another pressure");
  return PETSC_FALSE;
}

/* Where the path ends, and why. */
static void tell_stuck(const Element *e, PetscInt stage, const DriveControl *control, const DriveReport *report,
                       PetscReal share)
{
  static const char *const words[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  const YamlDocument *document = e->spec->document;
  const YamlNode *path = document ? yaml_find(document->root, "path") : NULL;
  char name[160], prescribed[80] = "";
  element_stage_name(&e->spec->stages[stage], sizeof name, name);
  for (int k = 0; k < 6; ++k)
    if (control->stress[k])
      snprintf(prescribed + strlen(prescribed), sizeof prescribed - strlen(prescribed), "%s%s",
               prescribed[0] ? ", " : "", words[k]);
  if (path)
    yaml_error(document, e->diag, path->child[stage], PETSC_FALSE, "%s ends after %.4g of its way", name,
               (double)share);
  else diag_error(e->diag, NULL, "%s ends after %.4g of its way", name, (double)share);
  if (report->status == LAW_INVERTED) diag_hint(e->diag, "the law takes the deformation for turned inside out");
  else if (prescribed[0])
    diag_hint(
      e->diag,
      "the point cannot carry the stresses that are prescribed there (%s): to go beyond a peak, prescribe its strain",
      prescribed);
  else diag_hint(e->diag, "the law gives no stress there");
}

static void warn_of_passed(const Element *e)
{
  if (e->passed <= TABLE_PASSED) return;
  diag_warning(e->diag, NULL,
               "an increment goes through %.2g of a piece of the table of strength (peak_strain, residual_strain): it "
               "has the strength of its end, and never had that between",
               (double)e->passed);
  diag_hint(e->diag, "take more `steps`: the error goes with their size");
}

/* PETSC_FALSE in *done: it cannot be followed further. */
static PetscErrorCode Follow(Element *e, PetscInt stage, PetscBool *done)
{
  const ElementStage *s = &e->spec->stages[stage];
  PetscReal first[6], last[6], from[6], to[6];
  DriveControl control;

  PetscFunctionBeginUser;
  *done = PETSC_TRUE;
  element_stage(s, &e->point, &control, first, last);
  control.seconds = s->seconds / (PetscReal)s->steps;
  if (s->seconds == 0 && e->point.material->law->rate)
    materials_step(1, e->point.material, e->point.time, 1, PETSC_FALSE);
  memcpy(from, first, sizeof from);
  for (PetscInt i = 0; i < s->steps && *done; ++i, ++e->summary.increments) {
    const PetscReal share = (PetscReal)(i + 1) / (PetscReal)s->steps;
    DriveReport report = {0};
    for (int k = 0; k < 6; ++k) to[k] = i + 1 == s->steps ? last[k] : first[k] + share * (last[k] - first[k]);
    *done = drive_advance(&e->point, &control, from, to, &report);
    e->summary.iterations += report.iterations;
    e->summary.most_iterations = PetscMax(e->summary.most_iterations, report.iterations);
    e->summary.substeps += report.substeps;
    e->passed = PetscMax(e->passed, report.passed);
    memcpy(from, to, sizeof from);
    if (*done || report.reached > 0) PetscCall(ElementTableAdd(&e->table, stage + 1, &e->point));
    if (!*done) tell_stuck(e, stage, &control, &report, ((PetscReal)i + report.reached) / (PetscReal)s->steps);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Write(const Element *e, const char *folder, FILE *out)
{
  char csv[PETSC_MAX_PATH_LEN], png[PETSC_MAX_PATH_LEN];
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(csv, sizeof csv, "%s/element.csv", folder));
  PetscCall(PetscSNPrintf(png, sizeof png, "%s/element.png", folder));
  PetscCall(ElementTableWrite(&e->table, csv, e->diag));
  if (!out) PetscFunctionReturn(0);
  fprintf(out, "%s (%s)\n", e->spec->title, e->spec->material.law->name);
  element_report(out, e->spec, &e->table);
  fprintf(out, "%" PetscInt_FMT " increments in %" PetscInt_FMT " parts, %" PetscInt_FMT " iterations\n",
          e->summary.increments, e->summary.substeps, e->summary.iterations);
  fprintf(out, "table: %s\n", csv);
  PetscCall(ElementFigure(e->spec, &e->table, png, e->diag, &done));
  if (done) fprintf(out, "picture: %s\n", png);
  PetscFunctionReturn(0);
}

static PetscErrorCode FollowAll(Element *e, const char *folder, FILE *out, ElementOutcome *outcome)
{
  PetscBool done = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(ElementTableAdd(&e->table, 0, &e->point));
  for (PetscInt s = 0; s < e->spec->n_stages && done; ++s) PetscCall(Follow(e, s, &done));
  warn_of_passed(e);
  element_measure(&e->table, e->summary.measures);
  PetscCall(Write(e, folder, out));
  *outcome = done ? ELEMENT_DONE : ELEMENT_STUCK;
  PetscFunctionReturn(0);
}

PetscErrorCode ElementCheck(const ElementOptions *options, Diag *diag, PetscBool *good)
{
  Element e = {.options = options, .diag = diag};

  PetscFunctionBeginUser;
  PetscCall(ElementRead(options, diag, &e.spec));
  *good = e.spec && start(&e) ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ElementSpecDestroy(&e.spec));
  PetscFunctionReturn(0);
}

PetscErrorCode ElementRun(const ElementOptions *options, FILE *out, Diag *diag, ElementSummary *summary,
                          ElementOutcome *outcome)
{
  Element e = {.options = options, .diag = diag};
  char folder[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  *outcome = ELEMENT_BAD_INPUT;
  PetscCall(ElementRead(options, diag, &e.spec));
  if (e.spec) {
    find_out(&e, folder);
    if (start(&e) && prepare_folder(folder, options->force, diag)) PetscCall(FollowAll(&e, folder, out, outcome));
  }
  if (summary) *summary = e.summary;
  PetscCall(PetscFree(e.table.values));
  PetscCall(ElementSpecDestroy(&e.spec));
  PetscFunctionReturn(0);
}
