/* Points find their cells again after they moved; those that left this rank's part of the grid
 * migrate.
 *
 * While the search runs, cell = -2 - old stands for "not found here, was in old": no list is needed
 * until some point leaves, and a step in which none does costs one small reduction. */
#include <stdlib.h>
#include "base/gather.h"
#include "points/migrate.h"
#include "points/fields.h"

#define LOST_KEPT 16

/* What stood out of the grid looks for its place from where it really is. */
static void undo_overhang(Points *points)
{
  if (!points->components[POINT_OVERHANG]) return;
  for (PetscInt i = 0; i < points->n * points->dim; ++i) {
    points->real[POINT_X][i] += points->real[POINT_OVERHANG][i];
    points->real[POINT_OVERHANG][i] = 0;
  }
}

/* Returns how many points are not in a cell of this rank. */
static PetscInt locate_here(Points *points, const Grid *grid)
{
  PetscInt n_leave = 0;
  undo_overhang(points);
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal *x = point_real(points, POINT_X, p);
    const PetscInt old = points->cell[p];
    const PetscBool sane = position_is_finite(points->dim, x);
    const PetscInt cell = sane ? point_locate(points, p, grid, old) : -1;
    points->cell[p] = cell >= 0 ? cell : -2 - old;
    n_leave += cell < 0;
  }
  return n_leave;
}

static PetscErrorCode LeaversCreate(Points *points, const Grid *grid, PetscInt n, Leavers *l)
{
  PetscFunctionBeginUser;
  l->n = 0;
  PetscCall(PetscMalloc3(n, &l->point, n, &l->last_cell, n, &l->owner));
  for (PetscInt p = 0; p < points->n; ++p) {
    if (points->cell[p] >= 0) continue;
    const PetscInt old = -2 - points->cell[p];
    l->point[l->n] = p;
    l->last_cell[l->n] = old >= 0 ? grid->global_cell[old] : -1;
    l->owner[l->n++] = -1;
    points->cell[p] = -1;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode LeaversDestroy(Leavers *l)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(l->point, l->last_cell, l->owner));
  PetscFunctionReturn(0);
}

/* Positions that are no numbers first, then by id: the same list for any number of ranks. */
static int compare_lost(const void *a, const void *b)
{
  const LostPoint *p = a, *q = b;
  const int insane_p = !position_is_finite(3, p->x), insane_q = !position_is_finite(3, q->x);
  if (insane_p != insane_q) return insane_q - insane_p;
  return (p->id > q->id) - (p->id < q->id);
}

static void describe_lost(const Leavers *l, PetscInt i, const Points *points, LostPoint *lost)
{
  const PetscInt p = l->point[i];
  memset(lost, 0, sizeof *lost);
  lost->id = points->id[p];
  lost->last_cell = l->last_cell[i];
  for (PetscInt d = 0; d < points->dim; ++d) {
    lost->x[d] = point_real(points, POINT_X, p)[d];
    lost->v[d] = point_real(points, POINT_V, p)[d];
  }
}

/* This rank's lost points, sorted. */
static PetscErrorCode ListLost(const Leavers *l, const Points *points, PetscInt *n, LostPoint **lost)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(l->n, lost));
  *n = 0;
  for (PetscInt i = 0; i < l->n; ++i)
    if (l->owner[i] == -1) describe_lost(l, i, points, *lost + (*n)++);
  if (*n) qsort(*lost, (size_t)*n, sizeof **lost, compare_lost);
  PetscFunctionReturn(0);
}

/* The first few of all ranks, on every rank. */
static PetscErrorCode GatherLost(const Grid *grid, PetscInt n_mine, const LostPoint *mine, PetscInt *n_lost,
                                 LostPoint **lost)
{
  PetscInt n_all;
  LostPoint *all;
  PetscFunctionBeginUser;
  *lost = NULL;
  PetscCallMPI(MPI_Allreduce(&n_mine, n_lost, 1, MPIU_INT, MPI_SUM, grid->comm));
  if (!*n_lost) PetscFunctionReturn(0);
  PetscCall(GatherAll(grid->comm, sizeof *all, PetscMin(n_mine, LOST_KEPT), mine, &n_all, &all));
  const PetscInt kept = PetscMin(n_all, LOST_KEPT);
  qsort(all, (size_t)n_all, sizeof *all, compare_lost);
  PetscCall(PetscMalloc1(kept, lost));
  PetscCall(PetscArraycpy(*lost, all, kept));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportLost(const Leavers *l, const Points *points, const Grid *grid, PetscInt *n_lost,
                                 LostPoint **lost)
{
  PetscInt n = 0;
  LostPoint *mine = NULL;
  PetscFunctionBeginUser;
  PetscCall(ListLost(l, points, &n, &mine));
  PetscCall(GatherLost(grid, n, mine, n_lost, lost));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(0);
}

/* Forget the points that were sent, and the lost ones if the policy says so. A position that is no
 * number is never dropped: something is wrong, and the caller shall see it. */
static PetscErrorCode DropGone(const Leavers *l, Points *points, OutsidePolicy policy)
{
  PetscBool *drop;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(points->n, &drop));
  for (PetscInt i = 0; i < l->n; ++i) {
    const PetscInt p = l->point[i];
    const PetscBool removed =
      l->owner[i] == -1 && policy == OUTSIDE_REMOVE && position_is_finite(points->dim, point_real(points, POINT_X, p));
    drop[p] = l->owner[i] >= 0 || removed;
    if (!removed) continue;
    tally_outside(points, p, 1);
    ++points->outside.removed;
    points->outside.mass += points->real[POINT_MASS][p];
    points->outside.work += points->real[POINT_WORK][p];
  }
  PetscCall(PointsCompact(points, drop));
  PetscCall(PetscFree(drop));
  PetscFunctionReturn(0);
}

static PetscErrorCode Migrate(Leavers *l, Points *points, const Grid *grid, OutsidePolicy policy, PetscInt *n_lost,
                              LostPoint **lost)
{
  Arrivals arrivals;
  PetscFunctionBeginUser;
  PetscCall(LeaversFindOwners(l, points, grid));
  if (policy == OUTSIDE_KEEP) PetscCall(LeaversClamp(l, points, grid));
  PetscCall(ReportLost(l, points, grid, n_lost, lost));
  PetscCall(LeaversSend(l, points, grid, &arrivals));
  PetscCall(DropGone(l, points, policy));
  PetscCall(ArrivalsUnpack(&arrivals, points, grid));
  PetscFunctionReturn(0);
}

PetscErrorCode PointsRelocate(Points *points, const Grid *grid, OutsidePolicy policy, PetscInt *n_lost,
                              LostPoint **lost)
{
  PetscInt n_leave, n_leave_all;
  Leavers leavers;
  PetscFunctionBeginUser;
  *n_lost = 0;
  *lost = NULL;
  points->outside = (OutsideTally){0};
  n_leave = locate_here(points, grid);
  PetscCallMPI(MPI_Allreduce(&n_leave, &n_leave_all, 1, MPIU_INT, MPI_SUM, grid->comm));
  if (n_leave_all) {
    PetscCall(LeaversCreate(points, grid, n_leave, &leavers));
    PetscCall(Migrate(&leavers, points, grid, policy, n_lost, lost));
    PetscCall(LeaversDestroy(&leavers));
  }
  PetscCall(PointsSort(points));
  PetscFunctionReturn(0);
}
