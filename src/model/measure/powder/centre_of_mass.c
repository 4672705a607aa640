/* Where the centre of mass hangs in a container: of a bed that turns with its drum as a rigid body
 * the inclination of the surface, without any noise. */
#include "model/measure/measure.h"

PetscErrorCode MassAngle(const Model *m, const MeasureSpec *s, PetscReal *angle)
{
  const PetscInt body = measure_body(m, s);
  PetscReal sum[3] = {0, 0, 0}, right[2], up[2]; /* mass, first moments */

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal mass = measure_share(m, s, body, p) * m->points->real[POINT_MASS][p];
    sum[0] += mass;
    for (int d = 0; d < 2; ++d) sum[1 + d] += mass * (point_real(m->points, POINT_X, p)[d] - s->about[d]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  measure_up(m, right, up);
  const PetscReal across = sum[1] * right[0] + sum[2] * right[1], above = sum[1] * up[0] + sum[2] * up[1];
  *angle = sum[0] > 0 ? PetscAtan2Real(-across, -above) : NAN;
  PetscFunctionReturn(0);
}

static PetscErrorCode Angle(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  (void)index;
  PetscFunctionBeginUser;
  PetscCall(MassAngle(m, s, value));
  *value *= 180 / PETSC_PI;
  PetscFunctionReturn(0);
}

const Measure measure_centre_of_mass = {
  .key = "centre_of_mass",
  .takes = MEASURE_WORD,
  .only_2d = PETSC_TRUE,
  .number = {.unit = "deg", .help = "centre of mass"},
  .words = (const MeasureNumber *const[]){
    WORD("angle",
         "of the line from the centre `about` down to the centre of mass with gravity: 0 if it hangs straight down, "
         "positive towards -x, as the inclination of a free surface that turns with it",
         "deg", .about = PETSC_TRUE, .in = PETSC_TRUE, .value = Angle),
    NULL}};
