/* Momentum and spin: sums over points. */
#include "base/math/tensor.h"
#include "model/measure/measure.h"

static PetscReal momentum(const Model *m, const MeasureSpec *s, PetscInt body)
{
  PetscReal sum = 0;
  for (PetscInt p = 0; p < m->points->n; ++p)
    sum +=
      measure_share(m, s, body, p) * m->points->real[POINT_MASS][p] * point_real(m->points, POINT_V, p)[s->component];
  return sum;
}

static PetscReal angular_momentum(const Model *m, const MeasureSpec *s, PetscInt body)
{
  const PetscInt i = m->dim == 2 ? 0 : (s->component + 1) % 3, j = m->dim == 2 ? 1 : (s->component + 2) % 3;
  PetscReal sum = 0;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), *v = point_real(m->points, POINT_V, p);
    sum += measure_share(m, s, body, p) * m->points->real[POINT_MASS][p] * (x[i] * v[j] - x[j] * v[i]);
  }
  return sum;
}

/* Mass, and its first and second moments; momentum, and its moment about the middle of the grid: about the origin of a
 * map what is small would be a difference of what is large. In two dimensions z is 0. */
enum { MASS, PLACE, SQUARES = PLACE + 3, MOMENTUM = SQUARES + 9, TURNING = MOMENTUM + 3, MOMENTS = TURNING + 3 };

/* Of this rank. */
static void sum_moments(const Model *m, const MeasureSpec *s, PetscInt body, PetscReal q[MOMENTS])
{
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal mass = measure_share(m, s, body, p) * m->points->real[POINT_MASS][p];
    PetscReal x[3] = {0, 0, 0}, v[3] = {0, 0, 0};
    for (PetscInt d = 0; d < m->dim; ++d) {
      x[d] = point_real(m->points, POINT_X, p)[d] - 0.5 * (m->grid->min[d] + m->grid->max[d]);
      v[d] = point_real(m->points, POINT_V, p)[d];
    }
    q[MASS] += mass;
    for (int d = 0; d < 3; ++d) {
      q[PLACE + d] += mass * x[d];
      q[MOMENTUM + d] += mass * v[d];
      q[TURNING + d] += mass * (x[(d + 1) % 3] * v[(d + 2) % 3] - x[(d + 2) % 3] * v[(d + 1) % 3]);
      for (int e = 0; e < 3; ++e) q[SQUARES + 3 * d + e] += mass * x[d] * x[e];
    }
  }
}

#define LEAST_INERTIA \
  1e-12 /* of the cube of its trace: the determinant of inertia of what is a line of points, or one */

/* Tensor of inertia about the centre of mass, and the moment of momentum about it. PETSC_FALSE: it has no inverse. */
static PetscBool inertia_of(const PetscReal q[MOMENTS], PetscReal inertia[9], PetscReal turning[3])
{
  PetscReal squares[9], trace = 0;
  for (int d = 0; d < 3; ++d) {
    const int i = (d + 1) % 3, j = (d + 2) % 3;
    turning[d] = q[TURNING + d] - (q[PLACE + i] * q[MOMENTUM + j] - q[PLACE + j] * q[MOMENTUM + i]) / q[MASS];
    for (int e = 0; e < 3; ++e) squares[3 * d + e] = q[SQUARES + 3 * d + e] - q[PLACE + d] * q[PLACE + e] / q[MASS];
    trace += squares[4 * d];
  }
  for (int k = 0; k < 9; ++k) inertia[k] = (k % 4 == 0) * trace - squares[k];
  return (PetscBool)(tensor_det(inertia) > LEAST_INERTIA * trace * trace * trace);
}

/* omega of I omega = L about the centre of mass; what has no such omega turns about the axis by L over the inertia
 * about it. */
static PetscErrorCode Spin(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const int axis = m->dim == 2 ? 2 : (int)s->component;
  PetscReal q[MOMENTS] = {0}, inertia[9], inverse[9], turning[3];

  (void)index;
  PetscFunctionBeginUser;
  sum_moments(m, s, measure_body(m, s), q);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, q, MOMENTS, MPIU_REAL, MPI_SUM, m->comm));
  *value = q[MASS] > 0 ? 0 : NAN;
  if (q[MASS] <= 0) PetscFunctionReturn(0);
  if (inertia_of(q, inertia, turning) && m->dim == 3) {
    tensor_inverse(inertia, inverse);
    for (int d = 0; d < 3; ++d) *value += inverse[3 * axis + d] * turning[d];
  } else if (inertia[4 * axis] > 0) *value = turning[axis] / inertia[4 * axis];
  PetscFunctionReturn(0);
}

const Measure measure_momentum = {
  .key = "momentum",
  .no_radial = PETSC_TRUE,
  .number = {.unit = "kg m/s",
             .help = "linear momentum of bodies (a wall: its `mass` times `wall_velocity`, as a `formula`)",
             .sum = momentum}};
const Measure measure_angular_momentum = {
  .key = "angular_momentum",
  .takes = MEASURE_SPIN_AXIS,
  .number = {.unit = "kg m2/s", .help = "angular momentum about the origin", .sum = angular_momentum}};
const Measure measure_spin = {.key = "spin",
                              .takes = MEASURE_SPIN_AXIS,
                              .number = {.unit = "rad/s",
                                         .help = "angular velocity: the inverse of the tensor of inertia times the "
                                                 "angular momentum, both about the centre of mass",
                                         .in = PETSC_TRUE,
                                         .value = Spin}};
