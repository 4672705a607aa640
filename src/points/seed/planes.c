/* Where plane sides of a body meet within a part of a cell, at whatever angle they cut it. */
#include "points/seed/seed.h"

#define ALIKE 1e-6  /* 1 - cosine: pieces of one plane */
#define SQUARE 1e-3 /* cosine: planes at right angles */

static PetscReal dot(PetscInt dim, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0;
  for (PetscInt d = 0; d < dim; ++d) sum += a[d] * b[d];
  return sum;
}

static PetscReal cosine(PetscInt dim, const PetscReal *a, const PetscReal *b)
{
  const PetscReal square = dot(dim, a, a) * dot(dim, b, b);
  return square > 0 ? dot(dim, a, b) / PetscSqrtReal(square) : 0;
}

void seed_add_plane(SeedPlanes *planes, PetscInt dim, const PetscReal *area)
{
  PetscInt k = 0;
  if (dot(dim, area, area) == 0) return;
  while (k < planes->n && cosine(dim, planes->area[k], area) < 1 - ALIKE) ++k;
  if (k == SEED_PLANES) return;
  if (k == planes->n) ++planes->n;
  for (PetscInt d = 0; d < dim; ++d) planes->area[k][d] += area[d];
}

void seed_add_planes(SeedPlanes *planes, PetscInt dim, PetscReal share, const SeedPlanes *more)
{
  for (PetscInt k = 0; k < more->n; ++k) {
    PetscReal area[3] = {0};
    for (PetscInt d = 0; d < dim; ++d) area[d] = share * more->area[k][d];
    seed_add_plane(planes, dim, area);
  }
}

/* The largest that is at right angles to n others; -1: none is. */
static PetscInt next_plane(const SeedPlanes *planes, PetscInt dim, PetscInt n, const PetscInt *others)
{
  PetscInt best = -1;
  PetscReal most = 0;
  for (PetscInt k = 0; k < planes->n; ++k) {
    const PetscReal square = dot(dim, planes->area[k], planes->area[k]);
    PetscBool fits = (PetscBool)(square > most);
    for (PetscInt i = 0; i < n; ++i)
      if (PetscAbsReal(cosine(dim, planes->area[k], planes->area[others[i]])) > SQUARE) fits = PETSC_FALSE;
    if (fits) most = square, best = k;
  }
  return best;
}

PetscBool seed_corner_of_planes(const Seeding *s, const SeedPlanes *planes, const PetscReal *position, PetscReal most,
                                PetscReal *corner)
{
  const PetscInt dim = s->source->dim;
  PetscInt chosen[3], n = 0;
  PetscReal to[3] = {0};
  for (PetscInt k; n < dim && (k = next_plane(planes, dim, n, chosen)) >= 0;) chosen[n++] = k;
  if (n < 2) return PETSC_FALSE;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal *area = planes->area[chosen[k]], size = PetscSqrtReal(dot(dim, area, area));
    PetscReal out[3] = {0};
    for (PetscInt d = 0; d < dim; ++d) out[d] = area[d] / size;
    const PetscReal away = seed_way_out(s, position, out, most);
    if (away >= most) return PETSC_FALSE;
    for (PetscInt d = 0; d < dim; ++d) to[d] += away * out[d];
  }
  for (PetscInt d = 0; d < dim; ++d) corner[d] = to[d];
  return PETSC_TRUE;
}
