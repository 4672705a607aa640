#include "material/plugin/plugin.h"
#include "run/report/summary.h"
#include "output/directory/run_dir_files.h"
#include <stdlib.h>
#include "run/report/losses.h"
#include "run/report/price.h"
#include "run/watch/events.h"
#include "talus_version.h"

PetscErrorCode SummaryVersion(MPI_Comm comm, RunDir *dir)
{
  char text[2048], petsc[256], mpi[MPI_MAX_LIBRARY_VERSION_STRING];
  PetscMPIInt size;
  int length;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscGetVersion(petsc, sizeof petsc));
  PetscCallMPI(MPI_Get_library_version(mpi, &length));
  PetscCall(PetscSNPrintf(text, sizeof text,
                          "talus = %s\nsources = %s\npetsc = %s\nmpi = %s\ncompiler = %s\nbuild = %s\nranks = %d\n",
                          TALUS_VERSION, TALUS_GIT_DESCRIBE, petsc, mpi, TALUS_COMPILER, TALUS_BUILD_TYPE, (int)size));
  const PetscErrorCode status = RunDirWriteText(dir, "version.txt", text);
  PetscFunctionReturn(status);
}

PetscErrorCode SummaryBegin(Model *m, RunDir *dir)
{
  char told[256];
  PetscInt points;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCall(ModelCountPoints(m, &points));
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  if (m->c->title) PetscCall(RunDirLog(dir, "title = %s", m->c->title));
  if (case_starts_with_gravity(m->c)) PetscCall(RunDirLog(dir, "gravity = from the start"));
  if (m->c->kinematics->hoop)
    PetscCall(RunDirLog(dir, "kinematics = axisymmetric: volumes, masses, forces and energies of the full circle"));
  PetscCall(RunDirLog(dir, "method = %s", m->method->name));
  method_tell_basis(m->method, m->c, sizeof told, told);
  PetscCall(RunDirLog(dir, "basis = %s", told));
  if (method_tell_transfer(m->method, m->c, sizeof told, told)) PetscCall(RunDirLog(dir, "transfer = %s", told));
  if (method_tell_scheme(m->method, m->c, sizeof told, told)) PetscCall(RunDirLog(dir, "scheme = %s", told));
  if (case_seeks(&m->c->analysis)) PetscCall(RunDirLog(dir, "formulation = %s", m->formulation->name));
  for (const char *const *law = plugin_words(); *law; ++law) PetscCall(RunDirLog(dir, "law = %s", *law));
  PetscCall(RunDirLog(dir, "cells = %d nodes = %d points = %d ranks = %d", (int)m->grid->n_cells_global,
                      (int)m->grid->n_nodes_global, (int)points, (int)size));
  PetscCall(PriceTell(m, sizeof told, told));
  if (told[0]) PetscCall(RunDirLog(dir, "explicit = %s", told));
  PetscFunctionReturn(0);
}

/* Their number, where it is not that of the start. */
static PetscErrorCode LogPoints(const Model *m, RunDir *dir)
{
  PetscInt points;

  PetscFunctionBeginUser;
  if (m->c->basis.split == 0) PetscFunctionReturn(0);
  PetscCall(ModelCountPoints(m, &points));
  PetscCall(RunDirLog(dir, "points = %d at the end, halves of those that were split among them", (int)points));
  PetscFunctionReturn(0);
}

/* How evenly several ranks shared the work, and what keeping it so has cost. */
static PetscErrorCode LogBalance(const Model *m, RunDir *dir, PetscReal seconds)
{
  const Balance *b = &m->balance;

  PetscFunctionBeginUser;
  if (b->imbalance == 0) PetscFunctionReturn(0); /* one rank, or nothing moves between them */
  PetscCall(RunDirLog(dir, "imbalance = %.3f largest = %.3f repartitions = %d seconds = %.3g", (double)b->imbalance,
                      (double)b->largest, (int)b->repartitions, (double)seconds));
  PetscFunctionReturn(0);
}

/* Everything that took a per cent of the time, for the log. */
static PetscErrorCode LogShares(RunDir *dir, PetscReal seconds, const PetscReal phase[PHASE_N], PetscReal rest)
{
  char text[512];
  int end = 0;

  PetscFunctionBeginUser;
  text[0] = 0;
  for (int k = 0; k <= PHASE_N && end < (int)sizeof text; ++k) {
    const PetscReal share = 100 * (k < PHASE_N ? phase[k] : rest) / PetscMax(seconds, 1e-9);
    if (share < 1) continue;
    end += snprintf(text + end, sizeof text - (size_t)end, "%s%s %.0f %%", end ? ", " : "",
                    k < PHASE_N ? phase_names[k] : "files and the rest", (double)share);
  }
  PetscCall(RunDirLog(dir, "time went to: %s", text));
  PetscFunctionReturn(0);
}

