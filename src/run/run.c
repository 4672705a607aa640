#include "run/report/losses.h"
#include "run/run_private.h"
#include "run/signals.h"
#include "run/stages/initial.h"
#include "run/report/summary.h"
#include "run/watch/events.h"

/* Times at which steps must end are one if they are no farther apart, s. In implicit dynamics a step is not much
 * shorter than those beside it (docs/theory.md, section 73). */
static PetscReal closest(const Run *r)
{
  PetscReal step = r->model->control.next;
  if (r->states.every > 0) step = PetscMin(step, r->states.every);
  if (r->rows.every > 0) step = PetscMin(step, r->rows.every);
  return (r->c->analysis.type == ANALYSIS_DYNAMIC ? CLOSE_STEPS : NO_STEP) * step;
}

static PetscReal next_of(const Schedule *s)
{
  return s->every > 0 ? (PetscReal)(s->count + 1) * s->every : PETSC_MAX_REAL;
}

/* Where is it due, if `other` is a time that stays? */
static PetscReal near(PetscReal due, PetscReal other, PetscReal close)
{
  return PetscAbsReal(due - other) <= close ? other : due;
}

/* The run has to stop next where it ends, a wall comes or goes, or a state or a row is due; but where these are close
 * together states wait for, or come with, what stays, and rows for either. */
static Stop next_stop(const Run *r)
{
  const PetscReal stays = PetscMin(r->c->analysis.end, r->model->time + model_until_change(r->model));
  const PetscReal close = closest(r), states = near(next_of(&r->states), stays, close);
  const PetscReal rows = near(near(next_of(&r->rows), stays, close), states, close);
  return (Stop){.time = PetscMin(stays, PetscMin(states, rows)), .close = close};
}

static PetscBool is_due(Schedule *s, const Run *r)
{
  const PetscBool stopped = (PetscBool)(r->model->time >= r->stop.time * (1 - 1e-9));
  const PetscReal time = r->model->time + (stopped ? r->stop.close : 0);
  if (s->every == 0) return PETSC_FALSE;
  if (s->every < 0) return r->model->step % (PetscInt)(-s->every) == 0;
  if (time < next_of(s)) return PETSC_FALSE;
  s->count = (PetscInt)(time / s->every * (1 + 1e-9));
  return PETSC_TRUE;
}

void run_count_from(Run *r)
{
  const PetscReal time = r->model->time + closest(r);
  if (r->states.every > 0) r->states.count = (PetscInt)(time / r->states.every * (1 + 1e-9));
  if (r->rows.every > 0) r->rows.count = (PetscInt)(time / r->rows.every * (1 + 1e-9));
}

void run_stop(Run *r, const char *reason)
{
  if (!r->failed) PetscStrncpy(r->summary.reason, reason, sizeof r->summary.reason);
  r->failed = PETSC_TRUE;
}

PetscErrorCode RunWritten(Run *r, PetscErrorCode code)
{
  PetscFunctionBeginUser;
  if (code == PETSC_ERR_FILE_WRITE) run_stop(r, run_dir_reason(r->dir));
  else PetscCall(code);
  PetscFunctionReturn(0);
}

static PetscErrorCode MeasureRow(Run *r)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < r->c->n_measures; ++k)
    PetscCall(ModelMeasureRow(r->model, &r->c->measures[k], k, &r->values[k]));
  PetscFunctionReturn(0);
}

/* What the run ends with is of its last step, whatever its last row is a mean of. */
static PetscErrorCode MeasureEnd(Run *r)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < r->c->n_measures; ++k)
    PetscCall(ModelMeasure(r->model, &r->c->measures[k], k, &r->values[k]));
  PetscFunctionReturn(0);
}

PetscErrorCode RunWriteRow(Run *r)
{
  PetscFunctionBeginUser;
  if (r->row_step == r->model->step) PetscFunctionReturn(0);
  PetscCall(MeasureRow(r));
  model_row_given(r->model);
  r->row_step = r->model->step;
  run_fill_row(r);
  PetscCall(AstrideLook(r->model));
  PetscCall(RunWritten(r, HistoryWrite(r->dir, r->model->time, r->model->step, r->row, r->there)));
  PetscFunctionReturn(0);
}

