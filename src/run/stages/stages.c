/* From one stage of a run to the next. */
#include "base/text.h"
#include "output/directory/run_dir_files.h"
#include "run/report/warn/warn.h"
#include "run/run_private.h"
#include "run/watch/events.h"

void run_begin_stage(Run *r, PetscInt k)
{
  Case *c = r->whole->n_stages ? r->whole->stage_case[k] : NULL;
  r->stage = k;
  r->c = case_stage(r->whole, k);
  if (!c) return;
  c->grid.trusted = r->whole->grid.trusted;
  case_begin(c, r->starts);
}

/* What goes by the case of the stage; counts begin where the clock stands. */
static PetscErrorCode Attend(Run *r)
{
  const OutputSpec *output = &r->c->output;

  PetscFunctionBeginUser;
  r->states = (Schedule){.every = output->every};
  r->rows = (Schedule){.every = output->history};
  run_count_from(r);
  PetscCall(RunMeasuresBegin(r));
  PetscCall(UntilDestroy(&r->until));
  PetscCall(UntilCreate(r->c, &r->until));
  PetscCall(StrengthRunDestroy(&r->strength));
  r->strength = (StrengthRun){0};
  PetscCall(LimitRunDestroy(&r->limit));
  r->limit = (LimitRun){0};
  PetscFunctionReturn(0);
}

PetscErrorCode RunEnterStage(Run *r, PetscInt k, const PetscReal *starts)
{
  Diag *unheard;

  PetscFunctionBeginUser;
  if (k == r->stage) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(r->starts, starts, k + 1));
  PetscBool (*const asked)(void) = r->model->asked;
  const BodyForce force = r->model->body_force;
  void *force_context = r->model->body_force_context;
  PetscCall(ModelDestroy(&r->model));
  run_begin_stage(r, k);
  PetscCall(DiagCreate(&unheard)); /* all has been said by the run that is resumed */
  PetscCall(ModelCreate(r->comm, r->c, unheard, &r->model));
  PetscCall(DiagDestroy(&unheard));
  PetscCheck(r->model, r->comm, PETSC_ERR_PLIB, "the model of stage %" PetscInt_FMT " could be made before", k);
  r->model->asked = asked;
  if (force) PetscCall(ModelSetBodyForce(r->model, force, force_context));
  PetscCall(Attend(r));
  PetscFunctionReturn(0);
}

PetscErrorCode RunWriteStages(Run *r)
{
  TextStream stream;
  char *text, number[32];

  PetscFunctionBeginUser;
  if (!r->whole->n_stages) PetscFunctionReturn(0);
  PetscCall(TextOpen(&stream));
  fputs("stage,begins [s],name\n", stream.out);
  for (PetscInt k = 0; k <= r->stage; ++k) {
    file_format_real(r->starts[k], number);
    fprintf(stream.out, "%d,%s,%s\n", (int)k + 1, number, r->whole->stages[k].name);
  }
  PetscCall(TextClose(&stream, &text));
  PetscCall(RunWritten(r, RunDirWriteText(r->dir, "stages.csv", text)));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

#define WORTH_A_WORD 1e-3 /* of all that is out of balance: the work of less is as nothing */

PetscErrorCode RunTellImbalance(const Run *r, const Imbalance *imbalance)
{
  const PetscReal *x = imbalance->where;
  char place[96];

  PetscFunctionBeginUser;
  if (r->model->dim == 2) snprintf(place, sizeof place, "(%g, %g)", (double)x[0], (double)x[1]);
  else snprintf(place, sizeof place, "(%g, %g, %g)", (double)x[0], (double)x[1], (double)x[2]);
  PetscCall(RunDirLog(r->dir, "out of balance = %.3g N in all, at most %.3g N at %s m", (double)imbalance->all,
                      (double)imbalance->most, place));
  if (imbalance->moved > WORTH_A_WORD * imbalance->all)
    PetscCall(RunDirLog(r->dir, "of points that moved = %.3g N in all: held, too, as a body goes; its work is external",
                        (double)imbalance->moved));
  if (r->c->release > 0) PetscCall(RunDirLog(r->dir, "released over = %g s", (double)r->c->release));
  PetscFunctionReturn(0);
}

PetscErrorCode RunEndStage(Run *r)
{
  const CheckpointSpec *spec = &r->whole->checkpoint;
  char path[CHECKPOINT_PATH];

  PetscFunctionBeginUser;
  PetscCall(RunWriteLastRow(r));
  PetscCall(RunWriteState(r));
  if (r->failed || (spec->minutes <= 0 && spec->steps <= 0)) PetscFunctionReturn(0);
  run_dir_stage_path(run_dir_path(r->dir), r->stage, path);
  PetscCall(CheckpointSaveAs(r, path));
  PetscFunctionReturn(0);
}

PetscErrorCode RunNextStage(Run *r, Diag *diag)
{
  const PetscInt k = r->stage + 1;
  const StageSpec *stage = &r->whole->stages[k];
  Imbalance imbalance;
  char text[256];
  PetscInt errors;

  PetscFunctionBeginUser;
  r->starts[k] = case_time(r->c, r->model->time); /* whatever a search has found */
  diag_of_stage(diag, r->stage, r->whole->stages[r->stage].name);
  if (r->whole->stage_case[k]->analysis.type != ANALYSIS_EXPLICIT) warn_of_sunk(r->model, PETSC_TRUE, diag);
  astride_tell(r->model, diag);
  run_begin_stage(r, k);
  diag_of_stage(diag, k, stage->name);
  PetscCall(ModelSucceed(r->c, diag, &r->model, &imbalance));
  diag_of_stage(diag, -1, NULL);
  PetscCall(DiagReduce(r->comm, diag, &errors));
  if (errors) {
    snprintf(text, sizeof text, "stage '%s' cannot begin at t = %g s", stage->name, (double)r->starts[k]);
    run_stop(r, text);
    PetscFunctionReturn(0);
  }
  PetscCall(Attend(r));
  PetscCall(RunDirLog(r->dir, "stage = %d of %d (%s) from t = %.9g s", (int)k + 1, (int)r->whole->n_stages, stage->name,
                      (double)r->starts[k]));
  if (method_tell_scheme(r->model->method, r->c, sizeof text, text)) PetscCall(RunDirLog(r->dir, "scheme = %s", text));
  PetscCall(RunTellImbalance(r, &imbalance));
  PetscCall(RunWriteStages(r));
  PetscCall(RunWritten(r, EventsWatch(r->model, r->dir, PETSC_TRUE, r->events)));
  PetscCall(UntilLook(&r->until, r->model));
  PetscFunctionReturn(0);
}

PetscErrorCode RunCheckStages(MPI_Comm comm, const Case *whole, Diag *diag)
{
  Model *m;
  PetscInt errors = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 1; k < whole->n_stages && !errors; ++k) {
    whole->stage_case[k]->grid.trusted = whole->grid.trusted;
    diag_of_stage(diag, k, whole->stages[k].name);
    PetscCall(RenameCheck(whole->stage_case[k], whole->stage_case[k - 1], PETSC_TRUE, diag));
    PetscCall(ModelCreate(comm, whole->stage_case[k], diag, &m));
    PetscCall(ModelDestroy(&m));
    PetscCall(DiagReduce(comm, diag, &errors));
  }
  diag_of_stage(diag, -1, NULL);
  PetscFunctionReturn(0);
}
