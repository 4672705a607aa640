/* Means over what is around a point (docs/theory.md, "Softening over a length"): before each step,
 * of the plastic strain at its start, with the weight (1 - r^2 / R^2)^2 of a distance r and the
 * volumes of the points. The sum is over all points within R, one by one.
 *
 * To find them points stand in rows along x, R / 4 high and wide, which begin with the lowest point
 * of all ranks, so that the origin says nothing in it. Nor do ranks: a sum goes through its points
 * in the same order on any number of them. */
#include <math.h>
#include <stdlib.h>
#include "base/exchange.h"
#include "base/math/lanes.h"
#include "model/model_private.h"

#define ROWS 4                  /* of a radius */
#define MARGIN (1 + 2.0 / ROWS) /* radii: rows are asked that far, a row more than there is weight */
#define KEYS 7                  /* numbers that the order asks, one after the other */

/* A point of this rank, or one of another rank near it. */
typedef struct {
  PetscReal key[KEYS]; /* row along z and y; x, y, z; volume, and what is averaged */
  PetscInt own;        /* number of the point, -1 of another rank's */
} Part;
enum { ROW_Z, ROW_Y, AT, VOLUME = AT + 3, VALUE };

/* Points in order, column by column, and first points of rows. */
typedef struct {
  PetscInt n, n_rows, *row;
  Part *part;
  PetscReal *x[3], *volume, *value;
  PetscReal *sum; /* for each: of the weights, and of the weighted values */
} Rows;

/* What lies between the lowest and the highest place of points. */
typedef struct {
  PetscReal low[3], high[3];
} Extent;

static int compare(const void *a, const void *b)
{
  const PetscReal *left = ((const Part *)a)->key, *right = ((const Part *)b)->key;
  for (int k = 0; k < KEYS; ++k)
    if (left[k] != right[k]) return left[k] < right[k] ? -1 : 1;
  return 0;
}

/* The points of one material; volumes are those of now. */
static PetscErrorCode Gather(const Model *m, PetscInt material, PetscInt *n, Part **part)
{
  const PetscInt followed = m->materials[material].law->followed;
  const Points *points = m->points;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(points->n + 1, part));
  for (PetscInt p = 0; p < points->n; ++p) {
    Part *to = *part + *n;
    if (points->material[p] != material) continue;
    *to = (Part){.own = p};
    for (PetscInt d = 0; d < m->dim; ++d) to->key[AT + d] = point_real(points, POINT_X, p)[d];
    to->key[VOLUME] = points->real[POINT_VOLUME][p] * points->real[POINT_J][p];
    to->key[VALUE] = point_real(points, POINT_STATE, p)[followed];
    ++*n;
  }
  PetscFunctionReturn(0);
}

/* Of the points of each rank. */
static PetscErrorCode Extents(MPI_Comm comm, PetscInt n, const Part *part, Extent *extent)
{
  Extent own;

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; ++d) {
    own.low[d] = PETSC_MAX_REAL, own.high[d] = PETSC_MIN_REAL;
    for (PetscInt k = 0; k < n; ++k) {
      own.low[d] = PetscMin(own.low[d], part[k].key[AT + d]);
      own.high[d] = PetscMax(own.high[d], part[k].key[AT + d]);
    }
  }
  PetscCallMPI(MPI_Allgather(&own, 6, MPIU_REAL, extent, 6, MPIU_REAL, comm));
  PetscFunctionReturn(0);
}

