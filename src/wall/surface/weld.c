/* Corners of triangles that coincide become one vertex, and their sides edges. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include "grid/search/tuple_table.h"
#include "wall/surface/triangles.h"

PetscErrorCode TrianglesAllocate(PetscInt n, Triangles *t)
{
  PetscFunctionBeginUser;
  t->n = n;
  PetscCall(PetscMalloc1(n, &t->corner));
  PetscCall(PetscMalloc1(n, &t->number));
  for (PetscInt i = 0; i < n; ++i) t->number[i] = i + 1;
  t->epsilon = FLT_EPSILON;
  PetscFunctionReturn(0);
}

PetscErrorCode TrianglesFree(Triangles *t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(t->corner));
  PetscCall(PetscFree(t->number));
  PetscCall(PetscFree(t->x));
  PetscCall(PetscFree(t->vertex));
  PetscCall(PetscFree(t->edge));
  PetscCall(PetscFree(t->side));
  PetscCall(PetscFree(t->met));
  PetscCall(PetscFree(t->normal));
  PetscFunctionReturn(0);
}

/* Vertices by the bin of 2 tolerances that they lie in. */
typedef struct {
  size_t mask;
  PetscInt *first, *next; /* vertex + 1, 0: none */
} Bins;

static size_t bin_of(const Bins *bins, const int64_t cell[3])
{
  uint64_t h = 0x9e3779b97f4a7c15u;
  for (int d = 0; d < 3; ++d) {
    h = (h ^ (uint64_t)cell[d]) * 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  }
  return (size_t)h & bins->mask;
}

static PetscBool coincide(const PetscReal *a, const PetscReal *b, PetscReal tolerance)
{
  return fabs(a[0] - b[0]) <= tolerance && fabs(a[1] - b[1]) <= tolerance && fabs(a[2] - b[2]) <= tolerance;
}

/* What lies within the tolerance of x is in its bin or, where x is near a side of it, beyond that
 * side. */
static PetscInt find_vertex(const Triangles *t, const Bins *bins, const PetscReal x[3])
{
  int64_t low[3], high[3], cell[3];
  for (int d = 0; d < 3; ++d) {
    low[d] = (int64_t)floor((x[d] - t->tolerance) / (2 * t->tolerance));
    high[d] = (int64_t)floor((x[d] + t->tolerance) / (2 * t->tolerance));
  }
  for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0])
    for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
      for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2])
        for (PetscInt v = bins->first[bin_of(bins, cell)]; v; v = bins->next[v - 1])
          if (coincide(t->x + 3 * (v - 1), x, t->tolerance)) return v - 1;
  return -1;
}

static PetscInt add_vertex(Triangles *t, Bins *bins, const PetscReal x[3])
{
  const PetscInt v = t->n_vertices++;
  int64_t cell[3];
  for (int d = 0; d < 3; ++d) {
    t->x[3 * v + d] = x[d];
    cell[d] = (int64_t)floor(x[d] / (2 * t->tolerance));
  }
  const size_t bin = bin_of(bins, cell);
  bins->next[v] = bins->first[bin];
  bins->first[bin] = v + 1;
  return v;
}

static void set_tolerance(Triangles *t)
{
  const PetscReal *x = (const PetscReal *)t->corner;
  PetscReal largest = 0;
  for (PetscInt i = 0; i < 9 * t->n; ++i) largest = PetscMax(largest, fabs(x[i]));
  t->tolerance = PetscMax(4 * t->epsilon * largest, 1e-100);
}

/* Keep triangles of three different vertices. */
static void leave_out(Triangles *t, PetscInt *left_out, PetscInt *first)
{
  PetscInt n = 0;
  *left_out = 0;
  for (PetscInt i = 0; i < t->n; ++i) {
    const PetscInt *v = t->vertex[i];
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
      if (!(*left_out)++) *first = t->number[i];
      continue;
    }
    for (int k = 0; k < 3; ++k) t->vertex[n][k] = v[k];
    t->number[n++] = t->number[i];
  }
  t->n = n;
}

PetscErrorCode TrianglesWeld(Triangles *t, PetscInt *left_out, PetscInt *first)
{
  const size_t corners = 3 * (size_t)t->n;
  Bins bins = {.mask = 15};

  PetscFunctionBeginUser;
  while (bins.mask < corners) bins.mask = 2 * bins.mask + 1;
  PetscCall(PetscCalloc1(bins.mask + 1, &bins.first));
  PetscCall(PetscMalloc1(corners, &bins.next));
  PetscCall(PetscMalloc1(3 * corners, &t->x));
  PetscCall(PetscMalloc1(t->n, &t->vertex));
  set_tolerance(t);
  for (PetscInt i = 0; i < t->n; ++i)
    for (int k = 0; k < 3; ++k) {
      const PetscInt v = find_vertex(t, &bins, t->corner[i][k]);
      t->vertex[i][k] = v >= 0 ? v : add_vertex(t, &bins, t->corner[i][k]);
    }
  leave_out(t, left_out, first);
  PetscCall(PetscFree(bins.first));
  PetscCall(PetscFree(bins.next));
  PetscFunctionReturn(0);
}

PetscErrorCode TrianglesJoin(Triangles *t)
{
  TupleTable *table;

  PetscFunctionBeginUser;
  PetscCall(TupleTableCreate(2, 3 * t->n, &table));
  PetscCall(PetscMalloc1(t->n, &t->edge));
  PetscCall(PetscMalloc1(3 * t->n, &t->side));
  PetscCall(PetscCalloc1(3 * t->n, &t->met));
  for (PetscInt i = 0; i < t->n; ++i)
    for (int k = 0; k < 3; ++k) {
      const PetscInt ends[2] = {t->vertex[i][k], t->vertex[i][(k + 1) % 3]}, e = tuple_add(table, ends);
      t->edge[i][k] = e;
      if (t->met[e] == 0) t->side[e][1] = -1;
      if (t->met[e] < 2) t->side[e][t->met[e]] = 3 * i + k;
      ++t->met[e];
    }
  t->n_edges = tuple_count(table);
  PetscCall(TupleTableDestroy(&table));
  PetscFunctionReturn(0);
}
