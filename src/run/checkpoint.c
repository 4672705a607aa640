/* Checkpoints of a run: when, what besides the model, and the way back. */
#include <string.h>
#include "base/hash.h"
#include "input/case_file.h"
#include "input/stages.h"
#include "output/checkpoint/checkpoint.h"
#include "model/state/state.h"
#include "run/run_private.h"

/* One line each, for writing and reading. */
static const struct {
  const char *name;
  size_t offset;
} counts[] = {
  {"states_due", offsetof(RunMemory, states)},      {"rows_due", offsetof(RunMemory, rows)},
  {"states_written", offsetof(RunMemory, written)}, {"state_step", offsetof(RunMemory, state_step)},
  {"row_step", offsetof(RunMemory, row_step)},      {"iterations_per_step", offsetof(RunMemory, iterations_per_step)},
};

/* Takes every place of a word out of a text. */
static void take_out(char *text, const char *word)
{
  const size_t n = strlen(word);
  for (char *at = text; n && (at = strstr(at, word));) memmove(at, at + n, strlen(at + n) + 1);
}

/* What a resumed run may change without becoming another one does not count. last: ends in others than the last stage
 * are the begins of those behind them. */
static Case without_what_may_change(const Case *c, PetscBool last)
{
  Case copy = *c;
  copy.title = NULL;
  copy.newton = (NewtonSpec){0};
  copy.linear = LINEAR_AUTO;
  copy.checkpoint = (CheckpointSpec){.keep = 1};
  copy.parallel = (ParallelSpec){0};
  copy.n_petsc = 0;
  copy.grid.outside = OUTSIDE_STOP;
  copy.analysis.n_until = 0;
  copy.analysis.smallest = copy.analysis.largest = copy.analysis.step;
  if (last && !case_is_static(&c->analysis)) copy.analysis.end = 1;
  return copy;
}

/* The stages with what they change of that. */
static PetscErrorCode StagesWithout(const Case *c, const Case *copy, StageSpec *stages)
{
  Case before = *copy;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->n_stages; ++k) {
    const Case stage = without_what_may_change(c->stage_case[k], (PetscBool)(k + 1 == c->n_stages));
    stages[k] = c->stages[k];
    PetscCall(StageText(&before, &stage, &stages[k].text));
    before = stage;
  }
  PetscFunctionReturn(0);
}

/* Where files are does not count either, for files.txt has their contents. */
PetscErrorCode RunFingerprint(const Case *c, PetscInt64 *value)
{
  Case copy = without_what_may_change(c, PETSC_TRUE);
  StageSpec *stages;
  char *yaml;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(c->n_stages, &stages));
  PetscCall(StagesWithout(c, &copy, stages));
  copy.stages = stages;
  PetscCall(CaseToYaml(&copy, &yaml));
  for (PetscInt k = 0; k < c->n_files; ++k) take_out(yaml, c->files[k].path);
  *value = (PetscInt64)hash_text(yaml);
  for (PetscInt k = 0; k < c->n_stages; ++k) PetscCall(PetscFree(stages[k].text));
  PetscCall(PetscFree(stages));
  PetscCall(PetscFree(yaml));
  PetscFunctionReturn(0);
}

static RunMemory memory_of(const Run *r)
{
  return (RunMemory){.states = r->states.count,
                     .rows = r->rows.count,
                     .written = output_count(r->output),
                     .state_step = r->state_step,
                     .row_step = r->row_step,
                     .iterations_per_step = r->summary.iterations_per_step,
                     .seconds = r->before + (MPI_Wtime() - r->start)};
}

