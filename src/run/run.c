#include "run/run.h"
#include <petsctime.h>
#include "io/case_file.h"
#include "run/output.h"
#include "run/signals.h"
#include "run/summary.h"

/* When something happens again: every so many seconds (> 0), every so many steps (< 0), or at the end only (0). */
typedef struct {
  PetscReal every;
  PetscInt count; /* how often it happened after the start */
} Schedule;

typedef struct {
  MPI_Comm comm;
  const Case *c;
  Model *model;
  RunDir *dir;
  Output *output;
  Schedule states, rows;
  PetscInt state_step, row_step; /* step of the newest state and row, -1 if none */
  PetscReal *values;
  PetscBool failed; /* gave up */
  RunSummary summary;
} Run;

/* Time until the schedule next wants the run to stop exactly. */
static PetscReal until_next(const Schedule *s, PetscReal time, PetscReal end)
{
  if (s->every <= 0) return end - time;
  return PetscMin((PetscReal)(s->count + 1) * s->every, end) - time;
}

static PetscBool is_due(Schedule *s, PetscReal time, PetscInt step)
{
  if (s->every == 0) return PETSC_FALSE;
  if (s->every < 0) return step % (PetscInt)(-s->every) == 0 ? PETSC_TRUE : PETSC_FALSE;
  if (time < (PetscReal)(s->count + 1) * s->every * (1 - 1e-9)) return PETSC_FALSE;
  s->count = (PetscInt)(time / s->every * (1 + 1e-9));
  return PETSC_TRUE;
}

/* The run ends early; the first reason counts. */
static void stop(Run *r, const char *reason)
{
  if (!r->failed) PetscStrncpy(r->summary.reason, reason, sizeof r->summary.reason);
  r->failed = PETSC_TRUE;
}