static PetscBool is_near(const Part *part, const Extent *extent, PetscReal margin)
{
  for (int d = 0; d < 3; ++d) {
    const PetscReal x = part->key[AT + d];
    if (x < extent->low[d] - margin || x > extent->high[d] + margin) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* What other ranks' points are to hear of, message by message. */
static PetscErrorCode Pack(PetscMPIInt size, PetscInt n, const Part *part, const Extent *extent, PetscReal margin,
                           const PetscMPIInt *slot, const Exchange *e, Part **out)
{
  PetscInt at = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(e->to_start[e->n_to] + 1, out));
  for (PetscMPIInt r = 0; r < size; ++r) /* messages are in the order of ranks */
    for (PetscInt k = 0; k < n && slot[r] >= 0; ++k) {
      if (!is_near(part + k, extent + r, margin)) continue;
      (*out)[at] = part[k];
      (*out)[at++].own = -1;
    }
  PetscFunctionReturn(0);
}

/* Add the other ranks' points that are near ours. */
static PetscErrorCode Share(MPI_Comm comm, const Extent *extent, PetscReal margin, PetscInt *n, Part **part)
{
  PetscMPIInt size, rank, *slot;
  PetscInt *per_rank;
  Part *out, *all;
  Exchange e;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscCalloc2(size, &per_rank, size, &slot));
  for (PetscMPIInt r = 0; r < size; ++r)
    for (PetscInt k = 0; k < *n && r != rank; ++k) per_rank[r] += is_near(*part + k, extent + r, margin);
  PetscCall(ExchangeCreate(comm, size, per_rank, slot, &e));
  PetscCall(Pack(size, *n, *part, extent, margin, slot, &e, &out));
  PetscCall(PetscMalloc1(*n + e.from_start[e.n_from] + 1, &all));
  PetscCall(PetscArraycpy(all, *part, *n));
  PetscCall(ExchangeItems(&e, sizeof *all, PETSC_FALSE, (char *)out, (char *)(all + *n)));
  *n += e.from_start[e.n_from];
  PetscCall(ExchangeDestroy(&e));
  PetscCall(PetscFree2(per_rank, slot));
  PetscCall(PetscFree(out));
  PetscCall(PetscFree(*part));
  *part = all;
  PetscFunctionReturn(0);
}

/* Points of this rank, and those of others that weigh here, with the rows where they stand. */
static PetscErrorCode Collect(const Model *m, PetscInt material, PetscReal radius, PetscInt *n, Part **part)
{
  PetscMPIInt size;
  Extent *extent;
  PetscReal low[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  PetscCall(PetscMalloc1(size, &extent));
  PetscCall(Gather(m, material, n, part));
  PetscCall(Extents(m->comm, *n, *part, extent));
  if (size > 1) PetscCall(Share(m->comm, extent, MARGIN * radius, n, part));
  for (PetscMPIInt r = 0; r < size; ++r)
    for (int d = 0; d < 3; ++d) low[d] = PetscMin(low[d], extent[r].low[d]);
  for (PetscInt k = 0; k < *n; ++k) {
    PetscReal *key = (*part)[k].key;
    key[ROW_Z] = floor((key[AT + 2] - low[2]) / (radius / ROWS));
    key[ROW_Y] = floor((key[AT + 1] - low[1]) / (radius / ROWS));
  }
  PetscCall(PetscFree(extent));
  PetscFunctionReturn(0);
}

/* Lanes are read from the last point on, too. */
static PetscErrorCode RowsCreate(const Model *m, PetscInt material, PetscReal radius, Rows *rows)
{
  PetscInt n;
  Part *part;

  PetscFunctionBeginUser;
  PetscCall(Collect(m, material, radius, &n, &part));
  if (n) qsort(part, (size_t)n, sizeof *part, compare);
  *rows = (Rows){.n = n, .part = part};
  PetscCall(PetscCalloc5(n + LANES, &rows->x[0], n + LANES, &rows->x[1], n + LANES, &rows->x[2], n + LANES,
                         &rows->volume, n + LANES, &rows->value));
  PetscCall(PetscCalloc2(n + 1, &rows->row, 2 * n, &rows->sum));
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal *key = part[k].key;
    for (int d = 0; d < 3; ++d) rows->x[d][k] = key[AT + d];
    rows->volume[k] = key[VOLUME];
    rows->value[k] = key[VALUE];
    if (!k || key[ROW_Z] != part[k - 1].key[ROW_Z] || key[ROW_Y] != part[k - 1].key[ROW_Y])
      rows->row[rows->n_rows++] = k;
  }
  rows->row[rows->n_rows] = n;
  PetscFunctionReturn(0);
}

static PetscErrorCode RowsDestroy(Rows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(rows->x[0], rows->x[1], rows->x[2], rows->volume, rows->value));
  PetscCall(PetscFree2(rows->row, rows->sum));
  PetscCall(PetscFree(rows->part));
  PetscFunctionReturn(0);
}

/* Number of the row there, -1 if nothing stands in it. */
static PetscInt row_at(const Rows *rows, PetscReal z, PetscReal y)
{
  PetscInt low = 0, high = rows->n_rows;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    const PetscReal *key = rows->part[rows->row[middle]].key;
    if (key[ROW_Z] == z && key[ROW_Y] == y) return middle;
    if (key[ROW_Z] < z || (key[ROW_Z] == z && key[ROW_Y] < y)) low = middle + 1;
    else high = middle;
  }
  return -1;
}

