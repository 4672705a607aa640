/* Points in the order of their cells: the point loop then meets a cell's nodes once, and neighbours
 * in memory are neighbours in space. A counting sort over the cells, so that the cost is linear;
 * lost points stand last. */
#include <stdlib.h>
#include "points/fields.h"

/* Lost points get the largest key. */
static inline PetscInt sort_key(const Points *points, PetscInt p)
{
  return points->cell[p] < 0 ? PETSC_MAX_INT : points->cell[p];
}

/* The order inside a cell. */
static inline int before(const Points *points, PetscInt p, PetscInt q)
{
  if (points->material[p] != points->material[q]) return points->material[p] < points->material[q];
  return points->id[p] < points->id[q];
}

static PetscBool is_sorted(const Points *points)
{
  for (PetscInt p = 1; p < points->n; ++p) {
    const PetscInt a = sort_key(points, p - 1), b = sort_key(points, p);
    if (a > b || (a == b && before(points, p, p - 1))) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static int compare(const void *a, const void *b, void *points)
{
  const PetscInt p = *(const PetscInt *)a, q = *(const PetscInt *)b;
  return before(points, q, p) - before(points, p, q);
}

/* Order the points of one cell. They are few and mostly in order already: insertion, unless there
 * are many. */
static void sort_run(Points *points, PetscInt n, PetscInt *order)
{
  if (n > 64) {
    qsort_r(order, (size_t)n, sizeof *order, compare, points);
    return;
  }
  for (PetscInt i = 1; i < n; ++i) {
    const PetscInt p = order[i];
    PetscInt j = i;
    for (; j > 0 && before(points, p, order[j - 1]); --j) order[j] = order[j - 1];
    order[j] = p;
  }
}

/* order[k]: which point belongs at place k. count has room for n_keys + 1. */
static void counting_order(Points *points, PetscInt n_keys, PetscInt *count, PetscInt *order)
{
  const PetscInt lost = n_keys - 1;
  for (PetscInt p = 0; p < points->n; ++p) ++count[PetscMin(sort_key(points, p), lost) + 1];
  for (PetscInt c = 0; c < n_keys; ++c) count[c + 1] += count[c];
  for (PetscInt p = 0; p < points->n; ++p) order[count[PetscMin(sort_key(points, p), lost)]++] = p;
  for (PetscInt c = 0, start = 0; c < n_keys; start = count[c++]) sort_run(points, count[c] - start, order + start);
}

static PetscBool is_first_of_size(const Points *points, int field, size_t size)
{
  size_t bytes;
  for (int f = 0; f < field; ++f) {
    (void)points_field(points, f, &bytes);
    if (bytes == size) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Every field is gathered into a spare array of its size, which becomes the field's, and the field's the spare one
 * for the next of that size: nothing is copied back. */
static PetscErrorCode Permute(Points *points, const PetscInt *order)
{
  PetscFunctionBeginUser;
  for (int f = 0; f < N_FIELDS; ++f) {
    size_t size, bytes;
    char *spare;
    (void)points_field(points, f, &size);
    if (!size || !is_first_of_size(points, f, size)) continue;
    PetscCall(PetscMalloc1(size * (size_t)points->capacity, &spare));
    for (int other = f; other < N_FIELDS; ++other) {
      char *data = points_field(points, other, &bytes);
      if (bytes != size) continue;
      field_gather(spare, data, bytes, points->n, order);
      points_set_field(points, other, spare);
      spare = data;
    }
    PetscCall(PetscFree(spare));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PointsSort(Points *points)
{
  PetscInt n_keys = 0, *count, *order;
  PetscFunctionBeginUser;
  if (is_sorted(points)) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < points->n; ++p) n_keys = PetscMax(n_keys, points->cell[p] + 1);
  ++n_keys; /* the lost */
  PetscCall(PetscCalloc1(n_keys + 1, &count));
  PetscCall(PetscMalloc1(points->n, &order));
  counting_order(points, n_keys, count, order);
  PetscCall(Permute(points, order));
  PetscCall(PetscFree(order));
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}