/* A file that the disk refused ends the run; the log has said so. */
static PetscErrorCode Written(Run *r, PetscErrorCode code)
{
  PetscFunctionBeginUser;
  if (code == PETSC_ERR_FILE_WRITE) stop(r, RunDirReason(r->dir));
  else PetscCall(code);
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteRow(Run *r)
{
  PetscFunctionBeginUser;
  if (r->row_step == r->model->step) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < r->c->n_measures; ++k)
    PetscCall(ModelMeasure(r->model, &r->c->measures[k], k, &r->values[k]));
  r->row_step = r->model->step;
  PetscCall(Written(r, HistoryWrite(r->dir, r->model->time, r->model->step, r->values)));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteState(Run *r)
{
  PetscBool ok;
  char reason[256], text[512];

  PetscFunctionBeginUser;
  if (r->state_step == r->model->step) PetscFunctionReturn(0);
  PetscCall(OutputWrite(r->output, r->model, &ok, reason));
  r->state_step = r->model->step;
  if (!ok) {
    snprintf(text, sizeof text, "cannot write the state at t = %g s: %s", (double)r->model->time, reason);
    PetscCall(RunDirLog(r->dir, "error = %s", text));
    stop(r, text);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode OpenHistory(Run *r)
{
  const char **names, **units;
  const PetscInt n = r->c->n_measures;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &names, n, &units, n, &r->values));
  for (PetscInt k = 0; k < n; ++k) {
    names[k] = r->c->measures[k].name;
    units[k] = measure_unit(&r->c->measures[k]);
    r->values[k] = 0;
  }
  PetscCall(Written(r, HistoryOpen(r->dir, n, names, units)));
  PetscReal *values = r->values;
  r->values = NULL;
  PetscCall(PetscMalloc1(n, &r->values));
  PetscCall(PetscFree3(names, units, values));
  PetscFunctionReturn(0);
}

static PetscErrorCode Open(Run *r, const RunOptions *options, Diag *diag)
{
  char *yaml;

  PetscFunctionBeginUser;
  PetscCall(RunDirCreate(r->comm, options->out, options->force, options->quiet, options->log, diag, &r->dir));
  if (!r->dir) PetscFunctionReturn(0);
  PetscCall(CaseToYaml(r->c, &yaml));
  PetscCall(Written(r, RunDirWriteText(r->dir, "case.yaml", yaml)));
  PetscCall(PetscFree(yaml));
  if (!r->failed) PetscCall(Written(r, SummaryVersion(r->comm, r->dir)));
  if (!r->failed) PetscCall(OpenHistory(r));
  if (r->failed) PetscFunctionReturn(0);
  PetscCall(OutputCreate(r->model, RunDirPath(r->dir), &r->output));
  PetscCall(SummaryBegin(r->model, r->dir));
  PetscCall(WriteRow(r));
  if (r->c->output.every != 0 && !r->failed) PetscCall(WriteState(r));
  PetscFunctionReturn(0);
}

static PetscErrorCode AfterStep(Run *r, const StepReport *report, PetscInt points)
{
  const PetscInt last = PetscMin(report->newton.iterations, NEWTON_HISTORY - 1);
  const RunProgress progress = {.step = r->model->step,
                                .iterations = report->newton.iterations,
                                .time = r->model->time,
                                .end = r->c->analysis.end,
                                .dt = report->dt,
                                .residual = report->newton.residual[last],
                                .points = points};

  PetscFunctionBeginUser;
  r->summary.iterations_per_step = PetscMax(r->summary.iterations_per_step, report->newton.iterations);
  if (report->cuts)
    PetscCall(
      RunDirLog(r->dir, "step = %d halved = %d dt = %g", (int)r->model->step, (int)report->cuts, (double)report->dt));
  PetscCall(RunDirProgress(r->dir, &progress));
  if (is_due(&r->rows, r->model->time, r->model->step)) PetscCall(WriteRow(r));
  if (is_due(&r->states, r->model->time, r->model->step)) PetscCall(WriteState(r));
  PetscFunctionReturn(0);
}

/* Say in the log (`what`) and to the caller (`sentence`) why the run ends here. */
static PetscErrorCode GiveUp(Run *r, const char *what, const char *sentence, const char *reason)
{
  char text[1024];

  PetscFunctionBeginUser;
  PetscCall(RunDirLog(r->dir, "%s = %s", what, reason));
  snprintf(text, sizeof text, "%s %s; the state at t = %g s is kept in %s", sentence, reason, (double)r->model->time,
           RunDirPath(r->dir));
  stop(r, text);
  PetscFunctionReturn(0);
}

/* Steps until the end, a failure or a signal. */
static PetscErrorCode Advance(Run *r)
{
  const PetscReal end = r->c->analysis.end;
  StepReport report;
  PetscBool asked = PETSC_FALSE;
  PetscInt points;
  char text[64];

  PetscFunctionBeginUser;
  while (!r->failed && r->model->time < end * (1 - 1e-12)) {
    const PetscReal limit =
      PetscMin(until_next(&r->states, r->model->time, end), until_next(&r->rows, r->model->time, end));
    PetscCall(ModelStep(r->model, limit, &report));
    if (report.outcome != STEP_ACCEPTED) {
      PetscCall(GiveUp(r, "gave up", "the run gave up:", report.reason));
      break;
    }
    PetscCall(ModelCountPoints(r->model, &points));
    PetscCall(AfterStep(r, &report, points));
    PetscCall(SignalsAsked(r->comm, &asked));
    if (!asked) continue;
    snprintf(text, sizeof text, "by a signal, after step %d", (int)r->model->step);
    PetscCall(GiveUp(r, "interrupted", "the run was interrupted", text));
    r->summary.interrupted = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Close(Run *r, PetscReal seconds, PetscReal *measures)
{
  PetscFunctionBeginUser;
  PetscCall(WriteRow(r));
  PetscCall(WriteState(r));
  if (measures) PetscCall(PetscArraycpy(measures, r->values, r->c->n_measures));
  r->summary.steps = r->model->step;
  r->summary.halvings = r->model->cuts;
  r->summary.iterations = r->model->total_iterations;
  r->summary.seconds = seconds;
  PetscCall(Written(r, SummaryEnd(r->model, r->dir, &r->summary, r->values)));
  PetscFunctionReturn(0);
}

PetscErrorCode RunCase(MPI_Comm comm, const Case *c, const RunOptions *options, Diag *diag, PetscReal *measures,
                       RunResult *result)
{
  Run run = {.comm = comm,
             .c = c,
             .states = {.every = c->output.every},
             .rows = {.every = c->output.history},
             .state_step = -1,
             .row_step = -1};
  double start, end;

  PetscFunctionBeginUser;
  *result = RUN_BAD_INPUT;
  PetscCall(ModelCreate(comm, c, diag, &run.model));
  if (!run.model) PetscFunctionReturn(0);
  signals_watch();
  PetscCall(PetscTime(&start));
  PetscCall(Open(&run, options, diag));
  if (run.dir && run.failed) { /* before the first step: nothing is left behind */
    DiagError(diag, NULL, "%s", run.summary.reason);
    PetscCall(RunDirDiscard(&run.dir));
  } else if (run.dir) {
    PetscCall(Advance(&run));
    PetscCall(PetscTime(&end));
    PetscCall(Close(&run, end - start, measures));
    PetscCall(ModelUnusedOptions(run.model, diag));
    *result = run.failed ? RUN_GAVE_UP : RUN_DONE;
    if (options->summary) *options->summary = run.summary;
  }
  signals_forget();
  PetscCall(PetscFree(run.values));
  PetscCall(OutputDestroy(&run.output));
  PetscCall(RunDirDestroy(&run.dir));
  PetscCall(ModelDestroy(&run.model));
  PetscFunctionReturn(0);
}
