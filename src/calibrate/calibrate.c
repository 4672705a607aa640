/* The search: runs, surrogates, the region, more runs where it is not clear, a run at its best
 * point. */
#include "calibrate/calibrate.h"
#include <math.h>
#include <string.h>
#include <unistd.h>
#include "calibrate/calibrate_private.h"
#include "input/case_file.h"
#include "output/directory/run_dir_files.h"

/* runs/calibrate/<name of the file> */
static void find_folders(CalibrateRun *r)
{
  const char *file = r->options->file, *slash = strrchr(file, '/'), *base = slash ? slash + 1 : file;
  const char *dot = strrchr(base, '.');
  PetscSNPrintf(r->folder, sizeof r->folder, "%.*s", slash ? (int)PetscMax(slash - file, 1) : 1, slash ? file : ".");
  if (r->options->out) PetscStrncpy(r->out, r->options->out, sizeof r->out);
  else
    PetscSNPrintf(r->out, sizeof r->out, "runs/calibrate/%.*s%s", dot > base ? (int)(dot - base) : (int)strlen(base),
                  base, r->options->quick ? "-quick" : "");
}

/* Cases from the folder of the file, and a folder for the runs of each instrument. */
static PetscErrorCode FindCases(CalibrateRun *r)
{
  char path[2 * PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(r->c->n_instruments, &r->cases));
  for (PetscInt i = 0; i < r->c->n_instruments && !diag_errors(r->diag); ++i) {
    const Instrument *instrument = &r->c->instruments[i];
    if (instrument->folder[0] == '/') PetscCall(PetscSNPrintf(path, sizeof path, "%s", instrument->folder));
    else PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", r->folder, instrument->folder));
    case_file_path(path, r->cases[i]);
    PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", r->out, instrument->name));
    const int error = r->options->dry ? 0 : file_make_folders(path);
    if (error) diag_error(r->diag, NULL, "cannot make '%s': %s", path, strerror(error));
  }
  PetscFunctionReturn(0);
}

