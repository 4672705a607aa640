#include "sweep/members/members.h"
#include <dirent.h>
#include <fnmatch.h>
#include <math.h>
#include <string.h>
#include <time.h>
#include "input/case_file.h"
#include "model/measure/measure.h"
#include "output/directory/run_dir_files.h"
#include "output/directory/run_dir_mark.h"
#include "run/report/found.h"
#include "run/signals.h"
#include "run/report/summary.h"

const char *const member_states[] = {"not run", "running",   "done",    "interrupted",
                                     "gave up", "bad input", "crashed", NULL};

PetscErrorCode MembersAdd(Members *members, const char *folder, const char *name, const char *file, PetscInt n_taken,
                          const Taken *taken, Member **member)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(members->n + 1) * sizeof(Member), &members->member));
  Member *m = *member = &members->member[members->n++];
  *m = (Member){.file = file, .n_taken = n_taken, .taken = taken};
  PetscCall(PetscStrncpy(m->name, name, sizeof m->name));
  PetscCall(PetscSNPrintf(m->folder, sizeof m->folder, "%s/%s", folder, m->name));
  PetscCall(PetscCalloc3(n_taken, &m->values, n_taken, &m->units, n_taken, &m->lack));
  for (PetscInt k = 0; k < n_taken; ++k) m->values[k] = NAN;
  PetscFunctionReturn(0);
}

PetscErrorCode MembersClear(Members *members)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < members->n; ++i) {
    PetscCall(SettingListClear(&members->member[i].set));
    PetscCall(PetscFree3(members->member[i].values, members->member[i].units, members->member[i].lack));
    PetscCall(PetscFree(members->member[i].means));
  }
  PetscCall(PetscFree(members->member));
  members->n = 0;
  PetscFunctionReturn(0);
}

PetscInt members_count(const Members *members, MemberState state)
{
  PetscInt n = 0;
  for (PetscInt i = 0; i < members->n; ++i) n += members->member[i].state == state;
  return n;
}

static PetscBool has_checkpoint(const char *folder)
{
  PetscBool has = PETSC_FALSE;
  DIR *listing = opendir(folder);
  for (struct dirent *e = NULL; listing && !has && (e = readdir(listing));)
    has = !fnmatch("checkpoint_[0-9]*.h5", e->d_name, 0);
  if (listing) closedir(listing);
  return has;
}

/* What is there already? */
static PetscErrorCode LookForRun(const Members *members, Member *m, const Case *c, Diag *diag)
{
  char *text, reason[256], outcome[64], changed[PETSC_MAX_PATH_LEN] = "";
  PetscBool same = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(FoundCase(PETSC_COMM_SELF, m->folder, &text, reason));
  if (text) PetscCall(FoundIsCase(c, text, &same));
  if (same) PetscCall(FoundChanged(PETSC_COMM_SELF, m->folder, NULL, changed));
  if (changed[0]) same = PETSC_FALSE;
  m->replace = members->force || (file_exists(m->folder, "case.yaml") && (!text || same));
  if (same && !members->force) {
    found_word(m->folder, "timings.txt", "outcome", outcome);
    m->kept = !strcmp(outcome, "done");
    m->resume = !m->kept && has_checkpoint(m->folder);
  } else if (text && !members->force) {
    if (changed[0]) diag_error(diag, NULL, "'%s' has changed since the run in '%s' read it", changed, m->folder);
    else diag_error(diag, NULL, "'%s' holds a run of another case: something has changed since then", m->folder);
    diag_hint(diag, "--force runs all members again, --out DIR leaves these alone");
  }
  PetscCall(PetscFree(text));
  if (m->kept) {
    summary_read(m->folder, &m->summary);
    PetscCall(MemberRead(members, m));
  }
  PetscFunctionReturn(0);
}

static void check_measures(Member *m, const Case *c, Diag *diag)
{
  const char *words[64] = {NULL};
  for (PetscInt k = 0; k < PetscMin(case_columns(c), 63); ++k) words[k] = case_column(c, k)->name;
  for (PetscInt k = 0; k < m->n_taken; ++k) {
    const PetscInt i = case_column_of(c, m->taken[k].measure);
    if (i >= 0) taken_unit(&m->taken[k], measure_unit(case_column(c, i)), m->units[k]);
    else {
      diag_error(diag, NULL, "%s has no measure '%s'", m->file, m->taken[k].measure);
      diag_hint_names(diag, m->taken[k].measure, words);
    }
  }
}

static PetscErrorCode LookForMeans(Member *m, const Case *c)
{
  PetscFunctionBeginUser;
  m->n_stages = case_stages(c);
  PetscCall(PetscFree(m->means));
  PetscCall(PetscCalloc1(m->n_taken * m->n_stages, &m->means));
  for (PetscInt i = 0; i < m->n_taken * m->n_stages; ++i) {
    const Case *stage = case_stage(c, i % m->n_stages);
    PetscCall(MeasureRowIsMean(stage, case_measure_of(stage, m->taken[i / m->n_stages].measure), &m->means[i]));
  }
  PetscFunctionReturn(0);
}

/* What is taken from a time after the end would be nan, after all the runs. */
static void check_windows(const Member *m, const Case *c, Diag *diag)
{
  for (PetscInt k = 0; k < m->n_taken && !c->n_stages; ++k) {
    const Taken *taken = &m->taken[k];
    if (!taken->has_window || taken->from <= c->analysis.end) continue;
    diag_error(diag, NULL, "the window of '%s' begins at %g s, when the run is over: it ends at %g s", taken->measure,
               (double)taken->from, (double)c->analysis.end);
  }
}

