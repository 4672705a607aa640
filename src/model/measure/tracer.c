/* Tracers: places of the material that are followed. */
#include "model/measure/measure.h"

/* One rank holds the tracer. */
static PetscErrorCode Tracer(const Model *m, const MeasureSpec *s, PetscInt index, PointReal field, PetscReal *value)
{
  PetscReal local = 0, x[3];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->tracers->n; ++p) {
    if (m->tracers->body[p] != index) continue;
    point_place(m->tracers, p, x);
    local = field == POINT_X ? x[s->component] : point_real(m->tracers, field, p)[s->component];
  }
  PetscCall(MPIU_Allreduce(&local, value, 1, MPIU_REAL, MPI_SUM, m->comm));
  if (m->memory[index].ended > 0) *value = NAN;
  PetscFunctionReturn(0);
}

static PetscErrorCode Displacement(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscFunctionBeginUser;
  PetscCall(Tracer(m, s, index, POINT_U, value));
  PetscFunctionReturn(0);
}

static PetscErrorCode Position(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscFunctionBeginUser;
  PetscCall(Tracer(m, s, index, POINT_X, value));
  PetscFunctionReturn(0);
}

static PetscErrorCode Velocity(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscFunctionBeginUser;
  PetscCall(Tracer(m, s, index, POINT_V, value));
  PetscFunctionReturn(0);
}

const Measure measure_displacement = {
  .key = "displacement",
  .number = {.unit = "m", .help = "component of a tracer's displacement", .of = OF_TRACER, .value = Displacement}};
const Measure measure_position = {
  .key = "position",
  .number = {.unit = "m", .help = "component of a tracer's position", .of = OF_TRACER, .value = Position}};
const Measure measure_velocity = {
  .key = "velocity",
  .number = {.unit = "m/s", .help = "component of a tracer's velocity", .of = OF_TRACER, .value = Velocity}};
