#include "picture/raster/spacing.h"
#include <math.h>
#include "grid/search/neighbours.h"

enum { MAX_NEIGHBOURS = 6, MAX_AROUND = 64 };

/* Edge of bins that hold some two points, if the points filled the box around them. */
static PetscReal choose_size(PetscInt dim, PetscInt n, const PetscReal *x)
{
  PetscReal extent[3] = {0}, volume = 1, largest = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal min = x[d], max = x[d];
    for (PetscInt i = 1; i < n; ++i) {
      min = PetscMin(min, x[i * dim + d]);
      max = PetscMax(max, x[i * dim + d]);
    }
    extent[d] = max - min;
    largest = PetscMax(largest, extent[d]);
  }
  if (!(largest > 1e-200)) largest = 1; /* all at one place, as far as numbers can tell */
  for (PetscInt d = 0; d < dim; ++d) volume *= PetscMax(extent[d] / largest, 1.0 / n);
  return largest * PetscPowReal(2 * volume / n, 1.0 / dim);
}

/* Distance to the k-th neighbour, searched no further than three bins: beyond that it does not
 * matter. */
static PetscReal neighbour_distance(const Neighbours *points, const PetscReal *x, PetscReal size, PetscInt k)
{
  PetscInt item[MAX_NEIGHBOURS + 1];
  PetscReal square[MAX_NEIGHBOURS + 1];
  /* the first one found is the point itself */
  for (PetscReal radius = size; radius <= 3 * size; radius *= 3)
    if (neighbours_within(points, x, radius, k + 1, item, square) > k) return PetscSqrtReal(square[k]);
  return PETSC_MAX_REAL;
}

/* Mean over the places around a point of what was found there. */
static PetscReal spacing_around(const Neighbours *points, const PetscReal *x, PetscReal radius,
                                const PetscReal *distance)
{
  PetscInt item[MAX_AROUND];
  PetscReal square[MAX_AROUND], sum = 0;
  const PetscInt n = neighbours_within(points, x, radius, MAX_AROUND, item, square);
  for (PetscInt i = 0; i < n; ++i) sum += distance[item[i]];
  return sum / (PetscReal)n;
}

PetscErrorCode PlotMedian(PetscInt n, const PetscReal *values, PetscReal *median)
{
  PetscReal *sorted;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &sorted));
  PetscCall(PetscArraycpy(sorted, values, n));
  PetscCall(PetscSortReal(n, sorted));
  *median = sorted[n / 2];
  PetscCall(PetscFree(sorted));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotSpacing(PetscInt dim, PetscInt n, const PetscReal *x, PetscReal *radius)
{
  /* Half the diagonal of a lattice cell is 0.71 (0.87 in space) of the distance to the 4th (6th)
   * neighbour. */
  const PetscInt k = dim == 2 ? 4 : 6;
  const PetscReal factor = dim == 2 ? 0.75 : 0.85;
  PetscReal median = 0, *distance, *at;
  Neighbours points;

  PetscFunctionBeginUser;
  if (n == 0) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(n, &distance, n * dim, &at));
  for (PetscInt i = 0; i < n * dim; ++i) at[i] = x[i / dim * 3 + i % dim];
  const PetscReal size = choose_size(dim, n, at);
  PetscCall(NeighboursCreate(dim, n, at, 0, NULL, NULL, size, &points));
  for (PetscInt i = 0; i < n; ++i) distance[i] = neighbour_distance(&points, at + i * dim, size, k);
  PetscCall(PlotMedian(n, distance, &median));
  if (!(median < 1e100)) median = size; /* a handful of points, without enough neighbours */
  if (!(median > 0)) median = size;     /* all in pairs at the same place */
  for (PetscInt i = 0; i < n; ++i) distance[i] = PetscMin(PetscMax(distance[i], 0.3 * median), 2 * median);
  for (PetscInt i = 0; i < n; ++i) { /* corners have few neighbours: no knobs there */
    const PetscReal around = spacing_around(&points, at + i * dim, 2 * size, distance);
    radius[i] = factor * PetscMin(PetscMax(distance[i], 0.95 * around), PetscMin(1.05 * around, 1.5 * median));
  }
  PetscCall(NeighboursDestroy(&points));
  PetscCall(PetscFree2(distance, at));
  PetscFunctionReturn(0);
}
