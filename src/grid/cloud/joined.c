/* Which nodes around a point are joined to it through material. */
#include "basis/cloud/cloud.h"
#include "grid/cloud/matter.h"

/* A way round a corner may be so many times as long as the straight one: down and up the sides of a notch of 60 degrees
 * between two cells of a rim, which is no slot, are 2, half round a hole 1.57, round the end of a slot of one cell from
 * the node beside it 3. */
#define DETOUR 2

static PetscReal distance(PetscInt dim, const PetscReal *a, const PetscReal *b)
{
  PetscReal square = 0;
  for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(a[d] - b[d]);
  return PetscSqrtReal(square);
}

/* The ways round corners, from node to node, the nearest first (Dijkstra); way[i] < 0: there is none yet. */
static void go_round(const CloudMatter *m, PetscInt field, const PetscReal *from, PetscInt n, const PetscReal *X,
                     PetscReal *way)
{
  PetscBool done[CLOUD_MAX_NODES];
  for (PetscInt i = 0; i < n; ++i) done[i] = (PetscBool)(X[i * m->dim] == MATTER_ANYWHERE);
  for (PetscInt round = 0; round < n; ++round) {
    PetscInt a = -1;
    for (PetscInt i = 0; i < n; ++i)
      if (!done[i] && way[i] >= 0 && (a < 0 || way[i] < way[a])) a = i;
    if (a < 0) return;
    done[a] = PETSC_TRUE;
    for (PetscInt b = 0; b < n; ++b) {
      if (done[b]) continue;
      const PetscReal *at = X + b * m->dim, length = way[a] + distance(m->dim, X + a * m->dim, at);
      if (length > DETOUR * distance(m->dim, from, at) || (way[b] >= 0 && length >= way[b])) continue;
      if (matter_joins(m, field, X + a * m->dim, at)) way[b] = length;
    }
  }
}

PetscBool matter_find_joined(const CloudMatter *m, PetscInt field, const PetscReal *from, PetscInt n,
                             const PetscReal *X, PetscBool *joined)
{
  PetscReal way[CLOUD_MAX_NODES];
  PetscInt straight = 0, all = 0;
  if (!matter_holds(m, field, from)) return PETSC_FALSE;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal *at = X + i * m->dim;
    const PetscBool anywhere = (PetscBool)(*at == MATTER_ANYWHERE);
    way[i] = anywhere ? 0 : matter_joins(m, field, from, at) ? distance(m->dim, from, at) : -1;
    straight += way[i] >= 0;
  }
  if (straight < n) go_round(m, field, from, n, X, way);
  for (PetscInt i = 0; i < n; ++i) {
    joined[i] = (PetscBool)(way[i] >= 0);
    all += joined[i];
  }
  return (PetscBool)(all < n);
}