static PetscReal sum_of(const Lanes *lanes)
{
  PetscReal sum = 0;
  for (int i = 0; i < LANES; ++i) sum += (*lanes)[i];
  return sum;
}

/* What the points from `first` to before `end` give to point k. */
static void add_points(const Rows *rows, PetscInt k, PetscInt first, PetscInt end, PetscReal per_radius2)
{
  const PetscReal x = rows->x[0][k], y = rows->x[1][k], z = rows->x[2][k];
  const Lanes none = {0};
  Lanes number, weights = none, values = none;
  for (int i = 0; i < LANES; ++i) number[i] = i;
  for (PetscInt q = first; q < end; q += LANES) {
    const Lanes dx = *(const LanesAnywhere *)(rows->x[0] + q) - x, dy = *(const LanesAnywhere *)(rows->x[1] + q) - y;
    const Lanes dz = *(const LanesAnywhere *)(rows->x[2] + q) - z;
    const Lanes part = 1 - (dx * dx + dy * dy + dz * dz) * per_radius2;
    const LaneBits counts = (part > 0) & (number < (PetscReal)(end - q));
    const Lanes weight = part * part * *(const LanesAnywhere *)(rows->volume + q);
    Lanes counted;
    lanes_select(&counts, &weight, &none, &counted);
    weights += counted;
    values += counted * *(const LanesAnywhere *)(rows->value + q);
  }
  rows->sum[2 * k] += sum_of(&weights);
  rows->sum[2 * k + 1] += sum_of(&values);
}

/* What a row gives to the points of another one: from x - reach to x + reach, which move on with x. */
static void add_row(const Rows *rows, PetscInt to, PetscInt from, PetscReal reach, PetscReal per_radius2)
{
  const PetscReal *x = rows->x[0];
  const PetscInt all = rows->row[from + 1];
  PetscInt first = rows->row[from], end = first;
  for (PetscInt k = rows->row[to]; k < rows->row[to + 1]; ++k) {
    if (rows->part[k].own < 0) continue;
    while (first < all && x[first] < x[k] - reach) ++first;
    while (end < all && x[end] <= x[k] + reach) ++end;
    if (first < end) add_points(rows, k, first, end, per_radius2);
  }
}

/* Least distance of rows that are so many apart. */
static PetscReal gap(int apart, PetscReal radius) { return PetscMax(PetscAbs(apart) - 1, 0) * radius / ROWS; }

/* Rows R apart have no weight for each other. */
static void add_rows(const Rows *rows, PetscInt to, PetscInt dim, PetscReal radius)
{
  const PetscReal *key = rows->part[rows->row[to]].key;
  const int across = dim == 3 ? ROWS : 0;
  for (int z = -across; z <= across; ++z)
    for (int y = -ROWS; y <= ROWS; ++y) {
      const PetscReal reach2 = PetscSqr(radius) - PetscSqr(gap(y, radius)) - PetscSqr(gap(z, radius));
      const PetscInt from = reach2 > 0 ? row_at(rows, key[ROW_Z] + z, key[ROW_Y] + y) : -1;
      if (from >= 0) add_row(rows, to, from, PetscSqrtReal(reach2), 1 / PetscSqr(radius));
    }
}

/* The point itself is among them: there is always a weight. */
static PetscErrorCode Hear(Model *m, PetscInt i, PetscReal radius)
{
  const Material *material = &m->materials[i];
  Rows rows;

  PetscFunctionBeginUser;
  PetscCall(RowsCreate(m, i, radius, &rows));
  for (PetscInt r = 0; r < rows.n_rows; ++r) add_rows(&rows, r, m->dim, radius);
  for (PetscInt k = 0; k < rows.n; ++k) {
    const PetscInt p = rows.part[k].own;
    if (p < 0) continue;
    material->law->hear(material->parameters, rows.sum[2 * k + 1] / rows.sum[2 * k],
                        point_real(m->points, POINT_STATE, p));
  }
  PetscCall(RowsDestroy(&rows));
  PetscFunctionReturn(0);
}

PetscErrorCode NonlocalStep(Model *m)
{
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  for (PetscInt i = 0; i < m->c->n_materials; ++i) {
    const Material *material = &m->materials[i];
    const PetscReal radius = material->law->reach ? material->law->reach(material->parameters) : 0;
    if (radius > 0) PetscCall(Hear(m, i, radius));
  }
  PetscCall(PhaseEnd(m->seconds, PHASE_PREPARE, &clock));
  PetscFunctionReturn(0);
}
