/* Chains of hops from a point to the nodes around it.
 *
 * A hop may be as long as the gap, or longer by the material's stretch along it: |d| / |F^-1 d|, up
 * to a limit, because after a large shear F has lost the memory of who was whose neighbour. */
#include "basis/cloud/cloud_gap.h"
#include <math.h>

void cloud_candidates(int dim, int n, const PetscReal *X, PetscReal h, const PetscReal *metric, const PetscReal *x,
                      CloudCandidates *near)
{
  near->dim = dim, near->X = X, near->x = x, near->metric = metric, near->h = h, near->known = PETSC_FALSE;
  near->n = n < CLOUD_MAX_NODES ? n : CLOUD_MAX_NODES;
  for (int a = 0; a < near->n; ++a) {
    PetscReal square = 0.0;
    for (int k = 0; k < dim; ++k) square += PetscSqr(X[a * dim + k] - x[k]);
    near->r[a] = sqrt(square) / h;
  }
}

static PetscBool hop(const CloudCandidates *near, const CloudSupport *support, const PetscReal *from,
                     const PetscReal *to)
{
  const int dim = near->dim;
  const PetscReal limit = PetscSqr(support->gap * near->h);
  PetscReal d[3], now = 0.0, before = 0.0;
  for (int k = 0; k < dim; ++k) d[k] = to[k] - from[k], now += d[k] * d[k];
  if (now <= limit) return PETSC_TRUE;
  if (!near->metric || now > limit * PetscSqr(support->stretch)) return PETSC_FALSE;
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim; ++l) before += d[k] * near->metric[k * dim + l] * d[l];
  return before <= limit;
}

/* Spread from the point over the candidates until nothing changes. */
static void link_all(CloudCandidates *near, const CloudSupport *support)
{
  int queue[CLOUD_MAX_NODES], head = 0, tail = 0;
  for (int a = 0; a < near->n; ++a) {
    near->linked[a] = a == 0 || hop(near, support, near->x, near->X + a * near->dim);
    if (near->linked[a]) queue[tail++] = a;
  }
  for (; head < tail && tail < near->n; ++head)
    for (int b = 0; b < near->n; ++b)
      if (!near->linked[b] && hop(near, support, near->X + queue[head] * near->dim, near->X + b * near->dim)) {
        near->linked[b] = PETSC_TRUE;
        queue[tail++] = b;
      }
  near->known = PETSC_TRUE;
}

PetscBool cloud_linked(CloudCandidates *near, const CloudSupport *support, int a, PetscReal radius)
{
  if (support->gap <= 0.0 || radius <= support->gap) return PETSC_TRUE;
  if (!near->known) link_all(near, support);
  return near->linked[a];
}
