/* Means over what is around a point (docs/theory.md, "Softening over a length"): before each step,
 * of the plastic strain at its start, with the weight (1 - r^2 / R^2)^2 of a distance r and the
 * volumes of the points.
 *
 * Points are gathered into bins of R / 4, each of which acts from its centre of volume: the work
 * for a point does not depend on how many there are. Every rank has the bins of all. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "model/model_private.h"

#define BINS 4 /* of a radius */

/* Sums over points: volume, volume times value, and times place. */
typedef struct {
  PetscReal at[3]; /* number of the bin along x, y, z */
  PetscReal volume, value, x[3];
} Bin;

#define BIN_NUMBERS ((PetscInt)(sizeof(Bin) / sizeof(PetscReal)))

/* By rows of x. */
static int order(const Bin *a, const PetscReal at[3])
{
  for (int d = 2; d >= 0; --d)
    if (a->at[d] != at[d]) return a->at[d] < at[d] ? -1 : 1;
  return 0;
}

static int compare(const void *a, const void *b) { return order(a, ((const Bin *)b)->at); }

/* First of the bins that is not before `at`. */
static PetscInt first_of(PetscInt n, const Bin *bin, const PetscReal at[3])
{
  PetscInt low = 0, high = n;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (order(&bin[middle], at) < 0) low = middle + 1;
    else high = middle;
  }
  return low;
}

/* Add up what falls into one bin; equal ones in the order in which they came, so that sums have
 * the same bits. */
static PetscErrorCode Merge(PetscInt *n, Bin *bin)
{
  PetscInt kept = 0, *place;
  Bin *sorted;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(*n, &sorted, *n, &place));
  PetscCall(PetscArraycpy(sorted, bin, *n));
  qsort(sorted, (size_t)*n, sizeof *sorted, compare);
  for (PetscInt k = 0; k < *n; ++k) { /* which of them are there, */
    if (kept && !order(&sorted[kept - 1], sorted[k].at)) continue;
    memcpy(sorted[kept].at, sorted[k].at, sizeof sorted->at);
    ++kept;
  }
  for (PetscInt k = 0; k < kept; ++k) memset(&sorted[k].volume, 0, sizeof *sorted - offsetof(Bin, volume));
  for (PetscInt k = 0; k < *n; ++k) { /* and their sums */
    Bin *to = &sorted[first_of(kept, sorted, bin[k].at)];
    to->volume += bin[k].volume;
    to->value += bin[k].value;
    for (int d = 0; d < 3; ++d) to->x[d] += bin[k].x[d];
  }
  PetscCall(PetscArraycpy(bin, sorted, kept));
  PetscCall(PetscFree2(sorted, place));
  *n = kept;
  PetscFunctionReturn(0);
}

/* Those of all ranks. */
static PetscErrorCode Share(MPI_Comm comm, PetscInt *n, Bin **bin)
{
  PetscMPIInt size, mine = (PetscMPIInt)(*n * BIN_NUMBERS), *count, *start;
  PetscInt all = 0;
  Bin *every;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(size, &count, size, &start));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < size; ++r) {
    start[r] = (PetscMPIInt)all;
    all += count[r];
  }
  PetscCall(PetscMalloc1(all / BIN_NUMBERS + 1, &every));
  PetscCallMPI(MPI_Allgatherv(*bin, mine, MPIU_REAL, every, count, start, MPIU_REAL, comm));
  PetscCall(PetscFree2(count, start));
  PetscCall(PetscFree(*bin));
  *bin = every;
  *n = all / BIN_NUMBERS;
  PetscCall(Merge(n, every));
  PetscFunctionReturn(0);
}

/* The bins of the points of one material, on all ranks; volumes are those of now. */
static PetscErrorCode Gather(const Model *m, PetscInt material, PetscReal edge, PetscInt *n, Bin **bin)
{
  const PetscInt averaged = m->materials[material].law->averaged;
  const Points *points = m->points;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(points->n + 1, bin));
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal volume = points->real[POINT_VOLUME][p] * points->real[POINT_J][p];
    const PetscReal *x = point_real(points, POINT_X, p);
    Bin *b = &(*bin)[*n];
    if (points->material[p] != material) continue;
    *b = (Bin){.volume = volume, .value = volume * point_real(points, POINT_STATE, p)[averaged]};
    for (PetscInt d = 0; d < m->dim; ++d) {
      b->at[d] = floor(x[d] / edge);
      b->x[d] = volume * x[d];
    }
    ++*n;
  }
  PetscCall(Merge(n, *bin));
  PetscCall(Share(m->comm, n, bin));
  for (PetscInt k = 0; k < *n; ++k)
    for (int d = 0; d < 3; ++d) (*bin)[k].x[d] /= (*bin)[k].volume;
  PetscFunctionReturn(0);
}

/* Weight and weighted sum of the bins of a row, x >= at[0] and <= last. */
static void add_row(PetscInt n, const Bin *bin, const PetscReal at[3], PetscReal last, const PetscReal x[3],
                    PetscReal radius2, PetscReal sum[2])
{
  for (PetscInt k = first_of(n, bin, at); k < n; ++k) {
    const Bin *b = &bin[k];
    PetscReal r2 = 0;
    if (b->at[1] != at[1] || b->at[2] != at[2] || b->at[0] > last) return;
    for (int d = 0; d < 3; ++d) r2 += PetscSqr(b->x[d] - x[d]);
    if (r2 >= radius2) continue;
    const PetscReal weight = PetscSqr(1 - r2 / radius2);
    sum[0] += weight * b->volume;
    sum[1] += weight * b->value;
  }
}

/* The bin of the point itself is among them: there is always a weight. */
static PetscReal mean_at(PetscInt dim, PetscInt n, const Bin *bin, const PetscReal *place, PetscReal radius)
{
  const PetscReal edge = radius / BINS;
  PetscReal at[3] = {0}, x[3] = {0}, middle[3] = {0}, sum[2] = {0};
  for (PetscInt d = 0; d < dim; ++d) {
    x[d] = place[d];
    middle[d] = floor(x[d] / edge);
  }
  at[0] = middle[0] - BINS - 1;
  for (int z = dim == 3 ? -BINS - 1 : 0; z <= (dim == 3 ? BINS + 1 : 0); ++z)
    for (int y = -BINS - 1; y <= BINS + 1; ++y) {
      at[1] = middle[1] + y;
      at[2] = middle[2] + z;
      add_row(n, bin, at, middle[0] + BINS + 1, x, radius * radius, sum);
    }
  return sum[1] / sum[0];
}

PetscErrorCode NonlocalStep(Model *m)
{
  PetscLogDouble clock;
  PetscInt n;
  Bin *bin;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  for (PetscInt i = 0; i < m->c->n_materials; ++i) {
    const Material *material = &m->materials[i];
    const PetscReal radius = material->law->reach ? material->law->reach(material->parameters) : 0;
    if (!(radius > 0)) continue;
    PetscCall(Gather(m, i, radius / BINS, &n, &bin));
    for (PetscInt p = 0; p < m->points->n; ++p) {
      if (m->points->material[p] != i) continue;
      const PetscReal mean = mean_at(m->dim, n, bin, point_real(m->points, POINT_X, p), radius);
      material->law->hear(material->parameters, mean, point_real(m->points, POINT_STATE, p));
    }
    PetscCall(PetscFree(bin));
  }
  PetscCall(PhaseEnd(m->seconds, PHASE_PREPARE, &clock));
  PetscFunctionReturn(0);
}
