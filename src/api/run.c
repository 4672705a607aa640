/* A case run as a whole. */
#include <stdlib.h>
#include <string.h>
#include "api/api.h"
#include "run/run.h"

/* Owns copies of the names, so that it may outlive its case. The C library's memory: it may also
 * outlive PETSc. */
struct TalusRun {
  TalusOutcome outcome;
  PetscInt n;
  char **names;
  double *values;
};

int TalusRunDestroy(TalusRun **run)
{
  if (!run || !*run) return TALUS_OK;
  for (PetscInt i = 0; (*run)->names && i < (*run)->n; ++i) free((*run)->names[i]);
  free((*run)->names);
  free((*run)->values);
  free(*run);
  *run = NULL;
  return TALUS_OK;
}

static TalusRun *create_run(const Case *c)
{
  TalusRun *run = calloc(1, sizeof(*run));
  if (!run) return NULL;
  const size_t n = (size_t)case_columns(c);
  run->n = case_columns(c);
  run->names = calloc(n + 1, sizeof(char *));
  run->values = calloc(n + 1, sizeof(double));
  PetscBool complete = run->names && run->values;
  for (size_t i = 0; complete && i < n; ++i)
    complete = (run->names[i] = strdup(case_column(c, (PetscInt)i)->name)) != NULL;
  if (!complete) TalusRunDestroy(&run);
  return run;
}

static PetscBool watch(void *context, PetscInt step, PetscReal time, PetscReal end)
{
  const TalusCase *c = context;
  return (PetscBool)(c->progress(c->progress_context, (int)step, time, end) != 0);
}

/* Those of the caller as the run asks for them, to be freed; NULL: there are none, or stages. */
static PetscErrorCode LoadFactorsOf(TalusCase *c, LoadAsked **asked)
{
  const PetscInt n = c->c->n_loads;
  PetscInt given = -1;

  PetscFunctionBeginUser;
  *asked = NULL;
  for (PetscInt k = 0; k < n; ++k)
    if (c->factors[k].factors) given = k;
  if (given < 0) PetscFunctionReturn(0);
  if (c->c->n_stages) {
    diag_error(c->diag, "stages", "a load that a function of the caller gives is not for cases with stages");
    PetscFunctionReturn(0);
  }
  PetscCall(PetscCalloc1(n, asked));
  for (PetscInt k = 0; k < n; ++k)
    if (c->factors[k].factors) (*asked)[k] = (LoadAsked){talus_ask_factors, &c->factors[k]};
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(TalusCase *c, const RunOptions *options, TalusRun *run, RunResult *result, char **messages)
{
  RunSummary summary = {0};
  RunOptions asked = *options;
  LoadAsked *factors;

  PetscFunctionBeginUser;
  asked.summary = &summary;
  asked.watcher = c->progress ? watch : NULL;
  asked.watcher_context = c;
  asked.body_force = c->force.force ? talus_ask_forces : NULL;
  asked.body_force_context = &c->force;
  PetscCall(LoadFactorsOf(c, &factors));
  asked.load_factors = factors;
  if (!diag_errors(c->diag)) PetscCall(RunCase(c->comm, c->c, &asked, c->diag, run->values, result));
  PetscCall(PetscFree(factors));
  if (summary.reason[0]) diag_error(c->diag, NULL, "%s", summary.reason);
  PetscCall(TalusTell(c->comm, c->diag, messages));
  PetscFunctionReturn(0);
}

int TalusRunCase(TalusCase *c, const char *out, unsigned flags, TalusRun **run, char **messages)
{
  const RunOptions options = {.out = out,
                              .force = (PetscBool) !!(flags & TALUS_RUN_FORCE),
                              .quiet = (PetscBool) !!(flags & TALUS_RUN_QUIET),
                              .resume = (PetscBool) !!(flags & TALUS_RUN_RESUME)};
  RunResult result = RUN_BAD_INPUT;

  if (messages) *messages = NULL;
  if (!run) return TALUS_ERROR_ARGUMENT;
  *run = NULL;
  if (!talus_is_running()) return TALUS_ERROR_STATE;
  if (!c || !out || !*out || (flags & ~(unsigned)(TALUS_RUN_FORCE | TALUS_RUN_QUIET | TALUS_RUN_RESUME)) ||
      (options.force && options.resume))
    return TALUS_ERROR_ARGUMENT;
  if (c->busy) return TALUS_ERROR_BUSY;
  TalusRun *made = create_run(c->c);
  if (!made) return TALUS_ERROR_MEMORY;
  c->busy = PETSC_TRUE;
  int error = TALUS_CALL(Run(c, &options, made, &result, messages));
  c->busy = PETSC_FALSE;
  if (!error && result == RUN_BAD_INPUT) error = TALUS_ERROR_INPUT;
  made->outcome = result == RUN_DONE ? TALUS_DONE : TALUS_GAVE_UP;
  if (error) TalusRunDestroy(&made);
  *run = made;
  return error;
}

int TalusRunOutcome(const TalusRun *run, TalusOutcome *outcome)
{
  if (!run || !outcome) return TALUS_ERROR_ARGUMENT;
  *outcome = run->outcome;
  return TALUS_OK;
}

int TalusRunMeasure(const TalusRun *run, const char *name, double *value)
{
  if (!run || !name || !value) return TALUS_ERROR_ARGUMENT;
  for (PetscInt i = 0; i < run->n; ++i) {
    if (strcmp(run->names[i], name)) continue;
    *value = run->values[i];
    return TALUS_OK;
  }
  return TALUS_ERROR_UNKNOWN;
}