/* Targets of all instruments, one behind the other. */
static PetscErrorCode FindTargets(CalibrateRun *r)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->c->n_instruments; ++i) n += r->c->instruments[i].n_targets;
  PetscCall(PetscCalloc4(n, &r->target, n, &r->instrument, n, &r->number, n, &r->surrogate));
  for (PetscInt i = 0; i < r->c->n_instruments; ++i)
    for (PetscInt k = 0; k < r->c->instruments[i].n_targets; ++k) {
      r->target[r->n_targets] = &r->c->instruments[i].targets[k];
      r->instrument[r->n_targets] = i;
      r->number[r->n_targets++] = k;
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(CalibrateRun *r, int *lock)
{
  PetscFunctionBeginUser;
  find_folders(r);
  PetscCall(CalibrationRead(r->options->file, r->diag, &r->c));
  if (!r->c) PetscFunctionReturn(0);
  if (!r->options->dry) members_prepare_folder(r->out, "region.csv", r->diag, lock);
  if (!diag_errors(r->diag)) PetscCall(FindCases(r));
  PetscCall(FindTargets(r));
  if (!diag_errors(r->diag)) PetscCall(CalibrateDesign(r));
  PetscFunctionReturn(0);
}

/* Run what is planned and learn from all. */
static PetscErrorCode RunAndFit(CalibrateRun *r)
{
  PetscFunctionBeginUser;
  r->members.jobs = members_jobs(r->options->jobs);
  PetscCall(MembersRun(&r->members));
  if (r->members.stopped) PetscFunctionReturn(0);
  PetscCall(CalibrateFit(r));
  if (!diag_errors(r->diag))
    fprintf(r->told, "region: %.3g %% of what is looked at, own error at most %.2g of the uncertainties\n",
            (double)(100 * r->region.volume), (double)region_doubt(&r->region));
  PetscFunctionReturn(0);
}

static PetscBool goes_on(const CalibrateRun *r) { return !r->members.stopped && !diag_errors(r->diag); }

/* More runs where the region is not clear, until it is. */
static PetscErrorCode Refine(CalibrateRun *r)
{
  PetscInt next[64], point;

  PetscFunctionBeginUser;
  for (PetscInt round = 0; round < r->c->rounds && goes_on(r); ++round) {
    if (region_doubt(&r->region) <= r->c->resolve) break;
    const PetscInt before = r->n, n = region_next(&r->region, r->n, r->x, r->c->batch, next);
    for (PetscInt i = 0; i < n; ++i)
      PetscCall(CalibrateAdd(r, r->region.x + next[i] * r->region.dim, PETSC_FALSE, &point));
    if (r->n == before) break;
    fprintf(r->told, "round %" PetscInt_FMT " of %" PetscInt_FMT ": %" PetscInt_FMT " more sets of parameters\n",
            round + 1, r->c->rounds, r->n - before);
    if (goes_on(r)) PetscCall(RunAndFit(r));
  }
  PetscFunctionReturn(0);
}

/* A run at the best point, which may move it; the last one is reported. */
static PetscErrorCode Confirm(CalibrateRun *r)
{
  enum { TRIES = 3 };

  PetscFunctionBeginUser;
  for (int k = 0; k < TRIES && goes_on(r) && !calibrate_is_confirmed(r); ++k) {
    const PetscInt before = r->n;
    PetscInt point;
    PetscCall(CalibrateAdd(r, r->region.x + r->region.best * r->region.dim, PETSC_TRUE, &point));
    if (goes_on(r) && r->n > before) PetscCall(RunAndFit(r));
    r->confirmed = point;
    if (r->n == before) break;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Search(CalibrateRun *r, CalibrateOutcome *outcome)
{
  PetscFunctionBeginUser;
  fprintf(r->told,
          "%s: %" PetscInt_FMT " sets of parameters, %" PetscInt_FMT " runs, %" PetscInt_FMT " done before; into %s\n",
          r->c->title, r->n, r->members.n, members_count(&r->members, MEMBER_DONE), r->out);
  fflush(r->told);
  *outcome = CALIBRATE_DONE;
  if (r->options->dry) PetscFunctionReturn(0);
  PetscCall(RunAndFit(r));
  PetscCall(Refine(r));
  PetscCall(Confirm(r));
  *outcome = CALIBRATE_FAILED;
  if (r->members.stopped) {
    diag_error(r->diag, NULL, "the calibration was interrupted by a signal");
    diag_hint(r->diag, "the same command goes on where its runs have stopped");
  } else if (!diag_errors(r->diag)) {
    PetscCall(CalibrateReport(r));
    *outcome = r->region.inside && calibrate_is_confirmed(r) ? CALIBRATE_DONE : CALIBRATE_NONE;
  }
  members_tell_lacks(&r->members, r->diag);
  PetscFunctionReturn(0);
}

static PetscErrorCode Clear(CalibrateRun *r)
{
  PetscFunctionBeginUser;
  PetscCall(RegionDestroy(&r->region));
  for (PetscInt k = 0; k < r->n_targets; ++k) PetscCall(SurrogateDestroy(&r->surrogate[k]));
  PetscCall(PetscFree4(r->target, r->instrument, r->number, r->surrogate));
  PetscCall(PetscFree(r->cases));
  PetscCall(PetscFree(r->x));
  PetscCall(MembersClear(&r->members));
  PetscCall(CalibrationDestroy(&r->c));
  PetscFunctionReturn(0);
}

PetscErrorCode CalibrateFile(const CalibrateOptions *options, FILE *out, Diag *diag, CalibrateOutcome *outcome)
{
  CalibrateRun r = {.options = options,
                    .diag = diag,
                    .told = out,
                    .confirmed = -1,
                    .members = {.force = options->force, .keep = options->keep, .trust = options->trust, .out = out}};
  int lock = -1;

  PetscFunctionBeginUser;
  *outcome = CALIBRATE_BAD_INPUT;
  PetscCall(Prepare(&r, &lock));
  if (!diag_errors(diag)) PetscCall(Search(&r, outcome));
  if (lock >= 0) close(lock);
  PetscCall(Clear(&r));
  PetscFunctionReturn(0);
}
