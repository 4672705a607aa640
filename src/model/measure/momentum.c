/* Momentum and spin: sums over points. */
#include "model/measure/measure.h"

static PetscReal momentum(const Model *m, const MeasureSpec *s, PetscInt body)
{
  PetscReal sum = 0;
  for (PetscInt p = 0; p < m->points->n; ++p)
    sum +=
      measure_share(m, s, body, p) * m->points->real[POINT_MASS][p] * point_real(m->points, POINT_V, p)[s->component];
  return sum;
}

/* This rank's mass, first moments, momenta, angular momentum and second moment about an axis; in
 * two dimensions that is z. */
static void sum_moments(const Model *m, const MeasureSpec *s, PetscInt body, PetscReal q[7])
{
  const PetscInt i = m->dim == 2 ? 0 : (s->component + 1) % 3, j = m->dim == 2 ? 1 : (s->component + 2) % 3;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal mass = measure_share(m, s, body, p) * m->points->real[POINT_MASS][p];
    const PetscReal *x = point_real(m->points, POINT_X, p), *v = point_real(m->points, POINT_V, p);
    const PetscReal add[7] = {1, x[i], x[j], v[i], v[j], x[i] * v[j] - x[j] * v[i], x[i] * x[i] + x[j] * x[j]};
    for (int k = 0; k < 7; ++k) q[k] += mass * add[k];
  }
}

static PetscReal angular_momentum(const Model *m, const MeasureSpec *s, PetscInt body)
{
  PetscReal q[7] = {0};
  sum_moments(m, s, body, q);
  return q[5];
}

/* Angular momentum over inertia about an axis through the centre of mass. */
static PetscErrorCode Spin(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscReal q[7] = {0};

  (void)index;
  PetscFunctionBeginUser;
  sum_moments(m, s, measure_body(m, s), q);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, q, 7, MPIU_REAL, MPI_SUM, m->comm));
  const PetscReal spin = q[5] - (q[1] * q[4] - q[2] * q[3]) / q[0];
  const PetscReal inertia = q[6] - (q[1] * q[1] + q[2] * q[2]) / q[0];
  *value = inertia > 0 ? spin / inertia : q[0] > 0 ? 0 : NAN;
  PetscFunctionReturn(0);
}

const Measure measure_momentum = {
  .key = "momentum", .no_radial = PETSC_TRUE, .number = {.unit = "kg m/s", .help = "linear momentum", .sum = momentum}};
const Measure measure_angular_momentum = {
  .key = "angular_momentum",
  .takes = MEASURE_SPIN_AXIS,
  .number = {.unit = "kg m2/s", .help = "angular momentum about the origin", .sum = angular_momentum}};
const Measure measure_spin = {
  .key = "spin",
  .takes = MEASURE_SPIN_AXIS,
  .number = {.unit = "rad/s",
             .help = "angular velocity: angular momentum over inertia, both about the centre of mass",
             .in = PETSC_TRUE,
             .value = Spin}};