/* Of a run with stages: which it is in, and when each began. */
static PetscErrorCode StageToTable(const Run *r, Table *table)
{
  Column *column;

  PetscFunctionBeginUser;
  if (!r->whole->n_stages) PetscFunctionReturn(0);
  PetscCall(TableAdd(table, "stage", NULL, COLUMN_INT64, 1, NULL, &column));
  *(PetscInt64 *)column->data = r->stage;
  PetscCall(TableAdd(table, "stages_begin", "s", COLUMN_REAL, r->whole->n_stages, r->starts, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode StageFromTables(Run *r, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "run");
  const PetscInt n = r->whole->n_stages;

  PetscFunctionBeginUser;
  if (!n || reason[0]) PetscFunctionReturn(0);
  const PetscInt64 *stage = table_data(table, "stage", COLUMN_INT64, 1, reason);
  const PetscReal *starts = table_data(table, "stages_begin", COLUMN_REAL, n, reason);
  if (stage && (*stage < 0 || *stage >= n)) snprintf(reason, 256, "run/stage makes no sense");
  for (PetscInt k = 0; starts && k < n; ++k)
    if (!(starts[k] >= 0 && starts[k] <= PETSC_MAX_REAL)) snprintf(reason, 256, "run/stages_begin makes no sense");
  if (!reason[0] && stage && starts) PetscCall(RunEnterStage(r, (PetscInt)*stage, starts));
  PetscFunctionReturn(0);
}

static PetscErrorCode MemoryToTables(const Run *r, Tables *tables)
{
  RunMemory memory = memory_of(r);
  HistoryMark mark;
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  PetscCall(TablesAdd(tables, "run", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "case", NULL, COLUMN_INT64, 1, NULL, &column));
  *(PetscInt64 *)column->data = r->fingerprint;
  PetscCall(TableAdd(table, "history", NULL, COLUMN_INT64, 3, NULL, &column));
  PetscCall(HistoryGetMark(r->dir, &mark));
  PetscCall(PetscArraycpy((PetscInt64 *)column->data, ((PetscInt64[]){mark.lines, mark.bytes, mark.crc}), 3));
  PetscCall(TableAdd(table, "seconds", "s", COLUMN_REAL, 1, NULL, &column));
  *(PetscReal *)column->data = memory.seconds;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(counts); ++i) {
    PetscCall(TableAdd(table, counts[i].name, NULL, COLUMN_INT64, 1, NULL, &column));
    *(PetscInt64 *)column->data = *(PetscInt *)((char *)&memory + counts[i].offset);
  }
  PetscCall(StageToTable(r, table));
  PetscFunctionReturn(0);
}

/* Checkpoints of older programs do not have it. */
static void mark_from_table(const Table *table, HistoryMark *mark)
{
  char reason[256];
  const PetscInt64 *kept = table_data(table, "history", COLUMN_INT64, 3, reason);
  *mark = kept ? (HistoryMark){kept[0], kept[1], kept[2]} : (HistoryMark){0};
}

static PetscErrorCode MemoryFromTables(Run *r, const Tables *tables, RunMemory *memory, char reason[256])
{
  const Table *table = tables_find(tables, "run");

  PetscFunctionBeginUser;
  reason[0] = 0;
  if (!table || table->rows != 1) snprintf(reason, 256, "run is missing");
  if (reason[0]) PetscFunctionReturn(0);
  const PetscInt64 *kept = table_data(table, "case", COLUMN_INT64, 1, reason);
  const PetscReal *seconds = table_data(table, "seconds", COLUMN_REAL, 1, reason);
  if (kept && *kept != r->fingerprint) snprintf(reason, 256, "it is of another case than the case.yaml beside it");
  memory->seconds = seconds ? *seconds : 0;
  mark_from_table(table, &memory->history);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(counts); ++i) {
    const PetscInt64 *data = table_data(table, counts[i].name, COLUMN_INT64, 1, reason);
    if (!data) continue;
    if (*data < -1 || *data > PETSC_MAX_INT) snprintf(reason, 256, "run/%s makes no sense", counts[i].name);
    *(PetscInt *)((char *)memory + counts[i].offset) = (PetscInt)*data;
  }
  PetscFunctionReturn(0);
}

PetscBool checkpoint_by_clock(const Run *r)
{
  const PetscReal minutes = r->whole->checkpoint.minutes;
  return minutes > 0 && MPI_Wtime() - r->last_checkpoint >= 60 * minutes;
}

PetscBool checkpoint_by_step(const Run *r)
{
  const PetscInt steps = r->whole->checkpoint.steps;
  return steps > 0 && r->model->step % steps == 0;
}

static PetscErrorCode Write(Run *r, const char *path, char reason[256], PetscErrorCode *code)
{
  Tables *tables;

  PetscFunctionBeginUser;
  PetscCall(TablesCreate(&tables));
  PetscCall(ModelToTables(r->model, tables));
  PetscCall(MemoryToTables(r, tables));
  PetscCall(UntilToTables(&r->until, r->c, tables));
  PetscCall(StrengthToTables(&r->strength, tables));
  PetscCall(LimitToTables(&r->limit, tables));
  PetscCall(OutputToTables(r->output, tables));
  *code = CheckpointWrite(r->comm, path, tables, reason);
  PetscCall(TablesDestroy(&tables));
  if (*code != PETSC_ERR_FILE_WRITE) PetscCall(*code);
  PetscFunctionReturn(0);
}