PetscErrorCode RunWriteLastRow(Run *r)
{
  PetscFunctionBeginUser;
  if (r->strength.n || r->limit.n) r->row_step = -1;
  PetscCall(RunWriteRow(r));
  PetscFunctionReturn(0);
}

/* Whatever stands there now is not this run's. */
static PetscErrorCode IsGone(Run *r, PetscBool *gone)
{
  PetscFunctionBeginUser;
  const PetscErrorCode present = RunDirPresent(r->dir);
  PetscCall(RunWritten(r, present));
  *gone = present != 0;
  PetscFunctionReturn(0);
}

PetscErrorCode RunWriteState(Run *r)
{
  PetscBool ok, gone = PETSC_FALSE;
  char reason[256], text[512];

  PetscFunctionBeginUser;
  if (r->state_step == r->model->step) PetscFunctionReturn(0);
  PetscCall(IsGone(r, &gone));
  if (gone) PetscFunctionReturn(0);
  PetscCall(OutputWrite(r->output, r->model, &ok, reason));
  r->state_step = r->model->step;
  if (ok) PetscFunctionReturn(0);
  PetscCall(IsGone(r, &gone));
  if (gone) PetscFunctionReturn(0);
  snprintf(text, sizeof text, "cannot write the state at t = %g s: %s", (double)r->model->time, reason);
  PetscCall(RunDirLog(r->dir, "error = %s", text));
  run_stop(r, text);
  PetscFunctionReturn(0);
}

static PetscErrorCode AfterStep(Run *r, const StepReport *report, PetscInt points)
{
  const PetscInt last = PetscMin(report->newton.iterations, NEWTON_HISTORY - 1);
  PetscFunctionBeginUser;
  PetscCall(UntilLook(&r->until, r->model));
  const RunProgress progress = {.step = r->model->step,
                                .iterations = report->newton.iterations,
                                .time = r->model->time,
                                .end = r->c->analysis.end,
                                .dt = report->dt,
                                .residual = report->newton.residual[last],
                                .points = points,
                                .earlier = r->until.n > 0,
                                .last = r->until.ended > 0};
  if (report->imbalance > 0)
    PetscCall(RunDirLog(r->dir, "repartition = step %d imbalance = %.3f to %.3f moved = %d of %d points",
                        (int)r->model->step, (double)report->imbalance, (double)r->model->balance.reached,
                        (int)report->moved, (int)points));
  r->summary.iterations_per_step = PetscMax(r->summary.iterations_per_step, report->newton.iterations);
  if (report->tries.again || report->cuts)
    PetscCall(RunDirLog(r->dir, "step = %d tried again = %d lost iterations = %d halved = %d dt = %g",
                        (int)r->model->step, (int)report->tries.again, (int)report->tries.lost, (int)report->cuts,
                        (double)report->dt));
  PetscCall(LossesLogStep(r->model, r->dir, report));
  PetscCall(RunWritten(r, EventsWatch(r->model, r->dir, PETSC_FALSE, r->events)));
  if (!r->strength.n && !r->limit.n) PetscCall(RunDirProgress(r->dir, &progress)); /* each factor tells of itself */
  if (is_due(&r->rows, r)) PetscCall(RunWriteRow(r));
  if (is_due(&r->states, r)) PetscCall(RunWriteState(r));
  PetscFunctionReturn(0);
}

/* Has any rank's watcher had enough? */
static PetscErrorCode Watch(const Run *r, PetscBool *enough)
{
  int any;

  PetscFunctionBeginUser;
  *enough = PETSC_FALSE;
  if (!r->watcher) PetscFunctionReturn(0);
  any = r->watcher(r->watcher_context, r->model->step, r->model->time, r->c->analysis.end);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, r->comm));
  *enough = any != 0;
  PetscFunctionReturn(0);
}

/* After the step's rows and states: a checkpoint if it is time for one, or if somebody wants the
 * run to end; NULL: nobody. */
