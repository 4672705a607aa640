#include "grid/partition/bisection.h"

#define HALVINGS 40

/* The tree, without cuts. */
static PetscInt plant(SpaceCuts *cuts, PetscMPIInt first, PetscMPIInt end)
{
  const PetscInt k = cuts->n++;
  cuts->part[k] =
    (SpacePart){.first = first, .middle = first + (end - first) / 2, .end = end, .lower = -1, .upper = -1};
  if (end - first == 1) return k;
  const PetscInt lower = plant(cuts, first, cuts->part[k].middle), upper = plant(cuts, cuts->part[k].middle, end);
  cuts->part[k].lower = lower;
  cuts->part[k].upper = upper;
  return k;
}

/* Extents of the positions in each part, as max and -min, over all ranks. */
static PetscErrorCode Extents(MPI_Comm comm, PetscInt dim, PetscInt n, const PetscReal *x, const PetscInt *at,
                              PetscInt n_parts, PetscReal *extent)
{
  PetscMPIInt length;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 6 * n_parts; ++k) extent[k] = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt d = 0; d < dim; ++d) {
      PetscReal *e = extent + 6 * at[i];
      e[d] = PetscMax(e[d], x[i * dim + d]);
      e[3 + d] = PetscMax(e[3 + d], -x[i * dim + d]);
    }
  PetscCall(PetscMPIIntCast(6 * n_parts, &length));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, extent, length, MPIU_REAL, MPIU_MAX, comm));
  PetscFunctionReturn(0);
}

/* Positions of each part, and those below its cut, over all ranks: total[k], below[k]. */
static PetscErrorCode Count(MPI_Comm comm, PetscInt dim, PetscInt n, const PetscReal *x, const PetscInt *at,
                            const SpaceCuts *cuts, PetscReal *count)
{
  PetscMPIInt length;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * cuts->n; ++k) count[k] = 0;
  for (PetscInt i = 0; i < n; ++i) {
    ++count[2 * at[i]];
    count[2 * at[i] + 1] += x[i * dim + cuts->part[at[i]].axis] < cuts->part[at[i]].cut;
  }
  PetscCall(PetscMPIIntCast(2 * cuts->n, &length));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, length, MPIU_REAL, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

/* Halve the interval of every part's cut until the right share of its positions lies below. */
static PetscErrorCode FindCuts(MPI_Comm comm, PetscInt dim, PetscInt n, const PetscReal *x, const PetscInt *at,
                               SpaceCuts *cuts)
{
  PetscReal *extent, *count; /* parts without positions at this level keep their cut */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(6 * cuts->n, &extent, 2 * cuts->n, &count));
  PetscCall(Extents(comm, dim, n, x, at, cuts->n, extent));
  for (PetscInt k = 0; k < cuts->n; ++k) {
    const PetscReal *e = extent + 6 * k;
    SpacePart *p = &cuts->part[k];
    if (e[0] == -PETSC_MAX_REAL) continue;
    for (PetscInt d = p->axis = 0; d < dim; ++d)
      if (e[d] + e[3 + d] > e[p->axis] + e[3 + p->axis]) p->axis = d;
    p->cut = 0.5 * (e[p->axis] - e[3 + p->axis]);
  }
  for (PetscInt step = 0; step < HALVINGS; ++step) {
    PetscCall(Count(comm, dim, n, x, at, cuts, count));
    for (PetscInt k = 0; k < cuts->n; ++k) {
      SpacePart *p = &cuts->part[k];
      const PetscReal share = (PetscReal)(p->middle - p->first) / (PetscReal)(p->end - p->first);
      if (count[2 * k] == 0) continue;
      if (count[2 * k + 1] > share * count[2 * k]) extent[6 * k + p->axis] = p->cut;
      else extent[6 * k + 3 + p->axis] = -p->cut;
      p->cut = 0.5 * (extent[6 * k + p->axis] - extent[6 * k + 3 + p->axis]);
    }
  }
  PetscCall(PetscFree2(extent, count));
  PetscFunctionReturn(0);
}

PetscErrorCode SpaceCutsCreate(MPI_Comm comm, PetscInt dim, PetscInt n, const PetscReal *x, SpaceCuts *cuts)
{
  PetscMPIInt size;
  PetscInt *at;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  *cuts = (SpaceCuts){.n = 0};
  PetscCall(PetscMalloc1(2 * size, &cuts->part));
  (void)plant(cuts, 0, size);
  PetscCall(PetscCalloc1(n, &at));
  /* one level of the tree after the other */
  for (PetscMPIInt width = size; width > 1; width = (width + 1) / 2) {
    PetscCall(FindCuts(comm, dim, n, x, at, cuts));
    for (PetscInt i = 0; i < n; ++i) {
      const SpacePart *p = &cuts->part[at[i]];
      if (p->lower >= 0) at[i] = x[i * dim + p->axis] < p->cut ? p->lower : p->upper;
    }
  }
  PetscCall(PetscFree(at));
  PetscFunctionReturn(0);
}

PetscErrorCode SpaceCutsDestroy(SpaceCuts *cuts)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(cuts->part));
  PetscFunctionReturn(0);
}

PetscMPIInt space_owner(const SpaceCuts *cuts, const PetscReal *x)
{
  PetscInt k = 0;
  while (cuts->part[k].lower >= 0)
    k = x[cuts->part[k].axis] < cuts->part[k].cut ? cuts->part[k].lower : cuts->part[k].upper;
  return cuts->part[k].first;
}
