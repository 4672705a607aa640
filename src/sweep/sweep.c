#include "sweep/sweep.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include "output/directory/run_dir_files.h"
#include "output/directory/run_dir_mark.h"
#include "sweep/sweep_private.h"

/* The case file may be named by its folder. */
static void find_case(SweepRun *s)
{
  struct stat info;
  const char *file = s->options->file, *slash = strrchr(file, '/');
  if (!stat(file, &info) && S_ISDIR(info.st_mode)) {
    PetscSNPrintf(s->file, sizeof s->file, "%s/case.yaml", file);
    PetscStrncpy(s->folder, file, sizeof s->folder);
  } else {
    PetscStrncpy(s->file, file, sizeof s->file);
    PetscSNPrintf(s->folder, sizeof s->folder, "%.*s", slash ? (int)PetscMax(slash - file, 1) : 1, slash ? file : ".");
  }
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

/* Ours to write into, and nobody else's at this time; *lock: to be closed. */
static void prepare_folder(SweepRun *s, int *lock)
{
  int error = file_make_folders(s->out);
  if (!error && !run_dir_is_signed(s->out) && file_exists(s->out, "sweep.csv")) {
    diag_error(s->diag, NULL, "'%s' holds a sweep.csv that talus has not written: it would be overwritten", s->out);
    diag_hint(s->diag, "name another directory with --out");
    return;
  }
  if (!error && access(s->out, W_OK | X_OK)) error = errno;
  if (!error) error = run_dir_sign(s->out);
  if (error) {
    diag_error(s->diag, NULL, "cannot write into '%s': %s", s->out, strerror(error));
    return;
  }
  *lock = open(s->out, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (*lock >= 0 && flock(*lock, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK)
    diag_error(s->diag, NULL, "another sweep is at work in '%s'", s->out);
}

static PetscInt count_cores(void)
{
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) ? 1 : PetscMax(CPU_COUNT(&set), 1);
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
  if (!s->options->dry) prepare_folder(s, lock);
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
    s.members.jobs = PetscMin(options->jobs ? options->jobs : count_cores(), s.members.n);
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
