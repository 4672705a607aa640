/* A measure from outside the house: a coordinate of the centre of mass, `{centre: y, of: {body:
 * stone}}`. Its file, and a line in more_measures.inc, are all that a measure is. */
#include "model/measure/measure.h"

static PetscErrorCode Centre(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const PetscInt body = measure_body(m, s);
  PetscReal sum[2] = {0, 0}; /* mass, first moment */

  (void)index;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal mass = measure_takes_point(m, body, p) ? m->points->real[POINT_MASS][p] : 0;
    sum[0] += mass;
    sum[1] += mass * point_real(m->points, POINT_X, p)[s->component];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  *value = sum[0] > 0 ? sum[1] / sum[0] : NAN;
  PetscFunctionReturn(0);
}

const Measure measure_centre = {.key = "centre",
                                .number = {.unit = "m", .help = "coordinate of the centre of mass", .value = Centre}};
