/* How a run begins: in a directory of its own, or where another one was cut off. */
#include <string.h>
#include "input/case_file.h"
#include "output/directory/run_dir_files.h"
#include "output/inputs.h"
#include "output/vtk/vtk.h"
#include "run/run_private.h"
#include "run/stages/initial.h"
#include "run/report/found.h"
#include "run/report/summary.h"
#include "run/watch/events.h"

/* Open the history: a new one, or (diag given) that of the run that is resumed. */
static PetscErrorCode OpenHistory(Run *r, Diag *diag)
{
  const char **names, **units;
  const PetscInt first = r->whole->n_stages ? 1 : 0, n = first + case_columns(r->whole);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n + 1, &names, n + 1, &units));
  names[0] = "stage", units[0] = "";
  for (PetscInt k = 0; k < case_columns(r->whole); ++k) {
    names[first + k] = case_column(r->whole, k)->name;
    units[first + k] = measure_unit(case_column(r->whole, k));
  }
  PetscCall(RunWritten(
    r, diag ? HistoryOpenFrom(r->dir, n, names, units, r->row_step, r->history.lines ? &r->history : NULL, diag)
            : HistoryOpen(r->dir, n, names, units)));
  PetscCall(PetscFree2(names, units));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteCase(Run *r)
{
  char *yaml;

  PetscFunctionBeginUser;
  PetscCall(CaseToYaml(r->whole, &yaml));
  PetscCall(RunWritten(r, RunDirWriteText(r->dir, "case.yaml", yaml)));
  PetscCall(PetscFree(yaml));
  if (!r->failed) PetscCall(RunWritten(r, SummaryVersion(r->comm, r->dir)));
  PetscFunctionReturn(0);
}

PetscErrorCode RunOpen(Run *r, const RunOptions *options, Diag *diag)
{
  PetscBool spares = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (!options->resume) PetscCall(RunDirSpares(r->comm, options->out, r->c->file, diag, &spares));
  if (!spares) PetscFunctionReturn(0);
  PetscCall(RunDirCreate(r->comm, options->out, options->force, options->quiet, options->log, diag, &r->dir));
  if (!r->dir) PetscFunctionReturn(0);
  PetscCall(FunctionsWrite(r, options)); /* before the case, without which nobody resumes the run */
  if (!r->failed) PetscCall(RunWritten(r, InputsWrite(r->comm, r->dir, r->whole)));
  if (!r->failed) PetscCall(WriteCase(r));
  if (!r->failed) PetscCall(OpenHistory(r, NULL));
  if (r->failed) PetscFunctionReturn(0);
  if (r->output) output_set_folder(r->output, run_dir_path(r->dir));
  else PetscCall(OutputCreate(r->model, run_dir_path(r->dir), &r->output));
  PetscCall(SummaryBegin(r->model, r->dir));
  if (r->whole->n_stages)
    PetscCall(RunDirLog(r->dir, "stage = 1 of %d (%s)", (int)r->whole->n_stages, r->c->spec->name));
  PetscCall(RunWriteStages(r));
  if (r->c->initial.run) PetscCall(RunDirLog(r->dir, "initial = %s", r->c->initial.run));
  if (r->c->initial.run) PetscCall(RunTellImbalance(r, &r->imbalance));
  else PetscCall(RunEquilibrate(r));
  if (r->failed) PetscFunctionReturn(0);
  PetscCall(UntilLook(&r->until, r->model));
  PetscCall(RunWritten(r, EventsWatch(r->model, r->dir, PETSC_TRUE, r->events)));
  PetscCall(RunWriteRow(r));
  if (r->c->output.every != 0 && !r->failed) PetscCall(RunWriteState(r));
  PetscFunctionReturn(0);
}

/* Of the states before number n; all: every one of them has a file in it. */
static PetscErrorCode KeepSeries(Run *r, const char *name, PetscInt n, PetscBool all, Diag *diag)
{
  char reason[256];
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  const PetscErrorCode code = VtkSeriesKeep(r->comm, run_dir_path(r->dir), name, n, all, reason);
  if (code && code != PETSC_ERR_FILE_WRITE) PetscCall(code);
  PetscCallMPI(MPI_Comm_rank(r->comm, &rank));
  if (code && !rank)
    diag_error(diag, NULL, "cannot go on with %s/%s.hdf.series: %s", run_dir_path(r->dir), name, reason);
  PetscFunctionReturn(0);
}

