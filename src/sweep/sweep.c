#include "sweep/sweep.h"
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "input/case_file.h"
#include "sweep/sweep_private.h"

static void find_case(SweepRun *s)
{
  case_file_path(s->options->file, s->file);
  const char *slash = strrchr(s->file, '/');
  PetscSNPrintf(s->folder, sizeof s->folder, "%.*s", slash ? (int)PetscMax(slash - s->file, 1) : 1,
                slash ? s->file : ".");
}

/* runs/sweep/<case>, and below it the sweep's name. */
static void find_out(SweepRun *s)
{
  char *real = realpath(s->file, NULL), *base = real ? strrchr(real, '/') + 1 : NULL, *dot;
  if (base && !strcmp(base, "case.yaml") && base - real > 1) {
    base[-1] = '\0';
    base = strrchr(real, '/') + 1;
  } else if (base && (dot = strrchr(base, '.')) && dot > base) *dot = '\0';
  if (s->options->out) PetscStrncpy(s->out, s->options->out, sizeof s->out);
  else
    PetscSNPrintf(s->out, sizeof s->out, "runs/sweep/%s%s%s%s", base && *base ? base : "case",
                  s->sweep->name ? "/" : "", s->sweep->name ? s->sweep->name : "", s->options->quick ? "-quick" : "");
  free(real);
}

/* The sweep of that name, and all there are in a hint if there is none. */
static PetscErrorCode ChooseFromFile(SweepRun *s)
{
  char path[PETSC_MAX_PATH_LEN];
  const char *words[64] = {NULL}, *name = s->options->name;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/sweep.yaml", s->folder));
  if (!name && access(path, F_OK)) {
    diag_error(s->diag, NULL, "nothing is to be varied");
    diag_hint(s->diag, "--over path.to.key=from:to:step, or --name of a sweep in %s, which is not there", path);
    PetscFunctionReturn(0);
  }
  PetscCall(SweepFileRead(path, s->diag, &s->sweeps));
  for (PetscInt k = 0; s->sweeps && k < s->sweeps->n; ++k) {
    if (k < 63) words[k] = s->sweeps->sweeps[k].name;
    if (name && !strcmp(name, s->sweeps->sweeps[k].name)) s->sweep = &s->sweeps->sweeps[k];
  }
  if (!s->sweeps || s->sweep) PetscFunctionReturn(0);
  if (name) diag_error(s->diag, NULL, "%s has no sweep '%s'", path, name);
  else diag_error(s->diag, NULL, "which of the sweeps in %s? --name chooses one", path);
  diag_hint_names(s->diag, name ? name : "", words);
  PetscFunctionReturn(0);
}

static PetscErrorCode Choose(SweepRun *s)
{
  PetscInt n_over = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->options->n_words; ++i) n_over += s->options->words[i].kind <= SWEEP_ALONG;
  if (!s->options->n_words || (!n_over && s->options->name == NULL)) PetscCall(ChooseFromFile(s));
  else {
    PetscCall(SweepFileFromWords(s->options->n_words, s->options->words, s->diag, &s->sweeps));
    if (s->sweeps) s->sweep = s->sweeps->sweeps;
  }
  PetscFunctionReturn(0);
}

static void tell_plan(const SweepRun *s)
{
  PetscInt resumed = 0, kept = members_count(&s->members, MEMBER_DONE);
  for (PetscInt i = 0; i < s->members.n; ++i) resumed += s->members.member[i].resume;
  fprintf(s->told, "%s: %" PetscInt_FMT " members", s->sweep->title ? s->sweep->title : s->file, s->members.n);
  if (kept) fprintf(s->told, ", %" PetscInt_FMT " done before", kept);
  if (resumed) fprintf(s->told, ", %" PetscInt_FMT " to go on from their checkpoints", resumed);
  fprintf(s->told, "; %" PetscInt_FMT " at a time, into %s\n", s->members.jobs, s->out);
  for (PetscInt i = 0; i < s->members.n && s->options->dry; ++i)
    fprintf(s->told, "  %s%s\n", s->members.member[i].name, s->members.member[i].kept ? " (done)" : "");
  fflush(s->told);
}

static PetscErrorCode WriteTable(void *context)
{
  PetscFunctionBeginUser;
  PetscCall(SweepTable(context));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunAll(SweepRun *s, SweepOutcome *outcome)
{
  PetscFunctionBeginUser;
  PetscCall(MembersRun(&s->members));
  PetscCall(SweepTable(s));
  fprintf(s->told, "table: %s/sweep.csv\n", s->out);
  PetscCall(SweepFigures(s));
  const PetscInt done = members_count(&s->members, MEMBER_DONE);
  *outcome = done == s->members.n ? SWEEP_DONE : SWEEP_FAILED;
  if (s->members.stopped) {
    diag_error(s->diag, NULL, "the sweep was interrupted by a signal: %" PetscInt_FMT " of %" PetscInt_FMT " are done",
               done, s->members.n);
    diag_hint(s->diag, "the same command goes on where its members have stopped");
  } else if (done < s->members.n)
    diag_error(s->diag, NULL, "%" PetscInt_FMT " of %" PetscInt_FMT " members did not come to their end",
               s->members.n - done, s->members.n);
  members_tell_lacks(&s->members, s->diag);
  if (diag_errors(s->diag)) *outcome = SWEEP_FAILED;
  PetscFunctionReturn(0);
}

/* From what is asked for to members that could be run; errors are in diag. */
static PetscErrorCode Prepare(SweepRun *s, int *lock)
{
  PetscFunctionBeginUser;
  find_case(s);
  PetscCall(Choose(s));
  if (!s->sweep) PetscFunctionReturn(0);
  find_out(s);
  if (!s->options->dry) members_prepare_folder(s->out, "sweep.csv", s->diag, lock);
  if (!diag_errors(s->diag)) PetscCall(SweepPlan(s));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepCase(const SweepOptions *options, FILE *out, Diag *diag, SweepOutcome *outcome)
{
  SweepRun s = {.options = options,
                .diag = diag,
                .told = out,
                .members = {.force = options->force, .keep = options->keep, .trust = options->trust, .out = out}};
  int lock = -1;

  PetscFunctionBeginUser;
  *outcome = SWEEP_BAD_INPUT;
  s.members.Ended = WriteTable;
  s.members.context = &s;
  PetscCall(Prepare(&s, &lock));
  if (!diag_errors(diag)) {
    s.members.jobs = PetscMin(members_jobs(options->jobs), s.members.n);
    tell_plan(&s);
    if (options->dry) *outcome = SWEEP_DONE;
    else PetscCall(RunAll(&s, outcome));
  }
  if (lock >= 0) close(lock);
  PetscCall(MembersClear(&s.members));
  PetscCall(PetscFree(s.taken));
  PetscCall(SweepFileDestroy(&s.sweeps));
  PetscFunctionReturn(0);
}
