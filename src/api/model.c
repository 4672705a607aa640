/* A model that the caller steps and looks into. */
#include <math.h>
#include <string.h>
#include "api/api.h"
#include "case/fields.h"
#include "run/output/output.h"
#include "run/watch/until.h"

struct TalusModel {
  Model *model;
  StepReport report;
  Until until;
  PetscBool busy; /* where functions of the caller may be asked, which must not change the model then */
  TalusForce force;
  TalusFactors *factors; /* of each load */
  TalusBodyForce single; /* asked for one point at a time */
  void *single_context;
};

void talus_ask_forces(void *force, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *b)
{
  const TalusForce *f = force;
  f->force(f->context, (int)n, X, x, t, b);
}

static PetscErrorCode SetForce(TalusModel *m, TalusBodyForces force, void *context)
{
  PetscFunctionBeginUser;
  m->force = (TalusForce){force, context};
  PetscCall(ModelSetBodyForce(m->model, force ? talus_ask_forces : NULL, &m->force));
  PetscFunctionReturn(0);
}

void talus_ask_factors(void *factors, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *f)
{
  const TalusFactors *asked = factors;
  asked->factors(asked->context, (int)n, X, x, t, f);
}

static PetscErrorCode SetFactors(TalusModel *m, PetscInt load, TalusFactors factors)
{
  PetscFunctionBeginUser;
  m->factors[load] = factors;
  PetscCall(ModelSetLoadFactors(m->model, load, factors.factors ? talus_ask_factors : NULL, &m->factors[load]));
  PetscFunctionReturn(0);
}

/* What was done while the model was busy has ended so. */
static int done(TalusModel *model, int error)
{
  model->busy = PETSC_FALSE;
  return error;
}

static PetscErrorCode Destroy(TalusModel **model)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree((*model)->factors));
  PetscCall(UntilDestroy(&(*model)->until));
  PetscCall(ModelDestroy(&(*model)->model));
  PetscCall(PetscFree(*model));
  PetscFunctionReturn(0);
}

int TalusModelDestroy(TalusModel **model)
{
  if (!model || !*model) return TALUS_OK;
  if (!talus_is_running()) return TALUS_ERROR_STATE;
  return (*model)->busy ? TALUS_ERROR_BUSY : TALUS_CALL(Destroy(model));
}

static PetscErrorCode Equilibrate(TalusCase *c, TalusModel *made)
{
  PetscFunctionBeginUser;
  PetscCall(ModelEquilibrate(made->model, &made->report));
  if (made->report.outcome == STEP_ACCEPTED) PetscFunctionReturn(0);
  diag_error(c->diag, "initial.equilibrium", "there is no equilibrium to begin with: %s", made->report.reason);
  PetscCall(ModelDestroy(&made->model));
  PetscFunctionReturn(0);
}

/* Does a condition end it here? */
static PetscErrorCode LookForEnd(TalusModel *m)
{
  PetscFunctionBeginUser;
  PetscCall(UntilLook(&m->until, m->model));
  until_reason(&m->until, m->model->c, m->report.reason);
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(TalusCase *c, TalusModel **model, char **messages)
{
  TalusModel *made;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&made));
  if (case_seeks(&c->c->analysis))
    diag_error(c->diag, "analysis.type", "%s is sought by a whole run, not step by step",
               c->c->analysis.type == ANALYSIS_FACTOR ? "a factor of safety" : "a limit load");
  else if (c->c->n_stages || c->c->initial.run)
    diag_error(c->diag, c->c->n_stages ? "stages" : "initial", "stages, and states of other runs, are for whole runs");
  else PetscCall(ModelCreate(c->comm, c->c, c->diag, &made->model));
  if (made->model && c->force.force) PetscCall(SetForce(made, c->force.force, c->force.context));
  PetscCall(PetscCalloc1(c->c->n_loads, &made->factors));
  for (PetscInt k = 0; made->model && k < c->c->n_loads; ++k)
    if (c->factors[k].factors) PetscCall(SetFactors(made, k, c->factors[k]));
  if (made->model) PetscCall(Equilibrate(c, made));
  PetscCall(UntilCreate(c->c, &made->until));
  if (made->model) PetscCall(LookForEnd(made));
  PetscCall(TalusTell(c->comm, c->diag, messages));
  if (made->model) *model = made;
  else PetscCall(Destroy(&made));
  PetscFunctionReturn(0);
}