static PetscErrorCode Pause(Run *r, const char **asked)
{
  PetscBool due = checkpoint_by_clock(r), signal, enough;

  PetscFunctionBeginUser;
  PetscCall(Watch(r, &enough));
  PetscCall(SignalsAsked(r->comm, &due, &signal));
  *asked = signal ? "a signal" : enough ? "the program that called it" : NULL;
  if (!r->failed && (due || *asked || checkpoint_by_step(r))) PetscCall(CheckpointSave(r));
  PetscFunctionReturn(0);
}

/* Say in the log (`what`) and to the caller (`sentence`) why the run ends here. */
static PetscErrorCode GiveUp(Run *r, const char *what, const char *sentence, const char *reason)
{
  char text[1024];

  PetscFunctionBeginUser;
  PetscCall(RunDirLog(r->dir, "%s = %s", what, reason));
  snprintf(text, sizeof text, "%s %s; the state at t = %g s is kept in %s", sentence, reason, (double)r->model->time,
           run_dir_path(r->dir));
  run_stop(r, text);
  PetscFunctionReturn(0);
}

/* The model stands after its last whole step. */
static PetscErrorCode Interrupted(Run *r, const char *whom)
{
  char text[64];

  PetscFunctionBeginUser;
  PetscCall(CheckpointSave(r));
  snprintf(text, sizeof text, "by %s, after step %d", whom, (int)r->model->step);
  PetscCall(GiveUp(r, "interrupted", "the run was interrupted", text));
  r->summary.interrupted = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Steps until the end, a condition, a failure or a signal. */
static PetscErrorCode Advance(Run *r)
{
  const PetscReal end = r->c->analysis.end;
  StepReport report;
  const char *asked = NULL;
  PetscInt points;

  PetscFunctionBeginUser;
  while (!r->failed && !r->until.ended && r->model->time < end * (1 - 1e-12)) {
    r->stop = next_stop(r);
    PetscCall(ModelStep(r->model, r->stop.time - r->model->time, &report));
    if (report.outcome == STEP_INTERRUPTED) {
      PetscCall(Interrupted(r, "a signal"));
      break;
    }
    if (report.outcome != STEP_ACCEPTED) {
      /* the model is as it was */
      if (report.outcome == STEP_TOO_SMALL) PetscCall(CheckpointSave(r));
      PetscCall(GiveUp(r, "gave up", "the run gave up:", report.reason));
      break;
    }
    PetscCall(ModelCountPoints(r->model, &points));
    PetscCall(AfterStep(r, &report, points));
    PetscCall(Pause(r, &asked));
    if (asked) PetscCall(Interrupted(r, asked));
  }
  PetscFunctionReturn(0);
}

/* What is sought when all loads are on, a step or a try at a time. */
static PetscErrorCode SeekOn(Run *r, StepReport *report)
{
  const PetscBool factor = r->c->analysis.type == ANALYSIS_FACTOR;

  PetscFunctionBeginUser;
  if (factor) PetscCall(StrengthTry(&r->strength, r->model, r->dir, report));
  else PetscCall(LimitStep(&r->limit, r->model, r->dir, report));
  if (report->outcome == STEP_INTERRUPTED || report->outcome == STEP_POINTS_LOST) PetscFunctionReturn(0);
  PetscCall(RunWritten(r, factor ? StrengthWrite(&r->strength, r->dir) : LimitWrite(&r->limit, r->model, r->dir)));
  PetscFunctionReturn(0);
}

static PetscBool seeks_on(const Run *r)
{
  if (r->c->analysis.type == ANALYSIS_FACTOR) return search_next(&r->strength.search, &r->c->analysis.reduction) > 0;
  return limit_goes_on(&r->limit);
}

/* All loads are on: larger and larger factors, until none is left to try. */
static PetscErrorCode Seek(Run *r)
{
  const PetscBool factor = r->c->analysis.type == ANALYSIS_FACTOR;
  StepReport report;
  const char *asked = NULL;
  PetscInt points;

  PetscFunctionBeginUser;
  if (factor && !r->strength.n) PetscCall(StrengthBegin(&r->strength, r->model));
  if (!factor && !r->limit.n) PetscCall(LimitBegin(&r->limit, r->model));
  while (!r->failed && !r->until.ended && seeks_on(r)) {
    PetscCall(SeekOn(r, &report));
    if (report.outcome == STEP_INTERRUPTED) {
      PetscCall(Interrupted(r, "a signal"));
      break;
    }
    if (report.outcome == STEP_POINTS_LOST) {
      PetscCall(GiveUp(r, "gave up", "the run gave up:", report.reason));
      break;
    }
    if (report.outcome != STEP_ACCEPTED) continue;
    PetscCall(ModelCountPoints(r->model, &points));
    PetscCall(AfterStep(r, &report, points));
    PetscCall(Pause(r, &asked));
    if (asked) PetscCall(Interrupted(r, asked));
  }
  if (r->failed) PetscFunctionReturn(0);
  if (factor) PetscCall(StrengthEnd(&r->strength, r->model, r->dir));
  else PetscCall(LimitEnd(&r->limit, r->model, r->dir));
  PetscFunctionReturn(0);
}

/* May the run go on to a later end some day, or another one start from its end? Whoever switches all rules of
 * checkpoints off wants none. */
static PetscBool may_go_on(const Run *r)
{
  const CheckpointSpec *spec = &r->whole->checkpoint;
  return spec->minutes > 0 || spec->steps > 0;
}

/* All stages, or the case itself. */
static PetscErrorCode RunStages(Run *r, Diag *diag)
{
  PetscFunctionBeginUser;
  for (;;) {
    PetscCall(Advance(r));
    if (case_seeks(&r->c->analysis) && !r->failed) PetscCall(Seek(r));
    if (r->failed || r->stage + 1 == case_stages(r->whole)) PetscFunctionReturn(0);
    PetscCall(RunEndStage(r));
    if (!r->failed) PetscCall(RunNextStage(r, diag));
  }
}

/* The messages that wait, as they are printed; the caller frees them. */
static PetscErrorCode Said(const Diag *diag, char **said)
{
  size_t length;

  PetscFunctionBeginUser;
  FILE *out = open_memstream(said, &length);
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for messages");
  PetscCall(DiagPrint(diag, out));
  fclose(out);
  PetscFunctionReturn(0);
}

/* Whoever opens the folder later reads what its run has warned of, too. */
static PetscErrorCode Warn(Run *r, Diag *diag)
{
  char *said;

  PetscFunctionBeginUser;
  PetscCall(LossesWarn(r->model, r->values, diag));
  if (!r->failed) PetscCall(ModelWarnLoose(r->model, diag));
  PetscCall(ModelUnusedOptions(r->model, diag));
  PetscCall(Said(diag, &said));
  run_dir_keep(r->dir, said);
  free(said);
  PetscFunctionReturn(0);
}

/* A run that ended and had a checkpoint, or may go on to a later end, leaves one of its end. */
static PetscErrorCode Close(Run *r, Diag *diag, PetscReal *measures)
{
  PetscReal seconds;

  PetscFunctionBeginUser;
  if (!r->failed && (r->n_written || may_go_on(r))) PetscCall(CheckpointSave(r));
  PetscCall(RunWriteLastRow(r));
  PetscCall(RunWriteState(r));
  PetscCall(MeasureEnd(r));
  PetscCall(Warn(r, diag));
  seconds = r->before + (MPI_Wtime() - r->start);
  if (measures) run_give_columns(r, measures);
  r->summary.steps = r->model->step;
  r->summary.halvings = r->model->cuts;
  r->summary.iterations = r->model->total_iterations;
  r->summary.seconds = seconds;
  until_reason(&r->until, r->c, r->summary.ended);
  r->summary.resumable = r->failed && r->checkpoint_step >= 0;
  r->summary.checkpoint_step = r->checkpoint_step;
  PetscCall(RunWritten(r, SummaryEnd(r->model, r->dir, &r->summary, r->values)));
  PetscCall(RunWritten(r, RunDirCheckLog(r->dir)));
  PetscFunctionReturn(0);
}

/* told: what was said before there was a folder. */
static PetscErrorCode RunModel(Run *r, const RunOptions *options, const char *told, Diag *diag, PetscReal *measures,
                               RunResult *result)
{
  PetscBool complete = PETSC_FALSE;

  PetscFunctionBeginUser;
  r->start = r->last_checkpoint = MPI_Wtime();
  if (options->resume) PetscCall(RunResume(r, options, diag, &complete));
  else PetscCall(RunOpen(r, options, diag));
  if (!r->dir) PetscFunctionReturn(0);
  if (complete) {
    for (PetscInt k = 0; measures && k < case_columns(r->whole); ++k) measures[k] = NAN;
    *result = RUN_DONE;
    /* before the first step: nothing is left behind by a run that was not there before */
  } else if (r->failed) {
    diag_error(diag, NULL, "%s", r->summary.reason);
    if (!options->resume) PetscCall(RunDirDiscard(&r->dir));
  } else {
    run_dir_keep(r->dir, told);
    PetscCall(RunStages(r, diag));
    PetscCall(Close(r, diag, measures));
    *result = r->failed ? RUN_GAVE_UP : RUN_DONE;
    if (options->summary) *options->summary = r->summary;
  }
  PetscFunctionReturn(0);
}

/* The first model; others are tried, so that all mistakes are told now. NULL if there are any. */
static PetscErrorCode ModelsCreate(Run *r, const RunOptions *options, Diag *diag)
{
  PetscInt errors;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(case_stages(r->whole), &r->starts));
  PetscCall(RunFingerprint(r->whole, &r->fingerprint));
  run_begin_stage(r, 0);
  PetscCall(ModelCreate(r->comm, r->c, diag, &r->model));
  if (r->model && options->body_force)
    PetscCall(ModelSetBodyForce(r->model, options->body_force, options->body_force_context));
  if (r->model) model_advise_still(r->model, r->whole, diag);
  for (PetscInt k = 0; r->model && options->load_factors && k < r->c->n_loads; ++k)
    if (options->load_factors[k].ask)
      PetscCall(ModelSetLoadFactors(r->model, k, options->load_factors[k].ask, options->load_factors[k].context));
  if (r->model) PetscCall(RunCheckStages(r->comm, r->whole, diag));
  if (r->model && r->c->initial.run) PetscCall(OutputCreate(r->model, NULL, &r->output)); /* nodes as undeformed */
  if (r->model && r->c->initial.run && !options->resume) PetscCall(InitialTake(r->model, diag, &r->imbalance));
  PetscCall(DiagReduce(r->comm, diag, &errors));
  if (!errors) PetscFunctionReturn(0);
  PetscCall(OutputDestroy(&r->output));
  PetscCall(ModelDestroy(&r->model));
  PetscCall(PetscFree(r->starts));
  PetscFunctionReturn(0);
}

