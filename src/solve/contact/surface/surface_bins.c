/* Points of a surface in order, and found by where they are. */
#include <stdlib.h>
#include "solve/contact/surface/surface.h"

#define MOST_BINS 8 /* times as many as there are points: beyond, bins are larger */

static int compare(const void *a, const void *b)
{
  const SurfacePoint *p = a, *q = b;
  if (p->x[0] != q->x[0]) return p->x[0] < q->x[0] ? -1 : 1;
  return (p->id > q->id) - (p->id < q->id);
}

/* As many bins along each axis as it takes, few enough in all. */
static void size_bins(SurfaceBins *b, const PetscReal max[3], PetscInt n)
{
  const PetscReal most = MOST_BINS * (PetscReal)n;
  for (;; b->side *= 1.5) {
    PetscReal all = 1;
    for (int d = 0; d < 3; ++d) {
      const PetscReal count = 1 + PetscFloorReal((max[d] - b->min[d]) / b->side);
      all *= count;
      b->counts[d] = (PetscInt)PetscMin(count, most);
    }
    if (all <= most) return;
  }
}

static PetscInt bin_along(const SurfaceBins *b, int d, PetscReal x)
{
  const PetscReal at = PetscFloorReal((x - b->min[d]) / b->side);
  return (PetscInt)PetscMax(-1, PetscMin(at, (PetscReal)b->counts[d]));
}

static PetscInt bin_of(const SurfaceBins *b, const PetscReal *x)
{
  return bin_along(b, 0, x[0]) + b->counts[0] * (bin_along(b, 1, x[1]) + b->counts[1] * bin_along(b, 2, x[2]));
}

static PetscErrorCode FillBins(Surface *s)
{
  SurfaceBins *b = &s->bins;
  const PetscInt n = b->counts[0] * b->counts[1] * b->counts[2];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n + 2, &b->start));
  PetscCall(PetscMalloc1(s->n, &b->point));
  for (PetscInt k = 0; k < s->n; ++k) ++b->start[bin_of(b, s->point[k].x) + 2];
  for (PetscInt k = 0; k < n; ++k) b->start[k + 2] += b->start[k + 1];
  for (PetscInt k = 0; k < s->n; ++k) b->point[b->start[bin_of(b, s->point[k].x) + 1]++] = k;
  PetscFunctionReturn(0);
}

PetscErrorCode SurfaceSort(Surface *s, PetscReal side)
{
  PetscReal max[3] = {0};

  PetscFunctionBeginUser;
  s->bins = (SurfaceBins){.side = side};
  if (!s->n) PetscFunctionReturn(0);
  qsort(s->point, (size_t)s->n, sizeof *s->point, compare);
  for (int d = 0; d < 3; ++d) s->bins.min[d] = max[d] = s->point[0].x[d];
  for (PetscInt k = 0; k < s->n; ++k)
    for (int d = 0; d < 3; ++d) {
      s->bins.min[d] = PetscMin(s->bins.min[d], s->point[k].x[d]);
      max[d] = PetscMax(max[d], s->point[k].x[d]);
    }
  size_bins(&s->bins, max, s->n);
  PetscCall(FillBins(s));
  PetscFunctionReturn(0);
}

/* On to the next bin that holds something; NULL: there is none. */
static const SurfacePoint *next_bin(SurfaceWalk *w)
{
  const SurfaceBins *b = &w->surface->bins;
  for (;;) {
    int d = 0;
    while (d < 3 && ++w->bin[d] > w->hi[d]) w->bin[d] = w->lo[d], ++d;
    if (d == 3) return NULL;
    const PetscInt bin = w->bin[0] + b->counts[0] * (w->bin[1] + b->counts[1] * w->bin[2]);
    w->k = b->start[bin], w->end = b->start[bin + 1];
    if (w->k < w->end) return w->surface->point + b->point[w->k++];
  }
}

const SurfacePoint *surface_first(const Surface *s, const PetscReal *x, PetscReal radius, SurfaceWalk *w)
{
  const SurfaceBins *b = &s->bins;
  *w = (SurfaceWalk){.surface = s};
  if (!s->n) return NULL;
  for (int d = 0; d < 3; ++d) {
    w->lo[d] = PetscMax(bin_along(b, d, x[d] - radius), 0);
    w->hi[d] = PetscMin(bin_along(b, d, x[d] + radius), b->counts[d] - 1);
    if (w->lo[d] > w->hi[d]) return NULL;
    w->bin[d] = w->lo[d];
  }
  --w->bin[0];
  return next_bin(w);
}

const SurfacePoint *surface_next(SurfaceWalk *w)
{
  return w->k < w->end ? w->surface->point + w->surface->bins.point[w->k++] : next_bin(w);
}