int TalusModelCreate(TalusCase *c, TalusModel **model, char **messages)
{
  if (messages) *messages = NULL;
  if (!model) return TALUS_ERROR_ARGUMENT;
  *model = NULL;
  if (!talus_is_running()) return TALUS_ERROR_STATE;
  if (!c) return TALUS_ERROR_ARGUMENT;
  if (c->busy) return TALUS_ERROR_BUSY;
  c->busy = PETSC_TRUE;
  const int error = TALUS_CALL(Create(c, model, messages));
  c->busy = PETSC_FALSE;
  if (error) return error;
  return *model ? TALUS_OK : TALUS_ERROR_INPUT;
}

static void point_by_point(void *context, int n, const double *X, const double *x, double t, double *b)
{
  const TalusModel *m = context;
  (void)x;
  for (size_t p = 0; p < (size_t)n; ++p) m->single(m->single_context, X + 3 * p, t, b + 3 * p);
}

int TalusModelSetBodyForce(TalusModel *model, TalusBodyForce force, void *context)
{
  if (!model) return TALUS_ERROR_ARGUMENT;
  if (model->busy) return TALUS_ERROR_BUSY;
  model->busy = PETSC_TRUE;
  model->single = force;
  model->single_context = context;
  return done(model, TALUS_CALL(SetForce(model, force ? point_by_point : NULL, model)));
}

int TalusModelSetBodyForces(TalusModel *model, TalusBodyForces force, void *context)
{
  if (!model) return TALUS_ERROR_ARGUMENT;
  if (model->busy) return TALUS_ERROR_BUSY;
  model->busy = PETSC_TRUE;
  return done(model, TALUS_CALL(SetForce(model, force, context)));
}

int TalusModelSetLoadFactors(TalusModel *model, const char *load, TalusLoadFactors factors, void *context)
{
  if (!model || !load) return TALUS_ERROR_ARGUMENT;
  if (model->busy) return TALUS_ERROR_BUSY;
  const PetscInt k = talus_load_index(model->model->c, load);
  if (k < 0) return TALUS_ERROR_UNKNOWN;
  model->busy = PETSC_TRUE;
  return done(model, TALUS_CALL(SetFactors(model, k, (TalusFactors){factors, context})));
}

static TalusStep step_of(StepOutcome outcome)
{
  switch (outcome) {
  case STEP_INTERRUPTED: /* nobody asks */
  case STEP_TOO_SMALL: return TALUS_STEP_TOO_SMALL;
  case STEP_POINTS_LOST: return TALUS_STEP_POINTS_LOST;
  case STEP_ACCEPTED: break;
  }
  return TALUS_STEP_ACCEPTED;
}

/* Points keep their order and their ranks until the next step, whatever is asked of them. A caller may mend why a step
 * failed, a function of its own for one: the next try begins with the same length. */
static PetscErrorCode Step(TalusModel *model, PetscReal limit)
{
  const StepControl control = model->model->control;

  PetscFunctionBeginUser;
  PetscCall(ModelStep(model->model, limit, &model->report));
  if (model->report.outcome == STEP_TOO_SMALL) model->model->control = control;
  PetscCall(ModelInitialise(model->model));
  if (model->report.outcome == STEP_ACCEPTED) PetscCall(LookForEnd(model));
  PetscFunctionReturn(0);
}

static PetscBool is_at_end(const TalusModel *m)
{
  return (PetscBool)(m->until.ended > 0 || m->model->time >= m->model->c->analysis.end * (1 - 1e-12));
}

int TalusModelStep(TalusModel *model, double limit, TalusStep *step)
{
  if (!model || !step || !(limit >= 0)) return TALUS_ERROR_ARGUMENT;
  if (model->busy) return TALUS_ERROR_BUSY;
  if (limit == 0 && is_at_end(model)) {
    if (!model->until.ended) model->report.reason[0] = '\0';
    *step = TALUS_STEP_AT_END;
    return TALUS_OK;
  }
  model->busy = PETSC_TRUE;
  const int error =
    done(model, TALUS_CALL(Step(model, limit > 0 ? limit : model->model->c->analysis.end - model->model->time)));
  if (!error) *step = step_of(model->report.outcome);
  return error;
}

const char *TalusModelReason(const TalusModel *model) { return model ? model->report.reason : ""; }

