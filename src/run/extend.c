/* A run that is asked to go on: to which end may it, and is there anything left to do? */
#include "input/case_file.h"
#include "run/run_private.h"

PetscErrorCode ExtensionBegin(const Run *r, Extension *extension)
{
  char path[PETSC_MAX_PATH_LEN];
  Diag *unheard;
  Case *kept = NULL;

  PetscFunctionBeginUser;
  extension->before = extension->now = r->whole->analysis.end;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/case.yaml", run_dir_path(r->dir)));
  PetscCall(DiagCreate(&unheard));
  PetscCall(CaseRead(r->comm, path, 0, NULL, unheard, &kept));
  if (kept) extension->before = kept->analysis.end;
  PetscCall(CaseDestroy(&kept));
  PetscCall(DiagDestroy(&unheard));
  PetscFunctionReturn(0);
}

static void hint_new_run(const Run *r, const Extension *e, Diag *diag)
{
  diag_hint(diag, "a new run does it: talus run %s/case.yaml --out ANOTHER --set analysis.end=%g", run_dir_path(r->dir),
            (double)e->now);
}

PetscBool extension_allowed(const Run *r, const Extension *e, Diag *diag)
{
  if (!case_is_static(&r->whole->analysis) || e->now == e->before) return PETSC_TRUE;
  diag_error(diag, "analysis.end",
             "a static run cannot go on to another end than its own, %g s: loads grow with time over analysis.end, so "
             "that all its steps would be others",
             (double)e->before);
  hint_new_run(r, e, diag);
  return PETSC_FALSE;
}

void extension_without_checkpoint(const Run *r, const Extension *e, Diag *diag)
{
  if (e->now <= e->before) {
    diag_warning(diag, NULL, "the run in '%s' is complete and has left no checkpoint: there is nothing to resume",
                 run_dir_path(r->dir));
    return;
  }
  diag_error(diag, "analysis.end",
             "the run in '%s' is complete at t = %g s and has left no checkpoint from which it could go on to %g s",
             run_dir_path(r->dir), (double)e->before, (double)e->now);
  hint_new_run(r, e, diag);
}

void extension_from_checkpoint(const Run *r, const Extension *e, Diag *diag)
{
  const PetscReal time = r->model->time;
  char reason[256];
  if (r->whole->n_stages) {
    /* others begin where one ends */
    if (r->stage + 1 == r->whole->n_stages && time >= r->c->analysis.end * (1 - 1e-12) &&
        !case_seeks(&r->c->analysis)) /* which goes on beyond it */
      diag_warning(diag, NULL, "the run in '%s' is complete at t = %g s: there is nothing left to do",
                   run_dir_path(r->dir), (double)time);
    return;
  }
  until_reason(&r->until, r->c, reason);
  if (case_seeks(&r->c->analysis) && time > e->now) return; /* the search goes on beyond the end of loading */
  if (time > e->now * (1 + 1e-12)) {
    diag_error(diag, "analysis.end", "the run in '%s' has come to t = %g s already, later than analysis.end = %g s",
               run_dir_path(r->dir), (double)time, (double)e->now);
    diag_hint(diag, "an end after that lets it go on; its states up to there are in '%s'", run_dir_path(r->dir));
  } else if (reason[0]) {
    diag_warning(diag, NULL, "the run in '%s' has ended at t = %g s, since %s: there is nothing left to do",
                 run_dir_path(r->dir), (double)time, reason);
    diag_hint(diag, "other conditions let it go on, or none: --set 'analysis.until=[]'");
  } else if (time >= e->now * (1 - 1e-12)) {
    diag_warning(diag, NULL, "the run in '%s' is complete at t = %g s: there is nothing left to do",
                 run_dir_path(r->dir), (double)time);
    if (!case_is_static(&r->c->analysis)) diag_hint(diag, "a later end lets it go on: --set analysis.end=...");
  }
}