/* "points [s] = 0.543   # 48 %: ..." */
static PetscErrorCode AddTime(char *text, size_t size, const char *name, PetscReal seconds, PetscReal all,
                              const char *help)
{
  const size_t end = strlen(text);

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(text + end, size - end, "%s [s] = %.6g   # %.1f %%: %s\n", name, (double)seconds,
                          (double)(100 * seconds / PetscMax(all, 1e-9)), help));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddCounts(const Model *m, const RunSummary *summary, size_t size, char *text)
{
  const size_t end = strlen(text);

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(text + end, size - end,
                          "steps = %d\niterations = %d\nmost iterations in a step = %d\nhalvings = %d\n"
                          "tries from another first guess = %d\niterations of tries that failed = %d\n"
                          "patterns = %d\nrepartitions = %d\nlargest imbalance = %.3f\noutcome = %s\n%s%s%s",
                          (int)summary->steps, (int)summary->iterations, (int)summary->iterations_per_step,
                          (int)summary->halvings, (int)m->tries.again, (int)m->tries.lost, (int)m->system->builds,
                          (int)m->balance.repartitions, (double)PetscMax(m->balance.largest, 1),
                          summary->reason[0] ? "gave up" : "done", summary->ended[0] ? "ended = " : "", summary->ended,
                          summary->ended[0] ? "\n" : ""));
  PetscFunctionReturn(0);
}

/* "force in the last step = 10000", of what the last row of the history has a mean over several steps of, for those who
 * read the end of a run. */
static PetscErrorCode AddLastStep(Model *m, const PetscReal *values, size_t size, char *text)
{
  PetscReal row;
  char number[32];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; m->c->output.history != -1 && k < m->c->n_measures; ++k) {
    PetscCall(ModelMeasureRow(m, m->c->measures + k, k, &row));
    if (row == values[k] || (PetscIsNanReal(row) && PetscIsNanReal(values[k]))) continue;
    file_format_real(values[k], number);
    const size_t end = strlen(text);
    PetscCall(PetscSNPrintf(text + end, size - end, "%s in the last step = %s\n", m->c->measures[k].name, number));
  }
  PetscFunctionReturn(0);
}

#define TIMINGS_TEXT 2560  /* bytes of timings.txt at most, */
#define LAST_STEP_TEXT 192 /* and of each line of a measure */

PetscErrorCode SummaryEnd(Model *m, RunDir *dir, const RunSummary *summary, const PetscReal *values)
{
  const PetscReal seconds = summary->seconds;
  PetscReal phase[PHASE_N], rest = seconds;
  const size_t size = TIMINGS_TEXT + LAST_STEP_TEXT * (size_t)m->c->n_measures;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, &text));
  model_times(m, phase);
  const char *linear = newton_linear_name(m->newton);
  if (linear[0]) /* a run that was whole when it was resumed has solved nothing */
    PetscCall(
      RunDirLog(dir, "linear = %s unknowns = %d", linear, (int)(m->system->n_active_global * m->system->block)));
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    PetscCall(
      RunDirLog(dir, "%s = %.10g %s", m->c->measures[k].name, (double)values[k], measure_unit(&m->c->measures[k])));
  PetscCall(EventsSummary(m, dir));
  PetscCall(LossesLogEnd(m, dir));
  if (summary->ended[0]) PetscCall(RunDirLog(dir, "ended = %s, at t = %g s", summary->ended, (double)m->time));
  PetscCall(RunDirLog(dir, "steps = %d iterations = %d halvings = %d seconds = %.3g", (int)summary->steps,
                      (int)summary->iterations, (int)summary->halvings, (double)seconds));
  PetscCall(LogPoints(m, dir));
  if (m->tries.again || m->cuts)
    PetscCall(RunDirLog(dir, "tried again = %d lost iterations = %d", (int)m->tries.again, (int)m->tries.lost));
  PetscCall(LogBalance(m, dir, phase[PHASE_REPARTITION]));
  PetscCall(AddTime(text, size, "total", seconds, seconds, "of all sessions of the run"));
  for (int k = 0; k < PHASE_N; ++k) {
    PetscCall(AddTime(text, size, phase_names[k], phase[k], seconds, phase_help[k]));
    rest -= phase[k];
  }
  PetscCall(LogShares(dir, seconds, phase, rest));
  PetscCall(AddTime(text, size, "rest", rest, seconds, "files, measures, earlier sessions of a resumed run"));
  PetscCall(AddCounts(m, summary, size, text));
  PetscCall(AddLastStep(m, values, size, text));
  const PetscErrorCode status = RunDirWriteText(dir, "timings.txt", text);
  PetscCall(PetscFree(text));
  PetscFunctionReturn(status);
}

void summary_read(const char *folder, RunSummary *summary)
{
  char path[PETSC_MAX_PATH_LEN], line[256];
  char *end;
  PetscSNPrintf(path, sizeof path, "%s/timings.txt", folder);
  *summary = (RunSummary){0};
  FILE *in = file_open_read(path);
  while (in && fgets(line, sizeof line, in)) {
    const char *equals = strstr(line, " = ");
    if (!strncmp(line, "ended = ", 8)) {
      line[strcspn(line, "\n")] = '\0';
      PetscStrncpy(summary->ended, line + 8, sizeof summary->ended);
    }
    const double value = equals ? strtod(equals + 3, &end) : 0;
    if (!equals || end == equals + 3) continue;
    const size_t n = (size_t)(equals - line);
    if (!strncmp(line, "total [s]", n)) summary->seconds = value;
    else if (!strncmp(line, "steps", n)) summary->steps = (PetscInt)value;
    else if (!strncmp(line, "iterations", n)) summary->iterations = (PetscInt)value;
    else if (!strncmp(line, "most iterations in a step", n)) summary->iterations_per_step = (PetscInt)value;
    else if (!strncmp(line, "halvings", n)) summary->halvings = (PetscInt)value;
  }
  if (in) fclose(in);
}
