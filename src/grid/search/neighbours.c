#include "grid/search/neighbours.h"
#include "base/math/lanes.h"

/* Bins over the bounding box; stragglers far away must not make them countless. */
static void choose_bins(Neighbours *b, PetscInt n, const PetscReal *min, const PetscReal *max, PetscReal size)
{
  const PetscReal most = 4 * (PetscReal)n + 1000;
  b->size = size;
  for (PetscReal total = most + 1; total > most; b->size *= 1.5) {
    total = 1;
    for (PetscInt d = 0; d < b->dim; ++d) total *= PetscFloorReal((max[d] - min[d]) / b->size) + 1;
    if (total <= most) break;
  }
  for (PetscInt d = 0; d < 3; ++d) {
    b->origin[d] = d < b->dim ? min[d] : 0;
    b->counts[d] = d < b->dim ? (PetscInt)((max[d] - min[d]) / b->size) + 1 : 1;
  }
}

static inline PetscInt bin_along(const Neighbours *b, PetscInt d, PetscReal x)
{
  const PetscReal k = (x - b->origin[d]) / b->size;
  return k < 0 ? 0 : k >= (PetscReal)b->counts[d] ? b->counts[d] - 1 : (PetscInt)k;
}

static inline PetscInt bin_of(const Neighbours *b, const PetscReal *x)
{
  PetscInt bin = 0;
  for (PetscInt d = b->dim - 1; d >= 0; --d) bin = bin * b->counts[d] + bin_along(b, d, x[d]);
  return bin;
}

static inline PetscBool is_taken(const unsigned char *skip, PetscInt i) { return !skip || !skip[i]; }

/* Bounds of the positions taken; returns how many there are. */
static PetscInt bounds_of(PetscInt dim, PetscInt n, const PetscReal *at, const unsigned char *skip, PetscReal min[3],
                          PetscReal max[3])
{
  PetscInt taken = 0;
  for (PetscInt i = 0; i < n; ++i) {
    if (!is_taken(skip, i)) continue;
    for (PetscInt d = 0; d < dim; ++d) {
      min[d] = taken ? PetscMin(min[d], at[i * dim + d]) : at[i * dim + d];
      max[d] = taken ? PetscMax(max[d], at[i * dim + d]) : at[i * dim + d];
    }
    ++taken;
  }
  return taken;
}

