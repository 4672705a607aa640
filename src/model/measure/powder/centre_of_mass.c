/* Where the centre of mass hangs in a container: of a bed that turns with its drum as a rigid body
 * the inclination of the surface, without any noise. */
#include "model/measure/measure.h"

/* Mass, and its first moments about the centre: to the right and against gravity. */
static PetscErrorCode Moments(const Model *m, const MeasureSpec *s, PetscReal *mass, PetscReal moment[2])
{
  const PetscInt body = measure_body(m, s);
  PetscReal sum[3] = {0, 0, 0}, right[2], up[2];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal share = measure_share(m, s, body, p) * m->points->real[POINT_MASS][p];
    sum[0] += share;
    for (int d = 0; d < 2; ++d) sum[1 + d] += share * (point_real(m->points, POINT_X, p)[d] - s->about[d]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  measure_up(m, right, up);
  *mass = sum[0];
  moment[0] = sum[1] * right[0] + sum[2] * right[1];
  moment[1] = sum[1] * up[0] + sum[2] * up[1];
  PetscFunctionReturn(0);
}

PetscErrorCode MassAngle(const Model *m, const MeasureSpec *s, PetscReal *angle)
{
  PetscReal mass, moment[2];

  PetscFunctionBeginUser;
  PetscCall(Moments(m, s, &mass, moment));
  *angle = mass > 0 ? PetscAtan2Real(-moment[0], -moment[1]) : NAN;
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

static PetscErrorCode Height(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscReal mass, moment[2];

  (void)index;
  PetscFunctionBeginUser;
  PetscCall(Moments(m, s, &mass, moment));
  *value = mass > 0 ? moment[1] / mass : NAN;
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
    WORD("height", "above the centre `about`, against gravity", "m", .about = PETSC_TRUE, .in = PETSC_TRUE,
         .value = Height),
    NULL}};