PetscErrorCode RunCase(MPI_Comm comm, const Case *c, const RunOptions *options, Diag *diag, PetscReal *measures,
                       RunResult *result)
{
  const Case *first = case_stage(c, 0);
  Run run = {.comm = comm,
             .whole = c,
             .c = first,
             .states = {.every = first->output.every},
             .rows = {.every = first->output.history},
             .state_step = -1,
             .row_step = -1,
             .checkpoint_step = -1,
             .watcher = options->watcher,
             .watcher_context = options->watcher_context};
  char *told = NULL;

  PetscFunctionBeginUser;
  *result = RUN_BAD_INPUT;
  PetscCall(ModelsCreate(&run, options, diag));
  if (!run.model) PetscFunctionReturn(0);
  PetscCall(UntilCreate(first, &run.until));
  PetscCall(RunMeasuresBegin(&run));
  if (options->warnings) {
    PetscCall(Said(diag, &told));
    PetscCall(DiagFlush(diag, options->warnings));
  }
  signals_watch();
  run.model->asked = signals_came;
  const PetscErrorCode code = RunModel(&run, options, told, diag, measures, result);
  signals_forget();
  free(told);
  PetscCall(code);
  PetscCall(StrengthRunDestroy(&run.strength));
  PetscCall(LimitRunDestroy(&run.limit));
  PetscCall(RunMeasuresEnd(&run));
  PetscCall(PetscFree(run.starts));
  PetscCall(UntilDestroy(&run.until));
  PetscCall(OutputDestroy(&run.output));
  PetscCall(RunDirDestroy(&run.dir));
  PetscCall(ModelDestroy(&run.model));
  PetscFunctionReturn(0);
}
