#include "run/stages/initial.h"
#include "input/case_file.h"
#include "output/checkpoint/checkpoint.h"
#include "output/directory/run_dir.h"

/* The case that the other run has kept. */
static PetscErrorCode ReadCase(MPI_Comm comm, const char *folder, Diag *diag, Case **c)
{
  PetscFunctionBeginUser;
  PetscCall(CaseReadKept(comm, folder, c));
  if (!*c) diag_error(diag, "initial.run", "there is no run in '%s': no case.yaml that could be read", folder);
  PetscFunctionReturn(0);
}

/* The file with the state, and the stage that it is of. */
static PetscErrorCode FindState(MPI_Comm comm, const InitialSpec *spec, const Case *other, Diag *diag, PetscInt *stage,
                                char path[CHECKPOINT_PATH])
{
  const char **names;

  PetscFunctionBeginUser;
  path[0] = '\0';
  *stage = PetscMax(0, other->n_stages - 1);
  if (!spec->stage) {
    PetscCall(RunDirNewest(comm, spec->run, path));
    if (path[0]) PetscFunctionReturn(0);
    diag_error(diag, "initial.run", "the run in '%s' has left no checkpoint to start from", spec->run);
    diag_hint(diag, "`checkpoint: {minutes: 0, steps: 0}` leaves none; a run of an older version may have left none");
    PetscFunctionReturn(0);
  }
  PetscCall(PetscCalloc1(other->n_stages + 1, &names));
  for (PetscInt k = 0; k < other->n_stages; ++k) {
    names[k] = other->stages[k].name;
    if (strcmp(names[k], spec->stage)) continue;
    run_dir_stage_path(spec->run, k, path);
    *stage = k;
  }
  if (!path[0]) diag_error(diag, "initial.stage", "the run in '%s' has no stage '%s'", spec->run, spec->stage);
  if (!path[0]) diag_hint_names(diag, spec->stage, names);
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

/* The newest state may be of an earlier stage than the last. */
static void stage_of(const Tables *tables, const Case *other, PetscInt *stage)
{
  char reason[256] = "";
  const Table *run = tables_find(tables, "run");
  const PetscInt64 *kept = run && other->n_stages ? table_data(run, "stage", COLUMN_INT64, 1, reason) : NULL;
  if (kept && *kept >= 0 && *kept < other->n_stages) *stage = (PetscInt)*kept;
}

static PetscErrorCode Read(Model *m, const Case *other, Diag *diag, Imbalance *imbalance)
{
  const InitialSpec *spec = &m->c->initial;
  char path[CHECKPOINT_PATH], reason[256];
  PetscInt stage;
  Tables *tables = NULL;

  PetscFunctionBeginUser;
  PetscCall(FindState(m->comm, spec, other, diag, &stage, path));
  if (!path[0]) PetscFunctionReturn(0);
  const PetscErrorCode code = CheckpointRead(m->comm, path, &tables, reason);
  if (code && code != PETSC_ERR_FILE_UNEXPECTED && code != PETSC_ERR_FILE_OPEN) PetscCall(code);
  if (code) diag_error(diag, "initial.run", "'%s' cannot be used: %s", path, reason);
  if (code) PetscFunctionReturn(0);
  stage_of(tables, other, &stage);
  PetscCall(ModelTakeRun(m, &tables, case_stage(other, stage), diag, imbalance));
  PetscCall(TablesDestroy(&tables));
  PetscFunctionReturn(0);
}

PetscErrorCode InitialTake(Model *m, Diag *diag, Imbalance *imbalance)
{
  Case *other = NULL;

  PetscFunctionBeginUser;
  PetscCall(ReadCase(m->comm, m->c->initial.run, diag, &other));
  if (other) PetscCall(Read(m, other, diag, imbalance));
  PetscCall(CaseDestroy(&other));
  PetscFunctionReturn(0);
}