int TalusModelTime(const TalusModel *model, double *time, double *end)
{
  if (!model) return TALUS_ERROR_ARGUMENT;
  if (time) *time = model->model->time;
  if (end) *end = model->model->c->analysis.end;
  return TALUS_OK;
}

int TalusModelMeasure(const TalusModel *model, const char *name, double *value)
{
  PetscReal now;
  if (!model || !name || !value) return TALUS_ERROR_ARGUMENT;
  const PetscInt i = talus_measure_index(model->model->c, name);
  if (i < 0) return TALUS_ERROR_UNKNOWN;
  const int error = TALUS_CALL(ModelMeasure(model->model, &model->model->c->measures[i], i, &now));
  if (!error) *value = now;
  return error;
}

/* Numbers a point, 0 if there is no such field. Positions and ids are no output fields: every file
 * has them. */
static PetscInt field_components(const char *name)
{
  if (!strcmp(name, "position")) return 3;
  const OutputField *field = output_field_find(name);
  return field && field->points ? field->components : 0;
}

static PetscErrorCode CopyField(const Model *m, const char *name, double *buffer)
{
  const Points *points = m->points;

  PetscFunctionBeginUser;
  if (!strcmp(name, "position")) {
    for (PetscInt i = 0; i < 3 * points->n; ++i)
      buffer[i] = i % 3 < m->dim ? point_real(points, POINT_X, i / 3)[i % 3] : 0;
  } else if (!strcmp(name, "id")) {
    for (PetscInt p = 0; p < points->n; ++p) buffer[p] = (double)points->id[p];
  } else PetscCall(OutputPointField(m, output_field_find(name), buffer));
  PetscFunctionReturn(0);
}

int TalusModelPoints(const TalusModel *model, const char *field, int *n, int *components, double *buffer,
                     size_t capacity)
{
  if (!model || !field) return TALUS_ERROR_ARGUMENT;
  const PetscInt k = field_components(field), count = model->model->points->n;
  if (!k) return TALUS_ERROR_UNKNOWN;
  if (n) *n = (int)count;
  if (components) *components = (int)k;
  if (!buffer) return TALUS_OK;
  if (capacity < (size_t)count * (size_t)k) return TALUS_ERROR_ARGUMENT;
  return TALUS_CALL(CopyField(model->model, field, buffer));
}

/* Arrays of the points that are shown as they are; those that may be written carry the motion or
 * the memory of a law, which the next step begins with. */
static const struct {
  const char *name;
  PointReal field;
  PetscBool written;
} arrays[] = {
  {"position", POINT_X, PETSC_FALSE},
  {"displacement", POINT_U, PETSC_FALSE},
  {"velocity", POINT_V, PETSC_TRUE},
  {"acceleration", POINT_A, PETSC_TRUE},
  {"mass", POINT_MASS, PETSC_FALSE},
  {"deformation_gradient", POINT_F, PETSC_FALSE},
  {"kirchhoff_stress", POINT_TAU, PETSC_FALSE},
  {"state", POINT_STATE, PETSC_TRUE},
};

int TalusModelArray(const TalusModel *model, const char *name, double **data, int *n, int *components, int *writable)
{
  size_t k = 0;
  if (!model || !name || !data) return TALUS_ERROR_ARGUMENT;
  while (k < PETSC_STATIC_ARRAY_LENGTH(arrays) && strcmp(arrays[k].name, name)) ++k;
  if (k == PETSC_STATIC_ARRAY_LENGTH(arrays)) return TALUS_ERROR_UNKNOWN;
  const Points *points = model->model->points;
  const PetscBool motion = arrays[k].field == POINT_V || arrays[k].field == POINT_A;
  *data = points->real[arrays[k].field];
  if (n) *n = (int)points->n;
  if (components) *components = (int)points->components[arrays[k].field];
  /* nodes that keep their motion do not ask the points */
  if (writable) *writable = arrays[k].written && (!motion || model->model->method->restores_grid);
  return TALUS_OK;
}

int TalusModelChanged(TalusModel *model)
{
  if (!model) return TALUS_ERROR_ARGUMENT;
  if (model->busy) return TALUS_ERROR_BUSY;
  model->busy = PETSC_TRUE;
  return done(model, TALUS_CALL(ModelPointsChanged(model->model)));
}
