/* Fields without what scatters from point to point: the mean of the points around each, of its own body. Vectors and
 * tensors are averaged before they become one number: the mean of speeds is not the speed of the mean. */
#include "grid/search/neighbours.h"
#include "picture/raster/spacing.h"
#include "picture/scene/scene.h"

/* Of a ball that fills a body together with its neighbours: some two distances from point to point. */
#define REACH 3.0
enum { MOST_AROUND = 128 };

/* Points that have a place, behind each other. */
typedef struct {
  PetscInt dim, n, *of;
  PetscReal *at, reach; /* n x dim; m */
} Placed;

static PetscErrorCode PlacedCreate(PetscInt dim, PetscInt n, const PetscReal *x, Placed *p)
{
  PetscReal *spread, *radius, median = 0;

  PetscFunctionBeginUser;
  *p = (Placed){.dim = dim};
  PetscCall(PetscMalloc2(n, &p->of, n * dim, &p->at));
  PetscCall(PetscMalloc2(3 * n, &spread, n, &radius));
  for (PetscInt i = 0; i < n; ++i) {
    if (!plot_has_place(x + 3 * i)) continue;
    for (PetscInt d = 0; d < 3; ++d) spread[3 * p->n + d] = x[3 * i + d];
    for (PetscInt d = 0; d < dim; ++d) p->at[p->n * dim + d] = x[3 * i + d];
    p->of[p->n++] = i;
  }
  PetscCall(PlotSpacing(dim, p->n, spread, radius));
  if (p->n) PetscCall(PlotQuantile(p->n, radius, 0.5, &median));
  p->reach = REACH * median;
  PetscCall(PetscFree2(spread, radius));
  PetscFunctionReturn(0);
}

/* Into mean (components numbers). */
static void mean_around(const Placed *p, const Neighbours *points, PetscInt k, const PetscReal *body,
                        PetscInt components, const PetscReal *data, PetscReal *mean)
{
  PetscInt item[MOST_AROUND];
  PetscReal square[MOST_AROUND], all = 0;
  const PetscInt n = neighbours_within(points, p->at + k * p->dim, p->reach, MOST_AROUND, item, square);
  for (PetscInt c = 0; c < components; ++c) mean[c] = 0;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt q = p->of[item[i]];
    const PetscReal weight = PetscSqr(1 - square[i] / PetscSqr(p->reach));
    if (body && body[q] != body[p->of[k]]) continue;
    for (PetscInt c = 0; c < components; ++c) mean[c] += weight * data[q * components + c];
    all += weight;
  }
  for (PetscInt c = 0; c < components; ++c) mean[c] = all > 0 ? mean[c] / all : data[p->of[k] * components + c];
}

PetscErrorCode PlotSmooth(PetscInt dim, PetscInt n, const PetscReal *x, const PetscReal *body, PetscInt components,
                          PetscReal *data)
{
  Neighbours points;
  PetscReal *means;
  Placed p;

  PetscFunctionBeginUser;
  PetscCall(PlacedCreate(dim, n, x, &p));
  if (p.reach > 0) {
    PetscCall(PetscMalloc1(p.n * components, &means));
    PetscCall(NeighboursCreate(dim, p.n, p.at, 0, NULL, NULL, p.reach, &points));
    for (PetscInt k = 0; k < p.n; ++k) mean_around(&p, &points, k, body, components, data, means + k * components);
    for (PetscInt i = 0; i < p.n * components; ++i) data[p.of[i / components] * components + i % components] = means[i];
    PetscCall(NeighboursDestroy(&points));
    PetscCall(PetscFree(means));
  }
  PetscCall(PetscFree2(p.of, p.at));
  PetscFunctionReturn(0);
}
