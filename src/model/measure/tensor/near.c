/* A tensor at a place of the material. One point's own would jump from point to point; a plane through
 * those around it is exact for linear fields, at the surface of a body too. */
#include <math.h>
#include <string.h>
#include "base/math/svd.h"
#include "model/measure/tensor/tensor.h"

#define REACH 3.0      /* spacings of points */
#define UNDECIDED 0.01 /* spread in a direction, over the largest, that tells no slope */
#define LONG 4.0       /* cells longer than that, over their shortest side, have points as far apart along each axis */

/* reach: along each axis, m */
typedef struct {
  PetscReal x[3], reach[3];
  PetscInt body;
} Place;

/* Where the tracer is; *there: somewhere. */
static PetscErrorCode FindTracer(const Model *m, PetscInt index, Place *place, PetscBool *there)
{
  PetscReal x[4] = {0}; /* the last: how many have it */

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->tracers->n; ++p) {
    if (m->tracers->body[p] != index) continue;
    point_place(m->tracers, p, x);
    x[3] = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, x, 4, MPIU_REAL, MPI_SUM, m->comm));
  memcpy(place->x, x, sizeof place->x);
  *there = x[3] > 0 && !(m->memory[index].ended > 0) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

static PetscReal distance2(const Model *m, PetscInt p, const PetscReal *x)
{
  PetscReal sum = 0;
  for (PetscInt d = 0; d < m->dim; ++d) sum += PetscSqr(point_real(m->points, POINT_X, p)[d] - x[d]);
  return sum;
}

/* Side of the square or cube that the point fills. */
static PetscReal spacing_of(const Model *m, PetscInt p)
{
  const PetscReal volume = measure_solid_volume(m, p), x = point_real(m->points, POINT_X, p)[0];
  const PetscReal thickness = m->c->kinematics->hoop ? 2 * PETSC_PI * x : 1;
  return PetscPowReal(volume / thickness, 1.0 / (PetscReal)m->dim);
}

/* The cell of a point, -1 if it has none: points of a cloud keep the number of one that is gone. */
static PetscInt cell_of(const Model *m, PetscInt p) { return m->grid->cloud ? -1 : m->points->cell[p]; }

/* How far points are asked along each axis. */
static void reach_of(const Model *m, PetscInt p, PetscReal reach[3])
{
  PetscReal x[CELL_MAX_NODES * 3], side[3] = {1, 1, 1}, least = PETSC_MAX_REAL, most = 0, product = 1;
  const PetscInt cell = cell_of(m, p), nodes = cell < 0 ? 0 : cells[grid_cell_type(m->grid, cell)].nodes;
  if (nodes) grid_cell_x(m->grid, cell, x);
  for (PetscInt d = 0; nodes && d < m->dim; ++d) {
    PetscReal low = x[d], high = x[d];
    for (PetscInt i = 0; i < nodes; ++i)
      low = PetscMin(low, x[i * m->dim + d]), high = PetscMax(high, x[i * m->dim + d]);
    side[d] = high - low;
    least = PetscMin(least, side[d]), most = PetscMax(most, side[d]), product *= side[d];
  }
  const PetscReal mean = PetscPowReal(product, 1.0 / (PetscReal)m->dim), spacing = REACH * spacing_of(m, p);
  for (PetscInt d = 0; d < 3; ++d) reach[d] = most > LONG * least ? spacing * side[d] / mean : spacing;
}

/* Body of the point nearest to the place, and how far others are asked. */
static PetscErrorCode FindNearest(const Model *m, Place *place)
{
  struct {
    double distance2;
    int rank;
  } mine = {HUGE_VAL, 0};
  PetscReal numbers[4] = {0, 0, 0, -1};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &mine.rank));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal square = distance2(m, p, place->x);
    if (!(square < mine.distance2)) continue;
    mine.distance2 = square;
    reach_of(m, p, numbers);
    numbers[3] = (PetscReal)m->points->body[p];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_DOUBLE_INT, MPI_MINLOC, m->comm));
  PetscCallMPI(MPI_Bcast(numbers, 4, MPIU_REAL, mine.rank, m->comm));
  memcpy(place->reach, numbers, sizeof place->reach);
  place->body = (PetscInt)numbers[3];
  PetscFunctionReturn(0);
}

/* Sums over the points around the place: volume, first and second moments of the position, and each of
 * these but the last with the tensor. Positions count from the place, over the reach. */
typedef struct {
  PetscReal volume, x[3], xx[9], tensor[6], x_tensor[18];
} Moments;

static void add_point(const Model *m, PetscInt p, const Place *place, PointTensor *tensor, Moments *sum)
{
  PetscReal x[3] = {0}, square = 0, volume = 0, value[6] = {0};
  for (PetscInt d = 0; d < m->dim; ++d) {
    x[d] = (point_real(m->points, POINT_X, p)[d] - place->x[d]) / place->reach[d];
    square += PetscSqr(x[d]);
  }
  if (square >= 1 || m->points->body[p] != place->body) return;
  tensor(m, p, PetscSqr(1 - square), value, &volume);
  sum->volume += volume;
  for (int k = 0; k < 6; ++k) sum->tensor[k] += value[k];
  for (int i = 0; i < 3; ++i) {
    sum->x[i] += volume * x[i];
    for (int j = 0; j < 3; ++j) sum->xx[3 * i + j] += volume * x[i] * x[j];
    for (int k = 0; k < 6; ++k) sum->x_tensor[6 * i + k] += value[k] * x[i];
  }
}

/* Mean and slope by least squares; the slope is left out where points do not spread. */
static void fit(const Moments *sum, PetscReal value[6])
{
  PetscReal mean[3], slope[3];
  for (int i = 0; i < 3; ++i) mean[i] = sum->x[i] / sum->volume;
  for (int k = 0; k < 6; ++k) {
    PetscReal spread[9], with[3];
    for (int i = 0; i < 3; ++i) {
      with[i] = sum->x_tensor[6 * i + k] - mean[i] * sum->tensor[k];
      for (int j = 0; j < 3; ++j) spread[3 * i + j] = sum->xx[3 * i + j] - mean[i] * sum->x[j];
    }
    svd_solve(3, UNDECIDED, spread, with, slope);
    value[k] = sum->tensor[k] / sum->volume;
    for (int i = 0; i < 3; ++i) value[k] -= slope[i] * mean[i];
  }
}

PetscErrorCode TensorNear(Model *m, PetscInt index, PointTensor *tensor, PetscReal value[6])
{
  Moments sum = {0};
  PetscBool there = PETSC_FALSE;
  Place place;

  PetscFunctionBeginUser;
  for (int k = 0; k < 6; ++k) value[k] = NAN;
  PetscCall(FindTracer(m, index, &place, &there));
  if (!there) PetscFunctionReturn(0);
  PetscCall(FindNearest(m, &place));
  for (PetscInt p = 0; p < m->points->n; ++p) add_point(m, p, &place, tensor, &sum);
  PetscCall(
    MPIU_Allreduce(MPI_IN_PLACE, (PetscReal *)&sum, sizeof sum / sizeof(PetscReal), MPIU_REAL, MPI_SUM, m->comm));
  if (sum.volume > 0) fit(&sum, value);
  PetscFunctionReturn(0);
}