PetscErrorCode MemberPlan(const Members *members, Member *m, Diag *diag)
{
  const PetscInt before = diag_errors(diag);
  Case *c;

  PetscFunctionBeginUser;
  PetscCall(CaseRead(PETSC_COMM_SELF, m->file, m->set.n, (const char *const *)m->set.text, diag, &c));
  PetscCall(DiagSetResolver(diag, NULL, NULL)); /* what follows is about no line of a case */
  if (c) check_measures(m, c, diag);
  if (c) check_windows(m, c, diag);
  if (c) PetscCall(LookForMeans(m, c));
  if (c) m->end = c->analysis.end;
  if (c && diag_errors(diag) == before) PetscCall(LookForRun(members, m, c, diag));
  PetscCall(CaseDestroy(&c));
  PetscFunctionReturn(0);
}

/* The end is the last step, where the last row is a mean over several. */
static void take_last_step(Member *m, PetscInt k)
{
  PetscReal value = m->values[k] / m->taken[k].times;
  const PetscReal row = value;
  found_last_step(m->folder, m->taken[k].measure, &value);
  if (value != row) m->values[k] = m->taken[k].times * value;
}

PetscErrorCode MemberRead(const Members *members, Member *m)
{
  char path[PETSC_MAX_PATH_LEN], reason[256];
  History history;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", m->folder));
  if (HistoryRead(path, &history, reason)) {
    m->state = MEMBER_CRASHED;
    PetscCall(PetscSNPrintf(m->why, sizeof m->why, "its history.csv cannot be read: %s", reason));
    PetscFunctionReturn(0);
  }
  for (PetscInt k = 0; k < m->n_taken; ++k) {
    const TakenMeans means = {m->n_stages, m->means + k * m->n_stages};
    m->values[k] = taken_value(&m->taken[k], &means, &history, m->lack[k]);
    if (m->taken[k].take == TAKE_END && !m->taken[k].has_window) take_last_step(m, k);
  }
  PetscCall(HistoryFree(&history));
  m->state = MEMBER_DONE;
  if (!members->keep) run_dir_remove_states(m->folder);
  PetscFunctionReturn(0);
}

/* Members from `first` on that lack this number in one way or another. */
static PetscInt count_lacks(const Members *members, PetscInt first, const Taken *taken)
{
  PetscInt n = 0;
  for (PetscInt i = first; i < members->n; ++i)
    for (PetscInt k = 0; k < members->member[i].n_taken; ++k)
      n += members->member[i].taken + k == taken && members->member[i].lack[k][0];
  return n;
}

/* Of rows that are too few for a slope there is no number in any reading: a mistake. */
void members_tell_lacks(const Members *members, Diag *diag)
{
  const DiagPlace nowhere = {.width = 1};
  char name[128], more[64];
  for (PetscInt i = 0; i < members->n; ++i)
    for (PetscInt k = 0; k < members->member[i].n_taken; ++k) {
      const Member *m = &members->member[i];
      const PetscInt n = count_lacks(members, i, m->taken + k);
      if (!m->lack[k][0] || n < count_lacks(members, 0, m->taken + k)) continue; /* an earlier one has told */
      PetscSNPrintf(more, sizeof more, n > 1 ? " (and %" PetscInt_FMT " more)" : "", n - 1);
      const PetscBool asks_wrong = (PetscBool)(m->taken[k].take == TAKE_SLOPE && PetscIsNanReal(m->values[k]));
      diag_at(diag, asks_wrong ? DIAG_ERROR : DIAG_WARNING, &nowhere, "'%s' of %s%s: %s",
              taken_name_among(m->taken + k, m->n_taken, m->taken, name), m->name, more, m->lack[k]);
    }
}

/* Members in the order of their numbers, as many at a time as there may be. */
static PetscErrorCode StartMore(Members *members, PetscInt *next)
{
  PetscFunctionBeginUser;
  while (*next < members->n && members_count(members, MEMBER_RUNNING) < members->jobs) {
    Member *m = &members->member[(*next)++];
    if (m->state == MEMBER_WAITING) PetscCall(MemberStart(members, m));
  }
  PetscFunctionReturn(0);
}

/* Look at all that run. */
static PetscErrorCode LookAtAll(Members *members, double start)
{
  PetscBool ended;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < members->n; ++i) {
    Member *m = &members->member[i];
    if (m->state != MEMBER_RUNNING) continue;
    PetscCall(MemberLook(members, m, &ended));
    if (!ended) continue;
    members_tell_end(members, m, MPI_Wtime() - start);
    if (members->Ended) PetscCall((*members->Ended)(members->context));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MembersRun(Members *members)
{
  const struct timespec pause = {0, 50000000};
  const double start = MPI_Wtime();
  double shown = start;
  PetscInt next = 0;

  PetscFunctionBeginUser;
  signals_watch();
  while (!members->stopped || members_count(members, MEMBER_RUNNING)) {
    if (!members->stopped && signals_came()) {
      members->stopped = PETSC_TRUE;
      members_stop(members);
    }
    if (!members->stopped) PetscCall(StartMore(members, &next));
    PetscCall(LookAtAll(members, start));
    if (next == members->n && !members_count(members, MEMBER_RUNNING)) break;
    if (MPI_Wtime() - shown > 0.5) members_show(members, MPI_Wtime() - start), shown = MPI_Wtime();
    nanosleep(&pause, NULL);
  }
  members_wipe(members);
  signals_forget();
  PetscFunctionReturn(0);
}
