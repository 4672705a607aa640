/* A run that is asked to go on: to which end may it, and is there anything left to do? */
#include "input/case_file.h"
#include "run/run_private.h"

static const Case *last_stage(const Case *whole) { return case_stage(whole, case_stages(whole) - 1); }

/* A key of the analysis, of the last stage where there are any: "stages[2].analysis.end". */
static const char *key_of(const Run *r, const char *word, char key[48])
{
  snprintf(key, 48, "analysis.%s", word);
  if (r->whole->n_stages) snprintf(key, 48, "stages[%d].analysis.%s", (int)r->whole->n_stages - 1, word);
  return key;
}

PetscErrorCode ExtensionBegin(const Run *r, Extension *extension)
{
  char path[PETSC_MAX_PATH_LEN];
  Diag *unheard;
  Case *kept = NULL;

  PetscFunctionBeginUser;
  extension->before = extension->now = last_stage(r->whole)->analysis.end;
  extension->stage = -1;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/case.yaml", run_dir_path(r->dir)));
  PetscCall(DiagCreate(&unheard));
  PetscCall(CaseRead(r->comm, path, 0, NULL, unheard, &kept));
  if (kept) extension->before = last_stage(kept)->analysis.end;
  for (PetscInt k = r->whole->n_stages - 2; kept && k >= 0 && k < kept->n_stages; --k)
    if (kept->stage_case[k]->analysis.end != r->whole->stage_case[k]->analysis.end) extension->stage = k;
  PetscCall(CaseDestroy(&kept));
  PetscCall(DiagDestroy(&unheard));
  PetscFunctionReturn(0);
}

static void hint_new_run(const Run *r, const Extension *e, Diag *diag)
{
  char key[48];
  diag_hint(diag, "a new run does it: talus run %s/case.yaml --out ANOTHER --set %s=%g", run_dir_path(r->dir),
            key_of(r, "end", key), (double)e->now);
}

PetscBool extension_allowed(const Run *r, const Extension *e, Diag *diag)
{
  char key[48];
  if (e->stage >= 0) {
    diag_error(diag, NULL, "stage '%s' cannot get another end: those behind it begin there",
               r->whole->stages[e->stage].name);
    diag_hint(diag, "that of the last stage may change: --set %s=...", key_of(r, "end", key));
    return PETSC_FALSE;
  }
  if (!case_is_static(&last_stage(r->whole)->analysis) || e->now == e->before) return PETSC_TRUE;
  diag_error(diag, key_of(r, "end", key),
             "a static run cannot go on to another end than its own, %g s: loads grow with time over analysis.end, so "
             "that all its steps would be others",
             (double)e->before);
  hint_new_run(r, e, diag);
  return PETSC_FALSE;
}

void extension_without_checkpoint(const Run *r, const Extension *e, Diag *diag)
{
  const char *of = r->whole->n_stages ? " of its last stage" : "";
  char key[48];
  if (e->now <= e->before) {
    diag_warning(diag, NULL, "the run in '%s' is complete and has left no checkpoint: there is nothing to resume",
                 run_dir_path(r->dir));
    return;
  }
  diag_error(diag, key_of(r, "end", key),
             "the run in '%s' is complete at t = %g s%s and has left no checkpoint from which it could go on to %g s",
             run_dir_path(r->dir), (double)e->before, of, (double)e->now);
  hint_new_run(r, e, diag);
}

void extension_from_checkpoint(const Run *r, Diag *diag)
{
  const PetscReal time = r->model->time, end = r->c->analysis.end;
  char reason[256], key[48];
  if (r->stage + 1 < case_stages(r->whole)) return;                              /* others begin where this one ends */
  if (case_seeks(&r->c->analysis) && (r->whole->n_stages || time > end)) return; /* it goes on beyond the end */
  until_reason(&r->until, r->c, reason);
  if (time > end * (1 + 1e-12)) {
    diag_error(diag, key_of(r, "end", key), "the run in '%s' has come to t = %g s already, later than %s = %g s",
               run_dir_path(r->dir), (double)time, r->whole->n_stages ? "the end" : "analysis.end", (double)end);
    diag_hint(diag, "an end after that lets it go on; its states up to there are in '%s'", run_dir_path(r->dir));
  } else if (reason[0]) {
    diag_warning(diag, NULL, "the run in '%s' has ended at t = %g s, since %s: there is nothing left to do",
                 run_dir_path(r->dir), (double)time, reason);
    diag_hint(diag, "other conditions let it go on, or none: --set '%s=[]'", key_of(r, "until", key));
  } else if (time >= end * (1 - 1e-12)) {
    diag_warning(diag, NULL, "the run in '%s' is complete at t = %g s: there is nothing left to do",
                 run_dir_path(r->dir), (double)time);
    if (!case_is_static(&r->c->analysis))
      diag_hint(diag, "a later end lets it go on: --set %s=...", key_of(r, "end", key));
  }
}