/* Files as they were when the checkpoint was written. */
static PetscErrorCode Rewind(Run *r, PetscInt step, Diag *diag)
{
  static const char *const others[] = {"grid", "walls", "contact"};
  const PetscInt states = output_count(r->output);
  PetscInt errors;

  PetscFunctionBeginUser;
  PetscCall(OutputCheck(r->output, r->comm, diag));
  PetscCall(DiagReduce(r->comm, diag, &errors));
  if (errors) PetscFunctionReturn(0); /* before anything is touched */
  PetscCall(OpenHistory(r, diag));
  if (r->stage > 0) PetscCall(RunRecallColumns(r));
  PetscCall(KeepSeries(r, "points", states, PETSC_TRUE, diag));
  for (int k = 0; k < 3; ++k) { /* stages differ in what they write */
    const PetscBool written = k ? r->c->output.walls && r->c->n_walls : r->c->output.grid;
    if (written || r->whole->n_stages) PetscCall(KeepSeries(r, others[k], states, !r->whole->n_stages, diag));
  }
  PetscCall(DiagReduce(r->comm, diag, &errors));
  if (errors || r->failed) PetscFunctionReturn(0);
  PetscCall(RunWritten(r, RunDirRewind(r->dir, states, step)));
  output_resumed_at(r->output, r->model->step);
  if (!r->failed) PetscCall(RunWritten(r, InputsMoved(r->comm, r->dir, r->whole)));
  if (!r->failed) PetscCall(WriteCase(r));
  if (!r->failed) PetscCall(RunWriteStages(r));
  if (!r->failed) PetscCall(RunWritten(r, EventsWatch(r->model, r->dir, PETSC_TRUE, r->events)));
  PetscFunctionReturn(0);
}

/* A run that has ended said so in its timings. */
static PetscErrorCode IsComplete(const Run *r, PetscBool *complete)
{
  PetscMPIInt rank;
  char path[FILE_PATH], line[128];
  int found = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(r->comm, &rank));
  snprintf(path, sizeof path, "%s/timings.txt", run_dir_path(r->dir));
  FILE *in = rank ? NULL : file_open_read(path);
  while (in && fgets(line, sizeof line, in))
    if (!strcmp(line, "outcome = done\n")) found = 1;
  if (in) fclose(in);
  PetscCallMPI(MPI_Bcast(&found, 1, MPI_INT, 0, r->comm));
  *complete = found != 0;
  PetscFunctionReturn(0);
}

/* No checkpoint is there: a run that is complete stays as it is, any other one starts again. */
static PetscErrorCode StartAgain(Run *r, const RunOptions *options, const Extension *extension, Diag *diag,
                                 PetscBool *complete)
{
  RunOptions again = *options;

  PetscFunctionBeginUser;
  PetscCall(IsComplete(r, complete));
  if (*complete) extension_without_checkpoint(r, extension, diag);
  if (*complete) PetscFunctionReturn(0);
  PetscCall(RunDirDestroy(&r->dir));
  again.force = PETSC_TRUE;
  if (r->c->initial.run) PetscCall(InitialTake(r->model, diag, &r->imbalance));
  if (diag_errors(diag)) PetscFunctionReturn(0);
  PetscCall(RunOpen(r, &again, diag));
  if (r->dir) PetscCall(RunDirLog(r->dir, "warning = there was no checkpoint to resume from: the run starts again"));
  PetscFunctionReturn(0);
}

/* What the run has read must be what it was; the run that it started from has given its state. */
static PetscErrorCode CheckInputs(const Run *r, Diag *diag, PetscBool *same)
{
  char changed[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(FoundChanged(r->comm, run_dir_path(r->dir), r->whole, changed));
  if (!changed[0]) PetscFunctionReturn(0);
  *same = PETSC_FALSE;
  diag_error(diag, NULL, "'%s' has changed since the run in '%s' read it", changed, run_dir_path(r->dir));
  diag_hint(diag, "a new run reads it as it is: talus run %s/case.yaml --out ANOTHER", run_dir_path(r->dir));
  PetscFunctionReturn(0);
}

PetscErrorCode RunResume(Run *r, const RunOptions *options, Diag *diag, PetscBool *complete)
{
  PetscMPIInt size;
  PetscInt step = -1, errors;
  PetscBool fits = PETSC_FALSE, same;
  Extension extension;

  PetscFunctionBeginUser;
  PetscCall(RunDirOpen(r->comm, options->out, options->quiet, options->log, diag, &r->dir));
  if (!r->dir) PetscFunctionReturn(0);
  PetscCall(FunctionsCheck(r, options, diag, &same));
  PetscCall(CheckInputs(r, diag, &same));
  PetscCall(ExtensionBegin(r, &extension));
  /* node positions at the start */
  if (r->output) output_set_folder(r->output, run_dir_path(r->dir));
  else PetscCall(OutputCreate(r->model, run_dir_path(r->dir), &r->output));
  if (same && extension_allowed(r, &extension, diag)) PetscCall(CheckpointLoad(r, diag, &step, &fits));
  if (fits && step < 0) PetscCall(StartAgain(r, options, &extension, diag, complete));
  if (fits && step >= 0) extension_from_checkpoint(r, diag);
  PetscCall(DiagReduce(r->comm, diag, &errors));
  if (fits && step >= 0 && !errors) PetscCall(Rewind(r, step, diag));
  PetscCall(DiagReduce(r->comm, diag, &errors));
  if (errors || !r->dir || step < 0) {
    if (errors) PetscCall(RunDirDestroy(&r->dir));
    PetscFunctionReturn(0);
  }
  PetscCallMPI(MPI_Comm_size(r->comm, &size));
  PetscCall(
    RunDirLog(r->dir, "resumed = step %d time = %.9g ranks = %d", (int)step, (double)r->model->time, (int)size));
  PetscFunctionReturn(0);
}
