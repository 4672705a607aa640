/* Tracers: places of the material that are followed. */
#include "model/measure/measure.h"

/* One rank holds the tracer. */
static PetscErrorCode Tracer(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const PointReal field = (PointReal)measure_number(s)->which;
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

#define TRACER(name, in, field)                \
  {                                            \
    .key = name, .number = {                   \
      .unit = in,                              \
      .help = "component of a tracer's " name, \
      .of = OF_TRACER,                         \
      .value = Tracer,                         \
      .which = field                           \
    }                                          \
  }
const Measure measure_displacement = TRACER("displacement", "m", POINT_U);
const Measure measure_position = TRACER("position", "m", POINT_X);
const Measure measure_velocity = TRACER("velocity", "m/s", POINT_V);