PetscErrorCode CheckpointSaveAs(Run *r, const char *path)
{
  char reason[256];
  PetscErrorCode code = 0;

  PetscFunctionBeginUser;
  PetscCall(Write(r, path, reason, &code));
  if (code) PetscCall(RunDirLog(r->dir, "warning = cannot write %s: %s", path, reason));
  PetscFunctionReturn(0);
}

PetscErrorCode CheckpointSave(Run *r)
{
  char path[CHECKPOINT_PATH], reason[256];
  PetscErrorCode code = 0;
  const double start = MPI_Wtime();

  PetscFunctionBeginUser;
  if (r->checkpoint_step == r->model->step || r->model->step == 0)
    PetscFunctionReturn(0); /* a run that has done nothing starts again */
  run_dir_checkpoint_path(r->dir, r->model->step, path);
  const PetscErrorCode present = RunDirPresent(r->dir);
  PetscCall(RunWritten(r, present));
  if (present) PetscFunctionReturn(0);
  PetscCall(RunWritten(r, HistorySync(r->dir)));
  PetscCall(Write(r, path, reason, &code));
  r->last_checkpoint = MPI_Wtime();
  if (code) {
    PetscCall(RunDirLog(r->dir, "warning = cannot write the checkpoint at step %d: %s", (int)r->model->step, reason));
    PetscFunctionReturn(0);
  }
  r->checkpoint_step = r->model->step;
  ++r->n_written;
  PetscCall(RunDirKeepCheckpoints(r->dir, PetscMax(1, r->whole->checkpoint.keep)));
  PetscCall(RunDirLog(r->dir, "checkpoint = step %d time = %.9g seconds = %.3g", (int)r->model->step,
                      (double)r->model->time, r->last_checkpoint - start));
  PetscFunctionReturn(0);
}

static void remember(Run *r, const RunMemory *memory)
{
  r->states.count = memory->states;
  r->rows.count = memory->rows;
  r->state_step = memory->state_step;
  r->row_step = memory->row_step;
  r->summary.iterations_per_step = memory->iterations_per_step;
  r->before = memory->seconds;
  r->checkpoint_step = r->model->step;
  r->history = memory->history;
}

/* The newest that is whole, others are told of in the log; *tables NULL if there is none. */
static PetscErrorCode ReadNewest(Run *r, PetscInt *step, Tables **tables)
{
  char path[CHECKPOINT_PATH], reason[256];
  PetscInt n, *steps;

  PetscFunctionBeginUser;
  *tables = NULL;
  *step = -1;
  PetscCall(RunDirCheckpoints(r->dir, &n, &steps));
  for (PetscInt i = 0; i < n && !*tables; ++i) {
    run_dir_checkpoint_path(r->dir, steps[i], path);
    const PetscErrorCode code = CheckpointRead(r->comm, path, tables, reason);
    if (code && code != PETSC_ERR_FILE_UNEXPECTED && code != PETSC_ERR_FILE_OPEN) PetscCall(code);
    if (code) PetscCall(RunDirLog(r->dir, "warning = the checkpoint %s cannot be used: %s", path, reason));
    else *step = steps[i];
  }
  PetscCall(PetscFree(steps));
  PetscFunctionReturn(0);
}

PetscErrorCode CheckpointLoad(Run *r, Diag *diag, PetscInt *step, PetscBool *fits)
{
  Tables *tables;
  RunMemory memory;
  char path[CHECKPOINT_PATH], reason[256];

  PetscFunctionBeginUser;
  *fits = PETSC_TRUE;
  PetscCall(ReadNewest(r, step, &tables));
  if (!tables) PetscFunctionReturn(0);
  PetscCall(MemoryFromTables(r, tables, &memory, reason));
  PetscCall(StageFromTables(r, tables, reason));
  if (!reason[0]) PetscCall(OutputFromTables(r->output, tables, memory.written, reason));
  if (!reason[0]) PetscCall(ModelFromTables(r->model, tables, reason));
  until_from_tables(&r->until, r->c, tables, reason);
  PetscCall(StrengthFromTables(&r->strength, tables, reason));
  PetscCall(LimitFromTables(&r->limit, tables, reason));
  PetscCall(TablesDestroy(&tables));
  if (!reason[0]) {
    remember(r, &memory);
    PetscFunctionReturn(0);
  }
  run_dir_checkpoint_path(r->dir, *step, path);
  diag_error(diag, NULL, "the checkpoint '%s' does not fit: %s", path, reason);
  *fits = PETSC_FALSE;
  PetscFunctionReturn(0);
}
