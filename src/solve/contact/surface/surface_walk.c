/* Points of a surface by their places.
 *
 * They stand in rows along x, side by side across the other axes, and ascend along x in each: so those near a place
 * are found by bisection, without a table. In the plane all are one row. */
#include <stdlib.h>
#include "solve/contact/surface/surface.h"

#define WIDE 2      /* of the size of a point: a row */
#define NARROW 1e-6 /* of the surface: at least so wide */

static int compare(const void *a, const void *b)
{
  const SurfacePoint *p = a, *q = b;
  for (int d = 1; d >= 0; --d)
    if (p->row[d] != q->row[d]) return p->row[d] < q->row[d] ? -1 : 1;
  if (p->x[0] != q->x[0]) return p->x[0] < q->x[0] ? -1 : 1;
  return (p->id > q->id) - (p->id < q->id);
}

/* Where rows begin, and how wide they are. */
static void lay_rows(Surface *s)
{
  PetscReal high[2] = {0, 0};
  s->reach = s->side = s->low[0] = s->low[1] = 0;
  for (PetscInt k = 0; k < s->n; ++k) {
    const SurfacePoint *p = s->point + k;
    s->reach = PetscMax(s->reach, p->reach);
    s->side = PetscMax(s->side, WIDE * p->size);
    for (int d = 0; d < 2; ++d) {
      s->low[d] = k ? PetscMin(s->low[d], p->x[1 + d]) : p->x[1 + d];
      high[d] = k ? PetscMax(high[d], p->x[1 + d]) : p->x[1 + d];
    }
  }
  for (int d = 0; d < 2; ++d) s->side = PetscMax(s->side, NARROW * (high[d] - s->low[d]));
  for (int d = 0; d < 2; ++d)
    s->rows[d] = s->dim == 3 && s->side > 0 ? 1 + (PetscInt)PetscFloorReal((high[d] - s->low[d]) / s->side) : 1;
}

/* Kept within the rows that there are, and one beyond. */
static PetscInt row_at(const Surface *s, int d, PetscReal x)
{
  if (s->rows[d] == 1) return 0;
  const PetscReal row = PetscFloorReal((x - s->low[d]) / s->side);
  return (PetscInt)PetscMax(-1, PetscMin((PetscReal)s->rows[d], row));
}

void surface_sort(Surface *s)
{
  lay_rows(s);
  for (PetscInt k = 0; k < s->n; ++k)
    for (int d = 0; d < 2; ++d) s->point[k].row[d] = row_at(s, d, s->point[k].x[1 + d]);
  if (s->n) qsort(s->point, (size_t)s->n, sizeof *s->point, compare);
}

/* Index of the first point of the row that is at least at x. */
static PetscInt first_at(const Surface *s, const PetscInt row[2], PetscReal x)
{
  const SurfacePoint key = {.row = {row[0], row[1]}, .x = {x}, .id = -1};
  PetscInt lo = 0, hi = s->n;
  while (lo < hi) {
    const PetscInt middle = lo + (hi - lo) / 2;
    if (compare(s->point + middle, &key) < 0) lo = middle + 1;
    else hi = middle;
  }
  return lo;
}

SurfaceWalk surface_walk(const Surface *s, const PetscReal x[3], PetscReal distance)
{
  SurfaceWalk w = {.surface = s, .low = x[0] - distance, .high = x[0] + distance};
  for (int d = 0; d < 2; ++d) {
    w.from[d] = w.row[d] = PetscMax(0, row_at(s, d, x[1 + d] - distance));
    w.to[d] = PetscMin(s->rows[d] - 1, row_at(s, d, x[1 + d] + distance));
  }
  const PetscBool any = (PetscBool)(w.from[0] <= w.to[0] && w.from[1] <= w.to[1]);
  if (any) w.next = first_at(s, w.row, w.low);
  else w.next = s->n, w.row[1] = w.to[1];
  return w;
}

/* On to the next row. */
static PetscBool change_row(SurfaceWalk *w)
{
  if (w->row[0] < w->to[0]) ++w->row[0];
  else if (w->row[1] < w->to[1]) w->row[0] = w->from[0], ++w->row[1];
  else return PETSC_FALSE;
  w->next = first_at(w->surface, w->row, w->low);
  return PETSC_TRUE;
}

const SurfacePoint *surface_next(SurfaceWalk *w)
{
  do {
    const SurfacePoint *p = w->surface->point + w->next;
    if (w->next < w->surface->n && p->row[0] == w->row[0] && p->row[1] == w->row[1] && p->x[0] <= w->high) {
      ++w->next;
      return p;
    }
  } while (change_row(w));
  return NULL;
}