PetscErrorCode NeighboursCreate(PetscInt dim, PetscInt n, const PetscReal *x, PetscInt n_more, const PetscReal *more,
                                const unsigned char *skip, PetscReal size, Neighbours *b)
{
  PetscReal min[3] = {0, 0, 0}, max[3] = {0, 0, 0};
  const PetscInt n_all = n + n_more;

  PetscFunctionBeginUser;
  *b = (Neighbours){.dim = dim};
  PetscCall(PetscMalloc3(n_all, &b->item, n_all * dim, &b->x, n_all * dim, &b->at));
  PetscCall(PetscArraycpy(b->at, x, n * dim));
  PetscCall(PetscArraycpy(b->at + n * dim, more, n_more * dim));
  b->n = bounds_of(dim, n_all, b->at, skip, min, max);
  choose_bins(b, b->n, min, max, size);
  const PetscInt bins = b->counts[0] * b->counts[1] * b->counts[2];
  PetscCall(PetscCalloc1(bins + 2, &b->start));
  /* next[k]: first the start of bin k, in the end its end, the start of bin k + 1 */
  PetscInt *next = b->start + 1;
  for (PetscInt i = 0; i < n_all; ++i)
    if (is_taken(skip, i)) ++next[bin_of(b, b->at + i * dim) + 1];
  for (PetscInt k = 0; k < bins; ++k) next[k + 1] += next[k];
  for (PetscInt i = 0; i < n_all; ++i) {
    if (!is_taken(skip, i)) continue;
    const PetscInt place = next[bin_of(b, b->at + i * dim)]++;
    b->item[place] = i;
    for (PetscInt d = 0; d < dim; ++d) b->x[place * dim + d] = b->at[i * dim + d];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode NeighboursDestroy(Neighbours *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(b->start));
  PetscCall(PetscFree3(b->item, b->x, b->at));
  PetscFunctionReturn(0);
}

/* The order of two positions at the same distance: by coordinates, since numbers are not the same
 * on any number of ranks. */
static inline PetscBool stands_behind(const Neighbours *b, PetscInt i, PetscInt j)
{
  for (PetscInt d = 0; d < b->dim; ++d) {
    const PetscReal off = b->at[i * b->dim + d] - b->at[j * b->dim + d];
    if (off != 0) return off > 0;
  }
  return PETSC_FALSE;
}

/* Insert among n by distance; clouds are small. If there are max already, the farthest gives
 * way. */
static inline PetscInt insert(const Neighbours *b, PetscInt n, PetscInt max, PetscInt *item, PetscReal *distance2,
                              PetscInt i, PetscReal d2)
{
  if (n == max && d2 >= distance2[n - 1]) return n;
  PetscInt k = n == max ? n - 1 : n;
  for (; k > 0 && (distance2[k - 1] > d2 || (distance2[k - 1] == d2 && stands_behind(b, item[k - 1], i))); --k) {
    item[k] = item[k - 1];
    distance2[k] = distance2[k - 1];
  }
  item[k] = i;
  distance2[k] = d2;
  return n == max ? n : n + 1;
}

/* The bins that a ball of this radius meets. */
typedef struct {
  PetscInt lo[3], hi[3];
} Range;

static inline Range range_around(const Neighbours *b, const PetscReal *x, PetscReal radius)
{
  Range r = {{0, 0, 0}, {0, 0, 0}};
  for (PetscInt d = 0; d < b->dim; ++d) {
    r.lo[d] = bin_along(b, d, x[d] - radius);
    r.hi[d] = bin_along(b, d, x[d] + radius);
  }
  return r;
}

/* How far in space a distance may be. */
static inline PetscReal reach_of(const NeighboursMap *map, PetscReal radius)
{
  return map ? map->longest * radius : radius;
}

/* One after the other into their places: for any number of them, and where distances are equal. */
static PetscInt insert_all(const Neighbours *b, const NeighboursMap *map, const PetscReal *x, PetscReal radius,
                           PetscInt max, PetscInt *item, PetscReal *distance2)
{
  const Range r = range_around(b, x, reach_of(map, radius));
  PetscInt n = 0;
  for (PetscInt k = r.lo[2]; k <= r.hi[2]; ++k)
    for (PetscInt j = r.lo[1]; j <= r.hi[1]; ++j) {
      const PetscInt row = (k * b->counts[1] + j) * b->counts[0];
      for (PetscInt e = b->start[row + r.lo[0]]; e < b->start[row + r.hi[0] + 1]; ++e) {
        const PetscReal d2 = neighbours_square(b->dim, map, b->x + e * b->dim, x);
        if (d2 < radius * radius) n = insert(b, n, max, item, distance2, b->item[e], d2);
      }
    }
  return n;
}

#define FEW (8 * LANES)

/* All of them as they come; -1 if there are more than FEW. Without a branch, since which are near
 * enough cannot be foretold. */
static inline __attribute__((always_inline)) PetscInt collect(const PetscInt dim, const NeighboursMap *map,
                                                              const Neighbours *b, const PetscReal *x, PetscReal radius,
                                                              PetscInt *item, PetscReal *distance2)
{
  const Range r = range_around(b, x, reach_of(map, radius));
  const PetscReal limit = radius * radius;
  PetscInt n = 0;
  for (PetscInt k = r.lo[2]; k <= r.hi[2]; ++k)
    for (PetscInt j = r.lo[1]; j <= r.hi[1]; ++j) {
      const PetscInt row = (k * b->counts[1] + j) * b->counts[0];
      for (PetscInt e = b->start[row + r.lo[0]]; e < b->start[row + r.hi[0] + 1]; ++e) {
        const PetscReal d2 = neighbours_square(dim, map, b->x + e * dim, x);
        item[n] = b->item[e];
        distance2[n] = d2;
        n += d2 < limit;
        if (n > FEW) return -1;
      }
    }
  return n;
}

/* The place of each among all, by counting the nearer ones; PETSC_FALSE if two are at the same
 * distance. */
static inline PetscBool count_nearer(PetscInt n, PetscReal *distance2, PetscInt *place)
{
  const PetscInt packs = (n + LANES - 1) / LANES;
  LaneBits nearer[FEW / LANES] = {{0}}, equal[FEW / LANES] = {{0}};
  Lanes d[FEW / LANES];
  for (PetscInt i = n; i < packs * LANES; ++i) distance2[i] = PETSC_MAX_REAL;
  memcpy(d, distance2, (size_t)(packs * LANES) * sizeof *distance2);
  for (PetscInt i = 0; i < n; ++i) {
    const Lanes one = distance2[i] - (Lanes){0};
    for (PetscInt k = 0; k < packs; ++k) {
      nearer[k] -= one < d[k];
      equal[k] -= one == d[k];
    }
  }
  PetscInt alone = 0;
  for (PetscInt i = 0; i < n; ++i) {
    place[i] = (PetscInt)nearer[i / LANES][i % LANES];
    alone += equal[i / LANES][i % LANES] == 1;
  }
  return alone == n;
}

/* In order, of those collected; all again where that is not to be had. */
static inline PetscInt in_order(const Neighbours *b, const NeighboursMap *map, const PetscReal *x, PetscReal radius,
                                PetscInt max, PetscInt n, const PetscInt *near, PetscReal *d2, PetscInt *item,
                                PetscReal *distance2)
{
  PetscInt place[FEW];
  if (n < 0 || n > max || !count_nearer(n, d2, place)) return insert_all(b, map, x, radius, max, item, distance2);
  for (PetscInt i = 0; i < n; ++i) {
    item[place[i]] = near[i];
    distance2[place[i]] = d2[i];
  }
  return n;
}

PetscInt neighbours_within(const Neighbours *b, const PetscReal *x, PetscReal radius, PetscInt max, PetscInt *item,
                           PetscReal *distance2)
{
  PetscInt near[FEW + 1];
  PetscReal d2[FEW + 1];
  const PetscInt n = b->dim == 2 ? collect(2, NULL, b, x, radius, near, d2) : collect(3, NULL, b, x, radius, near, d2);
  return in_order(b, NULL, x, radius, max, n, near, d2, item, distance2);
}

PetscInt neighbours_mapped(const Neighbours *b, const NeighboursMap *map, const PetscReal *x, PetscReal radius,
                           PetscInt max, PetscInt *item, PetscReal *distance2)
{
  PetscInt near[FEW + 1];
  PetscReal d2[FEW + 1];
  if (!map) return neighbours_within(b, x, radius, max, item, distance2);
  const PetscInt n = b->dim == 2 ? collect(2, map, b, x, radius, near, d2) : collect(3, map, b, x, radius, near, d2);
  return in_order(b, map, x, radius, max, n, near, d2, item, distance2);
}
