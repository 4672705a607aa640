#include "picture/plot_spacing.h"
#include <math.h>

enum { MAX_NEIGHBOURS = 6 };

/* Points sorted into boxes. */
typedef struct {
  PetscInt dim, counts[3], n_boxes;
  PetscReal min[3], size;
  PetscInt *start, *point;
} Boxes;

static PetscInt box_of(const Boxes *boxes, const PetscReal *x, PetscInt at[3])
{
  PetscInt box = 0;
  for (PetscInt d = 2; d >= 0; --d) {
    at[d] = d < boxes->dim ? PetscMin((PetscInt)((x[d] - boxes->min[d]) / boxes->size), boxes->counts[d] - 1) : 0;
    box = box * boxes->counts[d] + at[d];
  }
  return box;
}

/* Boxes of a size that holds some two points, if the points filled their bounding box. */
static void choose_size(Boxes *boxes, PetscInt n, const PetscReal *x)
{
  PetscReal max[3] = {0}, volume = 1, largest = 0;
  for (PetscInt d = 0; d < boxes->dim; ++d) boxes->min[d] = max[d] = x[d];
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt d = 0; d < boxes->dim; ++d) {
      boxes->min[d] = PetscMin(boxes->min[d], x[3 * i + d]);
      max[d] = PetscMax(max[d], x[3 * i + d]);
    }
  for (PetscInt d = 0; d < boxes->dim; ++d) largest = PetscMax(largest, max[d] - boxes->min[d]);
  if (!(largest > 1e-200)) largest = 1; /* all at one place, as far as numbers can tell */
  for (PetscInt d = 0; d < boxes->dim; ++d) volume *= PetscMax((max[d] - boxes->min[d]) / largest, 1.0 / n);
  boxes->size = largest * PetscPowReal(2 * volume / n, 1.0 / boxes->dim);
  boxes->n_boxes = 1;
  for (PetscInt d = 0; d < 3; ++d) {
    boxes->counts[d] = d < boxes->dim ? (PetscInt)((max[d] - boxes->min[d]) / boxes->size) + 1 : 1;
    boxes->n_boxes *= boxes->counts[d];
  }
}

static PetscErrorCode BoxesCreate(PetscInt dim, PetscInt n, const PetscReal *x, Boxes *boxes)
{
  PetscInt at[3];

  PetscFunctionBeginUser;
  boxes->dim = dim;
  choose_size(boxes, n, x);
  PetscCall(PetscCalloc1(boxes->n_boxes + 2, &boxes->start));
  PetscCall(PetscMalloc1(n, &boxes->point));
  for (PetscInt i = 0; i < n; ++i) ++boxes->start[box_of(boxes, x + 3 * i, at) + 2];
  for (PetscInt b = 1; b <= boxes->n_boxes; ++b) boxes->start[b + 1] += boxes->start[b];
  for (PetscInt i = 0; i < n; ++i) boxes->point[boxes->start[box_of(boxes, x + 3 * i, at) + 1]++] = i;
  PetscFunctionReturn(0);
}

/* Keep the k smallest numbers in order. */
static void insert(PetscReal *best, PetscInt k, PetscReal value)
{
  PetscInt i = k - 1;
  if (value >= best[i]) return;
  for (; i > 0 && best[i - 1] > value; --i) best[i] = best[i - 1];
  best[i] = value;
}

static void search_box(const Boxes *boxes, PetscInt box, const PetscReal *x, PetscInt self, PetscInt k, PetscReal *best)
{
  for (PetscInt j = boxes->start[box]; j < boxes->start[box + 1]; ++j) {
    const PetscReal *y = x + 3 * boxes->point[j];
    PetscReal r2 = 0;
    for (PetscInt d = 0; d < boxes->dim; ++d) r2 += (y[d] - x[3 * self + d]) * (y[d] - x[3 * self + d]);
    if (boxes->point[j] != self) insert(best, k, r2);
  }
}

/* Distance to the k-th neighbour, searched within two rings of boxes; further off it does not matter. */
static PetscReal neighbour_distance(const Boxes *boxes, const PetscReal *x, PetscInt self, PetscInt k)
{
  PetscReal best[MAX_NEIGHBOURS];
  PetscInt at[3], from[3], to[3];
  box_of(boxes, x + 3 * self, at);
  for (PetscInt ring = 1; ring <= 2; ++ring) {
    for (PetscInt i = 0; i < k; ++i) best[i] = PETSC_MAX_REAL;
    for (PetscInt d = 0; d < 3; ++d)
      from[d] = PetscMax(at[d] - ring, 0), to[d] = PetscMin(at[d] + ring, boxes->counts[d] - 1);
    for (PetscInt c = from[2]; c <= to[2]; ++c)
      for (PetscInt b = from[1]; b <= to[1]; ++b)
        for (PetscInt a = from[0]; a <= to[0]; ++a)
          search_box(boxes, (c * boxes->counts[1] + b) * boxes->counts[0] + a, x, self, k, best);
    if (best[k - 1] <= PetscSqr(ring * boxes->size)) break;
  }
  return PetscSqrtReal(best[k - 1]);
}

/* Mean over the boxes around a point of what was found there. */
static PetscReal spacing_around(const Boxes *boxes, const PetscReal *x, const PetscReal *distance, PetscInt self)
{
  PetscInt at[3], from[3], to[3], n = 0;
  PetscReal sum = 0;
  box_of(boxes, x + 3 * self, at);
  for (PetscInt d = 0; d < 3; ++d) from[d] = PetscMax(at[d] - 1, 0), to[d] = PetscMin(at[d] + 1, boxes->counts[d] - 1);
  for (PetscInt c = from[2]; c <= to[2]; ++c)
    for (PetscInt b = from[1]; b <= to[1]; ++b)
      for (PetscInt a = from[0]; a <= to[0]; ++a) {
        const PetscInt box = (c * boxes->counts[1] + b) * boxes->counts[0] + a;
        for (PetscInt j = boxes->start[box]; j < boxes->start[box + 1]; ++j) sum += distance[boxes->point[j]], ++n;
      }
  return sum / n;
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
  PetscReal median = 0, *distance;
  Boxes boxes;

  PetscFunctionBeginUser;
  if (n == 0) PetscFunctionReturn(0);
  PetscCall(BoxesCreate(dim, n, x, &boxes));
  PetscCall(PetscMalloc1(n, &distance));
  for (PetscInt i = 0; i < n; ++i) distance[i] = neighbour_distance(&boxes, x, i, k);
  PetscCall(PlotMedian(n, distance, &median));
  if (!(median < 1e100)) median = boxes.size; /* a handful of points, without enough neighbours */
  if (!(median > 0)) median = boxes.size;     /* all in pairs at the same place */
  for (PetscInt i = 0; i < n; ++i) distance[i] = PetscMin(PetscMax(distance[i], 0.3 * median), 2 * median);
  for (PetscInt i = 0; i < n; ++i) { /* corners have few neighbours: no knobs there */
    const PetscReal around = spacing_around(&boxes, x, distance, i);
    radius[i] = factor * PetscMin(PetscMax(distance[i], 0.95 * around), PetscMin(1.05 * around, 1.5 * median));
  }
  PetscCall(PetscFree(distance));
  PetscCall(PetscFree(boxes.start));
  PetscCall(PetscFree(boxes.point));
  PetscFunctionReturn(0);
}
